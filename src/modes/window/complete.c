/*
   What a solution says about its completeness. Without damping and friction the inertia of K - s M at the ends of the
   band proves it. Else two independent searches are compared, those of right and of left vectors, which begin from
   different starts on one shared factorisation a shift, and the frictionless, undamped count stands beside the modes
   found. There a mode is a pair of eigenvalues lambda: conjugates, of which one is listed, or two real ones where
   damping keeps it from oscillating. A rigid mode, a double zero, becomes 0 and -alpha with C x = alpha M x.
*/
#include "modes/modesimpl.h"
#include "base/text.h"

/* Of materials whose stiffness depends on the frequency, and where it is hysteretic alone */
static const char laws_text[] = "; a contour integral counts the same of modes damped by less than 0.995 of critical "
                                "damping";
static const char held_text[] = "; LAPACK has no others of the complex stiffness on the basis, but for what does not "
                                "oscillate";

#define MODES_DOUBTED 100 /* in a band where the units of a part are in doubt */

/* Modes that do not oscillate: rows listed, as many of them as the undamped system has modes, and those at zero. A zero
   is one mode with another zero, which is not listed, or with a decay; two decays are one mode */
static void CountReal(Modes modes, PetscInt *rows, PetscInt *pairs, PetscInt *at_zero)
{
  PetscInt decays = 0;

  *at_zero = 0;
  for (PetscInt i = 0; i < modes->n; i++) {
    *at_zero += modes->mode[i].rigid;
    decays += !modes->mode[i].rigid && modes->mode[i].omega == 0;
  }
  *rows  = *at_zero + decays;
  *pairs = *at_zero + (PetscMax(0, decays - *at_zero) + 1) / 2;
}

/* Whether the modes found are as many as those without friction and damping */
static PetscBool Expected(Modes modes, const Window *window)
{
  PetscInt rows, pairs, at_zero;

  CountReal(modes, &rows, &pairs, &at_zero);
  return modes->n - rows + pairs == window->known.expected ? PETSC_TRUE : PETSC_FALSE;
}

/* The count without friction and damping, and why that of the rows may differ from it */
static PetscErrorCode DescribeFrictionless(Modes modes, const Window *window, char text[], size_t size)
{
  PetscInt rows, pairs, at_zero;
  char     real[192] = "", other[160] = "", zeros[128] = "", count[256];

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (window->known.expected < 0 || window->count) PetscFunctionReturn(0);
  CountReal(modes, &rows, &pairs, &at_zero);
  if (at_zero && window->known.rigid)
    PetscCall(PetscSNPrintf(zeros, sizeof(zeros),
                            "; %" PetscInt_FMT " at zero, one for each motion that nothing resists, K x = 0", at_zero));
  if (rows != pairs)
    PetscCall(PetscSNPrintf(real, sizeof(real),
                            "; %" PetscInt_FMT " of them do not oscillate and count as %" PetscInt_FMT " mode%s", rows,
                            pairs, pairs == 1 ? "" : "s"));
  if (modes->n - rows + pairs != window->known.expected)
    PetscCall(PetscStrncpy(
      other, " without friction and damping, the others lie beyond that growth or have left the band", sizeof(other)));
  if (modes->n - rows + pairs > window->known.expected)
    PetscCall(PetscStrncpy(other,
                           " without friction and damping, the others came into the band by friction, damping or spin",
                           sizeof(other)));
  PetscCall(PetscSNPrintf(text, size, "%s%s", zeros, real));
  if (window->route.project && window->route.counted && !other[0] && !text[0]) PetscFunctionReturn(0); /* it is told */
  PetscCall(PetscSNPrintf(count, sizeof(count), "; %" PetscInt_FMT " mode%s expected from the inertia count%s",
                          window->known.expected, window->known.expected == 1 ? "" : "s", other));
  PetscCall(WordsAdd(text, count, size));
  PetscFunctionReturn(0);
}

