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

/* Factors of the coefficient: how many, their names and powers */
static PetscErrorCode MatrixTermSetFactors(MPI_Comm comm, void *owner, void *record)
{
  MatrixTerm    *term     = record;
  const PetscInt n_powers = term->n_powers;
  char           option[256], **words;
  int            n = 0;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(ViscoelasticSet(comm, term->name, &term->viscous, 1, term->loss, &term->law));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_parameter", term->name));
  if (term->has_parameters) PetscCall(ValuesSplit(comm, option, term->parameters, ',', &n, &words));
  PetscCheck(n <= OPERATORS_MAX_FACTORS, comm, PETSC_ERR_USER_INPUT, "%s names %d parameters; at most %d", option, n,
             OPERATORS_MAX_FACTORS);
  PetscCheck(!n_powers || n > 0, comm, PETSC_ERR_USER_INPUT, "-%s_power does nothing without %s, e.g. %s speed",
             term->name, option, option);
  PetscCheck(!n_powers || n_powers == n, comm, PETSC_ERR_USER_INPUT,
             "-%s_power has %" PetscInt_FMT " values, %s names %d: give a power of each", term->name, n_powers, option,
             n);
  for (term->n = 0; term->n < n; term->n++) {
    const PetscInt i = term->n, power = n_powers ? term->power[i] : 1;

    PetscCall(OptionsCheckName(comm, option, words[i]));
    PetscCheck(power != 0 && PetscAbsInt(power) <= MAX_POWER, comm, PETSC_ERR_USER_INPUT,
               "-%s_power %" PetscInt_FMT " must be an integer from -%d to %d that is not zero", term->name, power,
               MAX_POWER, MAX_POWER);
    PetscCall(PetscStrallocpy(words[i], &term->parameter[i]));
    term->power[i] = power;
  }
  if (term->has_parameters) PetscCall(PetscStrToArrayDestroy(n, words));
  PetscFunctionReturn(0);
}

/* Raises an error for a term that is not complete */
static PetscErrorCode MatrixTermCheck(MPI_Comm comm, const MatrixTerm *term)
{
  PetscFunctionBeginUser;
  PetscCheck(!term->law.kind || term->kind == OPERATORS_STIFFNESS, comm, PETSC_ERR_USER_INPUT,
             "-%s_kind must be stiffness: it has a law of a material over frequency", term->name);
  PetscCheck(term->file[0] || term->n_dense, comm, PETSC_ERR_USER_INPUT,
             "-terms names %s, but -%s_file (or -%s_dense) is missing", term->name, term->name, term->name);
  PetscCheck(!term->file[0] || !term->n_dense, comm, PETSC_ERR_USER_INPUT, "-%s_file and -%s_dense exclude each other",
             term->name, term->name);
  PetscCheck(term->scale != 0 && PetscAbsReal(term->scale) <= MATRIX_LARGEST, comm, PETSC_ERR_USER_INPUT,
             "-%s_scale %.6g must not be zero, and of at most 1e60", term->name, (double)term->scale);
  PetscFunctionReturn(0);
}

typedef struct {
  PetscReal value;
  PetscBool given;
} ParameterValue;

/* Shows the row of a parameter: its option has the name that terms give it */
static PetscErrorCode MatrixParameterVisit(const QuantityVisitor *visitor, const char name[], const char why[],
                                           ParameterValue *value)
{
  char           option[256];
  const Quantity row = {option,
                        "value of the parameter of this name",
                        NULL,
                        QUANTITY_REAL,
                        QUANTITY_AT(ParameterValue, value),
                        .given    = offsetof(ParameterValue, given),
                        .required = PETSC_TRUE,
                        .why      = why,
                        .varies   = VARIES_LINEAR};

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", name));
  PetscCall(QuantitiesVisit(visitor, &(QuantityTable){"Parameters of matrices", "operators.h", 1, &row, .in = 0}, NULL,
                            value, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixTermsVisitParameters(Operators o, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->parameters.n; i++)
    if (o->parameters.list[i].of_matrices)
      PetscCall(MatrixParameterVisit(visitor, o->parameters.list[i].name, NULL, NULL));
  PetscFunctionReturn(0);
}

/* The value of the parameter that factor i of a term names, and the limit that the power sets */
static PetscErrorCode MatrixTermAddParameter(Operators o, const MatrixTerm *term, PetscInt i)
{
  char                why[256];
  const char         *name  = term->parameter[i];
  PetscInt            index = ParametersFind(&o->parameters, name);
  const PetscBool     read  = strcmp(name, "contact_mu") ? PETSC_TRUE : PETSC_FALSE; /* else it is read beside H */
  ParameterValue      given = {.value = o->loaded_mu};
  OperatorsParameter *q;

  PetscFunctionBeginUser;
  if (index < 0) {
    PetscCall(PetscSNPrintf(why, sizeof(why), "the value of the parameter of -%s_parameter", term->name));
    if (read) PetscCall(MatrixParameterVisit(&(QuantityVisitor){QuantitiesReadVisited, &o->comm}, name, why, &given));
    PetscCall(ParametersAdd(&o->parameters, NULL, name,
                            &(OperatorsParameter){.value = given.value, .of_matrices = read}, &index));
  }
  q = &o->parameters.list[index];
  if (term->power[i] < 0) q->lower = 0;
  PetscCheck(q->value > q->lower, o->comm, PETSC_ERR_USER_INPUT,
             "-%s %.6g must exceed 0: -%s_power %" PetscInt_FMT " divides by it", name, (double)q->value, term->name,
             term->power[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsNameLaw(Operators o, size_t size, char text[], PetscBool *hysteretic)
{
  const char *option;
  char        name[32];

  PetscFunctionBeginUser;
  text[0]     = '\0';
  *hysteretic = PETSC_FALSE;
  for (PetscInt t = 0; t < o->n_named && !text[0]; t++) {
    const Viscoelastic *law = &o->named[t].law;

    if (!law->kind) continue;
    *hysteretic = law->kind == VISCOELASTIC_HYSTERETIC ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(ViscoelasticName(law, -1, &option, name));
    PetscCall(PetscSNPrintf(text, size, "-%s_%s", o->named[t].name, option));
  }
  PetscFunctionReturn(0);
}

const QuantityList operators_terms = {"-terms",
                                      "matrices from files, each the prefix of its -file and -kind",
                                      sizeof(MatrixTerm),
                                      &operators_term,
                                      MatrixTermSetFactors,
                                      .in = 0};

PetscErrorCode MatrixTermsSetFromOptions(Operators o)
{
  HelpKind help;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesReadList(o->comm, &operators_terms, NULL, &o->n_named, &o->named));
  PetscCall(HelpIsAsked(&help));
  for (PetscInt t = 0; t < o->n_named && help == HELP_NONE; t++) PetscCall(MatrixTermCheck(o->comm, &o->named[t]));
  PetscFunctionReturn(0);
}

PetscErrorCode MatrixTermsAddParameters(Operators o)
{
  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < o->n_named; t++)
    for (PetscInt i = 0; i < o->named[t].n; i++) PetscCall(MatrixTermAddParameter(o, &o->named[t], i));
  PetscFunctionReturn(0);
}
