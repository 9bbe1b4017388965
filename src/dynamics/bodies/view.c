/*
   View of the bodies: which kernel serves how many elements.
*/
#include "bodiesimpl.h"

/* Cells of each body [n_bodies] that the swept kernel serves, over all ranks, and all of them */
static PetscErrorCode BodiesCountSwept(Bodies b, PetscInt n_swept[], PetscInt n_all[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(n_swept, b->n_bodies));
  PetscCall(PetscArrayzero(n_all, b->n_bodies));
  for (PetscInt c = 0; c < b->mesh->n_cells; c++) {
    const PetscInt body = b->body[b->mesh->cell_node[b->mesh->cell_first[c]]];

    n_all[body]++;
    for (PetscInt i = 0; i < b->n_swept; i++) n_swept[body] += b->swept[i].body == body;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_swept, (PetscMPIInt)b->n_bodies, MPIU_INT, MPI_SUM, b->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n_all, (PetscMPIInt)b->n_bodies, MPIU_INT, MPI_SUM, b->comm));
  PetscFunctionReturn(0);
}

/* What a step reads of the blocks of all ranks, 10^6 bytes */
static PetscErrorCode BodiesViewBlocks(Bodies b, PetscViewer viewer)
{
  const General *g = &b->general;
  PetscReal      n[2]; /* blocks, nodes */

  PetscFunctionBeginUser;
  n[0] = g->n ? (PetscReal)(g->stiffness.start[g->n] + g->damping.start[g->n]) : 0;
  n[1] = (PetscReal)g->n;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 2, MPIU_REAL, MPI_SUM, b->comm));
  if (n[1] == 0) PetscFunctionReturn(0);
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %.0f blocks of %.0f nodes: %.4g MB, read in each step\n", (double)n[0],
                                   (double)n[1], 1e-6 * (double)n[0] * (9 * sizeof(PetscReal) + sizeof(PetscInt))));
  PetscFunctionReturn(0);
}

/* What stencils read in the place of blocks, of which a symmetric matrix has the upper half, 10^6 bytes of all ranks */
static PetscErrorCode BodiesViewSaved(Bodies b, PetscViewer viewer)
{
  PetscReal n[2] = {0, 0}; /* coefficients, blocks */

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < b->n_swept; i++) {
    const SweptBody *s = &b->swept[i];

    for (PetscInt l = 0; l < s->lines->n_lines; l++) {
      n[0] += (PetscReal)(STENCIL_COEFFICIENTS * s->stiffness[l].n);
      n[1] += 0.5 * (PetscReal)((3 * s->stiffness[l].n + 1) * s->lines->n_nodes);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 2, MPIU_REAL, MPI_SUM, b->comm));
  if (n[1] == 0) PetscFunctionReturn(0);
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "  saved: stencils read %.3g MB of coefficients in each step instead of %.3g MB of blocks (estimate)\n",
    1e-6 * (double)n[0] * sizeof(double), 1e-6 * (double)n[1] * (9 * sizeof(PetscReal) + sizeof(PetscInt))));
  PetscFunctionReturn(0);
}

/* How a body is swept */
static PetscErrorCode BodiesViewAxis(const BodiesFrame *frame, PetscViewer viewer)
{
  const PetscReal *along = &frame->row[3 * frame->axis];

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, ", swept %s ", frame->turned ? "about" : "along"));
  if (frame->oblique)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%.6g,%.6g,%.6g", (double)along[0], (double)along[1], (double)along[2]));
  else if (frame->turned)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%c", "xyz"[frame->axis]));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "an axis"));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesView(Bodies b, PetscViewer viewer)
{
  PetscInt *n_swept, *n_all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(b->n_bodies, &n_swept, b->n_bodies, &n_all));
  PetscCall(BodiesCountSwept(b, n_swept, n_all));
  for (PetscInt i = 0; i < b->n_bodies; i++) {
    const PetscInt n_rows = n_all[i] - n_swept[i];

    PetscCall(PetscViewerASCIIPrintf(viewer, "  body %" PetscInt_FMT ": %" PetscInt_FMT " elements", i + 1, n_all[i]));
    if (n_swept[i] || b->frame[i].turned) PetscCall(BodiesViewAxis(&b->frame[i], viewer));
    if (n_swept[i])
      PetscCall(PetscViewerASCIIPrintf(viewer, ", %" PetscInt_FMT " by a stencil along lines", n_swept[i]));
    if (n_rows) PetscCall(PetscViewerASCIIPrintf(viewer, ", %" PetscInt_FMT " by rows of 3 x 3 blocks", n_rows));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  }
  PetscCall(BodiesViewBlocks(b, viewer));
  PetscCall(BodiesViewSaved(b, viewer));
  PetscCall(PetscFree2(n_swept, n_all));
  PetscFunctionReturn(0);
}
