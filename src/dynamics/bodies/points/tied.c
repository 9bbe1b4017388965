/*
   Ties in time: the nodes x of a tie follow its masters q, x = T q (contact/tie.c). With the lumped masses D of all of
   them

      a = T (T'D T)^-1 T'f,

   so that forces D a in the place of f make the integrator, which divides by D, keep what follows in place to rounding,
   as at points that are joined rigidly (points/rigid.c). Every rank has all of them and does the same, from the forces
   of all ranks: copies stay bitwise equal. Displacements and velocities at the start are replaced by the nearest in D.
*/
#include "dynamics/bodies/bodiesimpl.h"
#include "base/gather.h"

/* The nodes of all links, ascending: global numbers, and where they are here; places of slaves and masters among
   them */
static PetscErrorCode TiedFindNodes(Bodies b, PetscInt n_links, const ContactLink links[], Tied *t, PetscInt slave[],
                                    PetscInt master[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((CONTACT_MAX_MASTER + 1) * n_links, &t->number));
  for (PetscInt l = 0; l < n_links; l++) {
    t->number[t->n++] = links[l].vertex;
    for (PetscInt i = 0; i < links[l].n_master; i++) t->number[t->n++] = links[l].corner[i];
  }
  PetscCall(PetscSortRemoveDupsInt(&t->n, t->number));
  PetscCall(PetscMalloc1(t->n, &t->vertex));
  for (PetscInt k = 0; k < t->n; k++) t->vertex[k] = -1;
  for (PetscInt v = 0; v < b->mesh->n_nodes; v++) {
    PetscInt k;

    PetscCall(PetscFindInt(b->mesh->number[v], t->n, t->number, &k));
    if (k >= 0) t->vertex[k] = v;
  }
  for (PetscInt l = 0; l < n_links; l++) {
    PetscCall(PetscFindInt(links[l].vertex, t->n, t->number, &slave[l]));
    for (PetscInt i = 0; i < links[l].n_master; i++)
      PetscCall(PetscFindInt(links[l].corner[i], t->n, t->number, &master[CONTACT_MAX_MASTER * l + i]));
  }
  PetscFunctionReturn(0);
}

/* Columns of the nodes that follow none, -1 of the others; raises an error where one that follows leads as well */
static PetscErrorCode TiedCountColumns(Bodies b, PetscInt n_links, const ContactLink links[], const PetscInt slave[],
                                       const PetscInt master[], Tied *t)
{
  PetscBool leads = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(t->n, &t->column));
  for (PetscInt l = 0; l < n_links; l++) t->column[slave[l]] = -1;
  for (PetscInt l = 0; l < n_links; l++)
    for (PetscInt i = 0; i < links[l].n_master; i++)
      if (t->column[master[CONTACT_MAX_MASTER * l + i]] < 0) leads = PETSC_TRUE;
  PetscCheck(
    !leads, b->comm, PETSC_ERR_SUP,
    "-ties: nodes follow others that follow others themselves, which -dynamics_model full does not support: let "
    "the body in the middle be the master of both, or take -dynamics_model reduced");
  for (PetscInt k = 0; k < t->n; k++)
    if (t->column[k] == 0) t->column[k] = t->n_masters++;
  PetscFunctionReturn(0);
}

