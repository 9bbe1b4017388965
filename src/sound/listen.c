/*
   Sound in time: s(t) = rho / (2 pi) int v_n(y, t - R / c) / R dA at times h apart, p = ds/dt.

   A point at R / c = (k + f) h, 0 <= f < 1, adds to s at t_{n+k-1} .. t_{n+k+2} what v(t_n) does there: v between times
   is sum_j L_j v(t_j), cubic through the four times around it. With k >= 3 the values s(t_{n-2}) .. s(t_{n+2}) that
   p(t_n) = (s_{n-2} - 8 s_{n-1} + 8 s_{n+1} - s_{n+2}) / (12 h) needs are complete with v(t_n).
*/
#include "soundimpl.h"

#define N_TAPS     4
#define NEAREST    3   /* least k */
#define MOST_DELAY 1e6 /* most k */

struct _p_SoundListener {
  Sound      sound;
  PetscReal  h;
  PetscInt   n_heard; /* times */
  PetscInt   length;  /* of the ring, times */
  PetscReal *ring;    /* [length][microphones] s of this rank's points, time n at n % length */
  PetscInt  *delay;   /* [points][microphones] k, 0 for points that do not face the microphone */
  PetscReal *tap;     /* [points][microphones][N_TAPS] */
  PetscInt   n_shapes;
  PetscReal *answer; /* [n_shapes][length][microphones] s after a rate 1 at one time, of all ranks; or NULL */
};

/* Times the size: Lagrange's polynomials of the times t_{m-k+1}, t_{m-k}, t_{m-k-1}, t_{m-k-2} at t_m - (k + f) h; the
   j-th is what t_n does to t_{n+k-1+j} */
static void TapsSet(PetscReal f, PetscReal size, PetscReal tap[N_TAPS])
{
  const PetscReal lagrange[N_TAPS] = {-f * (1 - f) * (1 - f + 1) / 6, (1 - f) * (1 + f) * (2 - f) / 2,
                                      f * (1 + f) * (2 - f) / 2, -f * (1 - f) * (1 + f) / 6};

  for (int j = 0; j < N_TAPS; j++) tap[j] = size * lagrange[j];
}

/* Delays of all points of this rank, and the longest of all ranks */
static PetscErrorCode ListenerSetDelays(SoundListener l)
{
  const Sound         sound    = l->sound;
  const SoundSurface *s        = &sound->surface;
  PetscReal           range[2] = {-MOST_DELAY, NEAREST}; /* the least, negated; the most */

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < s->n; q++)
    for (PetscInt i = 0; i < sound->n; i++) {
      const PetscInt at = q * sound->n + i;
      PetscReal      x[3], R, steps;

      SoundPlace(sound, i, x);
      R     = SoundSurfaceDistance(s, q, x);
      steps = R / (sound->speed * l->h);
      if (R <= 0) continue;
      range[0] = PetscMax(range[0], -steps);
      range[1] = PetscMax(range[1], steps);
      if (steps >= MOST_DELAY) continue;
      l->delay[at] = (PetscInt)PetscFloorReal(steps);
      TapsSet(steps - (PetscReal)l->delay[at], sound->density * s->area[q] / (2 * PETSC_PI * R), &l->tap[N_TAPS * at]);
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, sound->comm));
  PetscCheck(
    range[1] < MOST_DELAY, sound->comm, PETSC_ERR_USER_INPUT,
    "-sound_microphones: sound takes %g s to one of them, %g times -dynamics_history_interval %g s, at most %g "
    "times: move it nearer, or see to -sound_speed",
    (double)(range[1] * l->h), (double)range[1], (double)l->h, MOST_DELAY);
  PetscCheck(
    -range[0] >= NEAREST, sound->comm, PETSC_ERR_USER_INPUT,
    "-sound_microphones: one is nearer than %g m to the surface, 3 steps of -dynamics_history_interval %g s at "
    "the speed of sound: move it away, or shorten the interval",
    (double)(NEAREST * sound->speed * l->h), (double)l->h);
  l->length = (PetscInt)range[1] + N_TAPS + 2;
  PetscFunctionReturn(0);
}

PetscErrorCode SoundListen(Sound sound, PetscReal h, SoundListener *listener)
{
  const PetscInt n = sound->surface.n * sound->n;
  SoundListener  l;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&l));
  l->sound = sound;
  l->h     = h;
  PetscCall(PetscCalloc2(n, &l->delay, N_TAPS * n, &l->tap));
  PetscCall(ListenerSetDelays(l));
  PetscCall(PetscCalloc1(l->length * sound->n, &l->ring));
  *listener = l;
  PetscFunctionReturn(0);
}

/* s of a time, `ahead` of the last one that was heard */
static PetscReal *ListenerAt(SoundListener l, PetscInt ahead)
{
  return &l->ring[(l->n_heard + ahead + l->length) % l->length * l->sound->n];
}

