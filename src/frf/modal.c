/*
   Superposition of modes with the residual term: Galerkin's method on V, the span of the modes' vectors and of what
   the modes' own factorisation makes of forces, which grows until the answer stays what it is,

      H_p(omega) = l_p' V (V' Q(i omega) V)^-1 V' f,   m/N.

   Left and right vectors are in one V, so that the error of H is the product of what both leave of the force and of the
   outputs. The error at a frequency is the difference from the answer with one step more.
*/
#include "modes/space/answers.h"
#include "schur.h"
#include "solver/block/orthonormal.h"

/* Frequencies that are looked at while the space grows; all are looked at before it ends. */
#define N_LOOKS 33

#define RESPONSE_KEEP 0.03 /* of what answers leave: smaller directions are left to the next step */

typedef struct {
  ModesSpace   space;
  ModesAnswers answers;
  Vec          b, *l, *all; /* the force, the outputs, and both */
  PetscReal    shift;
  FrfSchur     used, larger; /* the small response before the last step, and after it */
} Superposition;

/* Space with the modes. With a symmetric pencil left vectors are right ones: the right side answers to the force and
   to the outputs. The factors are borrowed from the modes. */
static PetscErrorCode SuperpositionCreate(Frf frf, Superposition *s)
{
  PencilMatrices     pencil;
  const ShiftInvert *kept;

  PetscFunctionBeginUser;
  PetscCall(ModesGetFactor(frf->modes, &kept));
  PetscCall(PencilGetMatrices(frf->pencil, &pencil));
  PetscCall(FrfProject(frf, &s->b, &s->l));
  s->shift = kept->shift;
  if (pencil.C && !ShiftInvertIsDamped(kept)) s->shift = PetscSqrtReal(PetscAbsReal(kept->shift));
  PetscCall(ModesSpaceCreate(&pencil, &s->space));
  PetscCall(PetscMalloc1(frf->n_outputs + 1, &s->all));
  s->all[0] = s->b;
  PetscCall(PetscArraycpy(s->all + 1, s->l, frf->n_outputs));
  s->answers = (ModesAnswers){.space    = &s->space,
                              .factor   = *kept,
                              .keep     = RESPONSE_KEEP,
                              .edge     = {PETSC_MAX_REAL, 0},
                              .n        = {1, frf->n_outputs},
                              .b        = {s->all, s->l},
                              .n_solves = &frf->n_solves};
  if (pencil.symmetric) s->answers.n[0] = frf->n_outputs + 1, s->answers.n[1] = 0;
  s->answers.factor.progress = &frf->progress;
  s->answers.factor.after    = NULL;
  for (PetscInt i = 0; i < frf->n; i++) {
    s->answers.edge[0] = PetscMin(s->answers.edge[0], 2 * PETSC_PI * frf->freq[i]);
    s->answers.edge[1] = PetscMax(s->answers.edge[1], 2 * PETSC_PI * frf->freq[i]);
  }
  PetscCall(ModesSpaceAddModes(&s->space, frf->modes, frf->pencil, PETSC_FALSE));
  if (!pencil.symmetric) PetscCall(ModesSpaceAddModes(&s->space, frf->modes, frf->pencil, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* One step of both sides */
static PetscErrorCode SuperpositionStep(Frf frf, Superposition *s)
{
  PetscFunctionBeginUser;
  frf->n_steps++;
  PetscCall(ModesAnswersStep(&s->answers));
  PetscFunctionReturn(0);
}

/* The force and the outputs in coordinates */
static PetscErrorCode EndsCreate(Frf frf, const Superposition *s, FrfEnds *ends)
{
  PetscFunctionBeginUser;
  ends->n_outputs = frf->n_outputs;
  PetscCall(ModesSpaceProducts(&s->space, frf->n_outputs + 1, s->all, &ends->b));
  ends->l = ends->b + s->space.space.n;
  PetscFunctionReturn(0);
}

/* Both responses at the frequencies first, first + step and so on, FRF_BATCH at most; the error is their difference.
   schur[0] NULL: its responses are there already. work[4][FRF_BATCH][n_outputs]. Returns in *singular one that is a
   pole
 */
static PetscErrorCode RespondBatch(Frf frf, const FrfSchur *schur[2], PetscInt first, PetscInt step, PetscReal work[],
                                   PetscInt *singular)
{
  const PetscInt n = frf->n_outputs, block = FRF_BATCH * n, m = PetscMin(FRF_BATCH, (frf->n - 1 - first) / step + 1);
  PetscReal      omega[FRF_BATCH];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < m; f++) omega[f] = 2 * PETSC_PI * frf->freq[first + f * step];
  for (int k = 0; k < 2; k++) {
    PetscInt pole;

    if (!schur[k]) continue;
    PetscCall(FrfSchurRespond(schur[k], m, omega, &work[2 * k * block], &work[(2 * k + 1) * block], &pole));
    if (pole >= 0) *singular = first + pole * step;
  }
  for (PetscInt f = 0; f < m; f++) {
    const PetscReal *re = &work[f * n], *im = re + block;
    const PetscInt   i = first + f * step;

    if (schur[0]) PetscCall(PetscArraycpy(&frf->re[i * n], re, n));
    if (schur[0]) PetscCall(PetscArraycpy(&frf->im[i * n], im, n));
    for (PetscInt p = 0; p < n; p++)
      frf->error[i] +=
        PetscSqr(re[2 * block + p] - frf->re[i * n + p]) + PetscSqr(im[2 * block + p] - frf->im[i * n + p]);
    frf->error[i] = PetscSqrtReal(frf->error[i]);
  }
  PetscFunctionReturn(0);
}

/* Response at every stride-th frequency, shared among ranks in turn; the error is the difference of the two. used
   NULL: what is there already is its response. Sums over ranks, as each has zeros where it did nothing. */
static PetscErrorCode RespondAll(Frf frf, const FrfSchur *used, const FrfSchur *larger, PetscInt stride)
{
  const PetscInt n = frf->n_outputs;
  PetscReal     *work;
  PetscMPIInt    rank, size;
  PetscInt       singular = -1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(frf->comm, &rank));
  PetscCallMPI(MPI_Comm_size(frf->comm, &size));
  PetscCall(PetscMalloc1(4 * FRF_BATCH * n, &work));
  if (used) PetscCall(PetscArrayzero(frf->re, n * frf->n));
  if (used) PetscCall(PetscArrayzero(frf->im, n * frf->n));
  PetscCall(PetscArrayzero(frf->error, frf->n));
  for (PetscInt i = rank * stride; i < frf->n; i += FRF_BATCH * size * stride)
    PetscCall(RespondBatch(frf, (const FrfSchur *[]){used, larger}, i, size * stride, work, &singular));
  PetscCall(PetscFree(work));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &singular, 1, MPIU_INT, MPI_MAX, frf->comm));
  PetscCheck(singular < 0, frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_frequencies: %.15g Hz is a pole, where the response is infinite", (double)frf->freq[singular]);
  for (int part = 0; part < 2 && used; part++)
    PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, part ? frf->im : frf->re, (PetscMPIInt)(n * frf->n), MPIU_REAL, MPI_SUM, frf->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, frf->error, (PetscMPIInt)frf->n, MPIU_REAL, MPI_SUM, frf->comm));
  PetscFunctionReturn(0);
}

