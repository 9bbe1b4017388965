/*
   The bodies factored with the pairs at their present status: where thousands of pairs are open, K_a, in which all of
   them press, is too far from the system that is to be solved. z of a pair is eliminated from w = Q_e z + q0,

      K_s = K_a + kappa (G'(X - I) - S' D X) G,   X = P Q_e^-1,   Q_e = Q + REFACTOR_YIELD P,

   so that an open pair drops out of K_s, and one that is rigid (Q = 0) gets a spring of kappa / REFACTOR_YIELD. The
   small system with Q_e in the place of Q, a z = r, is solved by

      K_s u = -kappa (G'(X - I) - S' D X) r,   z = Q_e^-1 (r + G u),

   and is the preconditioner of GMRES on the small system itself, which that spring changes by REFACTOR_YIELD alone: a
   handful of steps, whatever the number of pairs. All statuses have one pattern, hence one symbolic analysis. Where u
   = Z q, G Z, S Z and Z'K_a Z stand for G, S and K_a.

   The determinant of the small system with Q_e is det K_s det Q_e / det K_a, of which det K_a > 0 and det Q_e > 0 (a
   triangle of blocks, of which that across the slip is (1 - alpha) E + e e' or more): the sign of det K_s tells whether
   the bodies jam (small.c). With Q_e pairs that share a force do not make it zero.
*/
#include "statics/pairs/small.h"
#include "base/algebra/dense.h"

/* compliance of rigid pairs over 1 / kappa: it leaves as many digits to rounding, and costs GMRES two or three steps */
#define REFACTOR_YIELD 1e-5
/* change of X over X from which on the law of a pair is another one */
#define REFACTOR_OTHER 0.5
/* the same, up to which the factors and their determinant are those of the law */
#define REFACTOR_SAME 1e-6

struct _StatusFactor {
  const Compliance *compliance;
  ShiftInvert       inverse;   /* of K_s */
  PetscBool         symmetric; /* K_s is */
  PetscBool         stands;    /* there are factors, of the laws X */
  Mat               G, S, K;   /* S NULL without sliding pairs */
  PetscReal        *X, *Qinv;  /* [rows][3] rows of the block of each pair */
  PetscReal        *slide;     /* [rows] D times the factor of friction */
  Vec               q, b;      /* work: unknowns that are factored */
};

PetscErrorCode StatusFactorCreate(const Compliance *c, StatusFactor *factor)
{
  const PetscInt n = c->rows->n;
  StatusFactor   f;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, factor));
  f             = *factor;
  f->compliance = c;
  f->symmetric  = !c->rows->S && !PairRowsCoulomb(c->rows) ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscCalloc3(3 * n, &f->X, 3 * n, &f->Qinv, n, &f->slide));
  if (c->Z) {
    PetscCall(MatMatMult(c->rows->G, c->Z, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &f->G));
    if (c->rows->S) PetscCall(MatMatMult(c->rows->S, c->Z, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &f->S));
  } else {
    PetscCall(PetscObjectReference((PetscObject)c->rows->G));
    if (c->rows->S) PetscCall(PetscObjectReference((PetscObject)c->rows->S));
    f->G = c->rows->G;
    f->S = c->rows->S;
  }
  PetscCall(MatCreateVecs(f->G, &f->q, NULL));
  PetscCall(VecDuplicate(f->q, &f->b));
  PetscFunctionReturn(0);
}

PetscErrorCode StatusFactorDestroy(StatusFactor *factor)
{
  StatusFactor f = *factor;

  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(0);
  PetscCall(ShiftInvertDestroy(&f->inverse));
  PetscCall(MatDestroy(&f->G));
  PetscCall(MatDestroy(&f->S));
  PetscCall(MatDestroy(&f->K));
  PetscCall(VecDestroy(&f->q));
  PetscCall(VecDestroy(&f->b));
  PetscCall(PetscFree3(f->X, f->Qinv, f->slide));
  PetscCall(PetscFree(*factor));
  PetscFunctionReturn(0);
}

