/*
   Unit test of solver/blockkrylov: eigenvalues nearest to a shift against closed forms, residuals of their vectors, for
   blocks of 1, 3 and 8 vectors and spaces so small that they restart; the same out to a distance from the shift alone, and
   of a problem and its transpose at once.

   References: 4 sin^2(k pi / (2 (n + 1))) of the second difference; a +- i c of blocks [a c; -c a]; a twice of [a 1; 0 a];
   the entries of a diagonal.
*/
#include "check.h"
#include "takenvectors.h"
#include "solver/block/krylov.h"

typedef struct {
  const char    *name;
  PetscInt       n, nev, ncv; /* ncv 0: the default */
  EPSProblemType type;
  PetscReal      shift, tolerance; /* of eigenvalues, beside their distance from the shift */
  PetscReal (*K)(PetscInt n, PetscInt i, PetscInt j);
  PetscReal (*M)(PetscInt i);
  void (*exact)(PetscInt n, PetscInt k, PetscReal value[2]); /* those of 0 <= k < n; infinite ones are HUGE_VAL */
} Case;

static PetscReal Difference(PetscInt n, PetscInt i, PetscInt j)
{
  (void)n;
  return i == j ? 2 : -1;
}

static void DifferenceExact(PetscInt n, PetscInt k, PetscReal value[2])
{
  value[0] = 4 * PetscSqr(sin((k + 1) * PETSC_PI / (2. * (n + 1))));
}

/* Twelve of each value */
static PetscReal Twelve(PetscInt n, PetscInt i, PetscInt j)
{
  (void)n;
  return i == j ? 1 + i / 12 : 0;
}

static void TwelveExact(PetscInt n, PetscInt k, PetscReal value[2])
{
  value[0] = Twelve(n, k, k);
}

/* Blocks of two: 1 + k/2 +- i (1 + k/2 mod 7) / 10 */
static PetscReal Turn(PetscInt n, PetscInt i, PetscInt j)
{
  const PetscReal c = 0.1 + 0.1 * (i / 2 % 7);

  (void)n;
  return i == j ? 1 + i / 2 : i / 2 == j / 2 ? (i < j ? c : -c) : 0;
}

static void TurnExact(PetscInt n, PetscInt k, PetscReal value[2])
{
  value[0] = Turn(n, k, k);
  value[1] = (0.1 + 0.1 * (k / 2 % 7)) * (k % 2 ? -1 : 1);
}

/* Blocks of two with one eigenvector each */
static PetscReal Defective(PetscInt n, PetscInt i, PetscInt j)
{
  (void)n;
  return i == j ? 1 + i / 2 : i / 2 == j / 2 && i < j ? 1 : 0;
}

static void DefectiveExact(PetscInt n, PetscInt k, PetscReal value[2])
{
  value[0] = Defective(n, k, k);
}

/* From 1 to 1e8 in n steps */
static PetscReal Spread(PetscInt n, PetscInt i, PetscInt j)
{
  return i == j ? pow(10, 8. * i / PetscMax(1, n - 1)) : 0;
}

static void SpreadExact(PetscInt n, PetscInt k, PetscReal value[2])
{
  value[0] = Spread(n, k, k);
}

static PetscReal One(PetscInt i)
{
  (void)i;
  return 1;
}

static PetscReal EveryThird(PetscInt i)
{
  return i % 3 ? 0 : 1;
}

/* The diagonal 1 + i with mass at every third */
static PetscReal Ramp(PetscInt n, PetscInt i, PetscInt j)
{
  (void)n;
  return i == j ? 1 + i : 0;
}

static void RampExact(PetscInt n, PetscInt k, PetscReal value[2])
{
  (void)n;
  value[0] = k % 3 ? HUGE_VAL : 1 + k;
}

