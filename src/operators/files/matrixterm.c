/*
   Named matrices (matrixtermoptions.c) as terms. One that is not symmetric is a term that comes with friction: the
   symmetric ones of K and M are the frictionless system, by which modes are counted and with which sweeps begin. Where
   these alone are no system, since no stiffness is symmetric or a mass is not, none of this holds, and all terms count
   as unsymmetric ones that are there without friction.
*/
#include "matrixterm.h"
#include "operators/pencilimpl.h"
#include <math.h>

/* |A - sign A'| / |A|, Frobenius norms: 0 for a symmetric A with sign 1, for a skew one with sign -1 */
static PetscErrorCode MatrixSkewness(Mat A, PetscReal sign, PetscReal *part)
{
  PetscReal norm;
  Mat       D;

  PetscFunctionBeginUser;
  PetscCall(MatNorm(A, NORM_FROBENIUS, &norm));
  PetscCall(MatTranspose(A, MAT_INITIAL_MATRIX, &D));
  PetscCall(MatAXPY(D, -sign, A, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatNorm(D, NORM_FROBENIUS, part));
  if (norm > 0) *part /= norm;
  PetscCall(MatDestroy(&D));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixIsSymmetric(Mat A, PetscBool *symmetric)
{
  PetscReal norm;

  PetscFunctionBeginUser;
  PetscCall(MatNorm(A, NORM_FROBENIUS, &norm));
  PetscCall(MatIsSymmetric(A, MATRIX_SYMMETRIC * norm, symmetric));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, symmetric, 1, MPIU_BOOL, MPI_LAND, PetscObjectComm((PetscObject)A)));
  PetscFunctionReturn(0);
}

/* Whether it is symmetric; an error where it is not what the option says */
static PetscErrorCode MatrixTermFindSymmetry(Operators o, MatrixTerm *term)
{
  static const char *const words[] = {"any", "symmetric", "skew"};
  PetscReal                part;

  PetscFunctionBeginUser;
  PetscCall(MatrixIsSymmetric(term->A, &term->even));
  if (term->symmetry == MATRIX_ANY) PetscFunctionReturn(0);
  PetscCall(MatrixSkewness(term->A, term->symmetry == MATRIX_SKEW ? -1 : 1, &part));
  PetscCheck(
    term->symmetry == MATRIX_EVEN ? term->even : part <= MATRIX_SYMMETRIC, o->comm, PETSC_ERR_USER_INPUT,
    "-%s_symmetry %s: the matrix differs by %.2g of its norm from %sits transpose; where the file holds half of "
    "it, give all of it",
    term->name, words[term->symmetry], (double)part, term->symmetry == MATRIX_SKEW ? "minus " : "");
  PetscFunctionReturn(0);
}

/* Reads the matrix, and raises an error where its size is not n (-1 for the first one) */
static PetscErrorCode MatrixTermLoad(Operators o, MatrixTerm *term, const char first[], PetscInt *n)
{
  char     option[256];
  PetscInt rows, columns;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_%s", term->name, term->file[0] ? "file" : "dense"));
  if (term->file[0])
    PetscCall(MatrixReadFile(o->comm, option, term->file, &term->A));
  else
    PetscCall(MatrixReadDense(o->comm, option, term->n_dense, term->dense, &term->A));
  PetscCall(MatGetSize(term->A, &rows, &columns));
  PetscCheck(rows == columns, o->comm, PETSC_ERR_USER_INPUT,
             "matrix %s is %" PetscInt_FMT " x %" PetscInt_FMT ": it must be square", term->name, rows, columns);
  PetscCheck(*n < 0 || rows == *n, o->comm, PETSC_ERR_USER_INPUT,
             "matrix %s has %" PetscInt_FMT " rows, but %s has %" PetscInt_FMT ": all must be alike", term->name, rows,
             first, *n);
  *n = rows;
  PetscCall(MatrixTermFindSymmetry(o, term));
  PetscFunctionReturn(0);
}

/* Raises an error where there is no stiffness or no mass, or where a mass is none */
static PetscErrorCode MatrixTermsCheckSystem(Operators o)
{
  static const TermsSumKind mass = {OPERATORS_MASS, TERMS_ALL, 1};
  PetscInt                  n[3] = {0, 0, 0};
  TermsSum                  sum  = {.A = NULL};

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < o->terms.n; t++) n[o->terms.term[t].kind]++;
  for (PetscInt i = 0; i < o->parameters.n; i++) PetscCall(OperatorsCheckParameter(o, i, o->parameters.p[i]));
  PetscCheck(n[OPERATORS_STIFFNESS] && n[OPERATORS_MASS], o->comm, PETSC_ERR_USER_INPUT,
             "no matrix is a %s: give one of -terms -..._kind %s", n[OPERATORS_MASS] ? "stiffness" : "mass",
             n[OPERATORS_MASS] ? "stiffness" : "mass");
  PetscCall(TermsSumForm(&o->terms, &mass, o->parameters.p, &sum));
  PetscCheck(sum.A, o->comm, PETSC_ERR_USER_INPUT, "the mass matrix is zero with these values of the parameters");
  PetscCall(MassCheck(sum.A, "", &o->mass_singular));
  PetscCall(TermsSumDestroy(&sum));
  PetscFunctionReturn(0);
}

