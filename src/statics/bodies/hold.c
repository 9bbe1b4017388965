/*
   How rigid motions r that nothing resists (rigid.c) are held: each at one unknown by a pin, a grounded spring. This is
   a statically determinate support, whose reaction is zero in equilibrium whatever its stiffness. Forces that would
   move a body along r are an error, and u is made free of r (r'M u = 0).
*/
#include "statics/staticsimpl.h"

/* force along a free motion beside all forces: rounding of sums of loads is far below it */
#define RESISTED 1e-8

/* Entry i of r, on all ranks */
static PetscErrorCode EntryGet(Vec r, PetscInt i, PetscScalar *entry)
{
  PetscScalar here = 0;
  PetscInt    begin, end;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(r, &begin, &end));
  if (i >= begin && i < end) PetscCall(VecGetValues(r, 1, &i, &here));
  PetscCallMPI(MPI_Allreduce(&here, entry, 1, MPIU_SCALAR, MPI_SUM, PetscObjectComm((PetscObject)r)));
  PetscFunctionReturn(0);
}

/* The largest entry of n vectors: in which of them, and where */
static PetscErrorCode LargestEntry(PetscInt n, const Vec r[], PetscInt *which, PetscInt *where)
{
  PetscReal largest = -1;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscReal high, low;
    PetscInt  at_high, at_low;

    PetscCall(VecMax(r[i], &at_high, &high));
    PetscCall(VecMin(r[i], &at_low, &low));
    if (PetscMax(high, -low) <= largest) continue;
    largest = PetscMax(high, -low);
    *which  = i;
    *where  = high >= -low ? at_high : at_low;
  }
  PetscFunctionReturn(0);
}

/* Unknowns at which the free motions are held, by elimination with full pivoting: the largest entry of what is left
   of all motions becomes the next pin, so that the matrix of motions at the pins is as well conditioned as can be had
   cheaply. Without this a pin near the axis of a rotation would hardly hold it. */
static PetscErrorCode PinsChoose(Hold *hold)
{
  Vec *r;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(hold->n, &hold->pin));
  PetscCall(VecDuplicateVecs(hold->r[0], hold->n, &r));
  for (PetscInt i = 0; i < hold->n; i++) PetscCall(VecCopy(hold->r[i], r[i]));
  for (PetscInt j = 0; j < hold->n; j++) {
    PetscScalar pivot, entry;
    PetscInt    best = 0;

    PetscCall(LargestEntry(hold->n - j, &r[j], &best, &hold->pin[j]));
    if (best) PetscCall(VecSwap(r[j], r[j + best]));
    PetscCall(EntryGet(r[j], hold->pin[j], &pivot));
    for (PetscInt i = j + 1; i < hold->n; i++) {
      PetscCall(EntryGet(r[i], hold->pin[j], &entry));
      PetscCall(VecAXPY(r[i], -entry / pivot, r[j]));
    }
  }
  PetscCall(VecDestroyVecs(hold->n, &r));
  PetscFunctionReturn(0);
}

/* Stiffness of a pin: the mean of A's diagonal, N/m. Any would do, since its reaction vanishes; one of this size
   keeps the condition of A what it is. */
PetscErrorCode HoldCreate(Operators operators, const PetscReal p[], Mat A, Hold *hold)
{
  PetscScalar sum;
  PetscInt    n, begin, end;
  Vec         diagonal;

  PetscFunctionBeginUser;
  PetscCall(FreeMotionsCreate(operators, p, A, hold));
  if (!hold->n) PetscFunctionReturn(0);
  PetscCall(PinsChoose(hold));
  PetscCall(MatCreateVecs(A, &diagonal, NULL));
  PetscCall(MatGetDiagonal(A, diagonal));
  PetscCall(VecGetSize(diagonal, &n));
  PetscCall(VecSum(diagonal, &sum));
  PetscCall(VecGetOwnershipRange(diagonal, &begin, &end));
  PetscCall(VecDestroy(&diagonal));
  hold->stiffness = PetscRealPart(sum) / (PetscReal)n;
  for (PetscInt i = 0; i < hold->n; i++)
    if (hold->pin[i] >= begin && hold->pin[i] < end)
      PetscCall(MatSetValue(A, hold->pin[i], hold->pin[i], hold->stiffness, ADD_VALUES));
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Where an unknown is, on all ranks */
typedef struct {
  PetscReal   x[3];
  int         direction, part;
  const char *name; /* of the part */
} UnknownPlace;

static PetscErrorCode UnknownFind(Operators operators, PetscInt unknown, UnknownPlace *place)
{
  const Mesh *mesh;
  PetscInt    at = -1;
  MPI_Comm    comm;
  Model       model;

  PetscFunctionBeginUser;
  *place = (UnknownPlace){.x = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL}, .direction = -1, .part = -1};
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++)
    if (mesh->unknown[i] == unknown) at = i;
  for (PetscInt c = 0; c < mesh->n_cells && at >= 0; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1]; i++)
      if (mesh->cell_node[i] == at / 3) place->part = (int)mesh->cell_part[c];
  if (at >= 0) PetscCall(PetscArraycpy(place->x, &mesh->x[at - at % 3], 3));
  if (at >= 0) place->direction = (int)(at % 3);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, place->x, 3, MPIU_REAL, MPI_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &place->direction, 2, MPI_INT, MPI_MAX, comm));
  place->name = place->part >= 0 ? mesh->part[place->part] : "?";
  PetscFunctionReturn(0);
}