/* The difference of s at the present time, of all ranks */
static PetscErrorCode ListenerDifferentiate(SoundListener l, PetscReal pressure[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < l->sound->n; i++)
    pressure[i] =
      (ListenerAt(l, -2)[i] - 8 * ListenerAt(l, -1)[i] + 8 * ListenerAt(l, 1)[i] - ListenerAt(l, 2)[i]) / (12 * l->h);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, pressure, (PetscMPIInt)l->sound->n, MPIU_REAL, MPI_SUM, l->sound->comm));
  PetscFunctionReturn(0);
}

/* What velocities of the nodes do */
static void ListenerAddNodal(SoundListener l, const PetscReal v[])
{
  const SoundSurface *s = &l->sound->surface;
  const PetscInt      n = l->sound->n;

  for (PetscInt q = 0; q < s->n; q++) {
    const PetscReal normal = SoundSurfaceNormal(s, q, v);

    for (PetscInt at = q * n; at < (q + 1) * n; at++)
      for (int j = 0; l->delay[at] && j < N_TAPS; j++)
        ListenerAt(l, l->delay[at] - 1 + j)[at - q * n] += l->tap[N_TAPS * at + j] * normal;
  }
}

/* What rates of the shapes do, on the first rank */
static PetscErrorCode ListenerAddRates(SoundListener l, const PetscReal rate[])
{
  const PetscInt n = l->sound->n, size = l->length * n;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(l->sound->comm, &rank));
  for (PetscInt k = 0; k < l->n_shapes && !rank; k++)
    for (PetscInt ahead = 0; ahead < l->length - 2; ahead++)
      for (PetscInt i = 0; i < n; i++) ListenerAt(l, ahead)[i] += rate[k] * l->answer[k * size + ahead * n + i];
  PetscFunctionReturn(0);
}

PetscErrorCode SoundListenerTakeShapes(SoundListener l, const SoundShapes *shapes)
{
  const PetscInt size = l->length * l->sound->n;
  const Mesh    *mesh;
  PetscReal     *v;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(l->sound->model, &mesh));
  l->n_shapes = shapes->n;
  PetscCall(PetscMalloc1(shapes->n * size, &l->answer));
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &v));
  for (PetscInt k = 0; k < shapes->n; k++) {
    PetscCall(shapes->get(shapes->ctx, k, v));
    ListenerAddNodal(l, v);
    PetscCallMPI(MPI_Allreduce(l->ring, &l->answer[k * size], (PetscMPIInt)size, MPIU_REAL, MPI_SUM, l->sound->comm));
    PetscCall(PetscArrayzero(l->ring, size));
  }
  PetscCall(PetscFree(v));
  PetscFunctionReturn(0);
}

PetscErrorCode SoundListenerHear(SoundListener l, const PetscReal motion[], PetscReal pressure[])
{
  const PetscInt n = l->sound->n;

  PetscFunctionBeginUser;
  if (l->answer)
    PetscCall(ListenerAddRates(l, motion));
  else
    ListenerAddNodal(l, motion);
  PetscCall(ListenerDifferentiate(l, pressure));
  PetscCall(PetscArrayzero(ListenerAt(l, -2), n)); /* comes to be the last of the ring */
  l->n_heard++;
  PetscFunctionReturn(0);
}

PetscErrorCode SoundListenerGetMemory(SoundListener l, PetscInt *n, PetscReal **values)
{
  const PetscInt n_ring = l->length * l->sound->n;

  PetscFunctionBeginUser;
  *n = 1 + n_ring;
  PetscCall(PetscMalloc1(*n, values));
  (*values)[0] = (PetscReal)l->n_heard;
  PetscCallMPI(MPI_Allreduce(l->ring, &(*values)[1], (PetscMPIInt)n_ring, MPIU_REAL, MPI_SUM, l->sound->comm));
  PetscFunctionReturn(0);
}

/* The first rank takes what all had */
PetscErrorCode SoundListenerSetMemory(SoundListener l, PetscInt n, const PetscReal values[])
{
  const PetscInt n_ring = l->length * l->sound->n;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(l->sound->comm, &rank));
  PetscCheck(n == 1 + n_ring, l->sound->comm, PETSC_ERR_ARG_SIZ,
             "memory of sound of %" PetscInt_FMT " numbers, must be %" PetscInt_FMT, n, 1 + n_ring);
  l->n_heard = (PetscInt)values[0];
  for (PetscInt i = 0; i < n_ring; i++) l->ring[i] = rank ? 0 : values[1 + i];
  PetscFunctionReturn(0);
}

PetscErrorCode SoundListenerDestroy(SoundListener *l)
{
  PetscFunctionBeginUser;
  if (!*l) PetscFunctionReturn(0);
  PetscCall(PetscFree2((*l)->delay, (*l)->tap));
  PetscCall(PetscFree((*l)->ring));
  PetscCall(PetscFree((*l)->answer));
  PetscCall(PetscFree(*l));
  PetscFunctionReturn(0);
}
