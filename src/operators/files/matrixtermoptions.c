/*
   Options of named matrices: each is a term of K, C or M with a product of powers of parameters for coefficient,

      kind += scale p_1^n_1 p_2^n_2 ... A

      -terms k1,kgeo -k1_file K1.bin -k1_kind stiffness
                     -kgeo_file KG.bin -kgeo_kind stiffness -kgeo_parameter speed -kgeo_power 2   -speed 10

   A parameter is an option of its own, whose value is that of the scene. Where a power of it is negative it must exceed
   zero at every point.
*/
#include "matrixterm.h"
#include "base/options/help.h"
#include <math.h>
#include <string.h>

#define MAX_POWER 8 /* of one parameter: beyond, products overflow */

/* The entries that are given inline */
static PetscErrorCode MatrixTermReadDense(OptionsItems PetscOptionsObject, MatrixTerm *term)
{
  PetscReal *value;
  PetscInt   n = OPERATORS_MAX_DENSE;
  PetscBool  set;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &value));
  PetscCall(OptionsCheckWords(PetscOptionsObject, "-dense", PETSC_FALSE));
  PetscCall(PetscOptionsRealArray("-dense", "or all entries of a small matrix, rows one after another", "operators.h",
                                  value, &n, &set));
  if (set) {
    PetscCall(PetscMalloc1(n, &term->dense));
    PetscCall(PetscArraycpy(term->dense, value, n));
    term->n_dense = n;
  }
  PetscCall(PetscFree(value));
  PetscFunctionReturn(0);
}

/* Factors of the coefficient */
static PetscErrorCode MatrixTermReadFactors(OptionsItems PetscOptionsObject, MatrixTerm *term)
{
  const MPI_Comm comm      = PetscOptionsObject->comm;
  char           text[512] = "", option[256], **words;
  PetscInt       power[8] = {1, 1, 1, 1, 1, 1, 1, 1}, n_powers = 8;
  int            n = 0;
  PetscBool      set, powers = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsString("-parameter", "numbers that it is proportional to, options of their own, e.g. speed",
                               "operators.h", text, text, sizeof(text), &set));
  PetscCall(OptionsCheckWords(PetscOptionsObject, "-power", PETSC_TRUE));
  PetscCall(
    PetscOptionsIntArray("-power", "power of each of them, e.g. 2 or -1", "operators.h", power, &n_powers, &powers));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_parameter", term->name));
  if (set) PetscCall(ValuesSplit(comm, option, text, ',', &n, &words));
  PetscCheck(n <= OPERATORS_MAX_FACTORS, comm, PETSC_ERR_USER_INPUT, "%s names %d parameters; at most %d", option, n,
             OPERATORS_MAX_FACTORS);
  PetscCheck(!powers || n > 0, comm, PETSC_ERR_USER_INPUT, "-%s_power does nothing without %s, e.g. %s speed",
             term->name, option, option);
  PetscCheck(!powers || n_powers == n, comm, PETSC_ERR_USER_INPUT,
             "-%s_power has %" PetscInt_FMT " values, %s names %d: give a power of each", term->name, n_powers, option,
             n);
  for (term->n = 0; term->n < n; term->n++) {
    const PetscInt i = term->n;

    PetscCall(OptionsCheckName(comm, option, words[i]));
    PetscCheck(power[i] != 0 && PetscAbsInt(power[i]) <= MAX_POWER, comm, PETSC_ERR_USER_INPUT,
               "-%s_power %" PetscInt_FMT " must be an integer from -%d to %d that is not zero", term->name, power[i],
               MAX_POWER, MAX_POWER);
    PetscCall(PetscStrallocpy(words[i], &term->parameter[i]));
    term->power[i] = power[i];
  }
  if (set) PetscCall(PetscStrToArrayDestroy(n, words));
  PetscFunctionReturn(0);
}

