/* Private to the history: its record and the files that fill it. What a restart needs is made of reals alone, to be
   kept as an array of them */
#pragma once

#include "history.h"
#include <squeal/options.h>
#include <squeal/quantity.h>

#define PAIRS_HEADER "time_s,pair,interface,x_m,y_m,z_m,gap_m,lambda_n_n,lambda_t_n,status"

/* Multiples of an interval, each met at the first t >= k interval - dt / 2 */
typedef struct {
  PetscReal interval; /* s, 0 for never */
  PetscReal next;     /* k of the one that comes next */
} Schedule;

/* Growth of the vibration, from the largest rises of the kinetic energy in consecutive windows of time */
typedef struct {
  PetscReal window;             /* length, s */
  PetscReal index;              /* of the present one */
  PetscReal rise, at;           /* its largest rise so far (J), with the peak at this time (s); 0 for none */
  PetscReal last_rise, last_at; /* those of the complete one before */
  PetscReal n;                  /* complete windows with a rise, one after the other, at most 2 */
  PetscReal rate;               /* half the logarithmic rate of the last two, 1/s; known for n = 2 */
  PetscReal energy[2], time;    /* kinetic energies of the last two rows, and time of the last */
  PetscReal trough;             /* the last one, J */
} Growth;

/* Live line; the times of the wall are of rank 0 */
typedef struct {
  PetscReal      interval; /* least time between two lines, s of the wall; 0 for none */
  PetscReal      end;      /* of the run, s */
  PetscReal      start;    /* first time seen, s */
  PetscLogDouble begun, shown;
} Live;

struct _p_History {
  MPI_Comm              comm;
  Schedule              rows, pairs, frames;
  Growth                growth;
  Live                  live;
  PetscReal             sweeps, steps; /* of the projector at the last row */
  HistorySource         source;
  PetscInt              n_probes;
  const Probe          *probes;
  PetscInt              n_circles;
  const Circle         *circles;
  const HistoryFilters *filters; /* NULL for none */
  Sound                 sound;
  SoundListener         listener; /* NULL without microphones, or before the first row */
  PetscInt              n_heard;  /* numbers that a restart brings, for the listener */
  PetscReal            *heard;    /* [n_heard] */
  /* where */
  ResultsTable table, pair_table, amplitude_table, circle_table, sound_table;
  ResultsFilm  film; /* NULL for none */
};

/* quantities.c - rows of the options */
extern const QuantityTable history_quantities;

/* motion.c - Cartesian displacement (m), velocity (m/s) and acceleration (m/s^2) of local node i at t_n; zero for
   a node without cells */
PETSC_INTERN void HistoryMotion(const Layout *layout, const HistoryState *state, PetscInt i, PetscReal u[3],
                                PetscReal v[3], PetscReal a[3]);

/* schedule.c - whether one is due; Meet then goes on to the next. Restore takes
   over from a run that may have had another interval */
PETSC_INTERN PetscBool ScheduleIsDue(const Schedule *schedule, PetscReal t, PetscReal dt);
PETSC_INTERN PetscBool ScheduleMeet(Schedule *schedule, PetscReal t, PetscReal dt);
PETSC_INTERN void      ScheduleRestore(Schedule *schedule, const Schedule *kept);

/* schedule.c - the intervals of a run of steps dt (0 for not rounded) to `end`: errors as of HistorySetUp().
   Collective. */
PETSC_INTERN PetscErrorCode HistoryFit(History history, PetscReal end, PetscReal dt);

/* tables/row.c - header of transient.csv, which the caller frees, and a row */
PETSC_INTERN PetscErrorCode HistoryCreateHeader(History history, char **header);
PETSC_INTERN PetscErrorCode HistoryWriteRow(History history, const HistoryState *state);

/* tables/pairs.c - rows of the states of all ranks, by interface and number of the slave */
PETSC_INTERN PetscErrorCode HistoryWritePairs(ResultsTable table, MPI_Comm comm, const ContactInterface interfaces[],
                                              PetscReal time, const HistoryPairs *pairs);

/* tables/amplitudes.c - header of amplitudes.csv, which the caller frees, and a row. Collective. */
PETSC_INTERN PetscErrorCode AmplitudesCreateHeader(const HistoryFilters *filters, char **header);
PETSC_INTERN PetscErrorCode HistoryWriteAmplitudes(History history, const HistoryState *state);

/* tables/circles.c - header of circles.csv, which the caller frees, a row, and the table of the nodes. Collective. */
PETSC_INTERN PetscErrorCode CirclesCreateHeader(History history, char **header);
PETSC_INTERN PetscErrorCode HistoryWriteCircles(History history, const HistoryState *state);
PETSC_INTERN PetscErrorCode CirclesWriteNodes(History history);

/* tables/sound.c - whether there are microphones; header of sound_time.csv, which the caller frees, and a row.
   Collective. */
PETSC_INTERN PetscBool      HistoryHears(History history);
PETSC_INTERN PetscErrorCode HistoryCreateSoundHeader(History history, char **header);
PETSC_INTERN PetscErrorCode HistoryWriteSound(History history, const HistoryState *state);

/* live.c */
PETSC_INTERN void           GrowthAdd(Growth *growth, PetscReal t, PetscReal kinetic);
PETSC_INTERN PetscErrorCode LiveShow(History history, const HistoryState *state);

/* snapshot.c */
PETSC_INTERN PetscErrorCode SnapshotsCreate(History history);
PETSC_INTERN PetscErrorCode SnapshotWrite(History history, const HistoryState *state);
