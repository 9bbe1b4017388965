/*
   What a solution says about its completeness. Without damping and friction inertia proves it. Else right and left
   vectors are compared, and the frictionless, undamped count stands beside the modes found. There a mode is a pair of
   eigenvalues lambda: conjugates, of which one is listed, or two real ones where damping keeps it from oscillating. A
   rigid mode, a double zero, becomes 0 and -alpha with C x = alpha M x.
*/
#include "modesimpl.h"

/* Modes that do not oscillate: rows listed, as many of them as the undamped system has modes, and those at zero. A zero is one
   mode with another zero, which is not listed, or with a decay; two decays are one mode */
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

/* The count without friction and damping, and why that of the rows may differ from it */
static PetscErrorCode DescribeFrictionless(Modes modes, const Window *window, char text[], size_t size)
{
  PetscInt rows, pairs, at_zero;
  char     real[192] = "", other[128] = "", zeros[128] = "";

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (window->expected < 0 || window->count) PetscFunctionReturn(0);
  CountReal(modes, &rows, &pairs, &at_zero);
  if (at_zero && window->rigid)
    PetscCall(PetscSNPrintf(zeros, sizeof(zeros), "; %" PetscInt_FMT " at zero, one for each motion that nothing resists, K x = 0",
                            at_zero));
  if (rows != pairs)
    PetscCall(PetscSNPrintf(real, sizeof(real),
                            "; %" PetscInt_FMT
                            " of these do not oscillate and are the real eigenvalues of %" PetscInt_FMT
                            " mode%s, which makes %" PetscInt_FMT,
                            rows, pairs, pairs == 1 ? "" : "s", modes->n - rows + pairs));
  if (modes->n - rows + pairs != window->expected)
    PetscCall(PetscStrncpy(other, "; the others lie beyond that growth or have left the band", sizeof(other)));
  if (modes->n - rows + pairs > window->expected)
    PetscCall(PetscStrncpy(other, "; the others came into the band by friction, damping or spin", sizeof(other)));
  PetscCall(PetscSNPrintf(text, size, "%s%s; the count without friction and damping is %" PetscInt_FMT " (inertia)%s",
                          zeros, real, window->expected, other));
  PetscFunctionReturn(0);
}

/* How the undamped modes of a projection are known to be complete, and what damping does to that */
static PetscErrorCode DescribeProjection(const Window *window, const char region[], const char rest[], char text[],
                                         size_t size)
{
  char undamped[192] = "inertia of K - s M counts the undamped modes in the band";

  PetscFunctionBeginUser;
  if (!window->counted)
    PetscCall(PetscSNPrintf(undamped, sizeof(undamped),
                            "undamped right and left vectors, sought from different starts with one shared "
                            "factorisation, give the same eigenvalues, to %.1e",
                            (double)window->worst));
  PetscCall(PetscSNPrintf(
    text, size,
    "none was found missing: %s; damping brings none%s from beyond them, since its estimated strength there is "
    "%.2g, and 1 would be needed%s",
    undamped, region, (double)window->beyond, rest));
  PetscFunctionReturn(0);
}

/* Why a damped solution was not done by projection */
static PetscErrorCode DescribeRoute(const Window *window, PetscBool dense, char text[], size_t size)
{
  char measure[80] = "";

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!window->why[0]) PetscFunctionReturn(0);
  if (window->beyond >= 0)
    PetscCall(PetscSNPrintf(measure, sizeof(measure), " (strength %.2g beyond the undamped modes of the window)",
                            (double)window->beyond));
  PetscCall(PetscSNPrintf(text, size, "; solved as a quadratic problem (%s), since %s%s", dense ? "LAPACK" : "PEP",
                          window->why, measure));
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
  if (window->most < INFINITY)
    PetscCall(
      PetscSNPrintf(massless, sizeof(massless),
                    "; unknowns have no mass, and with these modes of |lambda| above %.6g 1/s are not looked for",
                    (double)window->most));
  if (!window->count)
    PetscCall(PetscSNPrintf(region, sizeof(region), " with |growth| below %.6g 1/s", (double)window->growth));
  if (window->proven && window->count)
    PetscCall(PetscSNPrintf(text, size,
                            "none is missing: inertia of K - s M counts %" PetscInt_FMT " up to the outermost",
                            window->expected));
  else if (window->proven)
    PetscCall(PetscSNPrintf(text, size,
                            "none is missing: inertia of K - s M at the ends of the band counts %" PetscInt_FMT,
                            window->expected));
  else if (window->project && (modes->left || window->counted))
    PetscCall(DescribeProjection(window, region, frictionless, text, size));
  else if (modes->left && modes->dense)
    PetscCall(PetscSNPrintf(text, size,
                            "none was found missing: LAPACK finds all eigenvalues of the matrices and of their transposes, which are "
                            "the same%s, to %.1e%s",
                            region, (double)window->worst, frictionless));
  else if (modes->left)
    PetscCall(PetscSNPrintf(text, size,
                            "none was found missing: right and left vectors, sought from different starts with one "
                            "shared factorisation%s, give the same eigenvalues%s, to %.1e%s",
                            modes->shifts > 1 ? " a shift" : "", region, (double)window->worst, frictionless));
  else
    PetscCall(PetscSNPrintf(text, size, "completeness was not checked, since -modes_left is off%s", frictionless));
  PetscCall(PetscStrlcat(text, route, size));
  PetscCall(PetscStrlcat(text, massless, size));
  PetscFunctionReturn(0);
}

PetscErrorCode WindowComplain(Modes modes, const Window *window, const char solver[])
{
  Operators operators;
  Model     model;
  char      doubt[512] = "";

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  if (model)
    PetscCall(ModelDescribeDoubt(model, PetscMax(window->high, window->target) / (2 * PETSC_PI), sizeof(doubt), doubt));
  PetscCheck(!doubt[0], modes->comm, PETSC_ERR_NOT_CONVERGED,
             "the eigensolver did not converge all modes of the window: %s", doubt);
  SETERRQ(
    modes->comm, PETSC_ERR_NOT_CONVERGED,
    "the eigensolver did not converge all modes of the window; raise -%s_max_it or -%s_ncv, or narrow -modes_band",
    solver, solver);
}