static const Quantity *MatrixTermFindRow(const char option[])
{
  return QuantityFind(&operators_term, option);
}

/* One of the terms once more with the law as a factor */
static PetscErrorCode MatrixTermAddLaw(Operators o, const MatrixTerm *term, PetscInt at)
{
  const OperatorsTerm plain = o->terms.term[at];
  OperatorsLaw       *law;

  PetscFunctionBeginUser;
  if (!term->law.kind) PetscFunctionReturn(0);
  PetscCall(OperatorsAddLaw(o, term->name, &term->law, MatrixTermFindRow, -1, &law));
  PetscCall(OperatorsAddLawTerms(o, term->name, law, &plain));
  PetscFunctionReturn(0);
}

/* Adds one term, whose factors are those of the options */
static PetscErrorCode MatrixTermAdd(Operators o, const MatrixTerm *term)
{
  PetscInt parameter[OPERATORS_MAX_FACTORS];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < term->n; i++) parameter[i] = ParametersFind(&o->parameters, term->parameter[i]);
  PetscCall(TermsAdd(&o->terms, term->kind, term->A, (PetscBool)(term->even || !o->symmetric), term->n, parameter));
  PetscCall(TermsSetCause(&o->terms, o->terms.term[o->terms.n - 1].cause_kind, NULL, term->name));
  PetscCall(TermsSetPowers(&o->terms, term->power));
  o->terms.term[o->terms.n - 1].scale = term->scale;
  PetscFunctionReturn(0);
}

/* o->symmetric: the symmetric terms alone are a system, with a stiffness and only symmetric masses */
PetscErrorCode MatrixTermsAdd(Operators o)
{
  const char *first = o->terms.n ? "what -operators_load_k and its like give" : o->named[0].name;
  PetscInt    n     = -1, at;
  PetscBool   even  = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (o->terms.n) PetscCall(MatGetSize(o->terms.term[0].A, &n, NULL));
  for (PetscInt t = 0; t < o->n_named; t++) PetscCall(MatrixTermLoad(o, &o->named[t], first, &n));
  for (PetscInt t = 0; t < o->terms.n; t++)
    if (o->terms.term[t].kind == OPERATORS_STIFFNESS && !o->terms.term[t].frictional) even = PETSC_TRUE;
  for (PetscInt t = 0; t < o->n_named; t++) {
    if (o->named[t].kind == OPERATORS_STIFFNESS && o->named[t].even) even = PETSC_TRUE;
    if (o->named[t].kind == OPERATORS_MASS && !o->named[t].even) o->symmetric = PETSC_FALSE;
  }
  if (!even) o->symmetric = PETSC_FALSE;
  for (PetscInt t = 0; t < o->n_named; t++) {
    PetscCall(MatrixTermAdd(o, &o->named[t]));
    PetscCall(MatDestroy(&o->named[t].A));
  }
  at = o->terms.n - o->n_named;
  for (PetscInt t = 0; t < o->n_named; t++) PetscCall(MatrixTermAddLaw(o, &o->named[t], at + t));
  PetscCall(MatrixTermsCheckSystem(o));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilCheckMass(Pencil pencil, Mat M)
{
  const Terms *base   = &pencil->base;
  PetscBool    varies = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < base->n && !pencil->operators->model; t++)
    if (base->term[t].kind == OPERATORS_MASS && base->term[t].n) varies = PETSC_TRUE;
  if (varies) PetscCall(MassCheck(M, "", &pencil->mass_singular));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixTermsAddChecksum(Operators o, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < o->n_named; t++) {
    const OperatorsTerm *term = &o->terms.term[o->terms.n - 2 * o->n_laws - o->n_named + t];

    PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){(PetscInt)term->kind, term->n}));
    PetscCall(ChecksumAddReals(c, 1, &term->scale));
    for (PetscInt i = 0; i < term->n; i++)
      PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){term->factor[i].parameter, term->factor[i].power}));
    PetscCall(ViscoelasticAddChecksum(&o->named[t].law, c));
  }
  if (o->n_named) PetscCall(ChecksumAddReals(c, o->parameters.n, o->parameters.p));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixTermsDestroy(Operators o)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < o->n_named; t++) {
    for (PetscInt i = 0; i < o->named[t].n; i++) PetscCall(PetscFree(o->named[t].parameter[i]));
    PetscCall(PetscFree(o->named[t].dense));
    PetscCall(ViscoelasticFree(&o->named[t].law));
    PetscCall(PetscFree(o->named[t].name));
    PetscCall(MatDestroy(&o->named[t].A));
  }
  PetscCall(PetscFree(o->named));
  PetscFunctionReturn(0);
}
