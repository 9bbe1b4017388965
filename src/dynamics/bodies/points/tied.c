/*
   Ties in time: the nodes x of a tie follow its masters q, x = T q (contact/tie/tie.c). With the lumped masses D of
   all of them

      a = T (T'D T)^-1 T'f,

   so that forces D a in the place of f make the integrator, which divides by D, keep what follows in place to rounding,
   as at points that are joined rigidly (points/rigid.c). Every rank has all of them and does the same, from the forces
   of all ranks: copies stay bitwise equal. Displacements and velocities at the start are replaced by the nearest in D.
*/
#include "dynamics/bodies/bodiesimpl.h"
#include "base/gather.h"

/* The links of all ranks, with what they follow; the caller frees both */
static PetscErrorCode LinksGather(Bodies b, PetscInt *n, ContactLink **links, ContactLinkNode **nodes)
{
  const ContactLink *own;
  ContactLinkNode   *mine, *next;
  Contact            scene;
  PetscInt           n_own, n_mine = 0, n_nodes;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(b->operators, NULL, &scene));
  PetscCall(ContactGetLinks(scene, &n_own, &own));
  for (PetscInt l = 0; l < n_own; l++) n_mine += own[l].n_master;
  PetscCall(PetscMalloc1(n_mine, &mine));
  next = mine;
  for (PetscInt l = 0; l < n_own; next += own[l++].n_master)
    PetscCall(PetscArraycpy(next, own[l].master, own[l].n_master));
  PetscCall(GatherRecords(b->comm, n_own, sizeof(ContactLink), own, n, links));
  PetscCall(GatherRecords(b->comm, n_mine, sizeof(ContactLinkNode), mine, &n_nodes, nodes));
  PetscCall(PetscFree(mine));
  next = *nodes;
  for (PetscInt l = 0; l < *n; next += (*links)[l++].n_master) (*links)[l].master = next;
  PetscFunctionReturn(0);
}

/* The nodes of all links, ascending: global numbers, and where they are here; places of slaves among them */
static PetscErrorCode TiedFindNodes(Bodies b, PetscInt n_links, const ContactLink links[], Tied *t, PetscInt slave[])
{
  PetscInt n = n_links;

  PetscFunctionBeginUser;
  for (PetscInt l = 0; l < n_links; l++) n += links[l].n_master;
  PetscCall(PetscMalloc1(n, &t->number));
  for (PetscInt l = 0; l < n_links; l++) {
    t->number[t->n++] = links[l].vertex;
    for (PetscInt i = 0; i < links[l].n_master; i++) t->number[t->n++] = links[l].master[i].number;
  }
  PetscCall(PetscSortRemoveDupsInt(&t->n, t->number));
  PetscCall(PetscMalloc1(t->n, &t->vertex));
  for (PetscInt k = 0; k < t->n; k++) t->vertex[k] = -1;
  for (PetscInt v = 0; v < b->mesh->n_nodes; v++) {
    PetscInt k;

    PetscCall(PetscFindInt(b->mesh->number[v], t->n, t->number, &k));
    if (k >= 0) t->vertex[k] = v;
  }
  for (PetscInt l = 0; l < n_links; l++) PetscCall(PetscFindInt(links[l].vertex, t->n, t->number, &slave[l]));
  PetscFunctionReturn(0);
}

/* Columns of the nodes that follow none, -1 of the others */
static PetscErrorCode TiedCountColumns(PetscInt n_links, const PetscInt slave[], Tied *t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(t->n, &t->column));
  for (PetscInt l = 0; l < n_links; l++) t->column[slave[l]] = -1;
  for (PetscInt k = 0; k < t->n; k++)
    if (t->column[k] == 0) t->column[k] = t->n_masters++;
  PetscFunctionReturn(0);
}

