/*
   Operators: life cycle, access, and the pencil that the modes are computed from. Everything that is handed out is a
   sum of terms at the present values of the parameters, formed when it is asked for.
*/
#include "operatorsimpl.h"
#include "base/events.h"
#include <math.h>

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
  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_ASSEMBLE));
  if (operators->model) {
    PetscCall(OperatorsAssemble(operators));
    operators->n_body_terms = operators->base.n;
    PetscCall(OperatorsAddContactParameters(operators));
    PetscCall(OperatorsAddContact(operators));
  } else {
    PetscCall(OperatorsLoad(operators));
    operators->n_body_terms = operators->base.n;
  }
  operators->n_scene = operators->n_parameters;
  PetscCall(EventEnd(EVENT_ASSEMBLE));
  PetscFunctionReturn(0);
}

/* What each sum is made of */
static const struct {
  OperatorsTermKind kind;
  TermsChoice       choice;
  PetscBool         symmetric;   /* without friction and damping */
  SumKind           unprojected; /* the same sum when no constraint projects */
} sums[N_SUMS] = {
  [SUM_BODIES]  = {OPERATORS_STIFFNESS, TERMS_SYMMETRIC,   PETSC_TRUE,  SUM_BODIES},
  [SUM_K]       = {OPERATORS_STIFFNESS, TERMS_SYMMETRIC,   PETSC_TRUE,  SUM_K     },
  [SUM_M]       = {OPERATORS_MASS,      TERMS_ALL,         PETSC_TRUE,  SUM_M     },
  [SUM_C]       = {OPERATORS_DAMPING,   TERMS_ALL,         PETSC_FALSE, SUM_C     },
  [SUM_H]       = {OPERATORS_STIFFNESS, TERMS_UNSYMMETRIC, PETSC_FALSE, SUM_H     },
  [PROJECTED_K] = {OPERATORS_STIFFNESS, TERMS_SYMMETRIC,   PETSC_TRUE,  SUM_K     },
  [PROJECTED_M] = {OPERATORS_MASS,      TERMS_SYMMETRIC,   PETSC_TRUE,  SUM_M     },
  [PENCIL_K]    = {OPERATORS_STIFFNESS, TERMS_ALL,         PETSC_FALSE, PENCIL_K  },
  [PENCIL_M]    = {OPERATORS_MASS,      TERMS_ALL,         PETSC_FALSE, SUM_M     },
  [PENCIL_C]    = {OPERATORS_DAMPING,   TERMS_ALL,         PETSC_FALSE, SUM_C     },
};

/* One of the sums at the present values (borrowed); NULL when it vanishes */
static PetscErrorCode SumGet(Operators o, SumKind which, Mat *A)
{
  const Terms     bodies    = {o->n_body_terms, o->base.term};
  const SumKind   at        = o->Zr ? which : sums[which].unprojected;
  const PetscBool projected = o->Zr && at >= PROJECTED_K ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal mu        = OperatorsLargestMu(o);
  TermsSum       *sum       = &o->sum[at];

  PetscFunctionBeginUser;
  if (!sum->current) {
    if (projected) PetscCall(OperatorsProjectTerms(o));
    PetscCall(TermsSumForm(projected ? &o->projected : (at == SUM_BODIES ? &bodies : &o->base), sums[at].kind,
                           sums[at].choice, at == SUM_H && mu != 0 ? 1 / mu : 1, o->p, sum));
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

PetscErrorCode OperatorsGetBodies(Operators operators, Mat *K)
{
  PetscFunctionBeginUser;
  PetscCall(SumGet(operators, SUM_BODIES, K));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetInterface(Operators operators, PetscInt interface, PetscReal *mu, PetscReal *kn)
{
  const InterfaceParameters *q = &operators->interface[interface];
  const ContactInterface    *c;
  PetscInt                   n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(operators->contact, &n, &c));
  *mu = q->mu < 0 ? c[interface].mu : operators->p[q->mu];
  *kn = q->kn < 0 ? INFINITY : operators->p[q->kn];
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetTerms(Operators operators, PetscInt *n, const OperatorsTerm **terms)
{
  const Terms *list;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCheckLinear(operators));
  PetscCall(OperatorsProjectTerms(operators));
  list   = operators->Zr ? &operators->projected : &operators->base;
  *n     = list->n;
  *terms = list->term;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetPencil(Operators operators, OperatorsPencil *pencil)
{
  const Terms *terms;
  PetscBool    frictionless, same_mass;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCheckLinear(operators));
  PetscCall(OperatorsProjectTerms(operators));
  terms             = operators->Zr ? &operators->projected : &operators->base;
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
  PetscCall(OperatorsCreateNullSpaces(operators));
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

PetscErrorCode OperatorsGetSave(Operators operators, PetscBool *save)
{
  PetscFunctionBeginUser;
  *save = operators->save[0] ? PETSC_TRUE : PETSC_FALSE;
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
  PetscCall(OperatorsDestroyNullSpaces(o));
  PetscCall(TermsDestroy(&o->base));
  PetscCall(MatDestroy(&o->geometric));
  PetscCall(MatDestroy(&o->follower));
  PetscCall(PetscFree(o->group));
  PetscCall(PetscFree(o->interface));
  PetscCall(PetscFree(o->mu));
  PetscCall(PetscFree(o->parameter));
  PetscCall(PetscFree(o->p));
  PetscCall(PetscFree(*operators));
  PetscFunctionReturn(0);
}
