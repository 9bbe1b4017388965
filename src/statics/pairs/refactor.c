/*
   The bodies factored with the pairs at their present status: where thousands of pairs are open, K_a, in which all of
   them press, is too far from the system that is to be solved. z of a pair is eliminated from w = Q_e z + q0,

      K_s = K_a + kappa (G'(X - I) - S' D X) G,   X = P Q_e^-1,   Q_e = Q + REFACTOR_YIELD P,

   so that an open pair drops out of K_s, and one that is rigid (Q = 0) gets a spring of kappa / REFACTOR_YIELD. K_s
   takes the place of K_a, whose factors go, exactly and for the laws of any status: with w = G u

      K_s u = f - kappa G'(l - X w) + kappa S' (D l - D_s X w),

   D_s = D when K_s was made, are the same equations as with X = I, D_s = 0. At the laws of K_s l - X w is but
   REFACTOR_YIELD X l, so that the small system, multiplied by Q_e^-1, is I and a little: GMRES takes a handful of
   steps, whatever the number of pairs, and as many more as rows have other laws. All statuses have one pattern, hence
   one symbolic analysis. Where u = Z q, G Z, S Z and Z'K_a Z stand for G, S and K_a.

   What friction adds to K_s makes it unsymmetric, D_s and the force along the slip by l_n in X (all else in X is
   symmetric: P and Q of a pair commute). Left out of K_s, it costs GMRES some ten steps, while LDL' takes half of the
   memory and of the flops of LU: it is put in where GMRES does not do without, and for the determinant.

   The determinant of the small system with Q_e is det K_s det Q_e / det K_a, of which det K_a > 0 and det Q_e > 0 (a
   triangle of blocks, of which that across the slip is (1 - alpha) E + e e' or more): the sign of det K_s tells whether
   the bodies jam (small.c). With Q_e pairs that share a force do not make it zero.
*/
#include "statics/pairs/small.h"
#include "base/algebra/dense.h"

/* compliance of rigid pairs over 1 / kappa: it leaves as many digits to rounding, and costs GMRES two or three steps */
#define REFACTOR_YIELD 1e-5
/* change of (1 + X)^-1, 0 of a rigid pair and 1 of an open one, from which on the law of a pair is another one */
#define REFACTOR_OTHER 0.5
/* change of X over X, up to which the factors and their determinant are those of the law */
#define REFACTOR_SAME 1e-6

struct _StatusFactor {
  Compliance *compliance;
  ShiftInvert inverse;   /* of K_s */
  PetscBool   symmetric; /* K_s always is: there is no friction */
  PetscBool   whole;     /* K_s has friction, or there is none */
  PetscBool   stands;    /* there are factors, of the laws X */
  Mat         G, S, K;   /* S NULL without sliding pairs */
  PetscReal  *X, *Qinv;  /* [rows][3] rows of the block of each pair */
  PetscReal  *slide;     /* [rows] D times the factor of friction */
};

PetscErrorCode StatusFactorCreate(Compliance *c, StatusFactor *factor)
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
  PetscCall(PetscFree3(f->X, f->Qinv, f->slide));
  PetscCall(PetscFree(*factor));
  PetscFunctionReturn(0);
}

/* X and Q_e^-1 of a pair, [d][3]; without friction by the normal force where not whole */
static PetscErrorCode LawCondense(const LawRow from[], PetscBool whole, PetscReal X[], PetscReal Qinv[])
{
  const PetscInt d = from[0].d;
  LawRow         law[3];
  PetscReal      Q[9], inverse[9];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < d; i++) {
    law[i] = from[i];
    if (i && !whole) law[i].P[0] = law[i].Q[0] = 0;
  }
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

/* Whether the law of a pair has gone from X to another one, Y: how soft it is as its bodies feel it, to which springs
   of kappa are neither stiff nor soft */
