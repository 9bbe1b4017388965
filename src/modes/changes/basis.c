/*
   The space on which a changed system is solved: all modes of the system as it was, right and left ones, and how it
   answers to the change. A change adds c(lambda) a a' to Q(lambda), so that the new vectors obey

      Q(lambda) x = -c(lambda) (a'x) a,

   and are answers to forces along a at frequencies of the band: what its modes do not tell of them is spanned by few
   Krylov vectors at the shift of the modes' own factorisation (modes/space/krylov.c). A damped solution by projection
   leaves none, and one is made.
*/
#include "changes.h"
#include "solver/block/orthonormal.h"

#define CHANGE_STEPS 4 /* of the chains; what the last two change tells the error (dense.c) */

/* Coordinates [n][columns of the space] of vectors */
static PetscErrorCode SpaceCoordinates(const ChangeSpace *s, PetscInt n, const Vec a[], PetscReal **coordinates)
{
  const Subspace *space = &s->space.space;
  BV              block;
  Mat             H;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(space->V, n, &block));
  for (PetscInt j = 0; j < n; j++) PetscCall(BVInsertVec(block, j, a[j]));
  PetscCall(PetscMalloc1(n * space->n, coordinates));
  PetscCall(BVSetActiveColumns(space->V, 0, space->n));
  PetscCall(BlockProducts(space->V, NULL, block, &H));
  PetscCall(BlockCopy(H, PETSC_FALSE, space->n, *coordinates));
  PetscCall(MatDestroy(&H));
  PetscCall(BVDestroy(&block));
  PetscFunctionReturn(0);
}

/* Coordinates of the right vectors of all modes */
static PetscErrorCode SpaceKeepBefore(Modes modes, ChangeSpace *s)
{
  Vec *a, x[2], like;

  PetscFunctionBeginUser;
  s->n_before = modes->n;
  PetscCall(MatCreateVecs(s->space.pencil.K, &like, NULL));
  PetscCall(VecDuplicateVecs(like, 2 * modes->n, &a));
  for (PetscInt i = 0; i < modes->n; i++) {
    PetscCall(ModesGetVectors(modes, i, &x[0], &x[1], NULL, NULL));
    for (int part = 0; part < 2; part++)
      if (x[part]) PetscCall(PencilRestrict(modes->pencil, x[part], a[2 * i + part]));
  }
  PetscCall(SpaceCoordinates(s, 2 * modes->n, a, &s->before));
  PetscCall(PetscMalloc1(modes->n, &s->length));
  for (PetscInt i = 0; i < modes->n; i++) PetscCall(ChangeMeasureBefore(s, i, &s->length[i]));
  PetscCall(VecDestroyVecs(2 * modes->n, &a));
  PetscCall(VecDestroy(&like));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceCreate(Modes modes, PetscInt most_terms, ChangeSpace *s)
{
  const ShiftInvert *factor;
  PencilMatrices     pencil;
  PetscInt           n, most;

  PetscFunctionBeginUser;
  *s = (ChangeSpace){.owner = modes->pencil};
  PetscCall(ModesGetFactor(modes, &factor));
  PetscCall(PencilGetMatrices(modes->pencil, &pencil));
  PetscCall(ModesCountVectors(modes, &n));
  most = 2 * n + CHANGE_STEPS * most_terms;
  PetscCall(ModesSpaceCreate(&pencil, n + 2 * CHANGE_STEPS * most_terms, &s->space));
  PetscCall(ModesKrylovCreate(&s->space, factor, PETSC_FALSE, most, &s->right));
  PetscCall(ModesKrylovCreate(&s->space, factor, PETSC_TRUE, pencil.symmetric ? 0 : most, &s->left));
  s->right.n_solves = s->left.n_solves = &s->n_solves;
  PetscCall(ModesKrylovAddModes(modes, modes->pencil, &s->right));
  if (!pencil.symmetric) PetscCall(ModesKrylovAddModes(modes, modes->pencil, &s->left));
  s->n_modes = s->space.space.n;
  PetscCall(SpaceKeepBefore(modes, s));
  s->n_states[0] = s->right.n;
  s->n_states[1] = s->left.n;
  PetscFunctionReturn(0);
}

/* Leaves the modes alone */
static PetscErrorCode SpaceForget(ChangeSpace *s)
{
  PetscFunctionBeginUser;
  PetscCall(SubspaceTruncate(&s->space.space, s->n_modes));
  PetscCall(VecDestroyVecs(s->n_forces, &s->force));
  for (int i = 0; i < 2; i++) PetscCall(PetscFree(s->side[i]));
  s->n_forces = 0;
  PetscFunctionReturn(0);
}

/* Whether the answers to the terms are there: those of another amount at the same place */
static PetscErrorCode SpaceAnswers(const ChangeSpace *s, PetscInt n, const ChangeTerm terms[], PetscBool *answers)
{
  PetscFunctionBeginUser;
  *answers = s->n_forces == n ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt j = 0; j < n && *answers; j++) PetscCall(VecEqual(s->force[j], terms[j].force, answers));
  PetscFunctionReturn(0);
}

static PetscErrorCode SpaceKeepForces(ChangeSpace *s, PetscInt n, const ChangeTerm terms[])
{
  PetscFunctionBeginUser;
  s->n_forces = n;
  PetscCall(VecDuplicateVecs(terms[0].force, n, &s->force));
  for (PetscInt j = 0; j < n; j++) PetscCall(VecCopy(terms[j].force, s->force[j]));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceRespond(ChangeSpace *s, PetscInt n, const ChangeTerm terms[])
{
  Vec      *a[2], like;
  PetscBool answers;

  PetscFunctionBeginUser;
  PetscCall(SpaceAnswers(s, n, terms, &answers));
  if (answers) PetscFunctionReturn(0);
  PetscCall(SpaceForget(s));
  PetscCall(SpaceKeepForces(s, n, terms));
  PetscCall(MatCreateVecs(s->space.pencil.K, &like, NULL));
  for (int i = 0; i < 2; i++) {
    PetscCall(VecDuplicateVecs(like, n, &a[i]));
    for (PetscInt j = 0; j < n; j++)
      PetscCall(PencilProjectForce(s->owner, i ? PETSC_TRUE : PETSC_FALSE, terms[j].force, a[i][j]));
  }
  PetscCall(ModesKrylovRestart(&s->right, s->n_states[0], n, a[0]));
  PetscCall(ModesKrylovRestart(&s->left, s->n_states[1], s->space.pencil.symmetric ? 0 : n, a[1]));
  for (int step = 0; step < CHANGE_STEPS; step++) {
    s->first[0] = step ? s->first[1] : s->space.space.n;
    s->first[1] = s->space.space.n;
    PetscCall(ModesKrylovStep(&s->space, (ModesKrylov *[]){&s->right, &s->left}));
  }
  for (int i = 0; i < 2; i++) {
    PetscCall(SpaceCoordinates(s, n, a[i], &s->side[i]));
    PetscCall(VecDestroyVecs(n, &a[i]));
  }
  PetscCall(VecDestroy(&like));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSpaceDestroy(ChangeSpace *s)
{
  PetscFunctionBeginUser;
  PetscCall(SpaceForget(s));
  PetscCall(PetscFree(s->before));
  PetscCall(PetscFree(s->length));
  PetscCall(ModesKrylovDestroy(&s->right));
  PetscCall(ModesKrylovDestroy(&s->left));
  PetscCall(ModesSpaceDestroy(&s->space));
  PetscFunctionReturn(0);
}