/* What f would move, the motion m = sum (r_i . f) r_i: its largest entry, where that is, and the work f . m. work /
   largest is the force (N) that pushes the place which moves most. */
static PetscErrorCode HoldMove(const Hold *hold, Vec f, PetscInt *at, PetscScalar *largest, PetscScalar *work)
{
  PetscInt    which;
  PetscScalar along;
  Vec         motion;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(f, &motion));
  PetscCall(VecSet(motion, 0));
  for (PetscInt i = 0; i < hold->n; i++) {
    PetscCall(VecDot(f, hold->r[i], &along));
    PetscCall(VecAXPY(motion, along, hold->r[i]));
  }
  PetscCall(LargestEntry(1, &motion, &which, at));
  PetscCall(EntryGet(motion, *at, largest));
  PetscCall(VecDot(f, motion, work));
  PetscCall(VecDestroy(&motion));
  PetscFunctionReturn(0);
}

PetscErrorCode HoldIsPushed(const Hold *hold, Vec f, PetscReal size, PetscBool *pushed)
{
  PetscInt    at;
  PetscScalar largest, work;

  PetscFunctionBeginUser;
  *pushed = PETSC_FALSE;
  if (!hold->n) PetscFunctionReturn(0);
  PetscCall(HoldMove(hold, f, &at, &largest, &work));
  *pushed = PetscAbsScalar(work) <= RESISTED * size * PetscAbsScalar(largest) ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode HoldCheck(Operators operators, const Hold *hold, const char force[], Vec f, PetscReal size)
{
  PetscInt     at;
  PetscScalar  along, largest;
  PetscBool    pushed;
  UnknownPlace place;

  PetscFunctionBeginUser;
  PetscCall(HoldIsPushed(hold, f, size, &pushed));
  if (!pushed) PetscFunctionReturn(0);
  PetscCall(HoldMove(hold, f, &at, &largest, &along));
  PetscCall(UnknownFind(operators, at, &place));
  SETERRQ(
    PetscObjectComm((PetscObject)f), PETSC_ERR_USER_INPUT,
    "no equilibrium: %s push part %s with %.6g N along a rigid motion that nothing resists, which moves it most along "
    "%c, at %.6g, %.6g, %.6g m; give -supports, -springs or other -loads",
    force, place.name, (double)PetscAbsScalar(along / largest), "xyz"[place.direction], (double)place.x[0],
    (double)place.x[1], (double)place.x[2]);
  PetscFunctionReturn(0);
}

PetscErrorCode HoldFindLoose(Operators operators, const PetscReal p[], const Hold *hold, Mat A, const char **part)
{
  Hold left = {.n = 0};

  PetscFunctionBeginUser;
  *part = NULL;
  PetscCall(FreeMotionsCreate(operators, p, A, &left));
  if (left.n > hold->n) {
    UnknownPlace tips;

    PetscCall(PinsChoose(&left));
    PetscCall(UnknownFind(operators, left.pin[0], &tips));
    *part = tips.name;
  }
  PetscCall(HoldDestroy(&left));
  PetscFunctionReturn(0);
}

PetscErrorCode HoldProject(const Hold *hold, Vec u)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < hold->n; i++) {
    PetscScalar dot;

    PetscCall(VecDot(u, hold->mr[i], &dot));
    PetscCall(VecAXPY(u, -dot, hold->r[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode HoldRelieve(const Hold *hold, Vec f)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < hold->n; i++) {
    PetscScalar along;

    PetscCall(VecDot(f, hold->r[i], &along));
    PetscCall(VecAXPY(f, -along, hold->mr[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode HoldDestroy(Hold *hold)
{
  PetscFunctionBeginUser;
  if (hold->n) PetscCall(VecDestroyVecs(hold->n, &hold->r));
  if (hold->n) PetscCall(VecDestroyVecs(hold->n, &hold->mr));
  PetscCall(PetscFree(hold->pin));
  hold->n = 0;
  PetscFunctionReturn(0);
}
