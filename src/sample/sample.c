/*
   Samples: life cycle, options, and the flow: variables -> basis over their box -> all points with branches -> what
   they tell.
*/
#include "sampleimpl.h"
#include "base/text.h"

PetscErrorCode SampleCreate(MPI_Comm comm, Sample *sample)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, sample));
  (*sample)->comm = comm;
  PetscCall(QuantitiesInit(&sample_quantities, *sample));
  PetscFunctionReturn(0);
}

/* A variable that names no parameters is the parameter of its own name */
static PetscErrorCode VariablesName(Sample s)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_variables; k++) {
    SampleVariable *v = &s->variable[k];

    if (!v->n_names) {
      PetscCall(PetscMalloc1(1, &v->names));
      PetscCall(PetscStrallocpy(v->name, &v->names[0]));
      v->n_names = 1;
    }
    for (PetscInt i = 0; i < v->n_names; i++) {
      PetscCall(TextAdd(s->varied, s->varied[0] ? "," : "", sizeof(s->varied)));
      PetscCall(TextAdd(s->varied, v->names[i], sizeof(s->varied)));
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode VariableFree(SampleVariable *v)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < v->n_names; i++) PetscCall(PetscFree(v->names[i]));
  PetscCall(PetscFree(v->names));
  PetscCall(PetscFree(v->name));
  PetscCall(PetscFree(v->moved));
  PetscCall(PetscFree2(v->distribution.value, v->distribution.probability));
  PetscFunctionReturn(0);
}

/* What samples have and conditions have not, and the reverse */
static PetscErrorCode ConditionsCheckOptions(Sample s)
{
  const struct {
    PetscBool   given;
    const char *option;
  } drawn[]       = {{s->drawn, "-sample_variables"},
                     {s->n_given, "-sample_count"},
                     {s->kind_given, "-sample_sequence"},
                     {s->seed_given, "-sample_seed"},
                     {s->n_rows ? PETSC_TRUE : PETSC_FALSE, "-sample_indices"},
                     {s->correlations[0] ? PETSC_TRUE : PETSC_FALSE, "-sample_correlations"}};
  const char *own = s->n_columns   ? "-sample_columns"
                    : s->n_ignored ? "-sample_ignore"
                    : s->n_edges   ? "-sample_bands"
                                   : "";

  PetscFunctionBeginUser;
  PetscCheck(s->file[0] || !own[0], s->comm, PETSC_ERR_USER_INPUT, "%s does nothing without -sample_conditions", own);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(drawn); k++)
    PetscCheck(!s->file[0] || !drawn[k].given, s->comm, PETSC_ERR_USER_INPUT,
               "%s and -sample_conditions: points are drawn, or they are those of the file; leave one of them out",
               drawn[k].option);
  PetscCheck(s->n_edges != 1, s->comm, PETSC_ERR_USER_INPUT, "-sample_bands needs two edges at least");
  for (PetscInt k = 1; k < s->n_edges; k++)
    PetscCheck(s->edge[k] > s->edge[k - 1], s->comm, PETSC_ERR_USER_INPUT,
               "-sample_bands must ascend, which %.6g behind %.6g does not", (double)s->edge[k],
               (double)s->edge[k - 1]);
  PetscFunctionReturn(0);
}

