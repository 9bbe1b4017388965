/*
   What the choices of a solution saved, a line each for -squeal_view. LU of n unknowns has about twice the entries of
   LDL', 8 bytes each, as MUMPS estimates them; a quadratic problem is a linear one of twice the unknowns.
*/
#include "modesimpl.h"
#include "solver/factor/lowrank.h"

#define BYTES_TO_MB 1e-6

PetscErrorCode SavedByFactors(Modes modes, const ShiftInvert *si)
{
  const double mb   = BYTES_TO_MB * sizeof(PetscScalar) * si->cost.entries;
  char        *text = modes->saved[SAVED_FACTORS], what[64] = "no friction, a symmetric problem";

  PetscFunctionBeginUser;
  if (si->update)
    PetscCall(PetscSNPrintf(what, sizeof(what), "friction by an update of %" PetscInt_FMT " pairs", si->update->p));
  if (si->even && mb > 0)
    PetscCall(PetscSNPrintf(text, SAVED_LENGTH, "%s: factors of %.3g MB instead of about %.3g MB (estimate)", what, mb,
                            2 * mb));
  else
    PetscCall(PetscSNPrintf(text, SAVED_LENGTH, "nothing by factors: LU%s%s", si->why ? ", since " : "",
                            si->why ? si->why : ""));
  PetscFunctionReturn(0);
}

PetscErrorCode SavedByDamping(Modes modes, const PencilMatrices *pencil, const Window *window)
{
  char    *text = modes->saved[SAVED_DAMPING];
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(pencil->K, &n, NULL));
  if (!pencil->C)
    PetscCall(PetscSNPrintf(
      text, SAVED_LENGTH, "no damping: %" PetscInt_FMT " unknowns instead of %" PetscInt_FMT " of a quadratic problem",
      n, 2 * n));
  else if (window->route.project && window->route.mapped)
    PetscCall(
      PetscSNPrintf(text, SAVED_LENGTH,
                    "damping is alpha M + beta K with %.6g 1/s, %.6g s: by a formula from the undamped modes, no "
                    "quadratic problem of %" PetscInt_FMT " unknowns",
                    (double)window->route.mapped_alpha, (double)window->route.mapped_beta, 2 * n));
  else if (window->route.project)
    PetscCall(PetscSNPrintf(
      text, SAVED_LENGTH,
      "%s damping on a basis of %" PetscInt_FMT " vectors: no quadratic problem of %" PetscInt_FMT " unknowns",
      window->route.n_enlarged || window->route.n_about ? "strong" : "weak", window->route.n_basis, 2 * n));
  else
    PetscCall(PetscSNPrintf(text, SAVED_LENGTH,
                            "nothing by damping: a quadratic problem of %" PetscInt_FMT " unknowns%s%s", 2 * n,
                            window->route.why[0] ? ", since " : "", window->route.why));
  PetscFunctionReturn(0);
}

PetscErrorCode SavedView(Modes modes, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_SAVED; i++)
    if (modes->saved[i][0]) PetscCall(PetscViewerASCIIPrintf(viewer, "saved: %s\n", modes->saved[i]));
  PetscFunctionReturn(0);
}
