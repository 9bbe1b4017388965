/*
   The mechanism of each mode that grows, and the mode with which it couples: the one that shares most of its motion.
   Two modes that feed each other lie, with their conjugates, in one plane of real motions, while modes of a
   conservative system share none; so the measure is the larger of |x_i^H M x_k| and |x_i' M x_k|, vectors with |x|_M
   = 1. It is 1 where two modes merge.
*/
#include "modes/modesimpl.h"
#include "base/events.h"
#include <complex.h>

#define SHARED    1e-3 /* of the motion, at least, with a partner */
#define PAIR_NEAR 0.1  /* of the frequency: a pair whose real modes lie farther off is not alone */

/* z'x[k] of n vectors, 0 where there is none */
static PetscErrorCode VectorsDot(PetscInt n, Vec z, Vec x[], PetscScalar dot[])
{
  PetscInt some = 0;
  Vec     *list;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(dot, n));
  if (!z) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, &list));
  for (PetscInt k = 0; k < n; k++)
    if (x[k]) list[some++] = x[k];
  if (some) PetscCall(VecMDot(z, some, list, dot));
  for (PetscInt k = n - 1; k >= 0; k--) dot[k] = x[k] ? dot[--some] : 0; /* each at or behind where it stands */
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}

/* M xr and M xi of mode i, NULL where it has none */
static PetscErrorCode ModeTimesMass(Modes modes, PetscInt i, Vec Mx[2])
{
  Vec const x[2] = {modes->right.xr[i], modes->right.xi[i]};
  Mat       M;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMass(modes->pencil, &M));
  for (int part = 0; part < 2; part++) {
    Mx[part] = NULL;
    if (!x[part]) continue;
    PetscCall(VecDuplicate(x[part], &Mx[part]));
    PetscCall(MatMult(M, x[part], Mx[part]));
  }
  PetscFunctionReturn(0);
}

/* The mode that shares most of the motion of mode i, or -1. Of equal shares the first one. */
static PetscErrorCode ModeFindPartner(Modes modes, PetscInt i, PetscInt *partner)
{
  const PetscInt n    = modes->n;
  PetscReal      most = SHARED;
  PetscScalar   *dot[2][2];
  Vec            Mx[2];

  PetscFunctionBeginUser;
  *partner = -1;
  PetscCall(ModeTimesMass(modes, i, Mx));
  PetscCall(PetscMalloc4(n, &dot[0][0], n, &dot[0][1], n, &dot[1][0], n, &dot[1][1]));
  for (int part = 0; part < 2; part++) {
    PetscCall(VectorsDot(n, Mx[part], modes->right.xr, dot[part][0]));
    PetscCall(VectorsDot(n, Mx[part], modes->right.xi, dot[part][1]));
  }
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal rr = dot[0][0][k], ri = dot[0][1][k], ir = dot[1][0][k], ii = dot[1][1][k];
    const PetscReal shared = PetscMax(cabs(CMPLX(rr - ii, ri + ir)), cabs(CMPLX(rr + ii, ri - ir)));

    if (k == i || modes->mode[k].rigid || modes->mode[k].omega == 0 || shared <= most * (1 + LABEL_TIE)) continue;
    *partner = k;
    most     = shared;
  }
  PetscCall(PetscFree4(dot[0][0], dot[0][1], dot[1][0], dot[1][1]));
  for (int part = 0; part < 2; part++) PetscCall(VecDestroy(&Mx[part]));
  PetscFunctionReturn(0);
}

/* The numbers of mode i and of its partner (-1: none) */
static PetscErrorCode PairMeasure(Modes modes, PetscInt i, PetscInt partner, MechanismPair *pair)
{
  const PetscInt at[2] = {i, partner};
  PencilVectors  v     = {.n = partner < 0 ? 1 : 2};
  PencilForms   *forms;
  PetscInt       n;

  PetscFunctionBeginUser;
  *pair = (MechanismPair){.n = v.n, .mass = 1};
  for (PetscInt a = 0; a < v.n; a++) {
    const Mode *m = &modes->mode[at[a]];

    pair->lambda[a] = CMPLX(m->sigma, m->omega);
    pair->slope[a]  = 2 * pair->lambda[a] * CMPLX(m->product[0], m->product[1]);
    PetscCall(ModesGetVectors(modes, at[a], &v.xr[a], &v.xi[a], &v.yr[a], &v.yi[a]));
  }
  PetscCall(PencilMeasureForms(modes->pencil, pair->lambda[0], &v, &n, &forms));
  for (PetscInt t = 0; t < n; t++) MechanismAdd(pair, &forms[t]);
  PetscCall(PetscFree(forms));
  PetscFunctionReturn(0);
}

