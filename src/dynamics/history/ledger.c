/*
   The energy ledger. With v = v_{n-1/2}, v+ = v_{n+1/2}, f the sum of all forces at t_n, b = 1/2:

      1/2 v+'M v+ - 1/2 v'M v = dt 1/2 (v + v+)'f                       kinetic energy
      1/2 u_{n+1}'K u_n - 1/2 u_n'K u_{n-1} = dt 1/2 (v + v+)'K u_n     strain energy: K is symmetric

   exactly. So the work of each force in the step around t_n is dt 1/2 (v + v+)'force; it is gathered in two halves,
   when v and when v+ is at hand. For b > 1/2 the integrator itself does the work dt (b - 1/2) 1/2 (v + v+)'(f_n -
   f_{n-1}). All J.
*/
#include "ledger.h"

/* of the throughput: rounding of 1e6 steps is far below, a step beyond the critical one above it soon */
#define LEDGER_RTOL 1e-6
#define LEDGER_MADE 0.1 /* of the energy that others give: what contact may make of nothing within the steps */

/* Kinetic and strain energy are states, J; damping takes dt (v'd)/2 with v of both ends of the step, half of it
   with d of the step before. */
void LedgerAddBodies(LedgerPart *part, const BodiesSums *sums, PetscReal dt_old)
{
  part->kinetic = sums->kinetic;
  part->strain  = sums->strain;
  part->damping -= 0.5 * dt_old * (part->damping_now + sums->damping_old);
  part->damping_now = sums->damping;
}

void LedgerAddExternal(LedgerPart *part, const ExternalPower *power, PetscReal dt_old)
{
  part->external += 0.5 * dt_old * (part->external_now + power->old);
  part->external_now = power->now;
}

void LedgerAddIntegrator(LedgerPart *part, PetscReal b, PetscReal power, PetscBool complete, PetscReal dt_old)
{
  if (complete)
    part->integrator += 0.5 * dt_old * (b - 0.5) * (part->integrator_now + power);
  else
    part->integrator_now = power;
}

/* Works of contact since the first half step */
static void LedgerSetContact(Ledger *ledger, PetscInt n, const ContactSums sums[], PetscBool first,
                             LedgerOrigin *origin)
{
  LedgerOrigin now = {0};

  for (PetscInt i = 0; i < n; i++) {
    now.contact += sums[i].contact_work;
    now.friction += sums[i].friction_work;
    now.heat += sums[i].heat;
  }
  if (first) *origin = now;
  ledger->contact  = now.contact - origin->contact;
  ledger->friction = now.friction - origin->friction;
  ledger->heat     = now.heat - origin->heat;
}

static void LedgerRaiseThroughput(Ledger *l)
{
  const PetscReal term[] = {l->kinetic, l->strain,  l->external,   l->friction,
                            l->contact, l->damping, l->integrator, l->start};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(term); i++)
    l->throughput = PetscMax(l->throughput, PetscAbsReal(term[i]));
}

/* One reduction of all parts of this rank; works of contact are sums over the ranks already. What the start holds
   is the origin of all: work before the first half step is none. error = what no term explains. */
PetscErrorCode LedgerClose(MPI_Comm comm, LedgerAccount *account, PetscInt n, const ContactSums sums[], PetscBool first)
{
  LedgerPart *part   = &account->part;
  Ledger     *ledger = &account->total;
  LedgerPart  sum;

  PetscFunctionBeginUser;
  if (first) part->external = part->damping = part->integrator = 0;
  PetscCallMPI(MPI_Allreduce(part, &sum, (PetscMPIInt)(sizeof(sum) / sizeof(PetscReal)), MPIU_REAL, MPI_SUM, comm));
  ledger->kinetic    = sum.kinetic;
  ledger->strain     = sum.strain;
  ledger->external   = sum.external;
  ledger->damping    = sum.damping;
  ledger->integrator = sum.integrator;
  ledger->predicted  = sum.predicted;
  if (first) ledger->start = sum.kinetic + sum.strain;
  LedgerSetContact(ledger, n, sums, first, &account->origin);
  ledger->error = ledger->kinetic + ledger->strain - ledger->start - ledger->external - ledger->contact -
                  ledger->friction - ledger->damping - ledger->integrator;
  LedgerRaiseThroughput(ledger);
  PetscFunctionReturn(0);
}

/* Four checks, in this order: numbers; what is left over; damping that gives energy; and the sum of the kinetic
   energy at the half step and u_{n}'K u_{n-1} / 2. The last may be negative, down to -kinetic omega^2 dt^2 / 4 of a
   mode of omega: at a fraction x of the critical step at least (1 - x^2) of the kinetic energy remains, of which
   half is asked for. */
PetscErrorCode LedgerJudge(MPI_Comm comm, const Ledger *l, PetscReal fraction, PetscInt step, PetscReal time)
{
  const PetscReal scale = LEDGER_RTOL * (l->throughput + l->predicted);
  const PetscReal least = PetscMax(0.5 * (1 - fraction * fraction), 1e-3); /* a forced step leaves a bound, too */

  PetscFunctionBeginUser;
  PetscCheck(!PetscIsInfOrNanReal(l->kinetic + l->strain + l->error), comm, PETSC_ERR_FP,
             "energy is no number at step %" PetscInt_FMT ", %.6g s: velocities are beyond all bounds", step,
             (double)time);
  PetscCheck(PetscAbsReal(l->error) <= scale, comm, PETSC_ERR_FP,
             "energy grows without a reason: %.3g J of a throughput of %.3g J at step %" PetscInt_FMT
             ", %.6g s; take a smaller -ts_dt",
             (double)l->error, (double)l->throughput, step, (double)time);
  PetscCheck(l->damping <= scale, comm, PETSC_ERR_FP,
             "damping feeds %.3g J into the motion at step %" PetscInt_FMT
             ", %.6g s: the step is too large for it; take "
             "a smaller -ts_dt",
             (double)l->damping, step, (double)time);
  PetscCheck(l->kinetic + l->strain >= least * l->kinetic - scale, comm, PETSC_ERR_FP,
             "the fastest oscillations of the mesh grow (kinetic %.3g J, strain %.3g J) at step %" PetscInt_FMT
             ", %.6g s: the step is above the critical one; take a smaller -ts_dt",
             (double)l->kinetic, (double)l->strain, step, (double)time);
  PetscFunctionReturn(0);
}

PetscBool LedgerContactFeeds(PetscReal contact, PetscReal others)
{
  return contact > LEDGER_MADE * others ? PETSC_TRUE : PETSC_FALSE;
}

/* Normal contact keeps or takes energy; where it gives more than a tenth of all else the motion is made by the
   steps. */
PetscErrorCode LedgerJudgeContact(MPI_Comm comm, const Ledger *l, PetscInt step, PetscReal time)
{
  const PetscReal others =
    PetscAbsReal(l->start) + PetscAbsReal(l->external) + PetscAbsReal(l->friction) + PetscAbsReal(l->damping);

  PetscFunctionBeginUser;
  PetscCheck(l->contact <= LEDGER_RTOL * l->throughput || !LedgerContactFeeds(l->contact, others), comm, PETSC_ERR_FP,
             "normal contact, which does no work, gives %.3g J to the motion beside %.3g J of all else at step "
             "%" PetscInt_FMT ", %.6g s: pairs that open within steps make energy; take a smaller -ts_dt, or "
             "-dynamics_model full",
             (double)l->contact, (double)others, step, (double)time);
  PetscFunctionReturn(0);
}