static PetscErrorCode LawIsOther(PetscInt d, const PetscReal X[], const PetscReal Y[], PetscBool *other)
{
  PetscReal A[2][9], soft[2][9];
  PetscBool singular;

  PetscFunctionBeginUser;
  *other = PETSC_FALSE;
  for (PetscInt i = 0; i < d; i++)
    for (PetscInt k = 0; k < d; k++) {
      A[0][k * d + i]    = X[3 * i + k] + (i == k);
      A[1][k * d + i]    = Y[3 * i + k] + (i == k);
      soft[0][k * d + i] = soft[1][k * d + i] = i == k;
    }
  for (int j = 0; j < 2; j++) {
    PetscCall(DenseSolveWith(d, A[j], d, soft[j], &singular));
    if (singular) *other = PETSC_TRUE;
  }
  for (PetscInt i = 0; i < d * d; i++)
    if (PetscAbsReal(soft[0][i] - soft[1][i]) > REFACTOR_OTHER) *other = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode StatusFactorCompare(StatusFactor f, const SmallSystem *s, FactorDistance *d)
{
  const PairRows *rows = f->compliance->rows;
  PetscReal       X[9] = {0}, unused[9], largest = 0;

  PetscFunctionBeginUser;
  *d = (FactorDistance){.stands = f->stands, .whole = f->whole};
  for (PetscInt p = 0; p < rows->n_pairs && f->stands; p++) {
    const PetscInt first = rows->first[p];
    PetscReal      change;
    PetscBool      other;

    PetscCall(LawCondense(&s->law[first], f->whole, X, unused));
    change = LawChange(rows->law[p].d, &f->X[3 * first], X);
    PetscCall(LawIsOther(rows->law[p].d, &f->X[3 * first], X, &other));
    d->n_other += other ? rows->law[p].d : 0;
    largest = PetscMax(largest, change);
    if (f->whole) largest = PetscMax(largest, PetscAbsReal(s->friction * s->law[first].slide - f->slide[first]));
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

static PetscBool StatusFactorIsSymmetric(StatusFactor f)
{
  return f->symmetric || !f->whole ? PETSC_TRUE : PETSC_FALSE;
}

/* K_s, in place from the second time on */
static PetscErrorCode StatusFactorForm(StatusFactor f)
{
  const MatStructure pattern = f->K ? SUBSET_NONZERO_PATTERN : DIFFERENT_NONZERO_PATTERN;
  Mat                Ka      = f->compliance->Ka;

  PetscFunctionBeginUser;
  if (!Ka) PetscCall(KSPGetOperators(f->compliance->inverse.ksp, &Ka, NULL));
  if (f->K)
    PetscCall(MatCopy(Ka, f->K, SUBSET_NONZERO_PATTERN));
  else
    PetscCall(MatDuplicate(Ka, MAT_COPY_VALUES, &f->K));
  PetscCall(LawAdd(f, PETSC_FALSE, pattern));
  if (f->S && f->whole) PetscCall(LawAdd(f, PETSC_TRUE, pattern));
  PetscCall(MatSetOption(f->K, MAT_SYMMETRIC, StatusFactorIsSymmetric(f)));
  PetscFunctionReturn(0);
}

/* Factors of a matrix of this shape, K_a or K_s */
static PetscErrorCode StatusFactorMake(StatusFactor f, Mat K, PetscBool symmetric, ShiftInvert *inverse,
                                       PetscBool *singular)
{
  PencilMatrices pencil = {.symmetric = symmetric, .K = K};

  PetscFunctionBeginUser;
  inverse->comm = f->compliance->rows->comm;
  inverse->even = symmetric;
  inverse->bare = PETSC_TRUE;
  PetscCall(ShiftInvertFactor(&pencil, inverse, singular));
  PetscFunctionReturn(0);
}

/* Factors of K_a again, where those of a status have failed */
static PetscErrorCode StatusFactorFallBack(StatusFactor f)
{
  PetscBool singular;

  PetscFunctionBeginUser;
  PetscCall(StatusFactorMake(f, f->compliance->Ka, PETSC_TRUE, &f->compliance->inverse, &singular));
  PetscCall(ShiftInvertRegular(f->compliance->rows->comm, (PetscBool)!singular, 0));
  PetscFunctionReturn(0);
}

/* Another K_s than before, with or without friction: matrix and factors of that go */
static PetscErrorCode StatusFactorTurn(StatusFactor f, PetscBool whole)
{
  PetscFunctionBeginUser;
  if (f->symmetric) whole = PETSC_TRUE;
  if (f->whole == whole) PetscFunctionReturn(0);
  f->whole = whole;
  PetscCall(ShiftInvertDestroy(&f->inverse));
  PetscCall(MatDestroy(&f->K));
  PetscFunctionReturn(0);
}

/* Two sets of factors would take twice the memory: those of K_a go before */
PetscErrorCode StatusFactorSet(StatusFactor f, const SmallSystem *s, PetscBool whole, PetscBool *singular)
{
  Compliance     *c    = f->compliance;
  const PairRows *rows = c->rows;

  PetscFunctionBeginUser;
  PetscCall(StatusFactorTurn(f, whole));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt i = rows->first[p];

    PetscCall(LawCondense(&s->law[i], f->whole, &f->X[3 * i], &f->Qinv[3 * i]));
    f->slide[i] = f->whole ? s->friction * s->law[i].slide : 0;
  }
  PetscCall(StatusFactorForm(f));
  if (!c->W) PetscCall(KSPDestroy(&c->inverse.ksp));
  PetscCall(StatusFactorMake(f, f->K, StatusFactorIsSymmetric(f), &f->inverse, singular));
  f->stands = *singular ? PETSC_FALSE : PETSC_TRUE;
  (*s->n_factored)++;
  if (*singular && !c->W) PetscCall(StatusFactorFallBack(f));
  PetscFunctionReturn(0);
}

PetscErrorCode SmallIsReversed(const SmallSystem *s, PetscBool *reversed)
{
  StatusFactor   f        = s->compliance->status;
  PetscBool      singular = PETSC_FALSE;
  FactorDistance d;

  PetscFunctionBeginUser;
  PetscCall(StatusFactorCompare(f, s, &d));
  if (!d.same || !d.whole) PetscCall(StatusFactorSet(f, s, PETSC_TRUE, &singular));
  *reversed = PETSC_FALSE;
  if (!singular) PetscCall(ShiftInvertIsNegative(&f->inverse, reversed));
  PetscFunctionReturn(0);
}

/* out = A in of each pair, blocks A [rows][3] */
static void BlocksMult(const PairRows *rows, const PetscReal A[], const PetscReal in[], PetscReal out[])
{
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt first = rows->first[p];

    for (PetscInt i = first; i < rows->first[p + 1]; i++) {
      out[i] = 0;
      for (PetscInt k = 0; k < rows->law[p].d; k++) out[i] += A[3 * i + k] * in[first + k];
    }
  }
}

PetscBool StatusFactorServes(StatusFactor f)
{
  return f->stands && !f->compliance->W ? PETSC_TRUE : PETSC_FALSE;
}

const PetscReal *StatusFactorSlide(StatusFactor f)
{
  return StatusFactorServes(f) ? f->slide : NULL;
}

void StatusFactorHold(StatusFactor f, const PetscReal w[], PetscReal Xw[])
{
  const PairRows *rows = f->compliance->rows;

  if (StatusFactorServes(f))
    BlocksMult(rows, f->X, w, Xw);
  else
    for (PetscInt i = 0; i < rows->n; i++) Xw[i] = w[i];
}

void StatusFactorScale(StatusFactor f, const PetscReal r[], PetscReal z[])
{
  const PairRows *rows = f->compliance->rows;

  if (StatusFactorServes(f))
    BlocksMult(rows, f->Qinv, r, z);
  else
    for (PetscInt i = 0; i < rows->n; i++) z[i] = r[i];
}

PetscErrorCode StatusFactorSolve(StatusFactor f, Vec b, Vec u)
{
  PetscFunctionBeginUser;
  PetscCall(ShiftInvertSolve(StatusFactorServes(f) ? &f->inverse : &f->compliance->inverse, PETSC_FALSE, b, u));
  PetscFunctionReturn(0);
}