/* X and Q_e^-1 of a pair, [d][3] */
static PetscErrorCode LawCondense(const LawRow law[], PetscReal X[], PetscReal Qinv[])
{
  const PetscInt d = law[0].d;
  PetscReal      Q[9], inverse[9];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d; i++)
    for (PetscInt k = 0; k < d; k++) {
      Q[k * d + i]       = law[i].Q[k] + REFACTOR_YIELD * law[i].P[k];
      inverse[k * d + i] = i == k;
    }
  PetscCall(DenseSolveWith(d, Q, d, inverse, NULL));
  for (PetscInt i = 0; i < d; i++)
    for (PetscInt k = 0; k < d; k++) {
      Qinv[3 * i + k] = inverse[k * d + i];
      X[3 * i + k]    = 0;
      for (PetscInt j = 0; j < d; j++) X[3 * i + k] += law[i].P[j] * inverse[k * d + j];
    }
  PetscFunctionReturn(0);
}

/* Change of the law of a pair from X to Y, over the larger one or 1 */
static PetscReal LawChange(PetscInt d, const PetscReal X[], const PetscReal Y[])
{
  PetscReal largest = 1, difference = 0;

  for (PetscInt i = 0; i < 3 * d; i++) {
    largest    = PetscMax(largest, PetscMax(PetscAbsReal(X[i]), PetscAbsReal(Y[i])));
    difference = PetscMax(difference, PetscAbsReal(X[i] - Y[i]));
  }
  return difference / largest;
}

PetscErrorCode StatusFactorCompare(StatusFactor f, const SmallSystem *s, FactorDistance *d)
{
  const PairRows *rows = f->compliance->rows;
  PetscReal       X[9] = {0}, unused[9], largest = 0;

  PetscFunctionBeginUser;
  *d = (FactorDistance){.stands = f->stands};
  for (PetscInt p = 0; p < rows->n_pairs && f->stands; p++) {
    const PetscInt first = rows->first[p];
    PetscReal      change;

    PetscCall(LawCondense(&s->law[first], X, unused));
    change = LawChange(rows->law[p].d, &f->X[3 * first], X);
    d->n_other += change > REFACTOR_OTHER ? rows->law[p].d : 0;
    largest = PetscMax(largest, change);
    largest = PetscMax(largest, PetscAbsReal(s->friction * s->law[first].slide - f->slide[first]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &d->n_other, 1, MPIU_INT, MPI_SUM, rows->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPI_MAX, rows->comm));
  d->same = f->stands && largest <= REFACTOR_SAME ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Blocks kappa (X - I), or of the rows of sliding pairs kappa D X, on the diagonal of a matrix of all rows, N/m */
static PetscErrorCode LawMatrix(const StatusFactor f, PetscBool slide, Mat *A)
{
  const PairRows *rows  = f->compliance->rows;
  const PetscReal kappa = f->compliance->kappa;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(rows->comm, rows->n, rows->n, PETSC_DETERMINE, PETSC_DETERMINE, 3, NULL, 0, NULL, A));
  for (PetscInt p = 0; p < rows->n_pairs; p++)
    for (PetscInt i = rows->first[p]; i < rows->first[p + 1]; i++)
      for (PetscInt k = 0; k < rows->law[p].d; k++) {
        const PetscReal X     = f->X[3 * i + k];
        const PetscReal value = slide ? f->slide[i] * X : X - (i == rows->first[p] + k);

        PetscCall(MatSetValue(*A, rows->begin + i, rows->begin + rows->first[p] + k, kappa * value, INSERT_VALUES));
      }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* K += factor R' B G, B the blocks */
static PetscErrorCode LawAdd(const StatusFactor f, PetscBool slide, MatStructure pattern)
{
  Mat B, BG, RBG;

  PetscFunctionBeginUser;
  PetscCall(LawMatrix(f, slide, &B));
  PetscCall(MatMatMult(B, f->G, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &BG));
  PetscCall(MatTransposeMatMult(slide ? f->S : f->G, BG, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &RBG));
  PetscCall(MatAXPY(f->K, slide ? -1 : 1, RBG, pattern));
  PetscCall(MatDestroy(&RBG));
  PetscCall(MatDestroy(&BG));
  PetscCall(MatDestroy(&B));
  PetscFunctionReturn(0);
}

/* K_s, in place from the second time on */
static PetscErrorCode StatusFactorForm(StatusFactor f)
{
  const MatStructure pattern = f->K ? SUBSET_NONZERO_PATTERN : DIFFERENT_NONZERO_PATTERN;
  Mat                Ka;

  PetscFunctionBeginUser;
  PetscCall(KSPGetOperators(f->compliance->inverse.ksp, &Ka, NULL));
  if (f->K)
    PetscCall(MatCopy(Ka, f->K, SUBSET_NONZERO_PATTERN));
  else
    PetscCall(MatDuplicate(Ka, MAT_COPY_VALUES, &f->K));
  PetscCall(LawAdd(f, PETSC_FALSE, pattern));
  if (f->S) PetscCall(LawAdd(f, PETSC_TRUE, pattern));
  PetscCall(MatSetOption(f->K, MAT_SYMMETRIC, f->symmetric));
  PetscFunctionReturn(0);
}

PetscErrorCode StatusFactorSet(StatusFactor f, const SmallSystem *s, PetscBool *singular)
{
  const PairRows *rows   = f->compliance->rows;
  PencilMatrices  pencil = {.symmetric = f->symmetric};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt i = rows->first[p];

    PetscCall(LawCondense(&s->law[i], &f->X[3 * i], &f->Qinv[3 * i]));
    f->slide[i] = s->friction * s->law[i].slide;
  }
  PetscCall(StatusFactorForm(f));
  pencil.K        = f->K;
  f->inverse.comm = rows->comm;
  f->inverse.even = f->symmetric;
  f->inverse.bare = PETSC_TRUE;
  PetscCall(ShiftInvertFactor(&pencil, &f->inverse, singular));
  f->stands = *singular ? PETSC_FALSE : PETSC_TRUE;
  (*s->n_factored)++;
  PetscFunctionReturn(0);
}

PetscErrorCode SmallIsReversed(const SmallSystem *s, PetscBool *reversed)
{
  StatusFactor   f        = s->compliance->status;
  PetscBool      singular = PETSC_FALSE;
  FactorDistance d;

  PetscFunctionBeginUser;
  PetscCall(StatusFactorCompare(f, s, &d));
  if (!d.same) PetscCall(StatusFactorSet(f, s, &singular));
  *reversed = PETSC_FALSE;
  if (!singular) PetscCall(ShiftInvertIsNegative(&f->inverse, reversed));
  PetscFunctionReturn(0);
}

/* out = A in of each pair, blocks A [rows][3] */
static void BlocksMult(const PairRows *rows, const PetscReal A[], const PetscScalar in[], PetscScalar out[])
{
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt first = rows->first[p];

    for (PetscInt i = first; i < rows->first[p + 1]; i++) {
      out[i] = 0;
      for (PetscInt k = 0; k < rows->law[p].d; k++) out[i] += A[3 * i + k] * in[first + k];
    }
  }
}

