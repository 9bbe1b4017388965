/*
   Damped problem Q(lambda) x = (lambda^2 M + lambda C + K) x = 0 by projection on the undamped modes of the window and
   some beyond it, right and left ones, K x = kappa M x, found with one real factorisation P = K - s M. Galerkin's
   method with one real basis V for both sides (two bases make the dense problem ill-conditioned) gives lambda, x, y
   with residuals

      r = Q(lambda) x,   s = Q(lambda)' y,

   and V is extended by P^-1 r and P^-T s of all modes together until every backward error is at rounding level: a step
   of shift-and-invert subspace iteration each (M. E. Hochstenbach, G. L. G. Sleijpen, Linear Algebra Appl. 358, 2003).
   The error of an eigenvalue is the product of those of its two vectors, hence left vectors need less. Where rounding
   lies is not known beforehand: corrections that no longer add a direction to V have settled, too (settle.c).

   No mode is missing: the undamped modes are complete as right and left ones agree (or by inertia), and damping brings
   none from beyond them where its measure is below one. Where it is above DAMPING_WEAK the basis takes in what makes it
   so (projection/beyond.c); where that does not do, factors at complex shifts take the place of P
   (projection/strong.c), and where these do not the route is that of damped.c.
*/
#include "projection.h"
#include "base/process/memory.h"
#include "solver/block/orthonormal.h"

#define DAMPING_WEAK     0.9
#define PROJECT_FAR      2     /* times a target: modes above this lie far above it */
#define PROJECT_ATTEMPTS 3     /* with ever more undamped modes */
#define PROJECT_RIGHT    1e-14 /* backward errors of settled right and left vectors */
#define PROJECT_LEFT     1e-11
#define PROJECT_ROOM     2.5  /* columns of the basis beside undamped vectors */
#define PROJECT_DISTINCT 1e-9 /* undamped vectors that differ by less are one */
#define PROJECT_LOOSE    1e-3 /* V'MV - I may be as large as this: the dense pencil has it */

static const char why_whole[]   = "all modes of the system are in the window or next to it"; /* small: said nowhere */
static const char why_guard[]   = "damping moves modes by more than the guard";
static const char why_strong[]  = "damping is strong"; /* of laws, which may be weak beyond more modes */
static const char why_missing[] = "the search on the projected problem misses modes that its contour integral counts";
static const char why_edge[]    = "a mode lies on the edge of the window, where none can be counted: move the band";
static const char why_endless[] = "damping is strong: the contour integral that counts modes takes too many points";
static const char why_far[]     = "modes lie far above the target"; /* said nowhere: it is done again */
static const char why_differ[]  = "undamped right and left modes differ";

/* Removes what lies farther from the shift than the distance */
static PetscErrorCode SpectrumTrim(PetscReal shift, PetscReal distance, Spectrum *s)
{
  PetscFunctionBeginUser;
  for (PetscInt i = s->n - 1; i >= 0; i--) {
    const PetscComplex lambda = SpectrumLambda(s, i);

    if (cabs(-lambda * lambda - shift) >= distance) PetscCall(SpectrumRemove(s, i));
  }
  PetscFunctionReturn(0);
}

/* Frictionless modes of the band that were found */
static PetscInt CountInBand(const Window *window, const Spectrum *s)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < s->n; i++) n += s->omega[i] >= window->edge[0] && s->omega[i] <= window->edge[1];
  return n;
}

/* The middle of the modes nearest to the target, rad/s, where some lie far above it, or 0: stiffness that depends on
   the frequency is best known there, as C with the loss of a low target stops modes far above it */
static PetscReal MiddleOfFar(const Window *window, const Spectrum *s)
{
  const PetscReal d   = WindowNearest(window, s) * (1 + PETSC_SMALL);
  PetscReal       low = PETSC_MAX_REAL, high = 0;

  for (PetscInt i = 0; i < s->n; i++) {
    if (s->omega[i] <= window->known.scale || PetscAbsReal(s->omega[i] - window->target) > d) continue;
    low  = PetscMin(low, s->omega[i]);
    high = PetscMax(high, s->omega[i]);
  }
  return high > PROJECT_FAR * window->target ? (low + high) / 2 : 0;
}