static PetscErrorCode MatrixTermRead(OptionsItems PetscOptionsObject, void *owner, void *record)
{
  static const char *const kinds[]      = {"stiffness", "damping", "mass"}; /* of OperatorsTermKind */
  static const char *const symmetries[] = {"any", "symmetric", "skew"};
  MatrixTerm              *term         = record;
  PetscInt                 kind = 3, symmetry = MATRIX_ANY;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(OptionsGetPath(PetscOptionsObject, "-file", "PETSc binary file of the matrix", term->file, NULL));
  PetscCall(MatrixTermReadDense(PetscOptionsObject, term));
  PetscCall(PetscOptionsEList("-kind", "what it is part of (required)", "operators.h", kinds, 3, "", &kind, NULL));
  PetscCall(PetscOptionsEList("-symmetry", "what it must be, else the run stops", "operators.h", symmetries, 3,
                              symmetries[0], &symmetry, NULL));
  term->scale = 1;
  PetscCall(OptionsGetReal(PetscOptionsObject, "-scale", "a number that it is multiplied with", term->scale,
                           &term->scale, NULL));
  PetscCall(MatrixTermReadFactors(PetscOptionsObject, term));
  term->kind     = (OperatorsTermKind)kind;
  term->symmetry = (MatrixSymmetry)symmetry;
  PetscFunctionReturn(0);
}

/* Raises an error for a term that is not complete */
static PetscErrorCode MatrixTermCheck(MPI_Comm comm, const MatrixTerm *term)
{
  PetscFunctionBeginUser;
  PetscCheck(term->file[0] || term->n_dense, comm, PETSC_ERR_USER_INPUT,
             "-terms names %s, but -%s_file (or -%s_dense) is missing", term->name, term->name, term->name);
  PetscCheck(!term->file[0] || !term->n_dense, comm, PETSC_ERR_USER_INPUT, "-%s_file and -%s_dense exclude each other",
             term->name, term->name);
  PetscCheck((int)term->kind < 3, comm, PETSC_ERR_USER_INPUT, "-%s_kind is missing: give stiffness, damping or mass",
             term->name);
  PetscCheck(isfinite(term->scale) && term->scale != 0 && PetscAbsReal(term->scale) <= MATRIX_LARGEST, comm,
             PETSC_ERR_USER_INPUT, "-%s_scale %.6g must not be zero, and of at most 1e60", term->name,
             (double)term->scale);
  PetscFunctionReturn(0);
}

/* The value of the parameter that factor i of a term names, and the limit that the power sets */
static PetscErrorCode MatrixTermAddParameter(Operators o, const MatrixTerm *term, PetscInt i)
{
  char                option[256];
  const char         *name  = term->parameter[i];
  PetscInt            index = ParametersFind(&o->parameters, name);
  PetscReal           value = o->loaded_mu;
  PetscBool           set   = PETSC_TRUE;
  OperatorsParameter *q;

  PetscFunctionBeginUser;
  if (index < 0) {
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", name));
    PetscOptionsBegin(o->comm, NULL, "Parameters of matrices", NULL);
    if (strcmp(name, "contact_mu")) /* which is read beside H */
      PetscCall(OptionsGetReal(PetscOptionsObject, option, "value of the parameter of this name", 0, &value, &set));
    PetscOptionsEnd();
    PetscCheck(set, o->comm, PETSC_ERR_USER_INPUT, "%s is missing: the value of the parameter of -%s_parameter", option,
               term->name);
    PetscCall(ParametersAdd(&o->parameters, NULL, name,
                            &(OperatorsParameter){.unit = "", .value = value, .lower = -INFINITY}, &index));
  }
  q = &o->parameters.list[index];
  if (term->power[i] < 0) q->lower = 0;
  PetscCheck(q->value > q->lower, o->comm, PETSC_ERR_USER_INPUT,
             "-%s %.6g must exceed 0: -%s_power %" PetscInt_FMT " divides by it", name, (double)q->value, term->name,
             term->power[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixTermsSetFromOptions(Operators o)
{
  static const OptionsList list = {"-terms", "matrices from files, each the prefix of its -file and -kind", "Matrix",
                                   sizeof(MatrixTerm), MatrixTermRead};
  PetscBool                help, all;

  PetscFunctionBeginUser;
  PetscCall(OptionsReadList(o->comm, &list, NULL, &o->n_named, &o->named));
  PetscCall(HelpIsAsked(&help, &all));
  for (PetscInt t = 0; t < o->n_named && !help; t++) PetscCall(MatrixTermCheck(o->comm, &o->named[t]));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixTermsAddParameters(Operators o)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < o->n_named; t++)
    for (PetscInt i = 0; i < o->named[t].n; i++) PetscCall(MatrixTermAddParameter(o, &o->named[t], i));
  PetscFunctionReturn(0);
}
