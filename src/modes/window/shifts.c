/*
   A band in several shifts. Neighbouring parts overlap by a strip about the seam, which both cover:

      part k: [e_k (1 - d), e_(k+1) (1 + d)],   e_k = f_1 + k (f_2 - f_1) / n,   d = 1e-3,

   each with its own factorisation at the middle of its part in the plane of kappa and its own count by inertia. A seam
   is cut in the middle of the widest gap between the modes of the strip, so that what rounding makes different in two
   solutions of one mode, and the members of a pair with one frequency, cannot be parted by it.
*/
#include "modes/modesimpl.h"
#include "base/process/memory.h"

#define SHIFTS_STRIP 1e-3 /* relative half width of the strip about a seam */
#define SHIFTS_MODES 300  /* modes from which orthogonalisation costs more than another factorisation saves */
#define SHIFTS_EACH  2.2  /* right-hand sides for each mode of a band, as right or as left vector, */
#define SHIFTS_FIRST 45   /* and for all of them, as counted with 10 and with 51 modes */

PetscErrorCode ShiftsChoose(Modes modes, const PencilMatrices *pencil, const Window *window)
{
  const PetscInt n = modes->n_shifts;

  PetscFunctionBeginUser;
  modes->shifts = PetscMax(1, n);
  if (!n && !pencil->C && !window->count && !modes->keep)
    modes->shifts = PetscMax(modes->shifts, (window->known.expected + SHIFTS_MODES - 1) / SHIFTS_MODES);
  if (n <= 1) PetscFunctionReturn(0);
  PetscCheck(!window->count, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_shifts %" PetscInt_FMT " needs a band: give -modes_band, or leave it out", n);
  PetscCheck(!pencil->C, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_shifts %" PetscInt_FMT " is not offered with damping, whose modes one shift finds; leave it out",
             n);
  PetscCheck(window->known.expected < 0 || n <= PetscMax(1, window->known.expected), modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_shifts %" PetscInt_FMT " must be at most %" PetscInt_FMT ", the modes in the band", n,
             window->known.expected);
  PetscFunctionReturn(0);
}

/* The lower end of part k, rad/s */
PetscReal ShiftsSeam(const Window *window, PetscInt n, PetscInt k)
{
  return window->low + k * (window->high - window->low) / n;
}

/* Part k of the band */
static PetscErrorCode ShiftsPart(Modes modes, const PencilMatrices *pencil, const Window *window, PetscInt k,
                                 Window *part)
{
  const PetscInt  n    = modes->shifts;
  const PetscReal low  = k ? ShiftsSeam(window, n, k) * (1 - SHIFTS_STRIP) : window->low;
  const PetscReal high = k + 1 < n ? ShiftsSeam(window, n, k + 1) * (1 + SHIFTS_STRIP) : window->high;

  PetscFunctionBeginUser;
  PetscCall(WindowNarrow(modes, pencil, window, (PetscReal[]){low, high}, part));
  PetscFunctionReturn(0);
}

/* Middle of the widest gap between the modes in the strip about a seam */
static PetscReal ShiftsCut(const Spectrum *s, PetscReal seam)
{
  const PetscReal high = seam * (1 + SHIFTS_STRIP);
  PetscReal       last = seam * (1 - SHIFTS_STRIP), widest = 0, cut = seam;

  for (PetscInt i = 0; i <= s->n; i++) {
    const PetscReal next = i < s->n ? PetscMin(s->omega[i], high) : high;

    if (next - last > widest) widest = next - last, cut = 0.5 * (last + next);
    last = PetscMax(last, next);
  }
  return cut;
}

/* Modes of a spectrum below a frequency */
static PetscInt ShiftsBelow(const Spectrum *s, PetscReal omega)
{
  PetscInt n = 0;

  while (n < s->n && s->omega[n] < omega) n++;
  return n;
}

/* Adds the modes just found above the seam, in rad/s, to those of the parts before */
PetscErrorCode ShiftsAppend(Modes modes, PetscReal seam, Spectrum *right, Spectrum *left)
{
  const PetscReal cut   = right->n || seam > 0 ? ShiftsCut(right, seam) : 0;
  const PetscInt  lower = ShiftsBelow(right, cut), upper = ShiftsBelow(&modes->right, cut);

  PetscFunctionBeginUser;
  PetscCall(SpectrumKeep(right, 0, lower));
  PetscCall(SpectrumKeep(&modes->right, upper, modes->right.n - upper));
  PetscCall(SpectrumAppend(&modes->right, right));
  if (!modes->left) PetscFunctionReturn(0);
  PetscCall(SpectrumKeep(left, 0, lower));
  PetscCall(SpectrumKeep(&modes->left_spectrum, upper, modes->left_spectrum.n - upper));
  PetscCall(SpectrumAppend(&modes->left_spectrum, left));
  PetscFunctionReturn(0);
}

/* The modes of one part; si is its factorisation, whose analysis the counts of the next part take over */
static PetscErrorCode ShiftsSolvePart(Modes modes, const PencilMatrices *pencil, Window *part, ShiftInvert *si)
{
  PetscFunctionBeginUser;
  PetscCall(ModesFactor(modes, pencil, WindowMiddle(part), RELEASE_NOTHING, si));
  PetscCall(ModesSolveWindow(modes, pencil, part, si));
  PetscFunctionReturn(0);
}

/* All parts, one after the other by all ranks */
static PetscErrorCode ShiftsSolveParts(Modes modes, const PencilMatrices *pencil, Window *window, ShiftInvert *si,
                                       Spectrum *right, Spectrum *left)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < modes->shifts; k++) {
    Window part;

    if (k) PetscCall(ShiftInvertDestroy(&modes->counter));
    if (k) modes->counter = *si;
    PetscCall(ShiftsPart(modes, pencil, window, k, &part));
    PetscCall(ShiftsSolvePart(modes, pencil, &part, si));
    PetscCall(ShiftsAppend(modes, k ? ShiftsSeam(window, modes->shifts, k) : 0, right, left));
    window->route.worst  = PetscMax(window->route.worst, part.route.worst);
    window->route.proven = part.route.proven;
  }
  PetscFunctionReturn(0);
}

