/*
   What a killed sweep in full, or on real modes, goes on from: sweep_restart_000, written anew after each place, with
   the modes of all places so far and how many branches and events there were after each; in full also the contact
   statuses and the points from which branches go on. What is taken up goes through the same functions as what is
   solved, so that the tables are the same.
*/
#include "follow.h"
#include "base/process/interrupt.h"

enum { ITEM_PLACES, ITEM_STATE, ITEM_BEFORE, ITEM_FIRST, N_KEPT_ITEMS };

/* Counts after a place */
typedef struct {
  PetscInt n_modes, status, n_branches, n_broken, n_events;
} PlaceCounts;

/* What stands before the rest of the state; first is the point before itself where `same` */
typedef struct {
  PetscInt n_places, n_events, n_statuses, has_before, has_first, same;
} StateHeader;

/* Moves place i of the line behind those before it, or back. Reading sets the counts of branches and events as they
   were after that place, so that LineFinish() does the same as then. */
static PetscErrorCode PlaceMove(Sweep sweep, PetscInt i, LinePoints *points)
{
  JournalPack  *pack  = &sweep->places;
  ReducedModes *modes = &points->modes[i];
  SweepPlace   *place = &sweep->grid.place[points->first + i];
  PlaceCounts   c     = {modes->n, place->status, sweep->n_branches, sweep->n_broken, sweep->events.n};
  size_t        n;

  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, &c, sizeof(c)));
  n = (size_t)c.n_modes;
  if (!pack->write) {
    place->status     = c.status;
    sweep->n_branches = c.n_branches;
    sweep->n_broken   = c.n_broken;
    sweep->events.n   = c.n_events;
    PetscCall(ReducedModesCreate(c.n_modes, 0, modes));
    PetscCall(PetscMalloc1(n, &points->branch[i]));
    PetscCall(PetscCalloc1(n, &points->name[i]));
  }
  PetscCall(JournalPackMove(pack, modes->lambda, sizeof(*modes->lambda) * n));
  PetscCall(JournalPackMove(pack, modes->product, sizeof(*modes->product) * n));
  PetscCall(JournalPackMove(pack, modes->error, sizeof(*modes->error) * n));
  PetscCall(JournalPackMove(pack, modes->noise, sizeof(*modes->noise) * n));
  PetscCall(JournalPackMove(pack, modes->rigid, sizeof(*modes->rigid) * n));
  PetscCall(JournalPackMove(pack, points->branch[i], sizeof(PetscInt) * n));
  PetscCall(JournalPackMove(pack, points->name[i], sizeof(BranchName) * n));
  PetscCheck(pack->write || pack->good, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a kept point ends too early");
  PetscFunctionReturn(0);
}

/* Events and contact statuses, all that there are by now */
static PetscErrorCode ListsMove(Sweep sweep, const StateHeader *h, JournalPack *pack)
{
  StatusList  *list = &sweep->statuses;
  const size_t n = (size_t)h->n_statuses, n_all = n * (size_t)list->n_local;

  PetscFunctionBeginUser;
  if (!pack->write) {
    PetscCall(PetscRealloc(sizeof(BranchEvent) * (size_t)PetscMax(1, h->n_events), &sweep->events.event));
    PetscCall(PetscRealloc(sizeof(PetscInt) * (n + 1), &list->n_closed));
    PetscCall(PetscRealloc(sizeof(PetscBool) * (n_all + 1), &list->closed));
    list->n = h->n_statuses;
  }
  PetscCall(JournalPackMove(pack, sweep->events.event, sizeof(BranchEvent) * (size_t)h->n_events));
  PetscCall(JournalPackMove(pack, list->n_closed, sizeof(PetscInt) * n));
  PetscCall(JournalPackMove(pack, list->closed, sizeof(PetscBool) * n_all));
  PetscFunctionReturn(0);
}

/* All but the places, into the items or from them */
static PetscErrorCode StateMove(Sweep sweep, StateHeader *h, JournalPack *pack, JournalItem item[N_KEPT_ITEMS],
                                Follow *follow)
{
  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, h, sizeof(*h)));
  PetscCall(ListsMove(sweep, h, pack));
  if (!pack->write && h->has_before) PetscCall(PetscNew(&follow->before));
  if (!pack->write && h->has_first) PetscCall(PetscNew(&follow->first));
  if (h->has_before) PetscCall(FollowPointMove(sweep->comm, pack, follow->before, &item[ITEM_BEFORE]));
  if (h->has_first) PetscCall(FollowPointMove(sweep->comm, pack, follow->first, &item[ITEM_FIRST]));
  if (!pack->write && h->same) follow->first = follow->before;
  PetscFunctionReturn(0);
}

