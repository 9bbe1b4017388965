/*
   Operators: life cycle, access, and the pencil that the modes are computed from. Everything that is handed out is a
   sum of terms at the present values of the parameters, formed when it is asked for.
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
    PetscCall(PetscOptionsReal("-contact_mu", "friction coefficient of K + mu H", "operators.h", operators->loaded_mu,
                               &operators->loaded_mu, NULL));
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
  OperatorsPencil pencil;

  PetscFunctionBeginUser;
  if (operators->model) {
    PetscCall(OperatorsAssemble(operators));
    PetscCall(OperatorsAddContact(operators));
    PetscCall(OperatorsCreateNullSpaces(operators));
  } else {
    PetscCall(OperatorsLoad(operators));
  }
  PetscCall(OperatorsGetPencil(operators, &pencil));
  if (operators->save[0]) PetscCall(OperatorsSave(operators));
  PetscFunctionReturn(0);
}

/* What each sum is made of */
static const struct {
  OperatorsTermKind kind;
  TermsChoice       choice;
  PetscBool         symmetric;   /* without friction and damping */
  SumKind           unprojected; /* the same sum when no constraint projects */
} sums[N_SUMS] = {
  [SUM_K]       = {OPERATORS_STIFFNESS, TERMS_SYMMETRIC,   PETSC_TRUE,  SUM_K   },
  [SUM_M]       = {OPERATORS_MASS,      TERMS_ALL,         PETSC_TRUE,  SUM_M   },
  [SUM_C]       = {OPERATORS_DAMPING,   TERMS_ALL,         PETSC_FALSE, SUM_C   },
  [SUM_H]       = {OPERATORS_STIFFNESS, TERMS_UNSYMMETRIC, PETSC_FALSE, SUM_H   },
  [PROJECTED_K] = {OPERATORS_STIFFNESS, TERMS_SYMMETRIC,   PETSC_TRUE,  SUM_K   },
  [PROJECTED_M] = {OPERATORS_MASS,      TERMS_SYMMETRIC,   PETSC_TRUE,  SUM_M   },
  [PENCIL_K]    = {OPERATORS_STIFFNESS, TERMS_ALL,         PETSC_FALSE, PENCIL_K},
  [PENCIL_M]    = {OPERATORS_MASS,      TERMS_ALL,         PETSC_FALSE, SUM_M   },
  [PENCIL_C]    = {OPERATORS_DAMPING,   TERMS_ALL,         PETSC_FALSE, SUM_C   },
};

/* One of the sums at the present values (borrowed); NULL when it vanishes */
static PetscErrorCode SumGet(Operators o, SumKind which, Mat *A)
{
  const SumKind   at        = o->Zr ? which : sums[which].unprojected;
  const PetscBool projected = o->Zr && at >= PROJECTED_K ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal mu        = OperatorsLargestMu(o);
  TermsSum       *sum       = &o->sum[at];

  PetscFunctionBeginUser;
  if (!sum->current) {
    if (projected) PetscCall(OperatorsProjectTerms(o));
    PetscCall(TermsSumForm(projected ? &o->projected : &o->base, sums[at].kind, sums[at].choice,
                           at == SUM_H && mu != 0 ? 1 / mu : 1, o->p, sum));
    if (sum->A)
      PetscCall(MatSetOption(sum->A, MAT_SYMMETRIC, sums[at].symmetric && o->symmetric ? PETSC_TRUE : PETSC_FALSE));
  }
  *A = sum->A;
  PetscFunctionReturn(0);
}

