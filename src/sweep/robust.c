/*
   Robustness: parameters known to some percent only, the box p_k (1 +- h_k) around the scene's own values. The
   reduced model is first made good at the corners of the box (the greedy choice takes in a corner only where the
   estimate asks for it); then the corners and a Halton sequence inside the box are looked at,

      p_k = p_k0 (1 + h_k (2 u_k - 1)),   u_k(i) = sum_j d_j b_k^-(j+1),   i = sum_j d_j b_k^j,   b_k the k-th prime

   (J. H. Halton, Numerische Mathematik 2, 1960), which fills the box more evenly than random numbers and is the
   same in every run. The modes that become unstable anywhere are listed. Combinations between those looked at are
   not excluded.
*/
#include "sweepimpl.h"
#include <squeal/options.h>

/* Of a box in more than six dimensions 64 corners are looked at, a fractional factorial design: the side of a further
   parameter is the product of those of three of the first six, so that each parameter is at either end in half of them,
   and any two of them in all four combinations equally often. */
#define MAX_CORNERS 64
#define FREE_SIDES  6
/* Points of the Halton sequence. A region of one percent of the box escapes 200 random points with probability
   0.99^200 = 0.13. */
#define N_INSIDE 200

/* The box: parameters, and half widths relative to their values. What a link holds is moved together, each by the same
   part of its own value. */
typedef struct {
  PetscInt        n, parameter[SWEEP_MAX_UNCERTAIN], n_moved[SWEEP_MAX_UNCERTAIN];
  const PetscInt *moved[SWEEP_MAX_UNCERTAIN]; /* [n_moved] indices */
  PetscReal       half[SWEEP_MAX_UNCERTAIN];
} ParameterBox;

/* What parameter k of the box moves: itself, or all of the link that the axis of the sweep with it moves. A
   percentage of 0 is 0, hence the refusal. */
static PetscErrorCode BoxLink(Sweep sweep, const char name[], ParameterBox *box, PetscInt k)
{
  const SweepGrid          *grid = &sweep->grid;
  const PetscInt            axis = GridAxisOf(grid, box->parameter[k]);
  const OperatorsParameter *list;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(sweep->operators, &n, &list));
  box->n_moved[k] = axis < 0 ? 1 : grid->n_moved[axis];
  box->moved[k]   = axis < 0 ? &box->parameter[k] : grid->parameter[axis];
  for (PetscInt j = 0; j < k; j++) {
    PetscCheck(box->parameter[j] != box->parameter[k], sweep->comm, PETSC_ERR_USER_INPUT,
               "-sweep_uncertain names '%s' twice", name);
    PetscCheck(box->moved[j] != box->moved[k], sweep->comm, PETSC_ERR_USER_INPUT,
               "-sweep_uncertain names '%s' and '%s', which -sweep_link moves together: name one of them",
               list[box->parameter[j]].name, name);
  }
  for (PetscInt i = 0; i < box->n_moved[k]; i++)
    PetscCheck(grid->base[box->moved[k][i]] != 0, sweep->comm, PETSC_ERR_USER_INPUT,
               "-sweep_uncertain %s is 0 in this scene, and so is any percentage of it; give -%s another value",
               list[box->moved[k][i]].name, list[box->moved[k][i]].name);
  PetscFunctionReturn(0);
}

