/* A superelement that was made, in words: sizes and errors */
#include "substructureimpl.h"

/* The largest relative error of the modes in the band with an interface free or held; -1 where there are none */
static PetscReal ModesWorst(const Substructure s, PetscBool held, PetscInt *n, PetscReal *at)
{
  PetscReal worst = -1;

  *n = 0;
  for (PetscInt k = 0; k < s->n_modes; k++) {
    const SubstructureMode *mode     = &s->mode[k];
    const PetscReal         relative = mode->frequency > 0 ? mode->error / mode->frequency : 0;

    if (mode->held != held) continue;
    ++*n;
    if (relative > worst) *at = mode->frequency;
    worst = PetscMax(worst, relative);
  }
  return worst;
}

/* What it is of, and what its unknowns are */
static PetscErrorCode ViewSizes(const Substructure s, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "superelement: %" PetscInt_FMT " unknowns of", s->body.n));
  for (PetscInt i = 0; i < s->n_parts; i++)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s %s", i ? "," : "", s->parts[i]));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, " become %" PetscInt_FMT ": %" PetscInt_FMT " of %" PetscInt_FMT " nodes of the interface, ", s->n,
    s->interface.n, s->interface.n_nodes));
  if (s->method == SUBSTRUCTURE_NONE)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " inside: nothing is reduced\n", s->interface.n_kept));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " modes below %.6g Hz with it %s",
                                     s->n_modal - s->n_inertia, (double)s->cutoff,
                                     s->method == SUBSTRUCTURE_FIXED ? "held" : "free"));
  if (s->n_inertia) PetscCall(PetscViewerASCIIPrintf(viewer, ", %" PetscInt_FMT " answers to inertia", s->n_inertia));
  if (s->method != SUBSTRUCTURE_NONE) PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode SubstructureView(Substructure s, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(ViewSizes(s, viewer));
  if (s->interface.n_held)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  supports hold %" PetscInt_FMT " displacements of these nodes: hold them where it is used, too\n",
      s->interface.n_held));
  for (int held = 0; held < 2; held++) {
    PetscInt        n;
    PetscReal       at    = 0;
    const PetscReal worst = ModesWorst(s, held ? PETSC_TRUE : PETSC_FALSE, &n, &at);

    if (n)
      PetscCall(PetscViewerASCIIPrintf(
        viewer,
        "  interface %s: %" PetscInt_FMT
        " modes in %.6g to %.6g Hz, largest estimated error %.2g of the frequency, at %.6g Hz\n",
        held ? "held" : "free", n, (double)s->band[0], (double)s->band[1], (double)worst, (double)at));
  }
  if (s->any >= 0)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "  in any structure: estimated error %.2g of a frequency at %.6g Hz, less of "
                                     "lower ones\n",
                                     (double)s->any, (double)s->band[1]));
  PetscFunctionReturn(0);
}
