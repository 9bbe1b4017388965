/*
   Compliance of the bodies seen from the contact. With contact displacements w = G u and internal forces l (N) of the
   pairs, equilibrium K u + G'l - S' D l = f, D = mu in the rows of sliding pairs, is the same as

      K_a u = f - G'(l - kappa w) + S' D l,   K_a = K + kappa G'G + pins,

   where K_a can be factored although contact alone holds a body. Where displacements follow others, u = Z q, K_a^-1
   stands for Z (Z'K_a Z)^-1 Z' everywhere, which forces of that constraint do not enter. Multiplied by G, with forces l
   / kappa (m):

      w + (W - V D) l - W w = G K_a^-1 f,   W = kappa G K_a^-1 G',   V = kappa G K_a^-1 S'.

   Eigenvalues of W lie in (0, 1]. Closed pairs have columns of W in the small system, open ones of I - W: kappa, a
   tenth of the mean stiffness of a slave node against its neighbours along n, keeps both off zero (GMRES then takes a
   third of the steps that it takes with all of it).
*/
#include "statics/pairs/small.h"
#include "base/gather.h"
#include "operators/terms/terms.h"
#include "solver/block/orthonormal.h"

/* of the stiffness of a node: the spectra of W and I - W, see above */
#define KAPPA_SHARE 0.1
/* right-hand sides at once: triangular solves in blocks, with memory of 64 vectors of all unknowns */
#define COMPLIANCE_BLOCK 64

/* kappa, N/m: KAPPA_SHARE of the mean of n' diag(K) n at the slaves. A held direction counts as 0. It depends on the
   pairs and the bodies alone, not on what is closed, so that the factorisation serves all statuses. */
static PetscErrorCode ComplianceFindKappa(Mat K, const PairRows *rows, PetscReal *kappa)
{
  PetscReal          sum[2] = {0, 0};
  const PetscScalar *diagonal;
  PetscInt           begin, end;
  Vec                d;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(K, &d, NULL));
  PetscCall(MatGetDiagonal(K, d));
  PetscCall(VecGetOwnershipRange(d, &begin, &end));
  PetscCall(VecGetArrayRead(d, &diagonal));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    sum[1] += 1;
    for (int i = 0; i < 3; i++) {
      const PetscInt row = rows->pair[p].slave[0].unknown[i];

      if (row >= begin && row < end) sum[0] += PetscSqr(rows->pair[p].n[i]) * PetscRealPart(diagonal[row - begin]);
    }
  }
  PetscCall(VecRestoreArrayRead(d, &diagonal));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, rows->comm));
  if (sum[0] == 0) PetscCall(VecSum(d, &sum[0])); /* every slave is held along n: any stiffness of the bodies will do */
  *kappa = KAPPA_SHARE * sum[0] / sum[1];
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceAugment(Mat K, const PairRows *rows, PetscReal kappa, PetscBool closed_only,
                                 const ContactStatus status[], Mat *A)
{
  PetscScalar *resists;
  Mat          GG;
  Vec          weight = NULL;

  PetscFunctionBeginUser;
  if (closed_only) {
    PetscCall(MatCreateVecs(rows->G, NULL, &weight));
    PetscCall(VecGetArray(weight, &resists));
    for (PetscInt p = 0; p < rows->n_pairs; p++)
      for (PetscInt i = rows->first[p]; i < rows->first[p + 1]; i++) resists[i] = status[p] != CONTACT_OPEN;
    PetscCall(VecRestoreArray(weight, &resists));
  }
  PetscCall(TermsProduct(1, rows->G, weight, rows->G, &GG));
  PetscCall(VecDestroy(&weight));
  PetscCall(MatDuplicate(K, MAT_COPY_VALUES, A));
  PetscCall(MatAXPY(*A, kappa, GG, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatSetOption(*A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatDestroy(&GG));
  PetscFunctionReturn(0);
}

/* Stores kappa R Y (without unit: N/m times m/N), the columns from `first` on, into local rows [rows][n_all]. W is
   symmetric, so that its rows, gathered one rank after the other, are its columns. */
static PetscErrorCode ComplianceTakeRows(const Compliance *c, Mat R, Mat Y, PetscInt first, PetscReal local[])
{
  const PairRows    *rows = c->rows;
  const PetscScalar *value;
  PetscInt           stride, n;
  Mat                RY;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(Y, NULL, &n));
  PetscCall(MatMatMult(R, Y, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &RY));
  PetscCall(MatDenseGetLDA(RY, &stride));
  PetscCall(MatDenseGetArrayRead(RY, &value));
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt i = 0; i < rows->n; i++)
      local[i * rows->n_all + first + k] = c->kappa * PetscRealPart(value[k * stride + i]);
  PetscCall(MatDenseRestoreArrayRead(RY, &value));
  PetscCall(MatDestroy(&RY));
  PetscFunctionReturn(0);
}

