/*
   Groups of ranks that share the parts of a band: each holds the whole matrices among its ranks and solves part after
   part by itself; vectors then go back to all ranks. An error of one group is raised by all.
*/
#include "base/fault.h"
#include "groups.h"

PetscErrorCode GroupsCreate(MPI_Comm comm, PetscInt n, const PencilMatrices *pencil, Groups *groups)
{
  PetscBool known, symmetric;

  PetscFunctionBeginUser;
  *groups = (Groups){.comm = comm, .n = n, .pencil = {.symmetric = pencil->symmetric}};
  PetscCall(PetscSubcommCreate(comm, &groups->ranks));
  PetscCall(PetscSubcommSetNumber(groups->ranks, n));
  PetscCall(PetscSubcommSetType(groups->ranks, PETSC_SUBCOMM_CONTIGUOUS));
  groups->mine = groups->ranks->color;
  PetscCall(MatCreateVecs(pencil->K, &groups->like, NULL));
  for (int i = 0; i < 2; i++) {
    const Mat  A = i ? pencil->M : pencil->K;
    Mat *const B = i ? &groups->pencil.M : &groups->pencil.K;

    PetscCall(MatCreateRedundantMatrix(A, n, PetscSubcommChild(groups->ranks), MAT_INITIAL_MATRIX, B));
    PetscCall(MatIsSymmetricKnown(A, &known, &symmetric));
    if (known) PetscCall(MatSetOption(*B, MAT_SYMMETRIC, symmetric));
  }
  PetscFunctionReturn(0);
}

/* Right and left modes of a part, with the factors of this group; all is made and freed among its ranks */
static PetscErrorCode GroupSolve(Modes modes, const Groups *groups, Window *part)
{
  ShiftInvert si;

  PetscFunctionBeginUser;
  PetscCall(ShiftInvertCreate(&groups->pencil, WindowMiddle(part), PETSC_FALSE, &modes->progress, &si));
  PetscCall(ModesSolveWindow(modes, &groups->pencil, part, &si));
  PetscCall(ShiftInvertDestroy(&si));
  PetscFunctionReturn(0);
}

/* Keeps the first message of a group's error */
static PetscErrorCode GroupKeepError(MPI_Comm comm, int line, const char *function, const char *file,
                                     PetscErrorCode code, PetscErrorType type, const char *message, void *ctx)
{
  Fault *const fault = ctx;

  (void)comm, (void)line, (void)function, (void)file;
  if (type == PETSC_ERROR_INITIAL && !fault->code)
    (void)FaultNote(fault, code, "%s", message && message[0] ? message : "a group of ranks failed");
  return code;
}

PetscErrorCode GroupsSolve(Modes modes, const Groups *groups, Window *part)
{
  const PetscBool show  = ShiftInvertShows();
  Fault           fault = {0};

  PetscFunctionBeginUser;
  if (part) {
    struct _p_Modes alone = *modes;

    alone.comm          = PetscSubcommChild(groups->ranks);
    alone.right         = (Spectrum){0};
    alone.left_spectrum = (Spectrum){0};
    alone.counter       = (ShiftInvert){.progress = &modes->progress};
    if (groups->mine) ShiftInvertShow(PETSC_FALSE);
    PetscCall(PetscPushErrorHandler(GroupKeepError, &fault));
    (void)GroupSolve(&alone, groups, part);
    PetscCall(PetscPopErrorHandler());
    if (groups->mine) ShiftInvertShow(show);
    modes->right         = alone.right;
    modes->left_spectrum = alone.left_spectrum;
    PetscCall(PetscStrncpy(modes->solver, alone.solver, sizeof(modes->solver)));
  }
  PetscCall(FaultsRaise(groups->comm, &fault));
  PetscFunctionReturn(0);
}

/* The first rank of a group among all */
static PetscMPIInt GroupsRoot(const Groups *groups, PetscInt group)
{
  PetscMPIInt root = 0;

  for (PetscInt g = 0; g < group; g++) root += groups->ranks->subsize[g];
  return root;
}

/* y on all ranks of what is x in the layout of the ranks of `group` */
static PetscErrorCode GroupsGatherVec(const Groups *groups, PetscInt group, Vec x, Vec y)
{
  const PetscScalar *values = NULL;
  PetscInt           n      = 0, first, last;
  IS                 is;
  Vec                wide;
  VecScatter         scatter;

  PetscFunctionBeginUser;
  if (groups->mine == group) PetscCall(VecGetLocalSize(x, &n));
  if (groups->mine == group) PetscCall(VecGetArrayRead(x, &values));
  PetscCall(VecCreateMPIWithArray(groups->comm, 1, n, PETSC_DETERMINE, values, &wide));
  PetscCall(VecGetOwnershipRange(y, &first, &last));
  PetscCall(ISCreateStride(groups->comm, last - first, first, 1, &is));
  PetscCall(VecScatterCreate(wide, is, y, is, &scatter));
  PetscCall(VecScatterBegin(scatter, wide, y, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, wide, y, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(ISDestroy(&is));
  PetscCall(VecDestroy(&wide));
  if (groups->mine == group) PetscCall(VecRestoreArrayRead(x, &values));
  PetscFunctionReturn(0);
}

PetscErrorCode GroupsGather(const Groups *groups, PetscInt group, const Spectrum *from, Spectrum *to)
{
  const PetscMPIInt root = GroupsRoot(groups, group);
  PetscInt          n    = from->n;
  Vec               v[2];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&n, 1, MPIU_INT, root, groups->comm));
  PetscCall(SpectrumCreate(n, to));
  for (int k = 0; k < 2; k++) PetscCall(VecDuplicate(groups->like, &v[k]));
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool mine      = groups->mine == group ? PETSC_TRUE : PETSC_FALSE;
    PetscReal       lambda[3] = {mine ? from->sigma[i] : 0, mine ? from->omega[i] : 0, mine && from->xi[i] ? 1 : 0};

    PetscCallMPI(MPI_Bcast(lambda, 3, MPIU_REAL, root, groups->comm));
    PetscCall(GroupsGatherVec(groups, group, mine ? from->xr[i] : NULL, v[0]));
    if (lambda[2] > 0) PetscCall(GroupsGatherVec(groups, group, mine ? from->xi[i] : NULL, v[1]));
    PetscCall(SpectrumAdd(to, lambda[0], lambda[1], v[0], lambda[2] > 0 ? v[1] : NULL));
  }
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&v[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode GroupsAgree(const Groups *groups, PetscInt group, PetscReal *value)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(value, 1, MPIU_REAL, GroupsRoot(groups, group), groups->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode GroupsDestroy(Groups *groups)
{
  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&groups->like));
  PetscCall(MatDestroy(&groups->pencil.K));
  PetscCall(MatDestroy(&groups->pencil.M));
  PetscCall(PetscSubcommDestroy(&groups->ranks));
  PetscFunctionReturn(0);
}
