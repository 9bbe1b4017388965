/*
   The changed system on its space: of each term c(lambda) = k + lambda c + lambda^2 m adds c g_l g_r' to the dense
   pencil, g_l = V'Zl'a, g_r = V'Zr'a. Of a mass that hangs on a spring k and a dashpot c the motion q is a further
   unknown, with (k + lambda c) (q - a'u) between the two. All eigenvalues of that problem are found, so that pairs that
   merge or part are right, however near to lock-in.

   Error: the last responses Z are the end of the space. With Q_zz the block of Q(lambda) there and x_z, y_z the parts
   of the vectors in it, leaving them out moves the eigenvalue to first order by

      e = y_z' Q_zz(lambda) x_z / (y' Q'(lambda) x).

   Answers need not converge in every step: of a spring that is stiffer than the place where it acts the third
   step may do next to nothing, and the fourth much. Hence e_2 of the last two steps and e_1 of the last one count, as
   sqrt(e_1 e_2), but no less than 0.3 e_2, or e_2 of changes that are spread over many unknowns (spread.c), to which
   the space answers in few steps: a choice, no bound. Of 330 changes at random (tests/test_changes.py, --count 55,
   seeds 1 to 6) no mode was farther off than 0.32 of the stated error.

   Near another eigenvalue at the distance g the pair's plane counts: z (z - g) = -e g has a root at |z| = 2 |e| / (1 +
   sqrt(1 - 4 |e| / g)) at most, or sqrt(|e| g) where e is larger than g / 4. The noise of the modes that the space is
   made of, their largest error over condition, is added times the condition, twice: the changed system is rounded too.

   Friction makes the symmetric part of K indefinite, so that the space has eigenvalues that are none of the system (of
   a symmetric one each is above that of the system, Courant's principle). Where |e| is |lambda| or more the value says
   nothing, not even a sign: it is left out, and counted.
*/
#include "changes.h"
#include <complex.h>

#define TAIL_LEAST  0.3
#define TAIL_SPREAD 1 /* the same where changes are spread over many unknowns */
#define NOISES      2 /* times the noise */

/* A dense pencil with room for the unknowns of hung masses behind those of the space */
typedef struct {
  DensePencil q;
  PetscInt    n_space, first[2]; /* columns of the space; the first ones of the last two responses, and of the last */
  PetscReal   least;             /* of the last two, that the error is at least */
} ChangedPencil;

/* Copies a matrix of the space, NULL for zero, into the corner of one of n unknowns */
static PetscErrorCode CornerCreate(PetscInt n_space, const PetscReal small[], PetscInt n, PetscReal A[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(A, n * n));
  for (PetscInt j = 0; j < n_space && small; j++) PetscCall(PetscArraycpy(&A[j * n], &small[j * n_space], n_space));
  PetscFunctionReturn(0);
}

/* A += value (g_l; -1 at hung) (g_r; -1 at hung)', hung negative for none */
static void RankOneAdd(const ChangedPencil *c, PetscReal value, const PetscReal *const g[2], PetscInt hung,
                       PetscReal A[])
{
  const PetscInt n = c->q.n, m = c->n_space;

  if (value == 0) return;
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < m; i++) A[j * n + i] += value * g[0][i] * g[1][j];
  if (hung < 0) return;
  for (PetscInt i = 0; i < m; i++) {
    A[hung * n + i] -= value * g[0][i];
    A[i * n + hung] -= value * g[1][i];
  }
  A[hung * n + hung] += value;
}

/* A += value small in the corner */
static void SmallAdd(const ChangedPencil *c, PetscReal value, const PetscReal small[], PetscReal A[])
{
  const PetscInt n = c->q.n, m = c->n_space;

  for (PetscInt j = 0; j < m && value != 0; j++)
    for (PetscInt i = 0; i < m; i++) A[j * n + i] += value * small[j * m + i];
}