/* D, [3 nodes][3 nodes], what each follows */
static PetscErrorCode TiedCreateRows(PetscInt n_links, const ContactLink links[], const PetscInt slave[], const Tied *t,
                                     Mat *D)
{
  PetscInt most = 0;

  PetscFunctionBeginUser;
  for (PetscInt l = 0; l < n_links; l++) most = PetscMax(most, links[l].n_master);
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, 3 * t->n, 3 * t->n, 3 * most, NULL, D));
  for (PetscInt l = 0; l < n_links; l++)
    for (PetscInt i = 0; i < links[l].n_master; i++) {
      const ContactLinkNode *master = &links[l].master[i];
      PetscInt               at;

      PetscCall(PetscFindInt(master->number, t->n, t->number, &at));
      for (int k = 0; k < 9; k++)
        if (master->follow[k] != 0)
          PetscCall(MatSetValue(*D, 3 * slave[l] + k / 3, 3 * at + k % 3, master->follow[k], INSERT_VALUES));
    }
  PetscCall(MatAssemblyBegin(*D, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*D, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* T = E + D E + D^2 E + ..., [3 nodes][3 masters], E the injection of those that follow none: a sum that ends, where
   chains do (operators/points/dependents.c) */
static PetscErrorCode TiedCreateMap(MPI_Comm comm, PetscInt n_links, const ContactLink links[], const PetscInt slave[],
                                    Tied *t)
{
  PetscReal left = 1;
  Mat       D, power, next;

  PetscFunctionBeginUser;
  PetscCall(TiedCreateRows(n_links, links, slave, t, &D));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, 3 * t->n, 3 * t->n_masters, 1, NULL, &t->T));
  for (PetscInt k = 0; k < 3 * t->n; k++)
    if (t->column[k / 3] >= 0) PetscCall(MatSetValue(t->T, k, 3 * t->column[k / 3] + k % 3, 1, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(t->T, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(t->T, MAT_FINAL_ASSEMBLY));
  PetscCall(MatDuplicate(t->T, MAT_COPY_VALUES, &power));
  for (PetscInt step = 0; left > 0; step++) {
    PetscCheck(step <= n_links && t->n_masters, comm, PETSC_ERR_USER_INPUT,
               "-ties go round in a circle, so that nodes follow themselves: of two surfaces that are tied, let the "
               "same one be the slave everywhere");
    PetscCall(MatMatMult(D, power, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &next));
    PetscCall(MatNorm(next, NORM_FROBENIUS, &left));
    if (left > 0) PetscCall(MatAXPY(t->T, 1, next, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatDestroy(&power));
    power = next;
  }
  PetscCall(MatDestroy(&power));
  PetscCall(MatDestroy(&D));
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
    if (mark[v] & (BODIES_AT_RIGID | BODIES_AT_HEAVY | BODIES_AT_SUPER)) fault[TIED_AT_POINT] = 1;
  }
}

/* Raises the errors for nodes of ties that something else moves as well */
static PetscErrorCode TiedCheckNodes(Bodies b, const Tied *t, const unsigned char mark[])
{
  static const char *const what[N_TIED_FAULTS]  = {"supports or motions hold", "a contact surface has",
                                                   "a superelement, or a point that has a mass or is joined rigidly, has"};
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
  Tied            *t = &b->tied;
  ContactLink     *links;
  ContactLinkNode *nodes;
  PetscInt         n_links, *slave;

  PetscFunctionBeginUser;
  PetscCall(LinksGather(b, &n_links, &links, &nodes));
  PetscCall(PetscMalloc1(n_links, &slave));
  if (n_links) {
    PetscCall(TiedFindNodes(b, n_links, links, t, slave));
    PetscCall(TiedCheckNodes(b, t, mark));
    PetscCall(TiedCountColumns(n_links, slave, t));
    PetscCall(TiedCreateMap(b->comm, n_links, links, slave, t));
    PetscCall(TiedFactor(b, t));
  }
  PetscCall(PetscFree(slave));
  PetscCall(PetscFree(links));
  PetscCall(PetscFree(nodes));
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