static PetscErrorCode BoxRead(Sweep sweep, ParameterBox *box)
{
  const OperatorsParameter *list;
  PetscInt                  n_list;
  char                    **names;
  int                       n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(sweep->operators, &n_list, &list));
  PetscCall(ValuesSplit(sweep->comm, "-sweep_uncertain", sweep->uncertain, ',', &n, &names));
  PetscCheck(n >= 1 && n <= SWEEP_MAX_UNCERTAIN, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_uncertain '%s' must name 1 to %d parameters", sweep->uncertain, SWEEP_MAX_UNCERTAIN);
  PetscCheck(sweep->n_percent == 1 || sweep->n_percent == n, sweep->comm, PETSC_ERR_USER_INPUT,
             "-sweep_percent has %" PetscInt_FMT " values for %d parameters; give one, or one for each",
             sweep->n_percent, n);
  box->n = n;
  for (int k = 0; k < n; k++) {
    const PetscReal percent = sweep->percent[sweep->n_percent == 1 ? 0 : k];

    PetscCall(GridParameterFind(sweep->comm, sweep->operators, "-sweep_uncertain", names[k], &box->parameter[k]));
    PetscCheck(
      !list[box->parameter[k]].state, sweep->comm, PETSC_ERR_USER_INPUT,
      "-sweep_uncertain %s changes modes through the sliding state alone, which is held here; give -sweep_parameter %s",
      names[k], names[k]);
    PetscCheck(percent > 0 && percent < 100, sweep->comm, PETSC_ERR_USER_INPUT,
               "-sweep_percent %.6g must lie between 0 and 100", (double)percent);
    PetscCall(BoxLink(sweep, names[k], box, k));
    box->half[k] = percent / 100;
  }
  PetscCall(PetscStrToArrayDestroy(n, names));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepUncertainCheck(Sweep sweep)
{
  ParameterBox box;

  PetscFunctionBeginUser;
  PetscCall(BoxRead(sweep, &box));
  for (PetscInt k = 0; k < box.n; k++)
    PetscCall(OperatorsCheckMoved(sweep->operators, "-sweep_uncertain", box.n_moved[k], box.moved[k]));
  PetscFunctionReturn(0);
}

/* Element i of the van der Corput sequence in the given base, in [0, 1): the digits of i mirrored at the point. */
static PetscReal VanDerCorput(PetscInt i, PetscInt base)
{
  PetscReal value = 0, digit = 1;

  for (; i > 0; i /= base) value += (PetscReal)(i % base) * (digit /= (PetscReal)base);
  return value;
}

static PetscInt BoxCorners(const ParameterBox *box)
{
  return PetscMin(MAX_CORNERS, 1 << PetscMin(box->n, 10));
}

/* Moves parameter k of the box, and what is linked with it, to a side in [-1, 1] */
static void BoxMove(const ParameterBox *box, PetscInt k, PetscReal side, PetscReal p[])
{
  for (PetscInt m = 0; m < box->n_moved[k]; m++) p[box->moved[k][m]] *= 1 + side * box->half[k];
}

/* 1 or -1: on which side of parameter k corner i = 0, 1, ... lies */
static PetscReal CornerSide(PetscInt i, PetscInt k)
{
  static const unsigned products[SWEEP_MAX_UNCERTAIN - FREE_SIDES] = {007, 013, 015, 016, 023, 025, 026, 031, 032, 034};
  unsigned              odd = (unsigned)i & (k < FREE_SIDES ? 1U << k : products[k - FREE_SIDES]);

  for (int half = 4; half; half /= 2) odd ^= odd >> half;
  return odd & 1 ? 1 : -1;
}

/* Point i: 0 the scene itself, then corners, then the inside. The primes are those of as many
   parameters as may be named. */
static void BoxPoint(const ParameterBox *box, const PetscReal base[], PetscInt n_parameters, PetscInt n_corners,
                     PetscInt i, PetscReal p[])
{
  static const PetscInt primes[SWEEP_MAX_UNCERTAIN] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};

  for (PetscInt k = 0; k < n_parameters; k++) p[k] = base[k];
  for (PetscInt k = 0; k < box->n && i > 0; k++)
    BoxMove(box, k, i <= n_corners ? CornerSide(i - 1, k) : 2 * VanDerCorput(i - n_corners, primes[k]) - 1, p);
}

/* Risks of the modes of the nominal point, by what they become at the others; the last entry is for modes that the
   nominal point does not have in the band */