/* The pencil of the changed system */
static PetscErrorCode ChangedCreate(const ChangeSpace *s, PetscInt n_terms, const ChangeTerm terms[], ChangedPencil *c)
{
  const SubspaceTerm *small = s->space.space.term;
  PetscInt            n = s->space.space.n, hung = s->space.space.n;

  PetscFunctionBeginUser;
  *c = (ChangedPencil){.n_space = n,
                       .first   = {s->first[0], s->first[1]},
                       .least   = TAIL_LEAST,
                       .q       = {.damped = small[SUBSPACE_C].A ? PETSC_TRUE : PETSC_FALSE}};
  for (PetscInt t = 0; t < n_terms; t++) {
    if (terms[t].hung) n++;
    if (terms[t].A) c->least = TAIL_SPREAD;
    if (terms[t].viscosity != 0) c->q.damped = PETSC_TRUE;
  }
  c->q.n = n;
  PetscCall(PetscMalloc3(n * n, &c->q.K, n * n, &c->q.C, n * n, &c->q.M));
  PetscCall(CornerCreate(c->n_space, small[SUBSPACE_K].small, n, c->q.K));
  PetscCall(CornerCreate(c->n_space, small[SUBSPACE_C].A ? small[SUBSPACE_C].small : NULL, n, c->q.C));
  PetscCall(CornerCreate(c->n_space, small[SUBSPACE_M].small, n, c->q.M));
  for (PetscInt t = 0; t < n_terms; t++) {
    const ChangeTerm *term = &terms[t];
    const PetscReal  *g[2] = {s->side[0][t], s->side[1][t]};
    const PetscInt    at   = term->hung ? hung++ : -1;

    if (term->A) {
      SmallAdd(c, term->stiffness, g[0], c->q.K);
      SmallAdd(c, term->viscosity, g[0], c->q.C);
      SmallAdd(c, term->mass, g[0], c->q.M);
      continue;
    }
    RankOneAdd(c, term->stiffness, g, at, c->q.K);
    RankOneAdd(c, term->viscosity, g, at, c->q.C);
    if (at >= 0)
      c->q.M[at * n + at] += term->mass;
    else
      RankOneAdd(c, term->mass, g, -1, c->q.M);
  }
  PetscFunctionReturn(0);
}

/* |y_z' Q_zz x_z| of the columns from `first` on */
static PetscErrorCode TailMeasure(const ChangedPencil *c, PetscInt first, PetscComplex lambda, const PetscComplex x[],
                                  const PetscComplex y[], PetscReal *size)
{
  const PetscInt m = c->n_space - first;
  PetscComplex  *Q, sum = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PetscMax(1, m * m), &Q));
  DensePencilEvaluate(&c->q, lambda, first, m, Q);
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < m; i++) sum += y[first + i] * Q[j * m + i] * x[first + j];
  *size = cabs(sum);
  PetscCall(PetscFree(Q));
  PetscFunctionReturn(0);
}

/* |e| of an eigenvalue with its vectors, and the noise by its condition 2 |lambda| |x|_M |y|_M / |y'Q'x| */
static PetscErrorCode ErrorFind(const ChangedPencil *c, PetscReal noise, PetscComplex lambda, const PetscComplex x[],
                                const PetscComplex y[], PetscReal *error)
{
  const PetscInt n     = c->q.n;
  PetscComplex   slope = 0, xx = 0, yy = 0;
  PetscReal      tail[2];

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(TailMeasure(c, c->first[k], lambda, x, y, &tail[k]));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal M = c->q.M[j * n + i];

      slope += y[i] * (2 * lambda * M + (c->q.damped ? c->q.C[j * n + i] : 0)) * x[j];
      xx += conj(x[i]) * M * x[j];
      yy += conj(y[i]) * M * y[j];
    }
  *error = (PetscMax(PetscSqrtReal(tail[0] * tail[1]), c->least * tail[0]) +
            NOISES * noise * 2 * cabs(lambda) * PetscSqrtReal(cabs(xx) * cabs(yy))) /
           cabs(slope);
  PetscFunctionReturn(0);
}

/* Puts a mode in the order of frequency */
static void ChangedInsert(struct _p_ModesChanged *changed, const ChangedMode *mode)
{
  PetscInt k = changed->n++;

  for (; k > 0 && cimag(changed->mode[k - 1].lambda) > cimag(mode->lambda); k--)
    changed->mode[k] = changed->mode[k - 1];
  changed->mode[k] = *mode;
}

/* Distance of an eigenvalue from the next one, its own conjugate included */
static PetscReal ChangedGap(const struct _p_ModesChanged *changed, PetscInt i)
{
  PetscReal gap = 2 * cimag(changed->mode[i].lambda);

  for (PetscInt k = 0; k < changed->n; k++)
    if (k != i) gap = PetscMin(gap, cabs(changed->mode[i].lambda - changed->mode[k].lambda));
  return gap;
}

/* Errors in the plane of each with its neighbour */
static PetscErrorCode ErrorsWiden(struct _p_ModesChanged *changed)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < changed->n; i++) {
    const PetscReal e = changed->mode[i].error, gap = ChangedGap(changed, i);

    if (4 * e < gap)
      changed->mode[i].error = 2 * e / (1 + PetscSqrtReal(1 - 4 * e / gap));
    else
      changed->mode[i].error = PetscMax(e, PetscSqrtReal(e * gap));
  }
  PetscFunctionReturn(0);
}