/* The mechanism of mode i, which grows; the causes have been formed */
static PetscErrorCode ModeFindMechanism(Modes modes, PetscInt i, ModeMechanism *m)
{
  PetscInt      partner = -1;
  MechanismPair pair;
  PetscComplex  real[2];

  PetscFunctionBeginUser;
  if (modes->mode[i].omega > 0) PetscCall(ModeFindPartner(modes, i, &partner));
  PetscCall(PairMeasure(modes, i, partner, &pair));
  m->kind = MechanismDecide(&pair);
  if (partner < 0 || !MechanismIsOfTwo(m->kind)) PetscFunctionReturn(0);
  m->partner = partner;
  MechanismTake(&pair, WITHOUT_ALL, real);
  for (int k = 0; k < 2; k++) m->real[k] = PetscAbsReal(cimag(real[k]));
  if (m->real[0] > m->real[1]) {
    const PetscReal upper = m->real[0];

    m->real[0] = m->real[1];
    m->real[1] = upper;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModesGetMechanisms(Modes modes, const ModeMechanism **mechanisms)
{
  const PencilCause *cause;
  PetscInt           n;

  PetscFunctionBeginUser;
  *mechanisms = modes->mechanism;
  if (modes->mechanism) PetscFunctionReturn(0);
  PetscCall(PencilGetCauses(modes->pencil, &n, &cause));
  PetscCall(PetscCalloc1(modes->n, &modes->mechanism));
  PetscCall(EventBegin(EVENT_CAUSES));
  for (PetscInt i = 0; i < modes->n; i++) {
    ModeMechanism *m = &modes->mechanism[i];

    *m = (ModeMechanism){.partner = -1};
    if (!modes->mode[i].unstable) continue;
    m->kind = MECHANISM_UNKNOWN;
    if (modes->left_spectrum.n) PetscCall(ModeFindMechanism(modes, i, m));
  }
  PetscCall(EventEnd(EVENT_CAUSES));
  *mechanisms = modes->mechanism;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesViewMechanism(Modes modes, PetscInt i, const ModeMechanism *m, PetscViewer viewer)
{
  const Mode     *mode = &modes->mode[i];
  const PetscReal size = PetscSqrtReal(mode->sigma * mode->sigma + mode->omega * mode->omega);

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "mode %" PetscInt_FMT " grows by %.5g 1/s (by e in %.3g s", i + 1,
                                   (double)mode->sigma, (double)(1 / mode->sigma)));
  if (mode->omega > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, "; a further damping ratio of %.3g %% would stop it",
                                     (double)(100 * mode->sigma / size)));
  PetscCall(PetscViewerASCIIPrintf(viewer, "), %s", MechanismName(m->kind, PETSC_TRUE)));
  if (m->partner >= 0) PetscCall(PetscViewerASCIIPrintf(viewer, " with mode %" PetscInt_FMT, m->partner + 1));
  if (m->partner >= 0 && PetscAbsReal(m->real[0] - mode->omega) < PAIR_NEAR * mode->omega &&
      PetscAbsReal(m->real[1] - mode->omega) < PAIR_NEAR * mode->omega)
    PetscCall(PetscViewerASCIIPrintf(viewer, " (without friction and damping about %.4g and %.4g Hz, %.3g apart)",
                                     (double)(m->real[0] / (2 * PETSC_PI)), (double)(m->real[1] / (2 * PETSC_PI)),
                                     (double)(PetscAbsReal(m->real[1] - m->real[0]) / (2 * PETSC_PI))));
  PetscFunctionReturn(0);
}
