/*
   What each stage ends with, in words and as stages.csv: rows as those of reactions.csv, and of each contact how many
   pairs are open, stick and slip.
*/
#include "statics/staticsimpl.h"
#include "base/text.h"

PetscErrorCode StagesWrite(Statics s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  if (!s->n_stages) PetscFunctionReturn(0);
  PetscCall(
    ResultsTableOpen(results, "stages", "stage,name,kind,force_x_n,force_y_n,force_z_n,open,stick,slip", &table));
  for (PetscInt i = 0; i < s->n_reactions; i++) {
    const Reaction *r = &s->reaction[i];

    PetscCall(ResultsTableRow(table, "%s,%s,%s,%.15g,%.15g,%.15g,%" PetscInt_FMT ",%" PetscInt_FMT ",%" PetscInt_FMT,
                              s->stages[r->stage].name, r->name, r->kind, (double)r->force[0], (double)r->force[1],
                              (double)r->force[2], r->n[CONTACT_OPEN], r->n[CONTACT_STICK], r->n[CONTACT_SLIP]));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode StagesViewEnds(Statics s, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n_reactions && s->n_stages; i++) {
    const Reaction *r = &s->reaction[i];

    if (r->stage == s->stage || strcmp(r->kind, "contact on master")) continue;
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "stage %s: contact %s: %" PetscInt_FMT " of its pairs open, %" PetscInt_FMT
                                     " stick and %" PetscInt_FMT " slip; force on the master %.6g, %.6g, %.6g N\n",
                                     s->stages[r->stage].name, r->name, r->n[CONTACT_OPEN], r->n[CONTACT_STICK],
                                     r->n[CONTACT_SLIP], (double)r->force[0], (double)r->force[1],
                                     (double)r->force[2]));
  }
  PetscFunctionReturn(0);
}

/* Adds ", pull" of a list to words */
static PetscErrorCode NamesAdd(const char what[], PetscInt n, char *const names[], size_t size, char words[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(WordsAdd(words, i ? ", " : words[0] ? "; " : "", size));
    if (!i) PetscCall(WordsAdd(words, what, size));
    PetscCall(WordsAdd(words, names[i], size));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsViewStages(Statics s, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_stages; k++) {
    const Stage *stage      = &s->stages[k];
    char         words[512] = "";

    PetscCall(NamesAdd("load ", stage->n_loads, stage->loads, sizeof(words), words));
    PetscCall(NamesAdd("motion ", stage->n_motions, stage->motions, sizeof(words), words));
    PetscCall(NamesAdd("sliding of ", stage->n_sliding, stage->sliding, sizeof(words), words));
    PetscCall(NamesAdd("interference of ", stage->n_interferences, stage->interferences, sizeof(words), words));
    PetscCall(NamesAdd("without load ", stage->n_ends, stage->ends, sizeof(words), words));
    PetscCall(PetscViewerASCIIPrintf(viewer, "  stage %s: %s\n", stage->name, words));
  }
  PetscFunctionReturn(0);
}