/* u = K_a^-1 b, K_s^-1 b where a status stands for it */
static PetscErrorCode ComplianceInvert(const Compliance *c, Vec b, Vec u)
{
  PetscFunctionBeginUser;
  if (c->Z) {
    PetscCall(MatMultTranspose(c->Z, b, c->reduced[0]));
    PetscCall(StatusFactorSolve(c->status, c->reduced[0], c->reduced[1]));
    PetscCall(MatMult(c->Z, c->reduced[1], u));
  } else {
    PetscCall(StatusFactorSolve(c->status, b, u));
  }
  PetscFunctionReturn(0);
}

/* u = Z q: of a residual r only Z'r must vanish. E Z'r puts it at the unknowns that q stands for (E'Z = I). */
PetscErrorCode ComplianceDropConstraint(const Compliance *c, Vec r)
{
  PetscFunctionBeginUser;
  if (!c->E) PetscFunctionReturn(0);
  PetscCall(MatMultTranspose(c->Z, r, c->reduced[0]));
  PetscCall(MatMult(c->E, c->reduced[0], r));
  PetscFunctionReturn(0);
}

/* Z'A Z in the place of A */
static PetscErrorCode ComplianceProject(Mat Z, Mat *A)
{
  Mat AZ, ZAZ;

  PetscFunctionBeginUser;
  PetscCall(MatMatMult(*A, Z, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AZ));
  PetscCall(MatTransposeMatMult(Z, AZ, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &ZAZ));
  PetscCall(MatProductClear(ZAZ));
  PetscCall(MatSetOption(ZAZ, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatDestroy(&AZ));
  PetscCall(MatDestroy(A));
  *A = ZAZ;
  PetscFunctionReturn(0);
}

/* W and V, n_all solutions with K_a in blocks. K_a is symmetric: the rows of S K_a^-1 G' are the columns of V = kappa
   G K_a^-1 S'. Memory: 8 n_all^2 bytes for each, on every rank. */
static PetscErrorCode ComplianceFormDense(Compliance *c)
{
  const PairRows *rows  = c->rows;
  const PetscInt  n_all = rows->n_all;
  PetscInt        n_unknowns;
  PetscReal      *local[2];
  Mat             Gt;
  Progress        progress;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(c->u, &n_unknowns));
  PetscCall(MatTranspose(rows->G, MAT_INITIAL_MATRIX, &Gt));
  PetscCall(PetscMalloc2(rows->n * n_all, &local[0], rows->n * n_all, &local[1]));
  PetscCall(ProgressBegin(&progress, "contact compliance, blocks", (n_all + COMPLIANCE_BLOCK - 1) / COMPLIANCE_BLOCK));
  for (PetscInt first = 0; first < n_all; first += COMPLIANCE_BLOCK) {
    const PetscInt n = PetscMin(COMPLIANCE_BLOCK, n_all - first);
    Mat            B, Y;

    PetscCall(MatCreateDense(rows->comm, n_unknowns, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, &B));
    PetscCall(BlockTakeColumns(Gt, first, B));
    PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &Y));
    PetscCall(ShiftInvertApplyThrough(&c->inverse, c->Z, B, Y));
    PetscCall(ComplianceTakeRows(c, rows->G, Y, first, local[0]));
    if (rows->S) PetscCall(ComplianceTakeRows(c, rows->S, Y, first, local[1]));
    PetscCall(MatDestroy(&B));
    PetscCall(MatDestroy(&Y));
    PetscCall(ProgressStep(&progress));
  }
  PetscCall(ProgressEnd(&progress));
  PetscCall(GatherRecords(rows->comm, rows->n, (size_t)n_all * sizeof(PetscReal), local[0], NULL, &c->W));
  if (rows->S) PetscCall(GatherRecords(rows->comm, rows->n, (size_t)n_all * sizeof(PetscReal), local[1], NULL, &c->V));
  PetscCall(PetscFree2(local[0], local[1]));
  PetscCall(MatDestroy(&Gt));
  PetscFunctionReturn(0);
}

/* Order: pins are chosen from K + kappa G'G of all pairs, that is of motions which no pair resists even when all are
   closed, before followers are eliminated */