/* Right-hand sides that the modes of a window take about one shift; 0: not known */
static double ShiftsSolves(Modes modes, const Window *window)
{
  if (modes->keep || window->known.expected <= 0) return 0;
  return (modes->left ? 2 : 1) * (SHIFTS_EACH * (double)window->known.expected + SHIFTS_FIRST);
}

/* All modes of the window about one shift; after it the matrices of the pencil are to be got again */
static PetscErrorCode ShiftsSolveOne(Modes modes, const PencilMatrices *pencil, PetscReal shift, Window *window,
                                     ShiftInvert *si)
{
  PencilMatrices rest = *pencil;
  Mat            K;

  PetscFunctionBeginUser;
  modes->counter.solves = ShiftsSolves(modes, window);
  PetscCall(ModesFactor(modes, pencil, shift, modes->keep ? RELEASE_NOTHING : RELEASE_PENCIL, si));
  MemoryReturn(); /* what the update took, before there are spaces of vectors */
  K = si->product;
  if (K) PetscCall(PetscObjectReference((PetscObject)K)); /* another shift makes another one */
  if (K) rest.K = K;
  if (si->regain) rest.K_even = NULL;
  PetscCall(ModesSolveWindow(modes, &rest, window, si));
  PetscCall(MatDestroy(&K));
  PetscFunctionReturn(0);
}

PetscErrorCode ShiftsSolve(Modes modes, const PencilMatrices *pencil, Window *window, ShiftInvert *si)
{
  const PetscReal shift    = pencil->C ? DampedShift(window) : UndampedShift(window);
  Spectrum        found[2] = {{0}, {0}};

  PetscFunctionBeginUser;
  if (modes->shifts == 1) {
    PetscCall(ShiftsSolveOne(modes, pencil, shift, window, si));
    PetscFunctionReturn(0);
  }
  PetscCall(ShiftsSolveParts(modes, pencil, window, si, &found[0], &found[1]));
  modes->right         = found[0];
  modes->left_spectrum = found[1];
  PetscCheck(!window->route.proven || found[0].n == window->known.expected, modes->comm, PETSC_ERR_NOT_CONVERGED,
             "%" PetscInt_FMT " shifts found %" PetscInt_FMT " modes of the %" PetscInt_FMT
             " in the band; give another number of -modes_shifts",
             modes->shifts, found[0].n, window->known.expected);
  PetscFunctionReturn(0);
}