/* Collective. The pack of places grows with each; the file is written anew when it is due (JournalIsDue()), as
   writing all places after each would cost the square of their number. */
PetscErrorCode SweepKeepPlace(Sweep sweep, PetscInt i, LinePoints *points, Follow *follow)
{
  JournalPack pack = {.write = PETSC_TRUE};
  JournalItem item[N_KEPT_ITEMS];
  StateHeader h = {.n_places = sweep->n_kept + 1, .n_events = sweep->events.n, .n_statuses = sweep->statuses.n};
  char        name[64];
  PetscBool   kept;

  PetscFunctionBeginUser;
  if (!sweep->restart || !sweep->places.good) PetscFunctionReturn(0);
  h.has_before = follow->before ? 1 : 0;
  h.has_first  = follow->first && follow->first != follow->before ? 1 : 0;
  h.same       = follow->first && follow->first == follow->before ? 1 : 0;
  PetscCall(BasisKeptName("sweep", 0, name));
  PetscCall(PlaceMove(sweep, i, points));
  sweep->n_kept = h.n_places;
  if (!JournalIsDue(h.n_places)) PetscFunctionReturn(0);
  item[ITEM_BEFORE] = (JournalItem){"vectors", 0, NULL};
  item[ITEM_FIRST]  = (JournalItem){"vectors of the line before", 0, NULL};
  PetscCall(StateMove(sweep, &h, &pack, item, follow));
  item[ITEM_PLACES] = (JournalItem){"places", sweep->places.n, sweep->places.word};
  item[ITEM_STATE]  = (JournalItem){"state", pack.n, pack.word};
  PetscCall(JournalKeep(&sweep->journal, name, N_KEPT_ITEMS, item, &kept));
  PetscCall(PetscFree(item[ITEM_BEFORE].values));
  PetscCall(PetscFree(item[ITEM_FIRST].values));
  PetscCall(JournalPackDestroy(&pack));
  sweep->places.good = kept; /* else it goes on without */
  if (kept)
    InterruptSays("%d of %d points are kept, with which the same command goes on", (int)h.n_places,
                  (int)sweep->grid.n_places);
  PetscFunctionReturn(0);
}

/* Reading goes on until the pack is at its end and turns to writing: the places after it are solved and put behind
   the same pack. */
PetscErrorCode SweepTakePlace(Sweep sweep, PetscInt i, LinePoints *points, PetscBool *taken)
{
  PetscFunctionBeginUser;
  *taken = sweep->places.write ? PETSC_FALSE : PETSC_TRUE;
  if (!*taken) PetscFunctionReturn(0);
  PetscCall(PlaceMove(sweep, i, points));
  if (sweep->places.at == sweep->places.n) sweep->places.write = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode SweepResumePlaces(Sweep sweep, Follow *follow)
{
  JournalItem item[N_KEPT_ITEMS] = {[ITEM_PLACES] = {"places", -1, NULL},
                                    [ITEM_STATE]  = {"state", -1, NULL},
                                    [ITEM_BEFORE] = {"vectors", -1, NULL},
                                    [ITEM_FIRST]  = {"vectors of the line before", -1, NULL}};
  JournalPack pack               = {.good = PETSC_TRUE};
  StateHeader h                  = {0};
  char        name[64];
  PetscBool   taken;

  PetscFunctionBeginUser;
  sweep->places = (JournalPack){.write = PETSC_TRUE, .good = PETSC_TRUE};
  if (!sweep->restart) PetscFunctionReturn(0);
  PetscCall(SweepJournalOpen(sweep));
  PetscCall(BasisKeptName("sweep", 0, name));
  PetscCall(JournalTake(&sweep->journal, name, "the sweep begins anew", N_KEPT_ITEMS, item, &taken));
  if (!taken) PetscFunctionReturn(0);
  pack.word = item[ITEM_STATE].values;
  pack.n    = item[ITEM_STATE].n;
  PetscCall(StateMove(sweep, &h, &pack, item, follow));
  sweep->places =
    (JournalPack){item[ITEM_PLACES].values, item[ITEM_PLACES].n, item[ITEM_PLACES].n, 0, PETSC_FALSE, PETSC_TRUE};
  sweep->n_kept = h.n_places;
  PetscCall(JournalPackDestroy(&pack));
  PetscCall(PetscFree(item[ITEM_BEFORE].values));
  PetscCall(PetscFree(item[ITEM_FIRST].values));
  PetscCall(PetscPrintf(sweep->comm, "going on with %" PetscInt_FMT " of %" PetscInt_FMT " points kept in %s\n",
                        h.n_places, sweep->grid.n_places, sweep->folder));
  InterruptSays("%d of %d points are kept, with which the same command goes on", (int)h.n_places,
                (int)sweep->grid.n_places);
  PetscFunctionReturn(0);
}
