/*
   Why a mode of a frame grows: the rule of modes/growth/mechanism.c with the terms of the reduced model, and the mode
   that shares most of its motion as in modes/growth/pair.c, vectors with x^H Ms x = 1.
*/
#include "change.h"
#include "base/algebra/dense.h"

#define SHARED_LEAST 1e-3 /* of the motion, with a partner */

/* y^T A x, or y^T A^T x, of the leading block of A; y^H where conjugate */
static PetscComplex BlockProduct(const Reduced *reduced, const PetscReal A[], const PetscComplex y[],
                                 const PetscComplex x[], PetscBool conjugate)
{
  PetscComplex sum = 0;

  for (PetscInt k = 0; k < reduced->n_used; k++) {
    PetscComplex column = 0;

    for (PetscInt j = 0; j < reduced->n_used; j++) column += (conjugate ? conj(y[j]) : y[j]) * A[k * reduced->n + j];
    sum += column * x[k];
  }
  return sum;
}

/* The oscillating mode that shares most of the motion of mode i, max(|x^T M z|, |x^H M z|) of vectors of unit
   length in M, or -1: the transposed product tells a mirror image, the conjugated one the same turning. */
static PetscInt FramePartner(const ModeFrame *f, PetscInt i)
{
  const Reduced block   = {.n = f->pencil.n, .n_used = f->modes.size};
  PetscInt      partner = -1;
  PetscReal     most    = SHARED_LEAST;

  for (PetscInt k = 0; k < f->modes.n; k++) {
    const PetscComplex *x = &f->modes.x[i * f->modes.size], *z = &f->modes.x[k * f->modes.size];
    PetscReal           shared;

    if (k == i || f->modes.rigid[k] || cimag(f->modes.lambda[k]) <= 0) continue;
    shared = PetscMax(cabs(BlockProduct(&block, f->pencil.M, x, z, PETSC_FALSE)),
                      cabs(BlockProduct(&block, f->pencil.M, x, z, PETSC_TRUE)));
    if (shared > most) partner = k, most = shared;
  }
  return partner;
}

/* Adds a term with coefficient c */
static void PairAddTerm(const ModeFrame *f, PetscInt t, PetscReal c, const PetscInt at[2], MechanismPair *pair)
{
  const Reduced       *reduced = f->reduced;
  const OperatorsTerm *term    = &reduced->term[t];
  const PetscComplex  *x[2], *y[2];
  PencilForms          forms = {.kind = term->kind, .exact = term->constraint >= 0 ? PETSC_TRUE : PETSC_FALSE};
  PetscComplex         form;

  for (PetscInt a = 0; a < pair->n; a++) {
    x[a] = &f->modes.x[at[a] * f->modes.size];
    y[a] = &f->modes.y[at[a] * f->modes.size];
  }
  form          = c * BlockProduct(reduced, reduced->A[t], x[0], x[0], PETSC_TRUE);
  forms.form[0] = creal(form);
  forms.form[1] = cimag(form);
  for (PetscInt a = 0; a < pair->n; a++)
    for (PetscInt b = 0; b < pair->n; b++) {
      forms.product[a][b] = c * BlockProduct(reduced, reduced->A[t], y[a], x[b], PETSC_FALSE);
      forms.turned[a][b]  = c * BlockProduct(reduced, reduced->A[t], x[b], y[a], PETSC_FALSE);
    }
  MechanismAdd(pair, &forms);
}

/* slope = y^T Q'(lambda) x = 2 lambda y^T D x. Only terms that can feed a mode count: damping and what is not
   symmetric. */
Mechanism ModeFrameMechanism(const ModeFrame *f, PetscInt i)
{
  const PetscInt at[2] = {i, FramePartner(f, i)};
  MechanismPair  pair  = {.n = at[1] < 0 || cimag(f->modes.lambda[i]) <= 0 ? 1 : 2, .mass = 1};

  for (PetscInt a = 0; a < pair.n; a++) {
    pair.lambda[a] = f->modes.lambda[at[a]];
    pair.slope[a]  = 2 * pair.lambda[a] * f->modes.product[at[a]];
  }
  for (PetscInt t = 0; t < f->reduced->n_terms; t++) {
    const OperatorsTerm *term = &f->reduced->term[t];
    const PetscReal      c    = OperatorsTermCoefficient(term, f->p);

    if (c != 0 && (term->kind == OPERATORS_DAMPING || !term->symmetric)) PairAddTerm(f, t, c, at, &pair);
  }
  return MechanismDecide(&pair);
}
