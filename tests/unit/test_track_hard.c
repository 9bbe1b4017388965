/*
   Unit test of sweep/track, hard cases: defective points, doublets that lock in, rigid modes, steps too coarse for what
   happens between them.
*/
#include "densesweep.h"
#include "petscmain.h"

static const ReducedWindow everything = {0, 100, 100, 0};

/* Breaks when: a defective point spoils the match, or counts as two events. Reference: lock-in at p = 0.4 = a point of
   the sweep (d = (p - 0.5)^2 - 0.01), lock-out at 0.6, also one */
static PetscErrorCode TestDefective(int *failed)
{
  const PetscReal kappa[3] = {1, 2, 1.1}, slope[3] = {1, -1, 0.2};
  static Run      run;
  Dense           dense;

  PetscFunctionBeginUser;
  for (int hidden = 0; hidden < 2; hidden++) {
    const DenseEntry entry[2] = {
      {0, 1, 0.1 },
      {1, 0, -0.1}
    };
    PetscReal turned;

    DenseDiagonal(&dense, 3, kappa, slope, 2, entry);
    if (!hidden) { /* Q = I */
      const PetscReal K[9] = {1, 0.1, 0, -0.1, 2, 0, 0, 0, 1.1}, K1[9] = {1, 0, 0, 0, -1, 0, 0, 0, 0.2};

      DenseBegin(&dense, 3, PETSC_FALSE);
      DenseAddUnitMass(&dense);
      DenseAdd(&dense, OPERATORS_STIFFNESS, -1, K);
      DenseAdd(&dense, OPERATORS_STIFFNESS, 0, K1);
    }
    PetscCall(RunSweep(&dense, &everything, 0, 1, 11, &run));
    *failed += CheckTrue("events", run.events.n == 2, (double)run.events.n);
    *failed += CheckEvent("lock-in at a point", &run, 0, EVENT_LOCK_IN, 0.4);
    *failed += CheckEvent("lock-out at a point", &run, 1, EVENT_LOCK_OUT, 0.6);
    *failed += CheckTrue("branches", run.n_branches == 3, (double)run.n_branches);
    turned = 0;
    for (PetscInt k = 0; k < 11; k++)
      turned = PetscMax(turned, fabs(RunKappa(&run, k, run.branch[0][1]) - 1.1 - 0.2 * run.value[k]));
    *failed += CheckClose("the mode that passes through the pair", turned, 0, 1e-6);
    PetscCall(RunDestroy(&run));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a doublet that locks in with a doublet is taken apart. Reference: two copies of one pair, |p - 0.5| <
   0.1 */
static PetscErrorCode TestDoubletLockIn(int *failed)
{
  const PetscReal  kappa[5] = {1, 1, 2, 2, 1.3}, slope[5] = {1, 1, -1, -1, 0};
  const DenseEntry entry[4] = {
    {0, 2, 0.1 },
    {1, 3, 0.1 },
    {2, 0, -0.1},
    {3, 1, -0.1}
  };
  static Run run;
  Dense      dense;

  PetscFunctionBeginUser;
  DenseDiagonal(&dense, 5, kappa, slope, 4, entry);
  PetscCall(RunSweep(&dense, &everything, 0, 1, 8, &run));
  *failed += CheckTrue("events, two at each end", run.events.n == 4, (double)run.events.n);
  for (PetscInt e = 0; e < 4; e++)
    *failed +=
      CheckEvent("doublets lock in and out", &run, e, e < 2 ? EVENT_LOCK_IN : EVENT_LOCK_OUT, e < 2 ? 0.4 : 0.6);
  *failed += CheckTrue("branches", run.n_branches == 5, (double)run.n_branches);
  PetscCall(RunDestroy(&run));
  PetscFunctionReturn(0);
}

/* K0 + p K1 with random symmetric K0, K1 and an unsymmetric part of the given size; damping C if damped */
static void RandomSystem(Dense *dense, unsigned seed, PetscReal friction, PetscBool damped)
{
  PetscReal A[64];

  DenseBegin(dense, 8, PETSC_TRUE);
  dense->seed = seed;
  DenseAddUnitMass(dense);
  for (int t = 0; t < (damped ? 3 : 2); t++) {
    const PetscReal unsymmetric = t == 1 ? friction : 0;

    for (PetscInt i = 0; i < 8; i++) {
      for (PetscInt j = 0; j <= i; j++) {
        const PetscReal s = DenseRandom(dense), u = unsymmetric * DenseRandom(dense);

        A[i * 8 + j] = t == 2 ? 0 : (1 + 0.3 * t) * s + u;
        A[j * 8 + i] = t == 2 ? 0 : (1 + 0.3 * t) * s - u;
        if (i == j) A[i * 8 + j] = t == 0 ? 10 + 2. * (PetscReal)i : (t == 1 ? 8 * s : 0.05 * (1.2 + s));
      }
    }
    DenseAdd(dense, t == 2 ? OPERATORS_DAMPING : OPERATORS_STIFFNESS, t == 1, A);
  }
}

/* Whether an event of the run has the kind and branch of another event, and brackets that overlap */
static PetscInt HasEvent(const Run *run, const BranchEvent *other)
{
  for (PetscInt e = 0; e < run->events.n; e++) {
    const BranchEvent *event = &run->events.event[e];

    if (event->kind == other->kind && event->branch[0] == other->branch[0] && event->lower <= other->upper &&
        other->lower <= event->upper)
      return 1;
  }
  return 0;
}

/* Breaks when: coarse steps are not halved where modes exchange their shapes between the points, or branches change
   over where a pair locks out. Reference: the same sweep on a grid a hundred times finer */
static PetscErrorCode TestCoarse(int *failed)
{
  static Run coarse, fine;
  Dense      dense;

  PetscFunctionBeginUser;
  for (int c = 144; c < 156; c++) {
    PetscInt    differ = 0, same_events = 0;
    const char *kind = c % 3 == 0 ? "symmetric" : (c % 3 == 1 ? "friction" : "friction and damping");

    RandomSystem(&dense, 1000u + (unsigned)c, c % 3 ? 0.3 + 0.01 * c : 0, c % 3 == 2 ? PETSC_TRUE : PETSC_FALSE);
    PetscCall(RunSweep(&dense, &everything, 0, 1, 7, &coarse));
    PetscCall(RunSweep(&dense, &everything, 0, 1, 601, &fine));
    for (PetscInt k = 0; k < 7; k++)
      for (PetscInt i = 0; i < coarse.modes[k].n; i++) differ += coarse.branch[k][i] != fine.branch[100 * k][i];
    for (PetscInt e = 0; e < fine.events.n; e++) same_events += HasEvent(&coarse, &fine.events.event[e]);
    printf("     %s: %d events\n", kind, (int)fine.events.n);
    *failed += CheckTrue("modes on another branch than with fine steps", differ == 0, (double)differ);
    *failed += CheckTrue("events as with fine steps", same_events == fine.events.n && coarse.events.n == fine.events.n,
                         (double)coarse.events.n);
    PetscCall(RunDestroy(&coarse));
    PetscCall(RunDestroy(&fine));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a defective point of a damped system spoils the match. Reference: PHYSICS: with C = 0.02 I the two modes
   meet at mu = 0.78, a point here, where sigma = -0.01, and flutter from 0.78066 on */
static PetscErrorCode TestDampedDefective(int *failed)
{
  const PetscReal K[9] = {2, 1, 0, 1, 2.4, 0, 0, 0, 2.1}, H[9] = {0, -4. / 3},
                  C[9] = {0.02, 0, 0, 0, 0.02, 0, 0, 0, 0.05};
  static Run run;
  Dense      dense;

  PetscFunctionBeginUser;
  for (int hidden = 0; hidden < 2; hidden++) {
    DenseBegin(&dense, 3, hidden ? PETSC_TRUE : PETSC_FALSE);
    DenseAddUnitMass(&dense);
    DenseAdd(&dense, OPERATORS_STIFFNESS, -1, K);
    DenseAdd(&dense, OPERATORS_STIFFNESS, 0, H);
    DenseAdd(&dense, OPERATORS_DAMPING, -1, C);
    PetscCall(RunSweep(&dense, &everything, 0.58, 0.98, 5, &run));
    *failed += CheckTrue("events", run.events.n == 1, (double)run.events.n);
    *failed += CheckEvent("flutter", &run, 0, EVENT_LOCK_IN, 0.78066);
    *failed += CheckTrue("branches", run.n_branches == 3, (double)run.n_branches);
    PetscCall(RunDestroy(&run));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: the double zero of a rigid mode, in the state space of a damped system without a left vector of its own,
   spoils the match; a mode that leaves zero is lost; or a line on which damping begins is treated as undamped.
   Reference: diagonal, K = diag(0, p, 2 - p, 1.2), C = p diag(0, c, c, c): sigma = -p c / 2 where omega > 0 */
static PetscErrorCode TestRigid(int *failed)
{
  const PetscReal K[16]  = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1.2};
  const PetscReal K1[16] = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0};
  static Run      run;
  Dense           dense;

  PetscFunctionBeginUser;
  for (int c = 0; c < 3; c++) {
    const PetscReal d = c == 1 ? 0.02 : 1e-3, C[16] = {0, 0, 0, 0, 0, d, 0, 0, 0, 0, d, 0, 0, 0, 0, d};
    PetscInt        own;

    DenseBegin(&dense, 4, PETSC_TRUE);
    DenseAddUnitMass(&dense);
    DenseAdd(&dense, OPERATORS_STIFFNESS, -1, K);
    DenseAdd(&dense, OPERATORS_STIFFNESS, 0, K1);
    if (c) DenseAdd(&dense, OPERATORS_DAMPING, 0, C);
    printf("     %s\n", c ? "damping grows from zero" : "undamped");
    PetscCall(RunSweep(&dense, &everything, 0, 1.9, 9, &run));
    own = run.branch[0][2]; /* 0, 0, 1.2, 2 at p = 0 */
    *failed += CheckTrue("no event", run.events.n == 0, (double)run.events.n);
    *failed += CheckTrue("branches", run.n_branches == 4, (double)run.n_branches);
    *failed += CheckClose("1.2 stays", RunKappa(&run, 8, own), 1.2, 1e-3);
    *failed += CheckClose("2 - p", RunKappa(&run, 8, run.branch[0][3]), 0.1, 1e-3);
    *failed += CheckTrue("the rigid mode and the one that leaves zero",
                         fabs(RunKappa(&run, 8, 0) + RunKappa(&run, 8, 1) - 1.9) < 1e-3,
                         (double)(RunKappa(&run, 8, 0) + RunKappa(&run, 8, 1)));
    PetscCall(RunDestroy(&run));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestDefective(failed));
  PetscCall(TestDampedDefective(failed));
  PetscCall(TestDoubletLockIn(failed));
  PetscCall(TestRigid(failed));
  PetscCall(TestCoarse(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
