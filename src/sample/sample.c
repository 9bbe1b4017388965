/*
   Samples: life cycle, options, and the flow: variables -> basis over their box -> all points with branches -> what
   they tell.
*/
#include "sampleimpl.h"
#include <petsctime.h>

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
      PetscCall(PetscStrlcat(s->varied, s->varied[0] ? "," : "", sizeof(s->varied)));
      PetscCall(PetscStrlcat(s->varied, v->names[i], sizeof(s->varied)));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SampleSetFromOptions(Sample s)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(s->comm, &sample_quantities, s));
  PetscCall(QuantitiesReadList(s->comm, &sample_list, s, &s->n_variables, &s->variable));
  PetscCheck(s->n_variables <= SAMPLE_MAX_VARIABLES, s->comm, PETSC_ERR_USER_INPUT,
             "-sample_variables names %" PetscInt_FMT "; %d at most", s->n_variables, SAMPLE_MAX_VARIABLES);
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
  PetscCall(QuantitiesVisitList(visitor, &sample_list, s->n_variables, s->variable));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleSetRooms(Sample s, Operators operators, const PetscReal p[], Modes modes, Statics statics)
{
  PetscFunctionBeginUser;
  s->operators     = operators;
  s->box.comm      = s->comm;
  s->box.operators = operators;
  s->box.modes     = modes;
  s->box.statics   = statics;
  s->box.option    = "-sample_rtol";
  s->box.advice    = "raise -sample_max_solutions or -sample_rtol, or narrow the distributions";
  PetscCall(PetscFree(s->box.nominal));
  PetscCall(OperatorsCreatePoint(operators, p, &s->box.nominal));
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
  PetscLogDouble begun, ended;

  PetscFunctionBeginUser;
  (void)results;
  PetscCall(SampleFindVariables(s));
  PetscCall(PetscTime(&begun));
  PetscCall(BoxSetUp(&s->box));
  PetscCall(SamplePoints(s));
  PetscCall(PetscTime(&ended));
  s->seconds[0] = ended - begun;
  PetscCall(SampleBranches(s));
  PetscCall(SampleVerify(s));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleDestroy(Sample *sample)
{
  Sample s = *sample;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < s->n_variables; k++) {
    SampleVariable *v = &s->variable[k];

    for (PetscInt i = 0; i < v->n_names; i++) PetscCall(PetscFree(v->names[i]));
    PetscCall(PetscFree(v->names));
    PetscCall(PetscFree(v->name));
    PetscCall(PetscFree(v->moved));
    PetscCall(PetscFree2(v->distribution.value, v->distribution.probability));
  }
  for (PetscInt i = 0; s->point && i < s->n_points; i++) PetscCall(PetscFree(s->point[i].mode));
  PetscCall(PetscFree(s->point));
  PetscCall(PetscFree(s->variable));
  PetscCall(PetscFree(s->factor));
  PetscCall(PetscFree(s->check));
  PetscCall(PetscFree(s->branch));
  PetscCall(ReducedModesDestroy(&s->nominal));
  PetscCall(ReducedModesDestroy(&s->small));
  PetscCall(SequenceDestroy(&s->sequence));
  PetscCall(BoxDestroy(&s->box));
  PetscCall(PetscFree(*sample));
  PetscFunctionReturn(0);
}