/* Largest relative error at the frequencies that were looked at, and where */
static PetscReal WorstError(Frf frf, PetscInt stride, PetscInt *where)
{
  PetscReal worst = 0;

  *where = 0;
  for (PetscInt i = 0; i < frf->n; i += stride) {
    const PetscReal size = FrfMagnitude(frf, i), relative = size > 0 ? frf->error[i] / size : frf->error[i] > 0;

    if (relative <= worst) continue;
    worst  = relative;
    *where = i;
  }
  return worst;
}

/* The small response on the space as it is, with K rounded otherwise if asked for */
static PetscErrorCode SuperpositionReduce(Frf frf, const Superposition *s, PetscBool rounded, FrfSchur *schur)
{
  FrfEnds ends;

  PetscFunctionBeginUser;
  PetscCall(EndsCreate(frf, s, &ends));
  PetscCall(FrfSchurCreate(&s->space, rounded, s->shift, &ends, schur));
  PetscCall(PetscFree(ends.b));
  PetscFunctionReturn(0);
}

/* Steps until the answer is accurate but for rounding, of which the error that is told at the end has its part: the
   larger response is made once more with K rounded otherwise (space.c). */
static PetscErrorCode SuperpositionGrow(Frf frf, Superposition *s)
{
  const PetscInt stride = PetscMax(1, frf->n / N_LOOKS);
  PetscReal      worst  = PETSC_MAX_REAL;
  PetscInt       where  = 0;

  PetscFunctionBeginUser;
  PetscCall(SuperpositionStep(frf, s));
  PetscCall(SuperpositionReduce(frf, s, PETSC_FALSE, &s->larger));
  while (worst > frf->rtol && frf->n_steps < frf->max_steps + 1) {
    PetscCall(SuperpositionStep(frf, s));
    PetscCall(FrfSchurDestroy(&s->used));
    s->used = s->larger;
    PetscCall(SuperpositionReduce(frf, s, PETSC_FALSE, &s->larger));
    PetscCall(RespondAll(frf, &s->used, &s->larger, stride));
    worst = WorstError(frf, stride, &where);
    if (worst > frf->rtol || stride == 1) continue;
    PetscCall(RespondAll(frf, &s->used, &s->larger, 1));
    worst = WorstError(frf, 1, &where);
  }
  PetscCheck(worst <= frf->rtol, frf->comm, PETSC_ERR_NOT_CONVERGED,
             "the estimated error at %.6g Hz is %.2g after %" PetscInt_FMT
             " steps, more than -frf_rtol %.2g: let -modes_band end farther above it, or raise -frf_max_steps",
             (double)frf->freq[where], (double)worst, frf->n_steps - 1, (double)frf->rtol);
  PetscCall(FrfSchurDestroy(&s->larger));
  PetscCall(SuperpositionReduce(frf, s, PETSC_TRUE, &s->larger));
  PetscCall(RespondAll(frf, NULL, &s->larger, 1));
  PetscFunctionReturn(0);
}