/* A strength below 1; near 1 with two digits of what it is short of it */
static PetscErrorCode StrengthPrint(PetscReal strength, char text[], size_t size)
{
  const PetscReal left   = PetscMax(1 - strength, 1e-12);
  const int       digits = 1 + (int)ceil(-PetscLog10Real(left));

  PetscFunctionBeginUser;
  if (strength < 0.99)
    PetscCall(PetscSNPrintf(text, size, "%.2g", (double)strength));
  else
    PetscCall(PetscSNPrintf(text, size, "%.*f", digits, (double)strength));
  PetscFunctionReturn(0);
}

/* How the undamped modes of a projection are known to be complete, and what damping does to that */
static PetscErrorCode DescribeProjection(const Window *window, const char region[], const char rest[], char text[],
                                         size_t size)
{
  char undamped[192], more[64] = "", pole[160] = "", strength[32];

  PetscFunctionBeginUser;
  if (window->route.counted)
    PetscCall(PetscSNPrintf(undamped, sizeof(undamped),
                            "the inertia count confirms all undamped modes in the band, %" PetscInt_FMT,
                            window->known.expected));
  else
    PetscCall(PetscSNPrintf(undamped, sizeof(undamped), "two independent searches of the undamped modes agree to %.1e",
                            (double)window->route.worst));
  if (window->route.n_enlarged)
    PetscCall(
      PetscSNPrintf(more, sizeof(more), " and %" PetscInt_FMT " vectors of strong damping", window->route.n_enlarged));
  if (window->route.pole > 0)
    PetscCall(PetscSNPrintf(pole, sizeof(pole),
                            "; modes within %.4g of %.4g 1/s, where overdamped ones gather, are not sought",
                            (double)(window->route.pole / 2), (double)-window->route.pole));
  PetscCall(StrengthPrint(window->route.beyond, strength, sizeof(strength)));
  PetscCall(PetscSNPrintf(text, size, "%s; damping brings no others%s (its strength beyond them%s is %s, below 1)%s%s",
                          undamped, region, more, strength, rest, pole));
  PetscFunctionReturn(0);
}

/* The same where damping is so strong that complex shifts were needed */
static PetscErrorCode DescribeStrong(const Window *window, const char region[], const char rest[], char text[],
                                     size_t size)
{
  const PetscInt n = window->route.n_about;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(text, size,
                          "damping is strong (%.2g beyond the undamped modes); about %" PetscInt_FMT
                          " complex shift%s the undamped modes and searches from random vectors lead to these%s, all "
                          "eigenvalues of the dense problems, and to no others%s; modes that are damped by more than "
                          "%.2g of critical damping are not sought",
                          (double)window->route.beyond, n, n == 1 ? "" : "s", region, rest, MODES_DAMPED_MOST));
  PetscFunctionReturn(0);
}

/* Why a damped solution was not done by projection */
static PetscErrorCode DescribeRoute(const Window *window, PetscBool dense, char text[], size_t size)
{
  char measure[80] = "";

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!window->route.why[0]) PetscFunctionReturn(0);
  if (window->route.beyond >= 0)
    PetscCall(PetscSNPrintf(measure, sizeof(measure), " (strength %.2g beyond the undamped modes of the window)",
                            (double)window->route.beyond));
  PetscCall(PetscSNPrintf(text, size, "; solved as a quadratic problem (%s), since %s%s", dense ? "LAPACK" : "PEP",
                          window->route.why, measure));
  PetscFunctionReturn(0);
}

