/*
   Branches. A mode that is alone in its cluster, or whose cluster stays what it is (a doublet), hands its vectors on
   from point to point. When modes join (two lock in, several meet at a point) their branches live on in the common
   plane, each with the vectors that it had before; when the plane falls apart again, branches go where their remembered
   vectors lie,

      score(r, Q) = sum_{j in Q} (w_r^T x_j) (w_j^T x_r),

   the coefficient of branch r in itself after a detour over the modes of Q. Where this does not decide, the order of
   frequency is kept. Of an unstable pair the branch that was the lower one takes the unstable member.
*/
#include "branch.h"

/* Takes the vectors of mode i */
static PetscErrorCode BranchRemember(Branch *branch, const ModeFrame *frame, PetscInt i)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(branch->x, frame->X + i * frame->N, frame->N));
  PetscCall(PetscArraycpy(branch->y, frame->Y + i * frame->N, frame->N));
  PetscCall(PetscArraycpy(branch->w, frame->W + i * frame->N, frame->N));
  branch->lambda = frame->modes.lambda[i];
  branch->joined = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Makes a branch that has the vectors of mode i */
static PetscErrorCode BranchStart(Branch *branch, const ModeFrame *frame, PetscInt i)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(frame->N, &branch->x, frame->N, &branch->y, frame->N, &branch->w));
  PetscCall(BranchRemember(branch, frame, i));
  PetscFunctionReturn(0);
}

/* A new branch that begins with mode i */
static PetscErrorCode BranchListAdd(BranchList *list, ModeFrame *frame, PetscInt i)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((list->n + 1) * sizeof(*list->branch), &list->branch));
  PetscCall(BranchStart(&list->branch[list->n], frame, i));
  frame->branch[i] = list->first + list->n++;
  PetscFunctionReturn(0);
}

PetscErrorCode BranchListBegin(BranchList *list, ModeFrame *frame)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < frame->modes.n; i++) PetscCall(BranchListAdd(list, frame, i));
  PetscFunctionReturn(0);
}

/* score [nb] of a branch with the modes of b */
static PetscErrorCode BranchScore(const Branch *branch, const ModeFrame *b, PetscReal score[])
{
  const PetscInt nb = b->modes.n;
  PetscComplex  *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(nb, &sum));
  ModeFrameOverlap(b, branch->w, branch->x, sum);
  for (PetscInt j = 0; j < nb; j++) score[j] = b->form.damped ? cabs(sum[b->cluster[j]]) : creal(sum[b->cluster[j]]);
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

/* Hands the vectors on. A branch is joined from when it shares a cluster whose component had several clusters at a,
   and keeps the vectors from before until it is alone again: in the common plane vectors are any combinations. */
static PetscErrorCode BranchListUpdate(BranchList *list, const ModeFrame *b, const Match *match)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < b->modes.n; j++) {
    Branch        *branch = list->branch + b->branch[j] - list->first;
    const PetscInt size   = ModeFrameClusterSize(b, j);

    if (match->from[j] < 0) continue;
    if (size > 1 && match->clusters_a[match->component_b[j]] > 1) branch->joined = PETSC_TRUE;
    if (size == 1 || !branch->joined) PetscCall(BranchRemember(branch, b, j));
  }
  PetscFunctionReturn(0);
}

/* Modes are assigned by strength, joined branches by their score with remembered vectors; order = frequency that a
   branch had before it joined, so that the order within the plane is that before. Modes of b without a partner
   begin branches. */
PetscErrorCode BranchListContinue(BranchList *list, const ModeFrame *a, ModeFrame *b, Match *match)
{
  const PetscInt na = a->modes.n, nb = b->modes.n;
  PetscReal     *score, *order;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(na * nb, &score, na, &order));
  PetscCall(PetscArraycpy(score, match->strength, na * nb));
  for (PetscInt i = 0; i < na; i++) {
    const Branch *branch = list->branch + a->branch[i] - list->first;

    order[i] = cimag(branch->lambda);
    if (branch->joined) PetscCall(BranchScore(branch, b, score + i * nb));
  }
  PetscCall(MatchAssign(a, b, score, order, match));
  for (PetscInt j = 0; j < nb; j++) {
    if (match->from[j] < 0)
      PetscCall(BranchListAdd(list, b, j));
    else
      b->branch[j] = a->branch[match->from[j]];
  }
  PetscCall(BranchListUpdate(list, b, match));
  PetscCall(PetscFree2(score, order));
  PetscFunctionReturn(0);
}

/* Takes the vectors of entry m of a memory, with w^T x = 1 in the pencil of the frame */
static PetscErrorCode BranchRecall(Branch *branch, const ModeFrame *frame, const ReducedModes *modes, PetscInt m)
{
  const PetscInt n = modes->size, N = frame->N;
  PetscComplex   product;

  PetscFunctionBeginUser;
  branch->lambda = modes->lambda[m];
  branch->joined = PETSC_TRUE;
  StandardVector(&frame->form, branch->lambda, modes->x + m * n, branch->x);
  StandardVector(&frame->form, branch->lambda, modes->y + m * n, branch->y);
  PetscCall(StandardApply(&frame->form, STANDARD_B, PETSC_TRUE, 1, branch->y, branch->w));
  product = DenseDot(N, branch->w, branch->x);
  for (PetscInt k = 0; k < N && product != 0; k++) branch->w[k] /= product, branch->y[k] /= product;
  PetscFunctionReturn(0);
}

/* The branches as they were after point a, from the modes there and the remembered vectors of joined ones; those
   without a mode at a have no vectors and never match again. */
PetscErrorCode BranchListResume(BranchList *list, PetscInt n_branches, const ModeFrame *a, const BranchMemory *memory)
{
  PetscFunctionBeginUser;
  *list = (BranchList){.n = n_branches};
  PetscCall(PetscCalloc1(PetscMax(1, n_branches), &list->branch));
  for (PetscInt i = 0; i < a->modes.n; i++) PetscCall(BranchStart(&list->branch[a->branch[i]], a, i));
  for (PetscInt m = 0; m < memory->modes.n; m++) {
    Branch *branch = &list->branch[memory->branch[m]];

    if (branch->x) PetscCall(BranchRecall(branch, a, &memory->modes, m));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BranchListSave(const BranchList *list, const ModeFrame *b, BranchMemory *memory)
{
  ReducedModes *modes = &memory->modes;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < b->modes.n; j++) {
    const Branch *branch = &list->branch[b->branch[j] - list->first];

    if (!branch->joined || (b->form.damped && b->modes.rigid[j]))
      continue; /* a double zero has other vectors (frame.c) */
    modes->lambda[modes->n]  = branch->lambda;
    memory->branch[modes->n] = b->branch[j];
    PetscCall(PetscArraycpy(modes->x + modes->n * modes->size, branch->x, modes->size));
    PetscCall(PetscArraycpy(modes->y + modes->n * modes->size, branch->y, modes->size));
    modes->n++;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BranchListDestroy(BranchList *list)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < list->n; r++) PetscCall(PetscFree3(list->branch[r].x, list->branch[r].y, list->branch[r].w));
  PetscCall(PetscFree(list->branch));
  list->n = 0;
  PetscFunctionReturn(0);
}
