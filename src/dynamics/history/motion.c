/*
   Motion of a vertex at t_n: displacement (m), velocity (m/s) and acceleration (m/s^2). From state vectors, with the
   velocity before at t_{n-1/2} and the forces f (N),

      v_n = v_{n-1/2} + dt M^-1 (b f_n + (1/2 - b) f_{n-1}),   a_n = M^-1 f_n;

   a reduced run hands its own.
*/
#include "historyimpl.h"

static void LayoutMotion(const Layout *layout, const HistoryState *state, PetscInt i, PetscReal u[3], PetscReal v[3],
                         PetscReal a[3])
{
  const Layout    one  = {.at = (PetscInt[]){0}, .step = (PetscInt[]){1}, .basis = &layout->basis[9 * i]};
  const PetscReal kick = state->dt * state->b, kick_old = state->dt * (0.5 - state->b);
  PetscReal       local_u[3] = {0}, local_v[3] = {0}, local_a[3] = {0};

  for (PetscInt j = 0; layout->at[i] >= 0 && j < 3; j++) {
    const PetscInt  k    = layout->at[i] + j * layout->step[i];
    const PetscReal push = kick * state->f[k] + (state->f_old ? kick_old * state->f_old[k] : 0);

    local_u[j] = state->u[k];
    local_v[j] = state->before[k] + state->minv[k] * push;
    local_a[j] = state->minv[k] * state->f[k];
  }
  LayoutGet(&one, 0, local_u, u);
  LayoutGet(&one, 0, local_v, v);
  LayoutGet(&one, 0, local_a, a);
}

void HistoryMotion(const Layout *layout, const HistoryState *state, PetscInt i, PetscReal u[3], PetscReal v[3],
                   PetscReal a[3])
{
  if (state->motions)
    state->motions->at(state->motions->ctx, i, u, v, a);
  else
    LayoutMotion(layout, state, i, u, v, a);
}