PetscErrorCode WindowDescribe(Modes modes, const Window *window)
{
  char         frictionless[512], region[64] = "", route[256], massless[192] = "";
  char        *text = modes->completeness;
  const size_t size = sizeof(modes->completeness);

  PetscFunctionBeginUser;
  PetscCall(DescribeFrictionless(modes, window, frictionless, sizeof(frictionless)));
  PetscCall(DescribeRoute(window, modes->dense, route, sizeof(route)));
  if (window->known.most < INFINITY)
    PetscCall(PetscSNPrintf(massless, sizeof(massless),
                            "; unknowns have no mass: modes of |lambda| above %.6g 1/s are not sought",
                            (double)window->known.most));
  if (!window->count && !Expected(modes, window))
    PetscCall(PetscSNPrintf(region, sizeof(region), " for |growth| below %.6g 1/s", (double)window->growth));
  if (window->route.proven && window->count)
    PetscCall(PetscSNPrintf(text, size, "proven by the inertia count, %" PetscInt_FMT " up to the outermost",
                            window->known.expected));
  else if (window->route.proven)
    PetscCall(
      PetscSNPrintf(text, size, "proven by the inertia count, %" PetscInt_FMT " in the band", window->known.expected));
  else if (window->route.project && window->route.n_about)
    PetscCall(DescribeStrong(window, region, frictionless, text, size));
  else if (window->route.project && (modes->left || window->route.counted))
    PetscCall(DescribeProjection(window, region, frictionless, text, size));
  else if (modes->left && modes->dense)
    PetscCall(PetscSNPrintf(
      text, size, "LAPACK finds the same about two shifts, from the matrices and from their transposes, to %.1e%s%s",
      (double)window->route.worst, region, frictionless));
  else if (modes->left)
    PetscCall(PetscSNPrintf(text, size, "two independent searches agree to %.1e%s%s", (double)window->route.worst,
                            region, frictionless));
  else
    PetscCall(PetscSNPrintf(text, size, "not checked, since -modes_left is off%s", frictionless));
  if (window->route.laws) PetscCall(WordsAdd(text, window->route.held ? held_text : laws_text, size));
  PetscCall(WordsAdd(text, route, size));
  PetscCall(WordsAdd(text, massless, size));
  PetscFunctionReturn(0);
}

/* Why there may be too many modes; empty where nothing tells */
static PetscErrorCode WindowDoubt(Modes modes, const Window *window, size_t size, char doubt[])
{
  Operators operators;
  Model     model;

  PetscFunctionBeginUser;
  doubt[0] = '\0';
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  if (model) PetscCall(ModelDescribeDoubt(model, PetscMax(window->high, window->target) / (2 * PETSC_PI), size, doubt));
  PetscFunctionReturn(0);
}

PetscErrorCode WindowCheckCount(Modes modes, const Window *window)
{
  char doubt[512] = "", below[64] = "";

  PetscFunctionBeginUser;
  if (!modes->has_band || window->known.expected < 0) PetscFunctionReturn(0);
  if (!modes->has_most) PetscCall(WindowDoubt(modes, window, sizeof(doubt), doubt));
  if (modes->most == 0 || window->known.expected <= (doubt[0] ? MODES_DOUBTED : modes->most)) PetscFunctionReturn(0);
  if (window->known.below > 0)
    PetscCall(PetscSNPrintf(below, sizeof(below), " beside %" PetscInt_FMT " below it", window->known.below));
  SETERRQ(modes->comm, PETSC_ERR_USER_INPUT,
          "-modes_band %.6g,%.6g holds %" PetscInt_FMT
          " modes%s%s%s; narrow the band (Hz), or give -modes_most %" PetscInt_FMT " to compute them",
          (double)modes->band[0], (double)modes->band[1], window->known.expected, below, doubt[0] ? ": " : "", doubt,
          window->known.expected);
}

PetscErrorCode WindowComplain(Modes modes, const Window *window, const char solver[])
{
  char doubt[512];

  PetscFunctionBeginUser;
  PetscCall(WindowDoubt(modes, window, sizeof(doubt), doubt));
  PetscCheck(!doubt[0], modes->comm, PETSC_ERR_NOT_CONVERGED,
             "the eigensolver did not converge all modes of the window: %s", doubt);
  SETERRQ(
    modes->comm, PETSC_ERR_NOT_CONVERGED,
    "the eigensolver did not converge all modes of the window; raise -%s_max_it or -%s_ncv, or narrow -modes_band",
    solver, solver);
}
