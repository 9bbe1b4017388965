/*
   Displacements that follow others: the nodes of points that are joined rigidly (rigid.c), the slaves of ties
   (contact/tie/tie.c) and what stands first in an equation (equations.c). With D the rows of the followers and E the
   injection of all others, q = E'u,

      u = D u + E q = Z q,   Z = E + D E + D^2 E + ...,

   which ends since no chain of followers comes back to where it began. Pencils are projected on Z, symmetric ones stay
   symmetric; forces that Z'f = 0 leaves are those that hold the followers. A displacement that follows none but held
   ones is 0.
*/
#include "dependents.h"

/* The rows of a node that follows others by a tie */
static PetscErrorCode LinkAddRows(const ContactLink *link, PetscInt by, Dependents *d)
{
  PetscReal *value;
  PetscInt  *column;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * link->n_master, &value, 3 * link->n_master, &column));
  for (PetscInt i = 0; i < 3 * link->n_master; i++) column[i] = link->master[i / 3].unknown[i % 3];
  for (int e = 0; e < 3; e++) {
    if (link->slave[e] < 0) continue;
    for (PetscInt i = 0; i < 3 * link->n_master; i++) value[i] = link->master[i / 3].follow[3 * e + i % 3];
    PetscCall(DependentsClaim(d, link->slave[e], by));
    PetscCall(DependentsFollow(d, link->slave[e], 3 * link->n_master, column, value));
  }
  PetscCall(PetscFree2(value, column));
  PetscFunctionReturn(0);
}

/* What follows what, of points, of ties, then of equations */
static PetscErrorCode DependentsAddRows(Operators o, const Leaders *by, Dependents *d)
{
  const ContactLink *link;
  PetscInt           n;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < by->n_sets; s++) PetscCall(RigidAddRows(&by->set[s], s, d));
  PetscCall(ContactGetLinks(o->contact, &n, &link));
  for (PetscInt l = 0; l < n; l++) PetscCall(LinkAddRows(&link[l], by->n_sets + link[l].tie, d));
  PetscCall(EquationsAddRows(&by->equations, d->n_lists - 1, d));
  PetscFunctionReturn(0);
}

/* Raises the error for a node that two lists claim */
static PetscErrorCode DependentsCheck(Operators o, const Leaders *by, Dependents *d)
{
  const ContactTie *tie;
  PetscInt          n, a, b;

  PetscFunctionBeginUser;
  PetscCall(ContactGetTies(o->contact, &n, &tie));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &d->conflict, 1, MPIU_INT, MPI_MAX, o->comm));
  if (d->conflict < 0) PetscFunctionReturn(0);
  PetscCheck(
    d->conflict % d->n_lists < by->n_sets + n, o->comm, PETSC_ERR_USER_INPUT,
    "-model_equations: a displacement that stands first in an equation follows already, %s: let another one of "
    "the equation stand first",
    d->conflict / d->n_lists < by->n_sets       ? "by a point that is joined rigidly"
    : d->conflict / d->n_lists < by->n_sets + n ? "by a tie"
                                                : "by another equation");
  a = d->conflict / d->n_lists - by->n_sets;
  b = d->conflict % d->n_lists - by->n_sets;
  PetscCheck(b >= 0, o->comm, PETSC_ERR_USER_INPUT,
             "two points that are joined rigidly have nodes in common: join the whole to one of them");
  PetscCheck(a >= 0, o->comm, PETSC_ERR_USER_INPUT,
             "tie %s: nodes of %s are joined rigidly to point %s as well, and can follow one alone: swap -%s_surfaces, "
             "or name sets without common nodes",
             tie[b].name, tie[b].slave, by->set[a + by->n_sets].point->name, tie[b].name);
  SETERRQ(
    o->comm, PETSC_ERR_USER_INPUT,
    "ties %s and %s: nodes of %s and %s are the same, and can follow one surface alone: swap the -surfaces of one, or "
    "name sets without common nodes",
    tie[a].name, tie[b].name, tie[a].slave, tie[b].slave);
}

/* D, empty, once its rows are counted */
static PetscErrorCode DependentsCreate(Operators o, Dependents *d)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d->n; i++) d->count[i] = PetscMin(d->count[i], d->n);
  PetscCall(MatCreateAIJ(o->comm, d->n, d->n, PETSC_DETERMINE, PETSC_DETERMINE, 0, d->count, 0, d->count, &d->D));
  PetscFunctionReturn(0);
}