/* T, [3 nodes][3 masters] */
static PetscErrorCode TiedCreateMap(PetscInt n_links, const ContactLink links[], const PetscInt slave[],
                                    const PetscInt master[], Tied *t)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, 3 * t->n, 3 * t->n_masters, 3 * CONTACT_MAX_MASTER, NULL, &t->T));
  for (PetscInt k = 0; k < 3 * t->n; k++)
    if (t->column[k / 3] >= 0) PetscCall(MatSetValue(t->T, k, 3 * t->column[k / 3] + k % 3, 1, INSERT_VALUES));
  for (PetscInt l = 0; l < n_links; l++)
    for (PetscInt i = 0; i < 9 * links[l].n_master; i++) {
      const PetscInt  leads = t->column[master[CONTACT_MAX_MASTER * l + i / 9]];
      const PetscReal c     = links[l].follow[i / 9][i % 9];

      if (c != 0) PetscCall(MatSetValue(t->T, 3 * slave[l] + i % 9 / 3, 3 * leads + i % 3, c, INSERT_VALUES));
    }
  PetscCall(MatAssemblyBegin(t->T, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(t->T, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Masses of all nodes, kg, three times each */
static PetscErrorCode TiedSetMasses(Bodies b, Tied *t)
{
  PetscReal  *mass;
  PetscMPIInt n;

  PetscFunctionBeginUser;
  PetscCall(VecSet(t->mass, 0));
  PetscCall(VecGetArray(t->mass, &mass));
  for (PetscInt k = 0; k < 3 * t->n; k++) {
    const PetscInt v = t->vertex[k / 3];

    if (v >= 0 && b->layout.owned[v]) mass[k] = b->layout.total[b->layout.at[v]];
  }
  PetscCall(PetscMPIIntCast(3 * t->n, &n));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mass, n, MPIU_REAL, MPI_SUM, b->comm));
  PetscCall(VecRestoreArray(t->mass, &mass));
  PetscFunctionReturn(0);
}

/* The factors of T'D T (kg), on every rank: a tie has the nodes of a surface, few beside the bodies. T has full
   column rank, so that T'D T is positive definite. */
static PetscErrorCode TiedFactor(Bodies b, Tied *t)
{
  Mat DT, A;
  PC  pc;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(t->T, &t->q[0], &t->x));
  PetscCall(VecDuplicate(t->q[0], &t->q[1]));
  PetscCall(VecDuplicate(t->x, &t->mass));
  PetscCall(TiedSetMasses(b, t));
  PetscCall(MatDuplicate(t->T, MAT_COPY_VALUES, &DT));
  PetscCall(MatDiagonalScale(DT, t->mass, NULL));
  PetscCall(MatTransposeMatMult(t->T, DT, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &A));
  PetscCall(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &t->inverse));
  PetscCall(KSPSetType(t->inverse, KSPPREONLY));
  PetscCall(KSPSetOperators(t->inverse, A, A));
  PetscCall(KSPGetPC(t->inverse, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(KSPSetUp(t->inverse));
  PetscCall(MatDestroy(&DT));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* What a node of a tie must not be */
enum { TIED_HELD, TIED_IN_CONTACT, TIED_AT_POINT, N_TIED_FAULTS };

/* Which of the faults the local nodes have */
static void TiedFindFaults(Bodies b, const Tied *t, const unsigned char mark[], PetscInt fault[N_TIED_FAULTS])
{
  for (PetscInt k = 0; k < t->n; k++) {
    const PetscInt v = t->vertex[k];

    if (v < 0) continue;
    for (int j = 0; j < 3; j++)
      if (b->layout.minv[b->layout.at[v] + j * b->layout.step[v]] == 0) fault[TIED_HELD] = 1;
    if (mark[v] & BODIES_IN_CONTACT) fault[TIED_IN_CONTACT] = 1;
    if (mark[v] & (BODIES_AT_RIGID | BODIES_AT_HEAVY)) fault[TIED_AT_POINT] = 1;
  }
}

/* Raises the errors for nodes of ties that something else moves as well */
static PetscErrorCode TiedCheckNodes(Bodies b, const Tied *t, const unsigned char mark[])
{
  static const char *const what[N_TIED_FAULTS]  = {"supports or motions hold", "a contact surface has",
                                                   "a point that has a mass, or is joined rigidly, has"};
  PetscInt                 fault[N_TIED_FAULTS] = {0};

  PetscFunctionBeginUser;
  TiedFindFaults(b, t, mark, fault);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, fault, N_TIED_FAULTS, MPIU_INT, MPI_MAX, b->comm));
  for (int i = 0; i < N_TIED_FAULTS; i++)
    PetscCheck(
      !fault[i], b->comm, PETSC_ERR_SUP,
      "-ties: %s nodes of slave or master, which -dynamics_model full does not support: use sets apart from them, or "
      "-dynamics_model reduced",
      what[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode TiedSetUp(Bodies b, const unsigned char mark[])
{
  Tied              *t = &b->tied;
  const ContactLink *own;
  ContactLink       *links;
  Contact            scene;
  PetscInt           n_own, n_links, *slave, *master;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(b->operators, NULL, &scene));
  PetscCall(ContactGetLinks(scene, &n_own, &own));
  PetscCall(GatherRecords(b->comm, n_own, sizeof(ContactLink), own, &n_links, &links));
  PetscCall(PetscMalloc2(n_links, &slave, CONTACT_MAX_MASTER * n_links, &master));
  if (n_links) {
    PetscCall(TiedFindNodes(b, n_links, links, t, slave, master));
    PetscCall(TiedCheckNodes(b, t, mark));
    PetscCall(TiedCountColumns(b, n_links, links, slave, master, t));
    PetscCall(TiedCreateMap(n_links, links, slave, master, t));
    PetscCall(TiedFactor(b, t));
  }
  PetscCall(PetscFree2(slave, master));
  PetscCall(PetscFree(links));
  PetscFunctionReturn(0);
}

/* t->x = what a state vector has at the nodes, of all ranks */
static PetscErrorCode TiedGet(Bodies b, const Tied *t, const PetscReal x[])
{
  PetscReal  *all;
  PetscMPIInt n;

  PetscFunctionBeginUser;
  PetscCall(VecSet(t->x, 0));
  PetscCall(VecGetArray(t->x, &all));
  for (PetscInt k = 0; k < t->n; k++)
    if (t->vertex[k] >= 0 && b->layout.owned[t->vertex[k]]) LayoutGet(&b->layout, t->vertex[k], x, &all[3 * k]);
  PetscCall(PetscMPIIntCast(3 * t->n, &n));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, n, MPIU_REAL, MPI_SUM, b->comm));
  PetscCall(VecRestoreArray(t->x, &all));
  PetscFunctionReturn(0);
}

