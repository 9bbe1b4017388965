/* What samples tell a person */
#include "sampleimpl.h"

/* The probability that a branch grows */
static PetscErrorCode BranchView(Sample s, PetscInt b, PetscViewer viewer)
{
  const SampleBranch *branch = &s->branch[b];

  PetscFunctionBeginUser;
  if (!branch->n_possibly && b < s->nominal.n) PetscFunctionReturn(0);
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %s", branch->label));
  if (b < s->nominal.n) PetscCall(PetscViewerASCIIPrintf(viewer, " near %.2f Hz", (double)branch->frequency.mean));
  PetscCall(PetscViewerASCIIPrintf(viewer, ": %.4g, in [%.4g, %.4g] at 95 %%; growth %.4g to %.4g 1/s",
                                   (double)branch->n_unstable / (double)branch->n, (double)branch->interval[0],
                                   (double)branch->interval[1], (double)branch->growth.least,
                                   (double)branch->growth.most));
  if (branch->n_possibly > branch->n_surely)
    PetscCall(PetscViewerASCIIPrintf(viewer, "; %" PetscInt_FMT " left open by their errors",
                                     branch->n_possibly - branch->n_surely));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(0);
}

/* Modes that belong to no branch for certain */
static PetscInt ModesLost(Sample s, PetscInt *n)
{
  PetscInt lost = 0;

  *n = 0;
  for (PetscInt i = 0; i < s->n; i++)
    for (PetscInt k = 0; k < s->point[i].n; k++, ++*n) lost += s->point[i].mode[k].branch < 0;
  return lost;
}

/* True errors beside their estimates */
static PetscErrorCode VerifiedView(Sample s, PetscViewer viewer)
{
  PetscReal error = 0, ratio = 0;
  PetscInt  n = 0, n_beyond = 0, n_other = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_verify; k++) {
    const FullCheck *c = &s->check[k].found;

    error = PetscMax(error, c->error);
    ratio = PetscMax(ratio, c->ratio);
    n += c->n_full;
    n_beyond += c->n_beyond;
    n_other += s->check[k].same_status ? 0 : 1;
  }
  if (s->n_verify)
    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "checked by full solutions at %" PetscInt_FMT " points: largest true error %.1e, at most %.2g of what is stated; "
      "%" PetscInt_FMT " of %" PetscInt_FMT " modes beyond it; %.3g s each, %.3g s of a processor\n",
      s->n_verify, (double)error, (double)ratio, n_beyond, n, s->took[1].wall / (double)s->n_verify,
      s->took[1].processor / (double)s->n_verify));
  if (n_other)
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " of them have another contact status on the mesh\n", n_other));
  PetscFunctionReturn(0);
}

/* Contact statuses, and how they were found */
static PetscErrorCode StatusesView(Sample s, PetscViewer viewer)
{
  const StaticsMany *how   = &s->box.equilibria;
  PetscInt           least = BoxClosed(&s->box, 0), most = least;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n_points; i++) {
    least = PetscMin(least, BoxClosed(&s->box, i));
    most  = PetscMax(most, BoxClosed(&s->box, i));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "sliding state at each point: %" PetscInt_FMT " statuses, %" PetscInt_FMT
                                   " to %" PetscInt_FMT " of %" PetscInt_FMT " pairs closed, %" PetscInt_FMT
                                   " groups of pairs that open and close together\n",
                                   s->box.statuses.n, least, most, s->box.statuses.n_pairs, s->box.groups_of.n_groups));
  if (how->n_vectors)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "  %" PetscInt_FMT " equilibria on the mesh, the others on %" PetscInt_FMT
                                     " of their vectors (true error at most %.2g of the estimate)\n",
                                     how->n_mesh, how->n_vectors, (double)how->ratio));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleView(Sample s, PetscViewer viewer)
{
  static const char *const sequences[] = {"of a scrambled Sobol sequence", "of a Latin hypercube", "drawn at random"};
  PetscReal                worst       = 0;
  PetscInt                 lost, n;

  PetscFunctionBeginUser;
  lost = ModesLost(s, &n);
  for (PetscInt i = 0; i < s->n_points; i++) /* as it is stated, with rounding */
    for (PetscInt k = 0; k < s->point[i].n; k++) {
      const SampleMode *m = &s->point[i].mode[k];

      worst = PetscMax(worst, m->error / PetscMax(hypot(m->sigma, m->omega), PETSC_SMALL));
    }
  if (s->file[0])
    PetscCall(ConditionsView(s, viewer));
  else
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "%" PetscInt_FMT " samples of %" PetscInt_FMT " variables, %s, seed %" PetscInt_FMT "\n", s->n,
      s->n_variables, sequences[s->kind], s->seed));
  if (s->box.statics) PetscCall(StatusesView(s, viewer));
  if (!n || !s->file[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s\n",
                                     n            ? "probability of growth:"
                                     : s->file[0] ? "no condition has a mode in the band"
                                                  : "no sample has a mode in the band"));
  for (PetscInt b = 0; b <= s->nominal.n && n && !s->file[0]; b++) PetscCall(BranchView(s, b, viewer));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "branches: %" PetscInt_FMT " of %" PetscInt_FMT " modes are none of the scene's own for certain\n", lost,
    n));
  if (s->box.whole)
    PetscCall(PetscViewerASCIIPrintf(viewer, "basis of all %" PetscInt_FMT " unknowns: no error but rounding\n",
                                     s->box.basis.reduced.n_used));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "basis of %" PetscInt_FMT " vectors from %" PetscInt_FMT
                                     " full solutions; largest estimated error %.1e (an estimate, not a bound)\n",
                                     s->box.basis.reduced.n_used, s->box.greedy.n_samples, (double)worst));
  if (s->box.small.n_used)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "most points on %" PetscInt_FMT " vectors made of these, %" PetscInt_FMT " on all\n", s->box.small.n_used,
      s->n_large));
  if (s->box.turned.n_used)
    PetscCall(PetscViewerASCIIPrintf(viewer, "modes of these are sought in a core of %" PetscInt_FMT " directions\n",
                                     s->box.turned.core.m));
  PetscCall(VerifiedView(s, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "time: basis and samples %.2f s, %.2f s of a processor, %" PetscInt_FMT
                                   " points, %" PetscInt_FMT " between for branches\n",
                                   s->took[0].wall, s->took[0].processor, s->n_points, s->n_divided));
  PetscFunctionReturn(0);
}