/* E of what follows nothing */
static PetscErrorCode DependentsInject(Operators o, const Dependents *d)
{
  PetscInt n = 0, column;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d->n; i++) n += !d->follows[i];
  PetscCall(MatCreateAIJ(o->comm, d->n, n, PETSC_DETERMINE, PETSC_DETERMINE, 1, NULL, 0, NULL, &o->E));
  PetscCall(MatGetOwnershipRangeColumn(o->E, &column, NULL));
  for (PetscInt i = 0; i < d->n; i++)
    if (!d->follows[i]) PetscCall(MatSetValue(o->E, d->first + i, column++, 1, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(o->E, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(o->E, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Keeps of y what follows some of what y has, which are never more; how many are left over all ranks. (D y)_i is 0
   where i follows nothing that is left. */
static PetscErrorCode ChainsShorten(const Dependents *d, Vec y, Vec product, PetscInt *left)
{
  const PetscScalar *to;
  PetscScalar       *from;

  PetscFunctionBeginUser;
  *left = 0;
  PetscCall(MatMult(d->D, y, product));
  PetscCall(VecGetArrayRead(product, &to));
  PetscCall(VecGetArray(y, &from));
  for (PetscInt i = 0; i < d->n; i++) {
    if (to[i] == 0) from[i] = 0;
    *left += from[i] != 0;
  }
  PetscCall(VecRestoreArray(y, &from));
  PetscCall(VecRestoreArrayRead(product, &to));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, left, 1, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)y)));
  PetscFunctionReturn(0);
}

/* Raises an error where a chain of followers comes back to where it began: what is at the ends of chains is taken off
   until none is left, or all that are follow one of themselves. y has irrational entries, so that rows of D with
   weights of both signs do not sum to 0 by accident. Each pass takes off one or ends. */
static PetscErrorCode DependentsCheckChains(Operators o, const Dependents *d)
{
  PetscScalar *y;
  PetscInt     left, before;
  Vec          from, product;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(d->D, &from, &product));
  PetscCall(VecGetArrayWrite(from, &y));
  for (PetscInt i = 0; i < d->n; i++)
    y[i] = 1 + PetscSqrtReal((PetscReal)(d->first + i + 2)); /* no row takes it to 0 */
  PetscCall(VecRestoreArrayWrite(from, &y));
  PetscCall(VecGetSize(from, &left));
  do {
    before = left;
    PetscCall(ChainsShorten(d, from, product, &left));
  } while (0 < left && left < before);
  PetscCall(VecDestroy(&from));
  PetscCall(VecDestroy(&product));
  PetscCheck(
    left == 0, o->comm, PETSC_ERR_USER_INPUT,
    "%s go round in a circle, so that nodes follow themselves: of two surfaces that are tied, let the same one "
    "be the slave everywhere",
    o->dependent);
  PetscFunctionReturn(0);
}

/* Z = E + D E + D^2 E + ..., one product for each link of the longest chain; D^k E is exactly 0 then */
static PetscErrorCode DependentsSum(Operators o, const Dependents *d)
{
  Mat       power = o->E, next;
  PetscReal left  = 1;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(o->E, MAT_COPY_VALUES, &o->Z));
  while (left > 0) {
    PetscCall(MatMatMult(d->D, power, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &next));
    PetscCall(MatProductClear(next));
    PetscCall(MatNorm(next, NORM_FROBENIUS, &left));
    if (left > 0) PetscCall(MatAXPY(o->Z, 1, next, DIFFERENT_NONZERO_PATTERN));
    if (power != o->E) PetscCall(MatDestroy(&power));
    power = next;
  }
  PetscCall(MatDestroy(&power));
  PetscFunctionReturn(0);
}

/* In words, who is there */
static PetscErrorCode DependentsName(Operators o, const Leaders *by)
{
  const ContactTie *tie;
  PetscInt          n;
  char              ties[80] = "", points[80] = "";
  const PetscInt    n_sets = by->n_sets;

  PetscFunctionBeginUser;
  PetscCall(ContactGetTies(o->contact, &n, &tie));
  if (n) PetscCall(PetscSNPrintf(ties, sizeof(ties), "-ties %s%s", tie[0].name, n > 1 ? " and others" : ""));
  if (n_sets)
    PetscCall(PetscSNPrintf(points, sizeof(points), "-points joined rigidly (%s%s)", by->set[0].point->name,
                            n_sets > 1 ? " and others" : ""));
  PetscCall(PetscSNPrintf(o->dependent, sizeof(o->dependent), "%s%s%s%s%s", ties, n && n_sets ? " or " : "", points,
                          (n || n_sets) && by->equations.n ? " or " : "", by->equations.n ? "-model_equations" : ""));
  PetscFunctionReturn(0);
}