/* The eigenvalue of entry i, if it is one of those that are listed */
static PetscBool EntryIsListed(const DenseShifted *w, PetscInt i, const ChangeRange *range, PetscComplex *lambda)
{
  if (!DenseShiftedLambda(w, i, lambda) || !(cimag(*lambda) > 0)) return PETSC_FALSE;
  if (cimag(*lambda) < range->edge[0] || cimag(*lambda) > range->edge[1]) return PETSC_FALSE;
  return PetscAbsReal(creal(*lambda)) > range->growth ? PETSC_FALSE : PETSC_TRUE;
}

/* All eigenvalues of the changed system on the space */
static PetscErrorCode ChangedSolve(const ChangeSpace *s, PetscInt n_terms, const ChangeTerm terms[],
                                   const ChangeRange *range, ChangedPencil *c, DenseShifted *w)
{
  const PetscReal shift = PetscSqrtReal((PetscSqr(range->edge[0]) + PetscSqr(range->edge[1])) / 2);

  PetscFunctionBeginUser;
  PetscCall(ChangedCreate(s, n_terms, terms, c));
  PetscCall(DenseShiftedSolve(&c->q, shift, w));
  PetscFunctionReturn(0);
}

/* Real and imaginary part of z, made of length one, to [2][n] */
static void UnitParts(PetscInt n, const PetscComplex z[], PetscReal parts[])
{
  PetscReal square = 0;

  for (PetscInt k = 0; k < n; k++) square += creal(conj(z[k]) * z[k]);
  for (PetscInt k = 0; k < n && square > 0; k++) {
    parts[k]     = creal(z[k]) / PetscSqrtReal(square);
    parts[n + k] = cimag(z[k]) / PetscSqrtReal(square);
  }
}

PetscErrorCode ChangeSolveVectors(const ChangeSpace *s, const ChangeRange *range, ChangeVectors v[2])
{
  const PetscInt n = s->space.space.n;
  PetscInt       m = 0;
  ChangedPencil  c;
  DenseShifted   w;
  PetscComplex  *z, value;

  PetscFunctionBeginUser;
  PetscCall(ChangedSolve(s, s->n_terms, s->term, range, &c, &w));
  PetscCall(PetscMalloc1(c.q.n, &z));
  for (int k = 0; k < 2; k++) v[k] = (ChangeVectors){.stride = n, .left = k ? PETSC_TRUE : PETSC_FALSE};
  for (int k = 0; k < 2; k++) PetscCall(PetscCalloc1(2 * w.N * n, &v[k].x));
  PetscCall(PetscMalloc1(w.N, &v[0].lambda));
  for (PetscInt i = 0; i < w.N; i++) {
    if (!EntryIsListed(&w, i, range, &value)) continue;
    v[0].lambda[m] = value;
    PetscCall(DenseShiftedRight(&w, i, z));
    UnitParts(n, z, &v[0].x[2 * m * n]);
    PetscCall(DenseShiftedLeft(&w, i, z));
    UnitParts(n, z, &v[1].x[2 * m++ * n]);
  }
  v[0].n = v[1].n = m;
  v[1].lambda     = v[0].lambda;
  PetscCall(PetscFree(z));
  PetscCall(DenseShiftedDestroy(&w));
  PetscCall(DensePencilDestroy(&c.q));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeSolve(const ChangeSpace *s, PetscInt n_terms, const ChangeTerm terms[], const ChangeRange *range,
                           struct _p_ModesChanged *changed)
{
  ChangedPencil c;
  DenseShifted  w;
  PetscComplex *x, *y;

  PetscFunctionBeginUser;
  PetscCall(ChangedSolve(s, n_terms, terms, range, &c, &w));
  PetscCall(PetscMalloc2(c.q.n, &x, c.q.n, &y));
  PetscCall(PetscMalloc1(w.N, &changed->mode));
  changed->n = changed->n_left_out = 0;
  for (PetscInt i = 0; i < w.N; i++) {
    ChangedMode mode;

    if (!EntryIsListed(&w, i, range, &mode.lambda)) continue;
    PetscCall(DenseShiftedRight(&w, i, x));
    PetscCall(DenseShiftedLeft(&w, i, y));
    PetscCall(ErrorFind(&c, range->noise, mode.lambda, x, y, &mode.error));
    if (!(mode.error < cabs(mode.lambda))) {
      changed->n_left_out++;
      continue;
    }
    PetscCall(ChangeFindBefore(s, x, &mode));
    ChangedInsert(changed, &mode);
  }
  PetscCall(ErrorsWiden(changed));
  PetscCall(PetscFree2(x, y));
  PetscCall(DenseShiftedDestroy(&w));
  PetscCall(DensePencilDestroy(&c.q));
  PetscFunctionReturn(0);
}
