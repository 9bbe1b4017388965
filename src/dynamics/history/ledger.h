/*
   Ledger (private to dynamics/) - the energy balance of a run, J, at the half steps (dynamics.h).
*/
#pragma once

#include "dynamics/external/external.h"
#include <squeal/projector.h>

/* Over all ranks */
typedef struct {
  PetscReal kinetic, strain;             /* present */
  PetscReal external, friction, contact; /* works on the bodies since the start */
  PetscReal damping, integrator;         /* likewise; negative takes energy away */
  PetscReal heat;                        /* dissipated by slip, >= 0 */
  PetscReal start;                       /* kinetic + strain at the first half step */
  PetscReal error;                       /* kinetic + strain - start - works */
  PetscReal throughput;                  /* the largest of all the above so far, that errors are relative to */
  PetscReal predicted; /* what contact took within one step, at most: rounding of it is left where nothing moves */
} Ledger;

/* This rank's part, gathered step by step: works since the start; reals alone */
typedef struct {
  PetscReal kinetic, strain;
  PetscReal external, damping, integrator;
  PetscReal external_now, damping_now, integrator_now; /* W, of the step that is not complete yet */
  PetscReal predicted; /* largest kinetic energy of the surfaces before contact acts, which it takes from what rests */
} LedgerPart;

/* Works of contact up to the first half step, where the ledger begins */
typedef struct {
  PetscReal contact, friction, heat;
} LedgerOrigin;

/* All of a run, which goes on with it after a restart: reals alone */
typedef struct {
  Ledger       total;
  LedgerPart   part;
  LedgerOrigin origin;
} LedgerAccount;

/* The bodies' sums at the beginning of a step: completes the damping work of the step before, of length dt_old */
PETSC_INTERN void LedgerAddBodies(LedgerPart *part, const BodiesSums *sums, PetscReal dt_old);

/* Powers of external forces likewise */
PETSC_INTERN void LedgerAddExternal(LedgerPart *part, const ExternalPower *power, PetscReal dt_old);

/* Power v'(f_n - f_{n-1}) of the integrator at v_{n-1/2} (complete = false), then with v_{n+1/2}; `b` of the scheme */
PETSC_INTERN void LedgerAddIntegrator(LedgerPart *part, PetscReal b, PetscReal power, PetscBool complete,
                                      PetscReal dt_old);

/* Sums over all ranks, and the works of contact (n interfaces). `first`: the ledger begins here. Collective. */
PETSC_INTERN PetscErrorCode LedgerClose(MPI_Comm comm, LedgerAccount *account, PetscInt n, const ContactSums sums[],
                                        PetscBool first);

/*
   LedgerJudge - raises PETSC_ERR_FP where the energy cannot be explained: the balance does not close to 1e-6 of the
   throughput, damping gives energy, or kinetic + strain is below what a stable step allows. With fraction = dt /
   dt_crit every motion obeys kinetic + strain >= (1 - fraction^2) kinetic. Collective.
*/
PETSC_INTERN PetscErrorCode LedgerJudge(MPI_Comm comm, const Ledger *ledger, PetscReal fraction, PetscInt step,
                                        PetscReal time);

/* Where contact acts as the mean force of a step, a pair that opens in it gives energy: whether that is more than a
   tenth of what all others gave, J. LedgerJudgeContact raises PETSC_ERR_FP where it is; collective */
PETSC_INTERN PetscBool      LedgerContactFeeds(PetscReal contact, PetscReal others);
PETSC_INTERN PetscErrorCode LedgerJudgeContact(MPI_Comm comm, const Ledger *ledger, PetscInt step, PetscReal time);