/* Undamped right and left vectors of the window and a guard, as far as both reach; complete = none is missing */
static PetscErrorCode SolveUndamped(Modes modes, const PencilMatrices *undamped, Window *window, ShiftInvert *si,
                                    PetscReal *reach, PetscBool *complete)
{
  Spectrum       *right = &modes->right, *left = &modes->left_spectrum;
  const PetscBool counted =
    undamped->symmetric && window->known.expected >= 0 && !window->count ? PETSC_TRUE : PETSC_FALSE;
  Window wide = *window;

  PetscFunctionBeginUser;
  PetscCall(ModesSolveRight(modes, undamped, window, si));
  if (modes->may_move) window->route.middle = MiddleOfFar(window, &modes->right);
  if (window->route.middle > 0) PetscFunctionReturn(0);
  window->route.counted = counted;
  *reach                = right->reach;
  *complete             = !counted || CountInBand(window, right) == window->known.expected ? PETSC_TRUE : PETSC_FALSE;
  if (!modes->left || counted) PetscFunctionReturn(0);
  PetscCall(UndampedSolve(modes, undamped, window, si, PETSC_TRUE, left));
  *reach = PetscMin(right->reach, left->reach);
  if (*reach < PETSC_MAX_REAL) *reach *= 1 - 1e-9;
  PetscCall(SpectrumTrim(si->shift, *reach, right));
  PetscCall(SpectrumTrim(si->shift, *reach, left));
  *complete = right->n == left->n ? PETSC_TRUE : PETSC_FALSE;
  wide.low = 0, wide.high = PETSC_MAX_REAL, wide.count = 0;
  if (*complete) PetscCall(LeftMatch(modes, &wide, &window->route.worst, complete));
  if (*complete && CopiesDoubtful(modes, window, right)) *complete = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Forgets the spectra */
static PetscErrorCode SpectraDestroy(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCall(SpectrumDestroy(&modes->right));
  PetscCall(SpectrumDestroy(&modes->left_spectrum));
  PetscFunctionReturn(0);
}

/* Where damping leaves the vectors as they are */
static PetscErrorCode MapModes(Projection *p, Window *window, const char **why)
{
  Modes     modes = p->modes;
  Spectrum  right, left = {.n = 0};
  PetscReal d;

  PetscFunctionBeginUser;
  window->route.beyond       = 0;
  window->route.mapped       = PETSC_TRUE;
  window->route.mapped_alpha = p->alpha;
  window->route.mapped_beta  = p->beta;
  PetscCall(ProjectionMap(p, &modes->right, &right));
  if (modes->left) PetscCall(ProjectionMap(p, modes->left_spectrum.n ? &modes->left_spectrum : &modes->right, &left));
  PetscCall(SpectraDestroy(modes));
  modes->right         = right;
  modes->left_spectrum = left;
  PetscCall(WindowSelect(window, &modes->right));
  PetscCall(WindowSelect(window, &modes->left_spectrum));
  d = window->count ? WindowNearest(window, &modes->right) : 0;
  if (modes->right.n < window->count) d = PETSC_MAX_REAL;
  if (ProjectionEdge(p, d) > p->reach) *why = why_guard;
  PetscFunctionReturn(0);
}

/* Undamped vectors in the basis, with what damping leaves of their residuals where there are others beyond them. Of
   each kind of vectors one set is there at a time: new memory costs as much as products with it. */
static PetscErrorCode AddModal(Projection *p, ModalBlock modal[2])
{
  Modes modes = p->modes;

  PetscFunctionBeginUser;
  if (p->reach < PETSC_MAX_REAL) PetscCall(ModalBlocksReduce(p, &modes->right, &modes->left_spectrum, modal));
  PetscCall(SpectraDestroy(modes));
  p->space.room = (PetscInt)(PROJECT_ROOM * (modal[0].n + modal[1].n));
  for (int side = 0; side < 2 && modal[side].n; side++) {
    PetscCall(SubspaceAdd(&p->space, PROJECT_DISTINCT, modal[side].x, NULL));
    PetscCall(BVDestroy(&modal[side].x));
  }
  PetscFunctionReturn(0);
}

/* By Galerkin's method and corrections */
static PetscErrorCode Project(Projection *p, ModalBlock modal[2], Window *window, const char **why)
{
  Modes           modes = p->modes;
  const PetscReal most  = modes->damping == DAMPING_AUTO && !p->pencil->n_laws ? DAMPING_WEAK : 1;
  ProjectionModes found;
  PetscBool       settled, lost = PETSC_FALSE, endless = PETSC_FALSE;
  PetscInt        missing = 0, n_modal, n_undamped = CountInBand(window, &modes->right);

  PetscFunctionBeginUser;
  p->limit[0] = PROJECT_RIGHT;
  p->limit[1] = PROJECT_LEFT;
  p->finer    = 1;
  PetscCall(AddModal(p, modal));
  window->route.beyond = 0;
  if (p->reach < PETSC_MAX_REAL) PetscCall(ProjectionMeasureBeyond(p, &window->route.beyond));
  n_modal = p->space.n;
  if (window->route.beyond > most) PetscCall(ProjectionEnlarge(p, &window->route.beyond));
  window->route.n_enlarged = p->space.n - n_modal;
  if (window->route.beyond > most) {
    *why = p->pencil->n_laws ? why_strong : NULL;
    PetscCall(ModalBlocksDestroy(modal));
    window->route.n_enlarged = 0;
    if (!*why) PetscCall(SubspaceTruncate(&p->space, n_modal));
    if (!*why) PetscCall(ProjectionSolveStrong(p, n_undamped, window, why));
    PetscFunctionReturn(0);
  }
  if (p->reach < PETSC_MAX_REAL) PetscCall(ProjectionStart(p, modal));
  PetscCall(ModalBlocksDestroy(modal)); /* room for what follows */
  PetscCall(ProjectionIterate(p, &found, &settled));
  window->route.laws = p->pencil->n_laws ? PETSC_TRUE : PETSC_FALSE;
  window->route.held = ProjectionLawsAreHeld(p);
  if (settled && p->pencil->n_laws) PetscCall(ProjectionLawsCount(p, &found, &missing, &lost, &endless));
  if (missing) *why = why_missing;
  if (lost) *why = why_edge;
  if (endless) *why = why_endless;
  if (settled) PetscCall(ProjectionPut(p, &found));
  if (settled && !*why && NullHasDecays(modes, window)) PetscCall(ProjectionFindNull(p));
  window->route.n_basis = found.size;
  if (!settled) *why = found.lambda_reach > p->reach ? why_guard : "corrections do not settle";
  PetscCall(ProjectionModesDestroy(&found));
  PetscFunctionReturn(0);
}

/* From the undamped modes to the damped ones; why is set where the route ends before */
static PetscErrorCode AddDamping(Projection *p, Window *window, const char **why)
{
  Modes      modes = p->modes;
  ModalBlock modal[2];
  PetscBool  zero;

  PetscFunctionBeginUser;
  window->known.rigid  = 0;
  window->route.mapped = PETSC_FALSE;
  for (PetscInt i = 0; i < modes->right.n; i++) {
    PetscCall(ProjectionIsZero(p, &modes->right, i, &zero));
    window->known.rigid += zero;
  }
  PetscCall(ModalBlocksCreate(p, &modes->right, &modes->left_spectrum, modal));
  PetscCall(ProjectionFit(p, &modes->right, modal));
  PetscCall(ProjectionIsExact(p, &modes->right, &p->exact));
  if (!p->exact && p->reach == PETSC_MAX_REAL && modes->damping == DAMPING_AUTO && !p->pencil->n_laws)
    *why = why_whole;
  else {
    if (p->exact)
      PetscCall(MapModes(p, window, why));
    else
      PetscCall(Project(p, modal, window, why));
  }
  window->route.pole = ProjectionPole(p);
  PetscCall(ModalBlocksDestroy(modal));
  PetscFunctionReturn(0);
}

/* The empty basis */
static PetscErrorCode ProjectionCreate(Modes modes, const PencilMatrices *pencil, const Window *window, Projection *p)
{
  const Mat matrix[3] = {pencil->K, pencil->C, pencil->M};

  PetscFunctionBeginUser;
  *p = (Projection){.modes = modes, .pencil = pencil, .window = window};
  PetscCall(SubspaceCreate(pencil->M, pencil->M, PROJECT_LOOSE, &p->space));
  PetscCall(SubspaceAddPencil(&p->space, pencil));
  for (int i = 0; i < 3; i++) PetscCall(MatNorm(matrix[i], NORM_FROBENIUS, &p->norms[i]));
  PetscFunctionReturn(0);
}

/* Whether more undamped modes may help */
static PetscBool MayHelp(const PencilMatrices *pencil, const char why[])
{
  if (why == why_strong) return pencil->n_laws ? PETSC_TRUE : PETSC_FALSE;
  return why == why_differ || why == why_guard ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ProjectSolve(Modes modes, const PencilMatrices *pencil, Window *window, PetscBool *done)
{
  PencilMatrices undamped = *pencil;
  const char    *why      = why_differ;
  Projection     p;
  PetscBool      complete = PETSC_FALSE;
  PetscInt       n_found  = 0;

  PetscFunctionBeginUser;
  undamped.C      = NULL;
  undamped.n_laws = 0;
  PetscCall(ProjectionCreate(modes, pencil, window, &p));
  PetscCall(ModesFactor(modes, &undamped, UndampedShift(window), RELEASE_MATRIX, &p.si));
  MemoryReturn();
  window->guard = PETSC_TRUE;
  for (int attempt = 0; attempt < PROJECT_ATTEMPTS && MayHelp(pencil, why); attempt++) {
    if (attempt) window->extra += 10 + (!complete ? modes->right.n / 2 : why == why_strong ? n_found : 0);
    if (attempt && !complete) CopiesMakeRoom(modes, window, &modes->right);
    PetscCall(SpectraDestroy(modes));
    PetscCall(SubspaceTruncate(&p.space, 0));
    PetscCall(SolveUndamped(modes, &undamped, window, &p.si, &p.reach, &complete));
    n_found = modes->right.n;
    why     = window->route.middle > 0 ? why_far : complete ? NULL : why_differ;
    if (!why) PetscCall(AddDamping(&p, window, &why));
  }
  *done = why ? PETSC_FALSE : PETSC_TRUE;
  if (why && why != why_whole) PetscCall(PetscStrncpy(window->route.why, why, sizeof(window->route.why)));
  if (why) PetscCall(SpectraDestroy(modes));
  window->guard = PETSC_FALSE;
  if (why) window->extra = 6, window->known.rigid = 0;
  PetscCall(SubspaceDestroy(&p.space));
  if (!why && modes->keep)
    modes->factor = p.si;
  else
    PetscCall(ShiftInvertDestroy(&p.si));
  PetscFunctionReturn(0);
}