static const Case cases[] = {
  {"second difference",                    200, 20, 0,  EPS_GHEP,  0.5,  1e-10, Difference, One,        DifferenceExact},
  {"second difference, restarts",          200, 20, 36, EPS_GHEP,  0.5,  1e-10, Difference, One,        DifferenceExact},
  {"second difference, unsymmetric way",   200, 20, 36, EPS_GNHEP, 0.5,  1e-10, Difference, One,        DifferenceExact},
  {"twelve of each",                       240, 40, 60, EPS_GHEP,  0.7,  1e-11, Twelve,     One,        TwelveExact    },
  {"twelve of each, unsymmetric way",      240, 40, 0,  EPS_GNHEP, 0.7,  1e-11, Twelve,     One,        TwelveExact    },
  {"complex pairs",                        200, 30, 0,  EPS_GNHEP, 30.3, 1e-10, Turn,       One,        TurnExact      },
  {"complex pairs, restarts",              200, 30, 46, EPS_GNHEP, 30.3, 1e-10, Turn,       One,        TurnExact      },
  {"one vector for two",                   60,  20, 0,  EPS_GNHEP, 10.3, 1e-5,  Defective,  One,        DefectiveExact },
  {"from 1 to 1e8, all",                   40,  40, 0,  EPS_GHEP,  -1,   1e-11, Spread,     One,        SpreadExact    },
  {"from 1 to 1e8, all, unsymmetric way",  40,  40, 0,  EPS_GNHEP, -1,   1e-9,  Spread,     One,        SpreadExact    },
  {"mass at every third, all",             50,  50, 0,  EPS_GHEP,  -1,   1e-11, Ramp,       EveryThird, RampExact      },
  {"mass at every third",                  150, 20, 36, EPS_GHEP,  -1,   1e-11, Ramp,       EveryThird, RampExact      },
  {"mass at every third, unsymmetric way", 150, 20, 36, EPS_GNHEP, -1,   1e-11, Ramp,       EveryThird, RampExact      },
  {"one",                                  1,   1,  0,  EPS_GHEP,  0.3,  1e-14, Ramp,       One,        DefectiveExact },
  {"two",                                  2,   2,  0,  EPS_GNHEP, 0.3,  1e-6,  Defective,  One,        DefectiveExact },
  {"five",                                 5,   5,  0,  EPS_GHEP,  0.3,  1e-13, Twelve,     One,        TwelveExact    },
};

