/*
   What the scene prescribes for a time when the run is over. A restart may go on until it comes, so that for what a
   file says there is a warning, after what a restart refuses. It is an error where the command line says it, before
   anything is solved, or where nothing can go on.
*/
#include "externalimpl.h"
#include <squeal/options.h>

/* What is late, and which time must be before `last`, s */
typedef struct {
  const char *name, *option, *why;
  PetscReal   time, last;
} Late;

/* An error for LATE_NEVER, or where the command line itself gives the time; a warning where a file does, unless
   only the command line is judged (LATE_COMMAND). */
static PetscErrorCode LateCheck(External external, LateJudge judge, const Late *late)
{
  char why[200];

  PetscFunctionBeginUser;
  if (late->time < late->last) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(why, sizeof(why),
                          "must be before %.6g s, when %s: take an earlier one, or a longer -ts_max_time",
                          (double)late->last, late->why));
  PetscCheck(judge != LATE_NEVER, external->comm, PETSC_ERR_USER_INPUT, "-%s_%s %.6g: %s", late->name, late->option,
             (double)late->time, why);
  PetscCall(OptionsRefuseOf(external->comm, late->name, late->option, why));
  if (judge == LATE_COMMAND) PetscFunctionReturn(0);
  PetscCall(PetscFPrintf(external->comm, stderr,
                         "squeal: warning: %s at %.6g s is not before %.6g s, when %s: it comes when the run goes on "
                         "(-dynamics_restart)\n",
                         late->name, (double)late->time, (double)late->last, late->why));
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalCheckDelay(External external, const char name[], PetscReal delay, PetscReal end, LateJudge judge)
{
  PetscFunctionBeginUser;
  PetscCall(LateCheck(external, judge, &(Late){name, "delay", "the run ends", delay, end}));
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalCheckSteps(External external, PetscReal dt)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_loads; i++) {
    const TimedLoad *load = &external->loads[i];

    PetscCall(RampCheckSteps(external->comm, load->name, &load->ramp, dt));
  }
  for (PetscInt i = 0; i < external->n_motions; i++) {
    const Drive *motion = &external->motions[i];

    PetscCall(RampCheckSteps(external->comm, motion->prescribed->name, &motion->ramp, dt));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalCheckLate(External external, PetscReal end, PetscReal dt, LateJudge judge)
{
  /* t_n of the last step; 1e-12 keeps an end that is a whole number of steps but for rounding from one more */
  const PetscReal last = dt * (PetscCeilReal(end / dt * (1 - 1e-12)) - 1);
  Late            step = {.option = "time", .why = "the last step of the run begins", .last = last};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_acting; i++) {
    step.name = external->impulses[i].name;
    step.time = external->impulses[i].time;
    PetscCall(LateCheck(external, judge, &step));
  }
  if (judge == LATE_NEVER) PetscFunctionReturn(0); /* maps know no delays */
  for (PetscInt i = 0; i < external->n_loads; i++) {
    const TimedLoad *load = &external->loads[i];

    PetscCall(ExternalCheckDelay(external, load->name, load->ramp.delay, end, judge));
  }
  for (PetscInt i = 0; i < external->n_motions; i++) {
    const Drive *motion = &external->motions[i];

    PetscCall(ExternalCheckDelay(external, motion->prescribed->name, motion->ramp.delay, end, judge));
  }
  PetscFunctionReturn(0);
}
