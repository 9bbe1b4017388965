/*
   What the samples tell of each branch: moments and quantiles, the probability that it grows with its interval, and the
   dependence on the variables.

   A branch grows at a sample where it is unstable as modes are (-modes_unstable_above...). Samples of which the error
   leaves it open count as not growing for the lower end of the interval, and as growing for the upper one.
*/
#include "sampleimpl.h"
#include <string.h>

const SampleMode *SampleFind(Sample s, PetscInt i, PetscInt branch)
{
  const SamplePoint *point = &s->point[i];
  const SampleMode  *found = NULL;

  for (PetscInt k = 0; k < point->n; k++) {
    const SampleMode *m = &point->mode[k];

    if (branch < s->nominal.n && m->branch == branch) found = m;
    if (branch == s->nominal.n && (!found || m->sigma > found->sigma)) found = m;
  }
  return found;
}

void SampleBranchValues(Sample s, PetscInt branch, int which, PetscReal value[])
{
  for (PetscInt i = 0; i < s->n_points; i++) {
    const SampleMode *m = SampleFind(s, i, branch);

    value[i] = !m ? NAN : which ? m->sigma : m->omega / (2 * PETSC_PI);
  }
}

/* Mean and the like of those samples that have the branch; value [n_points] for work */
static PetscErrorCode BranchMoments(Sample s, PetscInt b, int which, PetscReal value[], Moments *moments)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  SampleBranchValues(s, b, which, value);
  for (PetscInt i = 0; i < s->n; i++)
    if (!PetscIsNanReal(value[i])) value[n++] = value[i];
  PetscCall(MomentsFind(n, value, moments));
  PetscFunctionReturn(0);
}

/* Counts the samples at which a branch grows, as far as its errors tell: of the last one any mode */
static void BranchCount(Sample s, PetscInt b, SampleBranch *branch)
{
  const ModesLimit *limit = &s->box.limit;

  for (PetscInt i = 0; i < s->n; i++) {
    PetscBool present = PETSC_FALSE, grows = PETSC_FALSE, surely = PETSC_FALSE, possibly = PETSC_FALSE;

    for (PetscInt k = 0; k < s->point[i].n; k++) {
      const SampleMode *m = &s->point[i].mode[k];

      if (b < s->nominal.n && m->branch != b) continue;
      present = PETSC_TRUE;
      if (ModesLimitIsExceeded(limit, m->sigma, m->omega, 0)) grows = PETSC_TRUE;
      if (ModesLimitIsExceeded(limit, m->sigma, m->omega, m->growth_error)) surely = PETSC_TRUE;
      if (ModesLimitIsExceeded(limit, m->sigma + m->growth_error, m->omega, 0)) possibly = PETSC_TRUE;
    }
    branch->n += present || b == s->nominal.n ? 1 : 0;
    branch->n_unstable += grows;
    branch->n_surely += surely;
    branch->n_possibly += possibly;
  }
}

/* Names that several branches have get numbers, in the order of their frequencies: "u2 #1", "u2 #2" */
static PetscErrorCode LabelsTellApart(PetscInt n, SampleBranch branch[])
{
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < n; b++) {
    char     label[sizeof(branch[b].label)];
    PetscInt same = 0;

    PetscCall(PetscStrncpy(label, branch[b].label, sizeof(label)));
    for (PetscInt k = b; k < n; k++) same += strcmp(branch[k].label, label) ? 0 : 1;
    for (PetscInt k = b, number = 0; k < n && same > 1 && label[0]; k++)
      if (!strcmp(branch[k].label, label))
        (void)snprintf(branch[k].label, sizeof(branch[k].label), "%.18s #%d", label, (int)++number);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SampleBranches(Sample s)
{
  PetscReal *value;
  char(*label)[32];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->nominal.n + 1, &s->branch));
  PetscCall(PetscMalloc2(s->n_points, &value, s->nominal.n + 1, &label));
  PetscCall(BasisKeepFree(&s->box.basis, s->box.modes, s->box.nominal));
  PetscCall(BasisLabelModes(&s->box.basis, s->box.modes, s->box.nominal, &s->nominal, label));
  for (PetscInt b = 0; b <= s->nominal.n; b++) {
    SampleBranch *branch = &s->branch[b];

    BranchCount(s, b, branch);
    PetscCall(BranchMoments(s, b, 0, value, &branch->frequency));
    PetscCall(BranchMoments(s, b, 1, value, &branch->growth));
    ClopperPearson(branch->n_surely, branch->n_possibly, branch->n, branch->interval);
    PetscCall(PetscStrncpy(branch->label, b < s->nominal.n ? label[b] : "any mode", sizeof(branch->label)));
  }
  PetscCall(LabelsTellApart(s->nominal.n, s->branch));
  PetscCall(PetscFree2(value, label));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleIndices(Sample s, const PetscReal value[], VariableIndex index[], PetscReal *r_squared,
                             PetscInt *n_rows)
{
  const PetscInt    d      = s->n_variables;
  const SobolDesign design = {s->n_rows, d, value, value + s->n, value + s->n + s->n_rows};
  PetscReal        *x;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < d; k++) index[k] = (VariableIndex){NAN, NAN, NAN, NAN, NAN, NAN};
  *n_rows = 0;
  if (s->n_rows) PetscCall(IndicesOfSobol(&design, index, n_rows));
  PetscCall(PetscMalloc1(s->n * d, &x));
  for (PetscInt i = 0; i < s->n; i++) PetscCall(SampleValues(s, i, &x[i * d]));
  PetscCall(RegressionSlopes(&(Regression){s->n, d, x, value}, index, r_squared));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}