/* The file and its columns as variables */
static PetscErrorCode ConditionsRead(Sample s)
{
  PetscFunctionBeginUser;
  s->drawn = s->n_variables ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ConditionTableRead(s->comm, s->file, &s->conditions));
  for (PetscInt k = 0; k < s->n_variables; k++) PetscCall(VariableFree(&s->variable[k]));
  PetscCall(PetscFree(s->variable));
  s->n = s->conditions.n;
  PetscCall(ConditionsSetColumns(s));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleSetFromOptions(Sample s)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(s->comm, &sample_quantities, s));
  PetscCall(QuantitiesReadList(s->comm, &sample_list, s, &s->n_variables, &s->variable));
  PetscCall(QuantitiesReadList(s->comm, &sample_columns, s, &s->n_columns, &s->column));
  if (s->file[0]) PetscCall(ConditionsRead(s));
  PetscCheck(s->n_variables <= SAMPLE_MAX_VARIABLES, s->comm, PETSC_ERR_USER_INPUT, "%s %" PetscInt_FMT "; %d at most",
             s->file[0] ? "-sample_conditions has columns to take:" : "-sample_variables names", s->n_variables,
             SAMPLE_MAX_VARIABLES);
  PetscCallMPI(MPI_Comm_size(s->comm, &size));
  PetscCheck(s->box.n_groups <= size, s->comm, PETSC_ERR_USER_INPUT,
             "-sample_groups %" PetscInt_FMT " must lie between 0 and the number of ranks, %d", s->box.n_groups,
             (int)size);
  PetscCall(VariablesName(s));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleVisit(Sample s, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisit(visitor, &sample_quantities, NULL, s, NULL));
  PetscCall(QuantitiesVisitList(visitor, &sample_list, s->file[0] ? 0 : s->n_variables, s->variable));
  PetscCall(QuantitiesVisitList(visitor, &sample_columns, s->n_columns, s->column));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleSetRooms(Sample s, Operators operators, const PetscReal p[], Modes modes, Statics statics)
{
  const OperatorsParameter *list;

  PetscFunctionBeginUser;
  s->operators  = operators;
  s->box.option = "-sample_rtol";
  s->box.advice = "raise -sample_max_solutions or -sample_rtol, or narrow the distributions";
  PetscCall(BoxSetRooms(&s->box, s->comm, operators, p, modes, statics));
  PetscCall(OperatorsGetParameters(operators, &s->box.n_base, &list));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleGetVaried(Sample s, const char **names)
{
  PetscFunctionBeginUser;
  *names = s->varied;
  PetscFunctionReturn(0);
}

PetscErrorCode SampleSolve(Sample s, Results results)
{
  PetscFunctionBeginUser;
  PetscCall(ConditionsCheckOptions(s));
  PetscCall(SampleFindVariables(s));
  PetscCall(SamplesCheckValues(s));
  PetscCall(SampleTimeTake(&s->took[0]));
  PetscCall(SampleJournalOpen(s, results));
  s->box.many = s->n_points >= SAMPLE_MANY ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(BoxSetUp(&s->box, s->n_points, SampleGet, s));
  PetscCall(SamplePoints(s));
  PetscCall(SampleTimeTake(&s->took[0]));
  PetscCall(SampleBranches(s));
  if (s->file[0]) PetscCall(SampleBands(s));
  PetscCall(SampleVerify(s));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleDestroy(Sample *sample)
{
  Sample s = *sample;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < s->n_variables; k++) PetscCall(VariableFree(&s->variable[k]));
  for (PetscInt k = 0; k < s->n_columns && !s->file[0]; k++) PetscCall(VariableFree(&s->column[k]));
  PetscCall(PetscFree(s->column));
  for (PetscInt i = 0; s->point && i < s->n_points; i++) PetscCall(PetscFree(s->point[i].mode));
  PetscCall(PetscFree(s->point));
  PetscCall(PetscFree(s->variable));
  PetscCall(PetscFree(s->factor));
  PetscCall(PetscFree(s->pass.list));
  PetscCall(ChecksumDestroy(&s->journal.scene));
  PetscCall(PetscFree(s->reversed));
  PetscCall(PetscFree(s->band));
  for (PetscInt k = 0; k < s->n_ignored; k++) PetscCall(PetscFree(s->ignored[k]));
  PetscCall(PetscFree(s->ignored));
  PetscCall(ConditionTableDestroy(&s->conditions));
  PetscCall(PetscFree(s->check));
  PetscCall(PetscFree(s->branch));
  PetscCall(ReducedModesDestroy(&s->nominal));
  PetscCall(ReducedModesDestroy(&s->small));
  PetscCall(SequenceDestroy(&s->sequence));
  PetscCall(BoxDestroy(&s->box));
  PetscCall(PetscFree(*sample));
  PetscFunctionReturn(0);
}
