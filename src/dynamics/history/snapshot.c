/*
   Snapshots: displacement (m) and velocity (m/s) of all nodes at t_n, Cartesian, and transient.xmf which shows them
   in time.
*/
#include "historyimpl.h"

PetscErrorCode SnapshotsCreate(History history)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(history->source.model, &mesh));
  PetscCall(ResultsFilmCreate(history->source.results, "transient", "snapshot", mesh, &history->film));
  PetscFunctionReturn(0);
}

PetscErrorCode SnapshotWrite(History history, const HistoryState *state)
{
  const Mesh *mesh;
  PetscInt    n;
  PetscReal  *u, *v, a[3];
  char        title[64];

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(history->source.model, &mesh));
  n = mesh->n_nodes;
  PetscCall(PetscMalloc2(3 * n, &u, 3 * n, &v));
  if (state->motions) PetscCall(state->motions->lift(state->motions->ctx, u, v));
  for (PetscInt i = 0; i < n && !state->motions; i++)
    HistoryMotion(history->source.layout, state, i, &u[3 * i], &v[3 * i], a);
  PetscCall(PetscSNPrintf(title, sizeof(title), "step %" PetscInt_FMT ", t = %.6g ms", state->step,
                          (double)(1e3 * state->time)));
  PetscCall(ResultsFilmWrite(history->film, state->time, title, 2,
                             (const ResultsNodal[]){{"displacement_m", 3, u}, {"velocity_m_s", 3, v}}));
  PetscCall(PetscFree2(u, v));
  PetscFunctionReturn(0);
}