PetscErrorCode ComplianceCreate(Operators operators, const PetscReal p[], const PairRows *rows, PetscInt max_rows,
                                Progress *progress, Compliance *c)
{
  PencilMatrices pencil = {.symmetric = PETSC_TRUE};
  Mat            K;

  PetscFunctionBeginUser;
  c->rows = rows;
  PetscCall(OperatorsGetBodies(operators, p, &K, &pencil.M, NULL));
  PetscCall(ComplianceFindKappa(K, rows, &c->kappa));
  PetscCall(ComplianceAugment(K, rows, c->kappa, PETSC_FALSE, NULL, &pencil.K));
  PetscCall(HoldCreate(operators, p, pencil.K, &c->hold));
  PetscCall(OperatorsGetDependents(operators, &c->Z, &c->E));
  PetscCall(PetscObjectReference((PetscObject)pencil.M));
  if (c->Z) {
    PetscCall(MatCreateVecs(c->Z, &c->reduced[0], NULL));
    PetscCall(VecDuplicate(c->reduced[0], &c->reduced[1]));
    PetscCall(ComplianceProject(c->Z, &pencil.K));
    PetscCall(ComplianceProject(c->Z, &pencil.M));
  }
  PetscCall(ShiftInvertCreate(&pencil, 0, PETSC_FALSE, progress, &c->inverse));
  if (rows->n_all <= max_rows)
    PetscCall(MatDestroy(&pencil.K));
  else
    c->Ka = pencil.K;
  PetscCall(MatDestroy(&pencil.M));
  PetscCall(MatDestroy(&c->inverse.term[0])); /* which is factored once, from a copy */
  PetscCall(MatCreateVecs(K, &c->u, &c->b));
  PetscCall(MatCreateVecs(rows->G, NULL, &c->row));
  PetscCall(StatusFactorCreate(c, &c->status));
  if (rows->n_all <= max_rows) PetscCall(ComplianceFormDense(c));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceAddForces(const Compliance *c, PetscReal friction, const PetscReal l[], const PetscReal w[],
                                   Vec b)
{
  const PairRows  *rows  = c->rows;
  const PetscReal *slide = StatusFactorSlide(c->status); /* NULL on a rank without rows too */
  PetscReal       *Xw;
  PetscScalar     *value;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(rows->n, &Xw));
  if (w) StatusFactorHold(c->status, w, Xw);
  PetscCall(VecGetArray(c->row, &value));
  for (PetscInt i = 0; i < rows->n; i++) value[i] = c->kappa * (Xw[i] - (l ? l[i] : 0));
  PetscCall(VecRestoreArray(c->row, &value));
  PetscCall(MatMultTransposeAdd(rows->G, c->row, b, b));
  if (rows->S && (friction != 0 || StatusFactorServes(c->status))) {
    PetscCall(VecSet(c->row, 0));
    PetscCall(VecGetArray(c->row, &value));
    for (PetscInt p = 0; p < rows->n_pairs; p++) {
      const PetscInt i = rows->first[p];

      if (friction != 0) value[i] = c->kappa * friction * rows->slide[p] * l[i];
      if (slide) value[i] -= c->kappa * slide[i] * Xw[i];
    }
    PetscCall(VecRestoreArray(c->row, &value));
    PetscCall(MatMultTransposeAdd(rows->S, c->row, b, b));
  }
  PetscCall(PetscFree(Xw));
  PetscFunctionReturn(0);
}

/* (K + pins) u = K_a u - kappa G'G u; where there is Z it is E Z'K_a Z E'u, with q = E'u */
PetscErrorCode ComplianceResidual(const Compliance *c, PetscReal friction, Vec f, const PetscReal l[], Vec u, Vec r)
{
  PetscFunctionBeginUser;
  if (c->Z) {
    PetscCall(MatMultTranspose(c->E, u, c->reduced[0]));
    PetscCall(MatMult(c->Ka, c->reduced[0], c->reduced[1]));
    PetscCall(MatMult(c->E, c->reduced[1], r));
  } else {
    PetscCall(MatMult(c->Ka, u, r));
  }
  PetscCall(VecAYPX(r, -1, f));
  PetscCall(MatMult(c->rows->G, u, c->row));
  PetscCall(VecScale(c->row, c->kappa));
  PetscCall(MatMultTransposeAdd(c->rows->G, c->row, r, r));
  PetscCall(ComplianceAddForces(c, friction, l, NULL, r));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceSolve(const Compliance *c, PetscReal friction, Vec f, const PetscReal l[], const PetscReal w[],
                               Vec u)
{
  PetscFunctionBeginUser;
  if (f)
    PetscCall(VecCopy(f, c->b));
  else
    PetscCall(VecSet(c->b, 0));
  PetscCall(ComplianceAddForces(c, friction, l, w, c->b));
  PetscCall(ComplianceInvert(c, c->b, u));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceGetRows(const Compliance *c, Vec u, PetscReal w[])
{
  PetscFunctionBeginUser;
  PetscCall(VecPlaceArray(c->row, w));
  PetscCall(MatMult(c->rows->G, u, c->row));
  PetscCall(VecResetArray(c->row));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceApply(const Compliance *c, PetscReal friction, const PetscReal l[], const PetscReal w[],
                               PetscReal y[])
{
  PetscFunctionBeginUser;
  PetscCall(ComplianceSolve(c, friction, NULL, l, w, c->u));
  PetscCall(ComplianceGetRows(c, c->u, y));
  for (PetscInt i = 0; i < c->rows->n; i++) y[i] = w[i] - y[i];
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceDestroy(Compliance *c)
{
  PetscFunctionBeginUser;
  PetscCall(StatusFactorDestroy(&c->status));
  PetscCall(ShiftInvertDestroy(&c->inverse));
  PetscCall(MatDestroy(&c->Ka));
  PetscCall(HoldDestroy(&c->hold));
  PetscCall(VecDestroy(&c->u));
  PetscCall(VecDestroy(&c->b));
  PetscCall(VecDestroy(&c->row));
  for (int i = 0; i < 2; i++) PetscCall(VecDestroy(&c->reduced[i]));
  PetscCall(PetscFree(c->W));
  PetscCall(PetscFree(c->V));
  PetscFunctionReturn(0);
}