/* b = kappa (S' D X r - G'(X - I) r); Xr is work */
static PetscErrorCode StatusFactorForces(StatusFactor f, Vec r, Vec Xr)
{
  const PairRows    *rows  = f->compliance->rows;
  const PetscReal    kappa = f->compliance->kappa;
  const PetscScalar *in;
  PetscScalar       *out;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(r, &in));
  PetscCall(VecGetArray(Xr, &out));
  BlocksMult(rows, f->X, in, out);
  for (PetscInt i = 0; i < rows->n; i++) out[i] = kappa * (in[i] - out[i]);
  PetscCall(VecRestoreArray(Xr, &out));
  PetscCall(MatMultTranspose(f->G, Xr, f->b));
  if (f->S) {
    PetscCall(VecGetArray(Xr, &out));
    BlocksMult(rows, f->X, in, out);
    for (PetscInt i = 0; i < rows->n; i++) out[i] *= kappa * f->slide[i];
    PetscCall(VecRestoreArray(Xr, &out));
    PetscCall(MatMultTransposeAdd(f->S, Xr, f->b, f->b));
  }
  PetscCall(VecRestoreArrayRead(r, &in));
  PetscFunctionReturn(0);
}

PetscErrorCode StatusFactorApply(StatusFactor f, Vec r, Vec z)
{
  const PetscScalar *in;
  PetscScalar       *out;
  Vec                w;

  PetscFunctionBeginUser;
  PetscCall(StatusFactorForces(f, r, z));
  PetscCall(ShiftInvertSolve(&f->inverse, PETSC_FALSE, f->b, f->q));
  PetscCall(VecDuplicate(r, &w));
  PetscCall(MatMultAdd(f->G, f->q, r, w));
  PetscCall(VecGetArrayRead(w, &in));
  PetscCall(VecGetArray(z, &out));
  BlocksMult(f->compliance->rows, f->Qinv, in, out);
  PetscCall(VecRestoreArray(z, &out));
  PetscCall(VecRestoreArrayRead(w, &in));
  PetscCall(VecDestroy(&w));
  PetscFunctionReturn(0);
}
