/*
   The error of the cut-off without the mesh: the modes that grow about the sliding state of the reduced model, as they
   are and with the inertia of what the cut-off leaves out (linear.c). It knows all modes below the cut-off, where
   compare.c knows those in
   -modes_band. Told before the run where one is far off, since a transient that squeals there is of another brake.
*/
#include "reduced/reducedimpl.h"
#include <stdlib.h>

#define INERTIA_LEAST 1e-3 /* of the angular frequency: what smaller growth is off by is relative to that */
#define INERTIA_ZERO  1e-6 /* of the cut-off, rad/s: a zero of a rigid motion, which rounding moves by its own root */
#define INERTIA_WARN  0.05 /* relative error of growth that is told before the run */

/* The nearest of n eigenvalues to sigma, omega */
static PetscInt InertiaMatch(PetscInt n, const PetscReal s[], const PetscReal w[], PetscReal sigma, PetscReal omega)
{
  PetscInt best = 0;

  for (PetscInt i = 1; i < n; i++)
    if (hypot(s[i] - sigma, w[i] - omega) < hypot(s[best] - sigma, w[best] - omega)) best = i;
  return best;
}

/* Whether the mode a grows faster than b, in either way; for qsort() */
static int InertiaFaster(const void *a, const void *b)
{
  const ReducedGrowing *g = a, *h = b;
  const PetscReal       most = PetscMax(g->growth, g->whole), other = PetscMax(h->growth, h->whole);

  return (most < other) - (most > other);
}

/* off = |growth with - growth without| over the larger of both, at least INERTIA_LEAST omega. Rigid zeros, which
   rounding moves by its root, are left out. */
static PetscErrorCode InertiaTake(ReducedRun r, PetscReal *z[2][2])
{
  const PetscInt n = 2 * r->reduction.model.m;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)r->reduction.model.m * sizeof(*r->result.growing),
                         &r->result.growing)); /* one of a pair of conjugates */
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal sigma = z[0][0][i], omega = z[0][1][i];
    const PetscInt  k    = InertiaMatch(n, z[1][0], z[1][1], sigma, omega);
    const PetscReal most = PetscMax(sigma, z[1][0][k]), scale = PetscMax(most, INERTIA_LEAST * omega);

    if (omega <= 0 || omega > 2 * PETSC_PI * r->request.cutoff || most <= 0) continue;
    if (hypot(omega, most) < INERTIA_ZERO * 2 * PETSC_PI * r->request.cutoff) continue;
    r->result.growing[r->result.n_growing++] =
      (ReducedGrowing){sigma, z[1][0][k], omega, PetscAbsReal(z[1][0][k] - sigma) / scale};
  }
  if (r->result.n_growing)
    qsort(r->result.growing, (size_t)r->result.n_growing, sizeof(*r->result.growing), InertiaFaster);
  PetscFunctionReturn(0);
}

/* That which is farthest off, or NULL */
static const ReducedGrowing *InertiaWorst(ReducedRun r)
{
  const ReducedGrowing *worst = NULL;

  for (PetscInt i = 0; i < r->result.n_growing; i++)
    if (!worst || r->result.growing[i].off > worst->off) worst = &r->result.growing[i];
  return worst;
}

/* Whether steady sliding is what the scene ends in */
static PetscBool InertiaSlides(ReducedRun r)
{
  for (PetscInt i = 0; i < r->run.n_interfaces; i++)
    if (!r->run.interfaces[i].slides && FrictionExists(&r->run.interfaces[i].friction)) return PETSC_FALSE;
  return r->reduction.model.n_pairs > 0 && r->reduction.model.Mx ? PETSC_TRUE : PETSC_FALSE;
}

/* About the reduced model's own sliding state at the end of the run, with all ramps done; *off = the largest error,
   0 where steady sliding is not what the scene is about. */
PetscErrorCode ReducedWeighGrowth(ReducedRun r, PetscReal *off)
{
  const PetscInt n = r->reduction.model.n_pairs, N = 2 * r->reduction.model.m;
  PetscBool      found;
  PetscBool     *closed;
  PetscReal     *loads, *lambda_n, *z[2][2];
  ReducedState   rest;

  PetscFunctionBeginUser;
  *off                = 0;
  r->result.n_growing = 0;
  if (!InertiaSlides(r)) PetscFunctionReturn(0);
  PetscCall(ReducedStateCreate(&r->reduction.model, &rest));
  PetscCall(PetscMalloc7(r->reduction.model.n_loads, &loads, n, &closed, n, &lambda_n, N, &z[0][0], N, &z[0][1], N,
                         &z[1][0], N, &z[1][1]));
  ReducedSetSteadyLoads(r, r->run.end, loads);
  PetscCall(ReducedEquilibrium(&r->reduction.model, loads, &rest, &found));
  for (PetscInt i = 0; i < n; i++) {
    closed[i]   = rest.status[i] != CONTACT_OPEN ? PETSC_TRUE : PETSC_FALSE;
    lambda_n[i] = rest.p[3 * i];
  }
  if (found) {
    PetscCall(ReducedLinearise(&r->reduction.model, closed, lambda_n, PETSC_FALSE, z[0][0], z[0][1]));
    PetscCall(ReducedLinearise(&r->reduction.model, closed, lambda_n, PETSC_TRUE, z[1][0], z[1][1]));
    PetscCall(InertiaTake(r, z));
  }
  if (InertiaWorst(r)) *off = InertiaWorst(r)->off;
  PetscCall(PetscFree7(loads, closed, lambda_n, z[0][0], z[0][1], z[1][0], z[1][1]));
  PetscCall(ReducedStateDestroy(&rest));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedWarnGrowth(ReducedRun r)
{
  const ReducedGrowing *w = InertiaWorst(r);

  PetscFunctionBeginUser;
  if (!w || w->off < INERTIA_WARN) PetscFunctionReturn(0);
  PetscCall(PetscFPrintf(
    r->comm, stderr,
    "squeal: warning: the mode at %.6g Hz grows by %.4g 1/s below -dynamics_cutoff %.6g Hz, and by %.4g with "
    "the inertia of what that leaves out: the vibration may be off by as much; raise the cut-off, or leave it "
    "out and say -dynamics_growth_rtol\n",
    (double)(w->omega / (2 * PETSC_PI)), (double)w->growth, (double)r->request.cutoff, (double)w->whole));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedGrowthView(ReducedRun r, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  if (!r->result.n_growing) PetscFunctionReturn(0);
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "modes below the cut-off that grow about the sliding state: reduced, and with the "
                                   "inertia of what the cut-off leaves out\n"));
  for (PetscInt i = 0; i < r->result.n_growing; i++) {
    const ReducedGrowing *g = &r->result.growing[i];

    PetscCall(PetscViewerASCIIPrintf(viewer, "  %10.4f Hz %+10.4f 1/s   %+10.4f 1/s: off by %.2g %%\n",
                                     (double)(g->omega / (2 * PETSC_PI)), (double)g->growth, (double)g->whole,
                                     (double)(100 * g->off)));
  }
  PetscFunctionReturn(0);
}
