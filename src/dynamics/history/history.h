/*
   History (private to dynamics/) - transient.csv, contact_pairs.csv, amplitudes.csv, circles.csv, sound_time.csv, the
   live line, and snapshots with transient.xmf.
*/
#pragma once

#include <squeal/quantity.h>
#include <squeal/projector.h>
#include <squeal/results.h>
#include <squeal/sound.h>
#include "ledger.h"

typedef struct _p_History *History;

/* States of this rank's pairs in the step from t_n */
typedef struct {
  PetscInt            n;
  const ContactState *state;     /* [n] */
  const PetscInt     *interface; /* [n] */
  const PetscInt     *number;    /* [n] global nodes */
  const PetscReal    *x;         /* [n][3] at rest, m */
} HistoryPairs;

/* Where motions come from that are in no state vectors: Cartesian displacement (m), velocity (m/s) and acceleration
   (m/s^2) of the local node of a probe; displacements and velocities [nodes][3] of all, collective */
typedef struct {
  void *ctx;
  void (*at)(void *ctx, PetscInt node, PetscReal u[3], PetscReal v[3], PetscReal a[3]);
  PetscErrorCode (*lift)(void *ctx, PetscReal u[], PetscReal v[]);
  const SoundShapes *shapes; /* of which the sound is made */
  const PetscReal   *rate;   /* [shapes] */
} HistoryMotions;

/* State at t_n, when the forces are complete: velocity v_n = before + dt minv ((1/2 - b) f_old + b f), acceleration a
   = minv f; b = 0 and f_old NULL in the first step, where before is v_0 */
typedef struct {
  PetscInt              step;
  PetscReal             time, dt, b;
  const PetscReal      *u, *before, *f, *minv, *f_old; /* state vectors; f_old NULL for b = 1/2 */
  const Ledger         *ledger;                        /* of the half step before t_n */
  PetscInt              n_interfaces;
  const ContactSums    *sums;    /* [n_interfaces] of the step from t_n */
  const HistoryMotions *motions; /* NULL: those of the state vectors */
  const HistoryPairs   *pairs;   /* NULL: those of the projector */
} HistoryState;

/* What is recorded, and where; all borrowed */
typedef struct {
  Model                   model;
  const Layout           *layout;    /* NULL beside HistoryMotions */
  ContactProjector        projector; /* NULL without contacts */
  PetscInt                n_interfaces;
  const ContactInterface *interfaces; /* NULL: without columns and pairs of their own */
  Results                 results;
} HistorySource;

/* Modal filters, weights of state vectors with every unknown on one rank */
typedef struct {
  PetscInt   n;    /* modes */
  PetscInt  *mode; /* [n] numbers in modes.csv */
  PetscReal *u;    /* [n][2][layout n] of displacements, real and imaginary part (-) */
  PetscReal *v;    /* [n][2][layout n] of velocities, s */
  PetscReal *rest; /* [n][2] what they give of the sliding state, m */
} HistoryFilters;

PETSC_INTERN PetscErrorCode HistoryCreate(MPI_Comm comm, History *history);

/* -dynamics_history_interval, -dynamics_pairs_interval, -dynamics_snapshot_interval, -dynamics_live */
PETSC_INTERN PetscErrorCode HistorySetFromOptions(History history);

/* HistoryVisit - shows the rows of its options. Collective. */
PETSC_INTERN PetscErrorCode HistoryVisit(History h, const QuantityVisitor *visitor);

/* Takes what is recorded, and rounds the intervals to whole steps dt (0 for not), the run to `end` at most. Collective.
   Errors: PETSC_ERR_USER_INPUT for intervals of the command line that are longer, or without effect. */
PETSC_INTERN PetscErrorCode HistorySetUp(History history, const HistorySource *source, PetscReal end, PetscReal dt);

/* Takes filters (borrowed), for amplitudes.csv beside every row. Not collective. */
PETSC_INTERN PetscErrorCode HistorySetFilters(History history, const HistoryFilters *filters);

/* Takes what microphones hear into sound_time.csv beside every row (referenced until HistoryDestroy()); before
   HistorySetUp(). Not collective. */
PETSC_INTERN PetscErrorCode HistorySetSound(History history, Sound sound);

/* Whether a row (or a snapshot) is due at step n, time t: the same answer on every rank, and cheap; multiples k of
   the interval are met at the first t >= k interval - dt / 2 */
PETSC_INTERN PetscBool HistoryIsDue(History history, PetscReal t, PetscReal dt);

/* Whether snapshots are asked for; after HistorySetUp() */
PETSC_INTERN PetscErrorCode HistoryHasFields(History history, PetscBool *fields);

/* writes what is due: row, snapshot, live line (step, time, time left, open/stick/slip, growth of the vibration).
   Collective. */
PETSC_INTERN PetscErrorCode HistoryRecord(History history, const HistoryState *state);

/* what must be kept for a restart: rows written so far (the table is flushed, and cut back to them at the restart),
   next times, what the live line needs; n numbers, the same on every rank. Get flushes. The caller frees values. */
PETSC_INTERN PetscErrorCode HistoryGetMemory(History history, PetscInt *n, PetscReal **values);
PETSC_INTERN PetscErrorCode HistorySetMemory(History history, PetscInt n, const PetscReal values[]);

/* adds the probes, circles and filters, whose columns go on. Not collective. */
PETSC_INTERN PetscErrorCode HistoryAddChecksum(History history, Checksum checksum);

/* completes transient.csv under its final name. Collective. */
PETSC_INTERN PetscErrorCode HistoryClose(History history);

/* frees it; without HistoryClose() the tables stay under their temporary names, for a restart. Collective. */
PETSC_INTERN PetscErrorCode HistoryDestroy(History *history);
