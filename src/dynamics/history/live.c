/*
   The live line: where a run stands, and whether it vibrates more and more.

   Growth: half the logarithmic rate of the largest rises K_1, K_2 of the kinetic energy, from a trough to the next
   peak, in two consecutive windows, peaks at times t_1, t_2,
      sigma = ln(K_2 / K_1) / (2 (t_2 - t_1)),
   exact for K = exp(2 sigma t) p(t) with p periodic and shorter than a window, but for what rows miss of a peak. Times
   closer than half a window stand for half a window, lest two peaks beside the border of the windows make a large rate
   of a small difference. A window goes on until it has a rise. Slow motion under the vibration does not count; where
   the energy only rises or falls, as under a load that is put on, there is no rate.
*/
#include "historyimpl.h"
#include <math.h>
#include <petsctime.h>

#define STALE 10 /* windows without a rise after which there is no vibration */

/* Ends the present window, which has a rise */
static void GrowthEndWindow(Growth *g)
{
  g->n = PetscMin(g->n + 1, 2);
  if (g->n == 2) g->rate = 0.5 * log(g->rise / g->last_rise) / PetscMax(g->at - g->last_at, 0.5 * g->window);
  g->last_rise = g->rise;
  g->last_at   = g->at;
  g->rise      = 0;
}

/* The row before the present one, K[1] at g->time, may have been a trough or a peak */
static void GrowthAddTurn(Growth *g, PetscReal kinetic)
{
  const PetscReal rise = g->energy[1] - g->trough;

  if (g->energy[1] < g->energy[0] && g->energy[1] <= kinetic) g->trough = g->energy[1];
  if (g->energy[1] <= g->energy[0] || g->energy[1] < kinetic || rise <= g->rise) return;
  g->rise = rise;
  g->at   = g->time;
}

void GrowthAdd(Growth *g, PetscReal t, PetscReal kinetic)
{
  const PetscReal index = PetscFloorReal(t / g->window);

  GrowthAddTurn(g, kinetic);
  if (index > g->index + STALE) g->n = 0;
  if (index != g->index && g->rise > 0) {
    GrowthEndWindow(g);
    g->index = index;
  }
  g->energy[0] = g->energy[1];
  g->energy[1] = kinetic;
  g->time      = t;
}

/* Time for people */
static void LivePrintTime(double seconds, char text[32])
{
  const long s = lround(PetscMin(seconds, 1e8));

  if (s < 60)
    (void)snprintf(text, 32, "%ld s", s);
  else if (s < 3600)
    (void)snprintf(text, 32, "%ld min %ld s", s / 60, s % 60);
  else
    (void)snprintf(text, 32, "%ld h %ld min", s / 3600, s / 60 % 60);
}

/* Contact state, empty without interfaces */
static void LivePrintContact(const HistoryState *state, char text[128])
{
  long   n[CONTACT_N_STATUS] = {0};
  double normal              = 0;

  text[0] = '\0';
  for (PetscInt i = 0; i < state->n_interfaces; i++) {
    for (int status = 0; status < CONTACT_N_STATUS; status++) n[status] += (long)state->sums[i].n[status];
    normal += (double)state->sums[i].normal;
  }
  if (state->n_interfaces)
    (void)snprintf(text, 128, "  open %ld stick %ld slip %ld  normal %.4g N", n[CONTACT_OPEN], n[CONTACT_STICK],
                   n[CONTACT_SLIP], normal);
}

/* Prints the line on this rank */
static PetscErrorCode LivePrint(const Live *live, const Growth *growth, const HistoryState *state)
{
  const PetscReal done = state->time - live->start, left = PetscMax(live->end - state->time, 0);
  char            time[32] = "-", contact[128], rate[32] = "-", line[320];

  PetscFunctionBeginUser;
  if (done > 0) LivePrintTime((double)(left / done) * (live->shown - live->begun), time);
  LivePrintContact(state, contact);
  if (growth->n == 2) (void)snprintf(rate, sizeof(rate), "%+.3g 1/s", (double)growth->rate);
  (void)snprintf(line, sizeof(line), "step %ld  t %.6g ms  left %s%s  growth %s\n", (long)state->step,
                 1e3 * (double)state->time, time, contact, rate);
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "%s", line));
  (void)fflush(PETSC_STDOUT);
  PetscFunctionReturn(0);
}

PetscErrorCode LiveShow(History history, const HistoryState *state)
{
  Live *const    live = &history->live;
  PetscMPIInt    rank;
  PetscLogDouble now;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(history->comm, &rank));
  if (rank || live->interval <= 0) PetscFunctionReturn(0);
  PetscCall(PetscTime(&now));
  if (live->begun == 0) {
    live->begun = live->shown = now;
    live->start               = state->time;
  }
  if (now - live->shown < live->interval) PetscFunctionReturn(0);
  live->shown = now;
  PetscCall(LivePrint(live, &history->growth, state));
  PetscFunctionReturn(0);
}