/* Into a state vector, at all copies */
static PetscErrorCode TiedPut(Bodies b, const Tied *t, PetscReal x[])
{
  const PetscReal *all;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(t->x, &all));
  for (PetscInt k = 0; k < t->n; k++)
    if (t->vertex[k] >= 0) LayoutSet(&b->layout, t->vertex[k], &all[3 * k], x);
  PetscCall(VecRestoreArrayRead(t->x, &all));
  PetscFunctionReturn(0);
}

/* Forces f become D T (T'D T)^-1 T'f; motions x become T (T'D T)^-1 T'D x. One sum over the ranks of 3 n numbers. */
PetscErrorCode TiedApply(Bodies b, PetscBool forces, PetscReal x[])
{
  const Tied *t = &b->tied;

  PetscFunctionBeginUser;
  if (!t->n) PetscFunctionReturn(0);
  PetscCall(TiedGet(b, t, x));
  if (!forces) PetscCall(VecPointwiseMult(t->x, t->mass, t->x));
  PetscCall(MatMultTranspose(t->T, t->x, t->q[0]));
  PetscCall(KSPSolve(t->inverse, t->q[0], t->q[1]));
  PetscCall(MatMult(t->T, t->q[1], t->x));
  if (forces) PetscCall(VecPointwiseMult(t->x, t->mass, t->x));
  PetscCall(TiedPut(b, t, x));
  PetscFunctionReturn(0);
}

PetscErrorCode TiedDestroy(Tied *t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(t->number));
  PetscCall(PetscFree(t->vertex));
  PetscCall(PetscFree(t->column));
  PetscCall(MatDestroy(&t->T));
  PetscCall(KSPDestroy(&t->inverse));
  for (int i = 0; i < 2; i++) PetscCall(VecDestroy(&t->q[i]));
  PetscCall(VecDestroy(&t->x));
  PetscCall(VecDestroy(&t->mass));
  PetscFunctionReturn(0);
}