/* Counts the rows, and checks that no two claim one */
static PetscErrorCode DependentsCount(Operators o, const Leaders *by, Dependents *d)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  d->first = mesh->first_own;
  d->n     = mesh->n_own;
  PetscCall(PetscCalloc1(d->n, &o->follows));
  d->follows = o->follows;
  PetscCall(PetscCalloc2(d->n, &d->by, d->n, &d->count));
  for (PetscInt i = 0; i < d->n; i++) d->by[i] = -1;
  PetscCall(DependentsAddRows(o, by, d));
  PetscCall(DependentsCheck(o, by, d));
  PetscFunctionReturn(0);
}

/* Z and E from the rows, once they are counted */
static PetscErrorCode DependentsResolve(Operators o, const Leaders *by, Dependents *d)
{
  PetscFunctionBeginUser;
  PetscCall(DependentsName(o, by));
  PetscCall(DependentsCreate(o, d));
  PetscCall(DependentsAddRows(o, by, d));
  PetscCall(MatAssemblyBegin(d->D, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(d->D, MAT_FINAL_ASSEMBLY));
  PetscCall(DependentsCheckChains(o, d));
  PetscCall(DependentsInject(o, d));
  PetscCall(DependentsSum(o, d));
  PetscCall(MatDestroy(&d->D));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCreateDependents(Operators o)
{
  const ContactTie *tie;
  Leaders           by;
  PetscInt          n_ties;

  PetscFunctionBeginUser;
  PetscCall(RigidSetsCreate(o, &by.n_sets, &by.set));
  PetscCall(EquationsCreate(o, &by.equations));
  PetscCall(ContactGetTies(o->contact, &n_ties, &tie));
  if (by.n_sets + n_ties + by.equations.n) {
    Dependents d = {.n_lists = by.n_sets + n_ties + (by.equations.n > 0), .conflict = -1};

    PetscCall(DependentsCount(o, &by, &d));
    if (!o->omit) PetscCall(DependentsResolve(o, &by, &d));
    PetscCall(PetscFree2(d.by, d.count));
  }
  PetscCall(RigidSetsDestroy(by.n_sets, by.set));
  PetscCall(EquationsDestroy(&by.equations));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetDependents(Operators o, Mat *Z, Mat *E)
{
  PetscFunctionBeginUser;
  if (Z) *Z = o->Z;
  if (E) *E = o->E;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCheckSpinningTies(Operators o, PetscInt part)
{
  const ContactTie *tie;
  const Mesh       *mesh;
  PetscInt          n_ties;
  PetscBool        *on;

  PetscFunctionBeginUser;
  PetscCall(ContactGetTies(o->contact, &n_ties, &tie));
  if (!n_ties) PetscFunctionReturn(0);
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(OperatorsMarkPart(mesh, part, &on));
  for (PetscInt t = 0; t < 2 * n_ties; t++) {
    PetscInt  n, *node;
    PetscBool spins = PETSC_FALSE;

    PetscCall(ModelGetSetNodes(o->model, t % 2 ? tie[t / 2].master : tie[t / 2].slave, &n, &node));
    for (PetscInt i = 0; i < n; i++)
      if (on[node[i]]) spins = PETSC_TRUE;
    PetscCall(PetscFree(node));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &spins, 1, MPIU_BOOL, MPI_LOR, o->comm));
    PetscCheck(
      !spins, o->comm, PETSC_ERR_SUP,
      "tie %s has nodes of part %s, which -%s_spin turns: that is not supported; give both bodies one mesh there",
      tie[t / 2].name, mesh->part[part], mesh->part[part]);
  }
  PetscCall(PetscFree(on));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilTakeDependents(Pencil pencil)
{
  const Operators o = pencil->operators;

  PetscFunctionBeginUser;
  if (!o->Z || pencil->Zr) PetscFunctionReturn(0);
  PetscCall(PetscObjectReference((PetscObject)o->Z));
  PetscCall(PetscObjectReference((PetscObject)o->E));
  pencil->Zr = o->Z;
  pencil->E  = o->E;
  PetscFunctionReturn(0);
}