static PetscErrorCode SuperpositionDestroy(Frf frf, Superposition *s)
{
  PetscFunctionBeginUser;
  PetscCall(FrfSchurDestroy(&s->used));
  PetscCall(FrfSchurDestroy(&s->larger));
  PetscCall(ModesSpaceDestroy(&s->space));
  PetscCall(VecDestroy(&s->b));
  PetscCall(PetscFree(s->all));
  PetscCall(VecDestroyVecs(frf->n_outputs, &s->l));
  PetscFunctionReturn(0);
}

/* What the force radiates, on the space with one step more */
static PetscErrorCode SuperpositionHear(Frf frf, Superposition *s)
{
  FrfSchur field[2];

  PetscFunctionBeginUser;
  if (!FrfHears(frf)) PetscFunctionReturn(0);
  PetscCall(FrfFieldCreate(&s->space, s->shift, s->b, &field[0]));
  PetscCall(ModesAnswersStep(&s->answers));
  PetscCall(FrfFieldCreate(&s->space, s->shift, s->b, &field[1]));
  PetscCall(FrfHearFields(frf, &s->space, field));
  for (int k = 0; k < 2; k++) PetscCall(FrfSchurDestroy(&field[k]));
  PetscFunctionReturn(0);
}

/* Collective. The factors of the modes are kept for the answers: no further factorisation. Residues name the
   modes of peaks; they are not summed. */
PetscErrorCode FrfSolveModal(Frf frf)
{
  FrfResidues   residues;
  Superposition s = {.shift = 0};
  PetscBool     terms;

  PetscFunctionBeginUser;
  PetscCall(ModesKeepFactor(frf->modes, PETSC_TRUE));
  PetscCall(ModesSetPencil(frf->modes, frf->pencil));
  PetscCall(ModesPrepareComponents(frf->modes, &terms));
  PetscCall(ModesSolve(frf->modes));
  PetscCall(ModesFindComponents(frf->modes));
  PetscCall(FrfCheckPoles(frf));
  PetscCall(SuperpositionCreate(frf, &s));
  PetscCall(SuperpositionGrow(frf, &s));
  frf->n_vectors = s.space.space.n;
  PetscCall(SuperpositionHear(frf, &s));
  PetscCall(SuperpositionDestroy(frf, &s));
  PetscCall(FrfResiduesCreate(frf, &residues));
  PetscCall(FrfFindPeaks(frf, &residues));
  PetscCall(FrfResiduesDestroy(&residues));
  if (frf->n_times) PetscCall(FrfSolveImpulse(frf));
  PetscFunctionReturn(0);
}
