/*
   What counts as unstable. The growth sigma of an eigenvalue must exceed its error and rounding, and a limit

      max(growth, zeta |lambda|),   zeta = -modes_unstable_damping, growth = -modes_unstable_growth

   zeta is the damping ratio that would stop what grows at the limit: more damping of that ratio, c = 2 zeta |lambda|
   per unit of modal mass, moves sigma by -zeta |lambda| to first order. Growth beyond its error that stays within the
   limit is neutral.

   Without a limit all growth beyond its error is an instability to sweeps, whose onsets lie at sigma = 0. In tables
   and counts growth within NEUTRAL_RATIO is neutral still. That ratio is a judgement: a steel disc that hangs on a
   string rings with some 5e-5, cast iron with some 1e-3, a joint with more, air and radiation with 1e-5 and more;
   what grows slower than a ratio of 1e-5 is stopped by what every brake has and no model. At 2 kHz it would need 8 s
   to grow by e.
*/
#include "modes/modesimpl.h"

#define NEUTRAL_RATIO 1e-5

PetscReal ModesLimitGrowth(const ModesLimit *limit, PetscReal size)
{
  return PetscMax(limit->growth, limit->ratio * size);
}

PetscBool ModesLimitIsExceeded(const ModesLimit *limit, PetscReal sigma, PetscReal omega, PetscReal error)
{
  const PetscReal size = PetscSqrtReal(sigma * sigma + omega * omega);

  return sigma > PetscMax(error, MODES_TINY * size) && sigma > ModesLimitGrowth(limit, size) ? PETSC_TRUE : PETSC_FALSE;
}

/* The limit, or where none is given that of what is neutral all the same */
static const ModesLimit *LimitOrSlight(const ModesLimit *limit)
{
  static const ModesLimit slight = {NEUTRAL_RATIO, 0};

  return limit->ratio > 0 || limit->growth > 0 ? limit : &slight;
}

ModesLimit ModesLimitInForce(const ModesLimit *limit)
{
  return *LimitOrSlight(limit);
}

ModeState ModesLimitJudge(const ModesLimit *limit, PetscReal sigma, PetscReal omega, PetscReal error)
{
  const PetscReal  size = PetscSqrtReal(sigma * sigma + omega * omega);
  const ModesLimit none = {0, 0};

  if (!ModesLimitIsExceeded(&none, sigma, omega, error)) return MODE_STABLE;
  return sigma > ModesLimitGrowth(LimitOrSlight(limit), size) ? MODE_UNSTABLE : MODE_NEUTRAL;
}

const char *ModeStateName(ModeState state)
{
  static const char *const name[] = {
    [MODE_STABLE] = "stable", [MODE_NEUTRAL] = "neutral", [MODE_UNSTABLE] = "unstable"};

  return name[state];
}

PetscErrorCode ModesGetLimit(Modes modes, ModesLimit *limit)
{
  PetscFunctionBeginUser;
  *limit = (ModesLimit){modes->unstable[0] / 100, modes->unstable[1]};
  PetscFunctionReturn(0);
}

PetscErrorCode ModesViewLimit(Modes modes, PetscBool decides, PetscViewer viewer)
{
  ModesLimit        given;
  const ModesLimit *limit;

  PetscFunctionBeginUser;
  PetscCall(ModesGetLimit(modes, &given));
  limit = LimitOrSlight(&given);
  if (!decides && limit != &given) PetscFunctionReturn(0);
  PetscCall(PetscViewerASCIIPrintf(viewer, "neutral: growth that is no instability, within"));
  if (limit->ratio > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, " a damping ratio of %.6g %%", (double)(100 * limit->ratio)));
  if (limit->growth > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s %.6g 1/s", limit->ratio > 0 ? " or" : "", (double)limit->growth));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(0);
}
