/*
   Operators: life cycle, access, and the pencil that the modes are computed from.
*/
#include "operatorsimpl.h"

PetscErrorCode OperatorsCreate(MPI_Comm comm, Operators *operators)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, operators));
  (*operators)->comm      = comm;
  (*operators)->symmetric = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetModel(Operators operators, Model model, Contact contact)
{
  PetscFunctionBeginUser;
  operators->model   = model;
  operators->contact = contact;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetFromOptions(Operators operators)
{
  static const char *const masses[] = {"consistent", "lumped"};
  PetscInt                 mass     = 0;
  PetscBool                have;

  PetscFunctionBeginUser;
  PetscOptionsBegin(operators->comm, NULL, "Operators", NULL);
  PetscCall(OperatorsLoadFromOptions(operators, PetscOptionsObject));
  PetscCall(PetscOptionsEList("-operators_mass", "mass matrix of the bodies; lumped: row sums", "operators.h", masses,
                              2, masses[0], &mass, NULL));
  PetscCall(PetscOptionsString("-operators_save", "folder for K.bin, M.bin, C.bin, H.bin (PETSc binary)", "operators.h",
                               operators->save, operators->save, sizeof(operators->save), NULL));
  PetscCall(OperatorsHaveMatrices(operators, &have));
  if (have)
    PetscCall(PetscOptionsReal("-contact_mu", "friction coefficient of K + mu H", "operators.h", operators->mu,
                               &operators->mu, NULL));
  PetscOptionsEnd();
  operators->lump = mass == 1 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsHaveMatrices(Operators operators, PetscBool *have)
{
  PetscFunctionBeginUser;
  *have = PETSC_FALSE;
  for (int i = 0; i < N_OPERATORS; i++)
    if (operators->load[i][0] || operators->n_dense[i]) *have = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetUp(Operators operators)
{
  PetscFunctionBeginUser;
  if (operators->model) {
    PetscCall(OperatorsAssemble(operators));
    PetscCall(OperatorsAddContact(operators));
    PetscCall(OperatorsCreateNullSpaces(operators));
  } else {
    PetscCall(OperatorsLoad(operators));
  }
  if (operators->save[0]) PetscCall(OperatorsSave(operators));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetMatrices(Operators operators, Mat *K, Mat *M, Mat *C, Mat *H, PetscReal *mu)
{
  PetscFunctionBeginUser;
  if (K) *K = operators->A[OPERATOR_K];
  if (M) *M = operators->A[OPERATOR_M];
  if (C) *C = operators->A[OPERATOR_C];
  if (H) *H = operators->A[OPERATOR_H];
  if (mu) *mu = operators->mu;
  PetscFunctionReturn(0);
}

/* Zl' A Zr, or A itself (one more reference) without constraints; NULL stays NULL */
static PetscErrorCode Project(Mat A, Mat Zl, Mat Zr, Mat *projected)
{
  Mat AZ;

  PetscFunctionBeginUser;
  *projected = A;
  if (!A) PetscFunctionReturn(0);
  if (!Zr) {
    PetscCall(PetscObjectReference((PetscObject)A));
    PetscFunctionReturn(0);
  }
  PetscCall(MatMatMult(A, Zr, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &AZ));
  PetscCall(MatTransposeMatMult(Zl, AZ, MAT_INITIAL_MATRIX, PETSC_DEFAULT, projected));
  PetscCall(MatDestroy(&AZ));
  PetscFunctionReturn(0);
}

/* K + mu H; K itself (one more reference) when there is no friction */
static PetscErrorCode StiffnessCreate(Operators operators, Mat *K)
{
  Mat *const A = operators->A;

  PetscFunctionBeginUser;
  *K = A[OPERATOR_K];
  if (!A[OPERATOR_H] || operators->mu == 0) {
    PetscCall(PetscObjectReference((PetscObject)*K));
    PetscFunctionReturn(0);
  }
  PetscCall(MatDuplicate(A[OPERATOR_K], MAT_COPY_VALUES, K));
  PetscCall(MatSetOption(*K, MAT_SYMMETRIC, PETSC_FALSE));
  PetscCall(MatAXPY(*K, operators->mu, A[OPERATOR_H], DIFFERENT_NONZERO_PATTERN));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetPencil(Operators operators, OperatorsPencil *pencil)
{
  OperatorsPencil *p = &operators->pencil;
  Mat              K;

  PetscFunctionBeginUser;
  if (!p->K) {
    PetscCall(StiffnessCreate(operators, &K));
    p->symmetric = operators->symmetric && K == operators->A[OPERATOR_K] && operators->Zl == operators->Zr
                     ? PETSC_TRUE
                     : PETSC_FALSE;
    PetscCall(Project(K, operators->Zl, operators->Zr, &p->K));
    PetscCall(Project(operators->A[OPERATOR_C], operators->Zl, operators->Zr, &p->C));
    PetscCall(Project(operators->A[OPERATOR_M], operators->Zl, operators->Zr, &p->M));
    PetscCall(MatSetOption(p->K, MAT_SYMMETRIC, p->symmetric));
    PetscCall(MatSetOption(p->M, MAT_SYMMETRIC,
                           operators->symmetric && operators->Zl == operators->Zr ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(MatDestroy(&K));
  }
  *pencil = *p;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetFrictionless(Operators operators, OperatorsPencil *pencil)
{
  OperatorsPencil *p = &operators->frictionless;

  PetscFunctionBeginUser;
  if (!p->K) {
    PetscCall(Project(operators->A[OPERATOR_K], operators->Zr, operators->Zr, &p->K));
    PetscCall(Project(operators->A[OPERATOR_M], operators->Zr, operators->Zr, &p->M));
    p->symmetric = operators->symmetric;
    PetscCall(MatSetOption(p->K, MAT_SYMMETRIC, p->symmetric));
    PetscCall(MatSetOption(p->M, MAT_SYMMETRIC, p->symmetric));
  }
  *pencil = *p;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsExpand(Operators operators, PetscBool left, Vec q, Vec u)
{
  const Mat Z = left ? operators->Zl : operators->Zr;

  PetscFunctionBeginUser;
  if (Z)
    PetscCall(MatMult(Z, q, u));
  else
    PetscCall(VecCopy(q, u));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCreateVec(Operators operators, Vec *u)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(operators->A[OPERATOR_K], u, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetModel(Operators operators, Model *model, Contact *contact)
{
  PetscFunctionBeginUser;
  if (model) *model = operators->model;
  if (contact) *contact = operators->contact;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsView(Operators operators, PetscViewer viewer)
{
  PetscInt n, n_pencil;
  MatInfo  info;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetPencil(operators, &operators->pencil));
  PetscCall(MatGetSize(operators->A[OPERATOR_K], &n, NULL));
  PetscCall(MatGetSize(operators->pencil.K, &n_pencil, NULL));
  PetscCall(MatGetInfo(operators->pencil.K, MAT_GLOBAL_SUM, &info));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "operators: %" PetscInt_FMT " unknowns, %.0f nonzeros, %s, %s, %s mass\n", n_pencil, (double)info.nz_used,
    operators->pencil.symmetric ? "no friction: symmetric" : "friction: unsymmetric",
    operators->pencil.C ? "damped: quadratic problem" : "undamped", operators->lump ? "lumped" : "consistent"));
  if (n_pencil < n)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %" PetscInt_FMT " unknowns eliminated by the contact constraint\n",
                                     n - n_pencil));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsDestroy(Operators *operators)
{
  Operators o = *operators;

  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(0);
  for (int i = 0; i < N_OPERATORS; i++) {
    PetscCall(MatDestroy(&o->A[i]));
    PetscCall(PetscFree(o->dense[i]));
  }
  PetscCall(MatDestroy(&o->pencil.K));
  PetscCall(MatDestroy(&o->pencil.C));
  PetscCall(MatDestroy(&o->pencil.M));
  PetscCall(MatDestroy(&o->frictionless.K));
  PetscCall(MatDestroy(&o->frictionless.M));
  PetscCall(MatDestroy(&o->Zr));
  PetscCall(MatDestroy(&o->Zl));
  PetscCall(PetscFree(*operators));
  PetscFunctionReturn(0);
}
