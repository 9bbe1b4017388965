/*
   All stages, one after the other, with the bolts that each tightens.
*/
#include "statics/staticsimpl.h"
#include "base/events.h"

PetscErrorCode StagesSolve(Statics s)
{
  PetscReal size = 0;
  Vec       f    = NULL, f0;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_STATICS));
  s->n_it = s->n_factored = s->n_reactions = 0;
  s->n_tightened                           = 0;
  s->peak                                  = 0;
  for (PetscInt k = 0; k < StagesCount(s); k++) {
    f0 = f;
    PetscCall(BoltsSolve(s, k, f0, &size, &f));
    PetscCall(StaticsWarnClosing(s));
    if (s->n_stages) PetscCall(StaticsFindReactions(s));
    PetscCall(VecDestroy(&f0));
  }
  s->solved = PETSC_TRUE;
  PetscCall(VecDestroy(&f));
  PetscCall(EventEnd(EVENT_STATICS));
  PetscFunctionReturn(0);
}