#define RESIDUAL_LIMIT(c) ((c)->exact == SpreadExact ? 2e8 * PETSC_MACHINE_EPSILON : 1e-9) /* rounding of 1e8 beside 2 */
static PetscErrorCode MakeMatrices(const Case *c, Mat *K, Mat *M)
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, c->n, c->n, 3, NULL, 2, NULL, K));
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, c->n, c->n, 1, NULL, 0, NULL, M));
  PetscCall(MatGetOwnershipRange(*K, &first, &last));
  for (PetscInt i = first; i < last; i++) {
    for (PetscInt j = PetscMax(0, i - 1); j < PetscMin(c->n, i + 2); j++)
      PetscCall(MatSetValue(*K, i, j, c->K(c->n, i, j), INSERT_VALUES));
    PetscCall(MatSetValue(*M, i, i, c->M(i), INSERT_VALUES));
  }
  for (int m = 0; m < 2; m++) {
    PetscCall(MatAssemblyBegin(m ? *M : *K, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(m ? *M : *K, MAT_FINAL_ASSEMBLY));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeSolver(const Case *c, Mat K, Mat M, PetscInt block, EPS *eps)
{
  char value[16];
  ST   st;
  KSP  ksp;
  PC   pc;

  PetscFunctionBeginUser;
  block = PetscMin(block, c->n); /* larger ones are refused */
  if (c->ncv && c->ncv < c->n) block = PetscMin(block, (c->ncv - c->nev) / 2);
  PetscCall(PetscSNPrintf(value, sizeof(value), "%d", (int)block));
  PetscCall(PetscOptionsSetValue(NULL, "-eps_blockkrylovschur_size", value));
  PetscCall(EPSCreate(PETSC_COMM_WORLD, eps));
  PetscCall(EPSSetOperators(*eps, K, M));
  PetscCall(EPSSetProblemType(*eps, c->type));
  PetscCall(EPSSetType(*eps, EPSBLOCKKRYLOVSCHUR));
  PetscCall(EPSSetDimensions(*eps, c->nev, c->ncv ? c->ncv : PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(EPSSetTolerances(*eps, 1e-11, 500));
  PetscCall(EPSGetST(*eps, &st));
  PetscCall(STSetType(st, STSINVERT));
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(EPSSetWhichEigenpairs(*eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSSetTarget(*eps, c->shift));
  PetscCall(EPSSetFromOptions(*eps));
  PetscFunctionReturn(0);
}

static PetscReal Distance(const PetscReal value[2], PetscReal re, PetscReal im)
{
  return value[0] == HUGE_VAL ? HUGE_VAL : hypot(value[0] - re, value[1] - im);
}

/* The finite closed forms, `exact` of length n, nearest to the shift first; their number */
static PetscInt SortExact(const Case *c, PetscReal exact[][2])
{
  PetscInt n = 0;

  for (PetscInt k = 0; k < c->n; k++) {
    PetscReal value[2] = {0, 0};
    PetscInt  at       = n;

    c->exact(c->n, k, value);
    if (value[0] == HUGE_VAL) continue;
    for (; at > 0 && Distance(exact[at - 1], c->shift, 0) > Distance(value, c->shift, 0) * (1 + 1e-14); at--)
      for (int i = 0; i < 2; i++) exact[at][i] = exact[at - 1][i];
    for (int i = 0; i < 2; i++) exact[at][i] = value[i];
    n++;
  }
  return n;
}

/* Largest error of the eigenvalues found, each closed form of the nearest serving once, and largest residual
   |K x - kappa M x|, |x| = 1, both beside |kappa - shift| */
static PetscErrorCode Measure(const Case *c, EPS eps, PetscInt n_exact, PetscReal exact[][2], PetscReal worst[2])
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(EPSGetConverged(eps, &n));
  worst[0] = worst[1] = 0;
  for (PetscInt i = 0; i < n; i++) {
    PetscInt  nearest = 0;
    PetscReal kr, ki, residual;

    PetscCall(EPSGetEigenvalue(eps, i, &kr, &ki));
    for (PetscInt k = 1; k < PetscMin(n, n_exact); k++)
      if (Distance(exact[k], kr, ki) < Distance(exact[nearest], kr, ki)) nearest = k;
    worst[0]          = PetscMax(worst[0], Distance(exact[nearest], kr, ki) / hypot(kr - c->shift, ki));
    exact[nearest][0] = HUGE_VAL;
    PetscCall(EPSComputeError(eps, i, EPS_ERROR_ABSOLUTE, &residual));
    worst[1] = PetscMax(worst[1], residual / hypot(kr - c->shift, ki));
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a restart loses the decomposition, a complex pair is cut, locked vectors change, a block that lost its rank
   ends the search or brings vectors of the null space of M, copies of an eigenvalue beyond the block are missed */
static PetscErrorCode TestCase(const Case *c, PetscInt block, int *failed)
{
  PetscReal(*exact)[2], worst[2];
  PetscInt           n, n_exact;
  EPSConvergedReason reason;
  EPS                eps;
  Mat                K, M;

  PetscFunctionBeginUser;
  if (block == 1 && c->exact == TwelveExact && c->n > 12) PetscFunctionReturn(0); /* one vector finds one copy */
  PetscCall(PetscMalloc1(c->n + 1, &exact));
  n_exact = SortExact(c, exact);
  PetscCall(MakeMatrices(c, &K, &M));
  PetscCall(MakeSolver(c, K, M, block, &eps));
  PetscCall(EPSSolve(eps));
  PetscCall(EPSGetConverged(eps, &n));
  PetscCall(EPSGetConvergedReason(eps, &reason));
  PetscCall(Measure(c, eps, n_exact, exact, worst));
  printf("     %s, blocks of %d\n", c->name, (int)block);
  *failed += CheckTrue("as many as there are, or were asked for", n >= PetscMin(c->nev, n_exact) && n <= n_exact, n);
  *failed +=
    CheckTrue("it says that there are no more", (reason == EPS_DIVERGED_BREAKDOWN) == (n_exact < c->nev), reason);
  *failed += CheckClose("eigenvalues", worst[0], 0, c->tolerance) + CheckClose("residuals", worst[1], 0, RESIDUAL_LIMIT(c));
  PetscCall(EPSDestroy(&eps));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscCall(PetscFree(exact));
  PetscFunctionReturn(0);
}

/* Columns of a pair of blocks one by one; ctx is the KSP of K - shift M */
static PetscErrorCode SolveBoth(void *ctx, PetscInt n_right, Mat X)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  for (PetscInt j = 0; j < n; j++) {
    Vec b, x;

    PetscCall(MatDenseGetColumnVec(X, j, &x));
    PetscCall(VecDuplicate(x, &b));
    PetscCall(VecCopy(x, b));
    PetscCall(j < n_right ? KSPSolve((KSP)ctx, b, x) : KSPSolveTranspose((KSP)ctx, b, x));
    PetscCall(VecDestroy(&b));
    PetscCall(MatDenseRestoreColumnVec(X, j, &x));
  }
  PetscFunctionReturn(0);
}

/* The eigenvalues within a distance of 5.2: some 20, where 60 are asked for */
static PetscErrorCode CheckWithin(const Case *c, EPS eps, int *failed)
{
  PetscReal exact[241][2], worst[2];
  PetscInt  n, n_exact = SortExact(c, exact), within;
  PetscBool reached;

  PetscFunctionBeginUser;
  for (within = 0; Distance(exact[within], c->shift, 0) < 5.2;) within++;
  PetscCall(EPSGetConverged(eps, &n));
  PetscCall(BlockKrylovReached(eps, &reached));
  PetscCall(Measure(c, eps, n_exact, exact, worst));
  *failed += CheckTrue("all within the distance alone", n >= within && reached && n < c->nev && within > 10, n);
  *failed += CheckClose("eigenvalues", worst[0], 0, c->tolerance) + CheckClose("residuals", worst[1], 0, RESIDUAL_LIMIT(c));
  PetscFunctionReturn(0);
}

/* Breaks when: a space that grows beside another takes the columns of the other, or transposed and plain solves are
   exchanged, a solver forgets where its space was, or a solution ends before all within the distance are there */
static PetscErrorCode TestBoth(PetscInt block, int *failed)
{
  const Case c = {"both at once", 240, 60, 80, EPS_GNHEP, 60.3, 1e-10, Turn, One, TurnExact};
  EPS        eps[2];
  Mat        K[2], M;
  PetscBool  paired;
  ST         st;
  KSP        ksp;

  PetscFunctionBeginUser;
  PetscCall(MakeMatrices(&c, &K[0], &M));
  PetscCall(MatTranspose(K[0], MAT_INITIAL_MATRIX, &K[1]));
  for (int side = 0; side < 2; side++) {
    PetscCall(MakeSolver(&c, K[side], M, block, &eps[side]));
    PetscCall(BlockKrylovSetReach(eps[side], 5.2));
  }
  PetscCall(KeepColumnsApart(eps[1]));
  PetscCall(EPSSetUp(eps[0]));
  PetscCall(EPSGetST(eps[0], &st));
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(BlockKrylovSetOther(eps[0], eps[1], SolveBoth, ksp, &paired));
  *failed += CheckTrue("a problem and its transpose at once, in blocks of", paired, block);
  for (int side = 0; side < 2; side++) {
    PetscCall(EPSSolve(eps[side]));
    PetscCall(CheckWithin(&c, eps[side], failed));
    PetscCall(CheckTaken(&eps[side], failed));
    PetscCall(MatDestroy(&K[side]));
  }
  PetscCall(MatDestroy(&M));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscMPIInt size;
  PetscBool   all; /* on one rank each case in each block, on two every other case, on three the others; else a part of these */
  int         failed = 0;

  PetscFunctionBeginUser;
  PetscCall(SlepcInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-all", &all));
  PetscCall(BlockKrylovRegister());
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (int i = 0; i < (int)PETSC_STATIC_ARRAY_LENGTH(cases); i++)
    for (int b = 0; b < 3; b++)
      if ((size == 1 && all) || (b == i % 3 && (size == 1 || (i % 2 == size % 2 && (all || i % 8 == size % 8)))))
        PetscCall(TestCase(&cases[i], (PetscInt[]){1, 3, 8}[b], &failed));
  for (int b = 0; b < 3; b++)
    if (size == 1 || (all && b == (size == 2 ? 2 : 1))) PetscCall(TestBoth((PetscInt[]){1, 3, 8}[b], &failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(SlepcFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
