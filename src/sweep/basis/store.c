/*
   Points on the reduced model with errors. The errors handed on are POINTS_MARGIN times those of estimate.c, which see
   what the added vectors tell and no more: over 5,657 eigenvalues of scripts/study/errors the true error is at most
   0.91 of what is handed on. While the model is the same, only vectors that tell its error being added, solutions serve
   again.
*/
#include "points.h"

/* Points: at 200 vectors and 60 modes each takes some 0.4 MB. More than the greedy choice looks at. */
#define STORE_MOST 128

/* Forgets all solutions where they are not those of this model and window. Vectors in use change the model, n_used
   with them; vectors that are only added do not. */
static PetscErrorCode PointStoreReset(PointStore *store, const Reduced *reduced, const ReducedWindow *window)
{
  const PetscInt n_used = reduced->n_used;
  PetscBool      same;

  PetscFunctionBeginUser;
  PetscCall(PetscMemcmp(&store->window, window, sizeof(*window), &same));
  if (same && store->n_used == n_used) PetscFunctionReturn(0);
  PetscCall(PointStoreDestroy(store));
  store->n_used = n_used;
  store->window = *window;
  PetscCall(PetscMalloc3(STORE_MOST * reduced->n_parameters, &store->p, STORE_MOST, &store->modes, STORE_MOST,
                         &store->estimated));
  PetscFunctionReturn(0);
}

PetscErrorCode PointStoreDestroy(PointStore *store)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < store->n; i++) PetscCall(ReducedModesDestroy(&store->modes[i]));
  PetscCall(PetscFree3(store->p, store->modes, store->estimated));
  store->n = store->n_used = 0;
  PetscFunctionReturn(0);
}

/* The point with these values, or -1 */
static PetscErrorCode PointStoreFind(const PointStore *store, PetscInt n_parameters, const PetscReal p[], PetscInt *at)
{
  PetscBool same = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (*at = 0; *at < store->n; ++*at) {
    PetscCall(PetscMemcmp(&store->p[*at * n_parameters], p, (size_t)n_parameters * sizeof(*p), &same));
    if (same) PetscFunctionReturn(0);
  }
  *at = -1;
  PetscFunctionReturn(0);
}

/* error = POINTS_MARGIN (error - noise) + noise, rad/s: the margin is on what the basis lacks, not on rounding. */
PetscErrorCode PointEstimate(const Reduced *reduced, const PetscReal p[], ReducedModes *modes)
{
  PetscFunctionBeginUser;
  PetscCall(ReducedEstimate(reduced, p, modes));
  for (PetscInt i = 0; i < modes->n; i++)
    modes->error[i] = POINTS_MARGIN * (modes->error[i] - modes->noise[i]) + modes->noise[i];
  PetscFunctionReturn(0);
}

/* Not collective. The eigenvalues are kept with the model, the errors with the size of the whole basis: after
   vectors were added the errors alone are computed again. The caller gets a copy. */
PetscErrorCode PointStoreSolve(PointStore *store, const Reduced *reduced, const ReducedWindow *window,
                               const PetscReal p[], ReducedModes *modes)
{
  PetscInt at;

  PetscFunctionBeginUser;
  if (store) {
    PetscCall(PointStoreReset(store, reduced, window));
    PetscCall(PointStoreFind(store, reduced->n_parameters, p, &at));
  }
  if (!store || (at < 0 && store->n == STORE_MOST)) {
    PetscCall(ReducedSolve(reduced, p, window, modes));
    PetscCall(PointEstimate(reduced, p, modes));
    PetscFunctionReturn(0);
  }
  if (at < 0) {
    at = store->n;
    PetscCall(PetscArraycpy(&store->p[at * reduced->n_parameters], p, reduced->n_parameters));
    PetscCall(ReducedSolve(reduced, p, window, &store->modes[at]));
    store->estimated[at] = 0;
    store->n++;
  }
  if (store->estimated[at] != reduced->n) PetscCall(PointEstimate(reduced, p, &store->modes[at]));
  store->estimated[at] = reduced->n;
  PetscCall(ReducedModesSelect(&store->modes[at], store->modes[at].n, NULL, modes));
  PetscFunctionReturn(0);
}