static PetscErrorCode RisksCount(Sweep sweep, PetscInt n, const PetscReal points[], const ReducedModes modes[],
                                 SweepRisk risk[])
{
  PetscInt *match;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscBool certain;

    sweep->worst_risk = PetscMax(sweep->worst_risk, ReducedModesWorst(&modes[i], &sweep->window, PETSC_FALSE));
    PetscCall(PetscMalloc1(modes[i].n, &match));
    PetscCall(TrackMatch(&sweep->basis.reduced, points, &modes[0], &modes[i], match, &certain));
    for (PetscInt k = 0; k < modes[i].n; k++) {
      const PetscReal sigma = creal(modes[i].lambda[k]);
      SweepRisk      *r     = &risk[match[k] >= 0 ? match[k] : modes[0].n];

      if (ModesLimitJudge(&sweep->limit, sigma, cimag(modes[i].lambda[k]), modes[i].error[k]) != MODE_UNSTABLE)
        continue;
      r->n_unstable++;
      if (sigma <= r->largest) continue;
      r->largest = sigma;
      r->omega   = cimag(modes[i].lambda[k]);
      r->error   = modes[i].error[k];
    }
    PetscCall(PetscFree(match));
  }
  PetscFunctionReturn(0);
}

/* Keeps the risks of modes that become unstable somewhere, with their names */
static PetscErrorCode RisksKeep(Sweep sweep, const PetscReal p[], const ReducedModes *nominal, SweepRisk risk[])
{
  char(*label)[32];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(nominal->n, &label));
  PetscCall(BasisLabelModes(&sweep->basis, sweep->modes, p, nominal, label));
  sweep->n_risks = 0;
  for (PetscInt k = 0; k <= nominal->n; k++) {
    if (!risk[k].n_unstable) continue;
    risk[k].nominal = k < nominal->n ? creal(nominal->lambda[k]) : NAN;
    PetscCall(PetscStrncpy(risk[k].label, k < nominal->n ? label[k] : "not in the band before", sizeof(risk[k].label)));
    risk[sweep->n_risks++] = risk[k];
  }
  PetscCall(PetscFree(label));
  PetscFunctionReturn(0);
}

/* The greedy choice goes on with the basis of the sweep and may add as many full solutions again. All ranks hold
   all modes after PointsSolve(), and match them alike. */
PetscErrorCode SweepRobustness(Sweep sweep)
{
  const PetscInt n_parameters = sweep->grid.n_parameters;
  PetscInt       n, n_corners;
  PetscReal     *points;
  ReducedModes  *modes;
  ParameterBox   box;

  PetscFunctionBeginUser;
  PetscCall(BoxRead(sweep, &box));
  n_corners = BoxCorners(&box);
  n         = 1 + n_corners + N_INSIDE;
  PetscCall(PetscMalloc2(n * n_parameters, &points, n, &modes));
  for (PetscInt i = 0; i < n; i++)
    BoxPoint(&box, sweep->grid.base, n_parameters, n_corners, i, &points[i * n_parameters]);
  sweep->greedy.last        = PETSC_MAX_REAL;
  sweep->greedy.n_passed    = 0;
  sweep->greedy.max_samples = sweep->greedy.n_samples + sweep->max_samples;
  if (!sweep->whole) PetscCall(GreedyRun(&sweep->greedy, 1 + n_corners, points, &sweep->basis));
  PetscCall(PointsSolve(&sweep->groups, &sweep->basis.reduced, &sweep->window, n, points, modes));
  PetscCall(PetscCalloc1(modes[0].n + 1, &sweep->risk));
  PetscCall(RisksCount(sweep, n, points, modes, sweep->risk));
  PetscCall(RisksKeep(sweep, points, &modes[0], sweep->risk));
  sweep->n_combinations = n;
  for (PetscInt i = 0; i < n; i++) PetscCall(ReducedModesDestroy(&modes[i]));
  PetscCall(PetscFree2(points, modes));
  PetscFunctionReturn(0);
}