/* H: the one given, at any mu, or that of a model, which vanishes with mu */
static PetscErrorCode FrictionGet(Operators o, Mat *H)
{
  const OperatorsTerm *last = &o->base.term[o->base.n - 1];

  PetscFunctionBeginUser;
  if (o->model)
    PetscCall(SumGet(o, SUM_H, H));
  else
    *H = last->frictional ? last->A : NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetMatrices(Operators operators, Mat *K, Mat *M, Mat *C, Mat *H, PetscReal *mu)
{
  PetscFunctionBeginUser;
  if (K) PetscCall(SumGet(operators, SUM_K, K));
  if (M) PetscCall(SumGet(operators, SUM_M, M));
  if (C) PetscCall(SumGet(operators, SUM_C, C));
  if (H) PetscCall(FrictionGet(operators, H));
  if (mu) *mu = OperatorsLargestMu(operators);
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetTerms(Operators operators, PetscInt *n, const OperatorsTerm **terms)
{
  const Terms *list = operators->Zr ? &operators->projected : &operators->base;

  PetscFunctionBeginUser;
  PetscCall(OperatorsProjectTerms(operators));
  *n     = list->n;
  *terms = list->term;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetPencil(Operators operators, OperatorsPencil *pencil)
{
  const Terms *terms = operators->Zr ? &operators->projected : &operators->base;
  PetscBool    frictionless, same_mass;

  PetscFunctionBeginUser;
  PetscCall(OperatorsProjectTerms(operators));
  frictionless      = TermsVanish(terms, TERMS_UNSYMMETRIC, PETSC_FALSE, operators->p);
  same_mass         = TermsVanish(terms, TERMS_UNSYMMETRIC, PETSC_TRUE, operators->p);
  pencil->symmetric = operators->symmetric && frictionless ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SumGet(operators, frictionless ? PROJECTED_K : PENCIL_K, &pencil->K));
  PetscCall(SumGet(operators, same_mass ? PROJECTED_M : PENCIL_M, &pencil->M));
  PetscCall(SumGet(operators, PENCIL_C, &pencil->C));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetFrictionless(Operators operators, OperatorsPencil *pencil)
{
  PetscFunctionBeginUser;
  PetscCall(SumGet(operators, PROJECTED_K, &pencil->K));
  PetscCall(SumGet(operators, PROJECTED_M, &pencil->M));
  pencil->C         = NULL;
  pencil->symmetric = operators->symmetric;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsExpand(Operators operators, PetscBool left, Vec q, Vec u)
{
  Vec part;

  PetscFunctionBeginUser;
  if (!operators->Zr) {
    PetscCall(VecCopy(q, u));
    PetscFunctionReturn(0);
  }
  PetscCall(MatMult(operators->Zr, q, u));
  if (!left) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(u, &part));
  for (PetscInt i = 0; i < operators->n_left; i++) {
    PetscCall(MatMult(operators->left[i], q, part));
    PetscCall(VecAXPY(u, operators->p[operators->left_mu[i]], part));
  }
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsRestrict(Operators operators, Vec u, Vec q)
{
  PetscFunctionBeginUser;
  if (operators->E)
    PetscCall(MatMultTranspose(operators->E, u, q));
  else
    PetscCall(VecCopy(u, q));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCreateVec(Operators operators, Vec *u)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(operators->base.term[0].A, u, NULL));
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
  OperatorsPencil pencil;
  PetscInt        n, n_pencil;
  MatInfo         info;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetPencil(operators, &pencil));
  PetscCall(MatGetSize(operators->base.term[0].A, &n, NULL));
  PetscCall(MatGetSize(pencil.K, &n_pencil, NULL));
  PetscCall(MatGetInfo(pencil.K, MAT_GLOBAL_SUM, &info));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "operators: %" PetscInt_FMT " unknowns, %.0f nonzeros, %s, %s, %s mass\n", n_pencil, (double)info.nz_used,
    pencil.symmetric ? "no friction: symmetric" : "friction: unsymmetric",
    pencil.C ? "damped: quadratic problem" : "undamped", operators->lump ? "lumped" : "consistent"));
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
  for (int i = 0; i < N_OPERATORS; i++) PetscCall(PetscFree(o->dense[i]));
  for (int i = 0; i < N_SUMS; i++) PetscCall(TermsSumDestroy(&o->sum[i]));
  for (PetscInt i = 0; i < o->n_left; i++) PetscCall(MatDestroy(&o->left[i]));
  PetscCall(PetscFree2(o->left, o->left_mu));
  PetscCall(MatDestroy(&o->Zr));
  PetscCall(MatDestroy(&o->E));
  PetscCall(TermsDestroy(&o->projected));
  PetscCall(TermsDestroy(&o->base));
  PetscCall(PetscFree(o->interface_mu));
  PetscCall(PetscFree(o->mu));
  PetscCall(PetscFree(o->parameter));
  PetscCall(PetscFree(o->p));
  PetscCall(PetscFree(*operators));
  PetscFunctionReturn(0);
}
