/*
   Proof that there is no equilibrium, by a rigid motion. Let r be a motion that costs no energy in parts and springs,
   K r = 0. Whatever the displacements, equilibrium K u + sum_p B_p'l_p = f asks for

      r'f = sum_p (B_p r)'l_p

   with forces l_p that pair p can carry. When the loads push along r, r'f > 0, and no force of a pair works against it,

      sliding   (N r - mu T r)_p <= 0,      Coulomb   (N r)_p + mu |T r|_p <= 0      for all p,

   there is none (Farkas' lemma). Such a motion is what the loads leave when the pairs balance as much of them as they
   can (balance.c): with r_i'M r_j = delta_ij it is the least acceleration of the bodies. What is found is verified:
   contact forces that balance the loads all the same would have to be PROOF_RATIO times as large.
*/
#include "statics/staticsimpl.h"
#include "base/gather.h"

/* contact forces beside the loads: what needs more is no equilibrium of bodies that keep their shape */
#define PROOF_RATIO    1e6
#define PROOF_ROUNDING 1e-14 /* of the work of a pair's forces along a motion */
#define PROOF_PUSH     1e-8  /* force along the motion beside all forces */
#define FRICTION_NONE  1e-4  /* part of the friction that is none, given these */
#define FRICTION_STEPS 40    /* of the bisection for the friction that can be balanced */

/* What each free motion does to this rank's pairs */
static PetscErrorCode RigidPairsFill(const Active *a, const Hold *free, const RigidPairs *k, PetscReal local[])
{
  const PairRows    *rows = a->rows;
  const PetscScalar *along;
  PetscReal         *w;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n, &w));
  for (PetscInt j = 0; j < k->m; j++) {
    PetscCall(ComplianceGetRows(a->compliance, free->r[j], w));
    if (rows->S) PetscCall(MatMult(rows->S, free->r[j], a->compliance->row));
    PetscCall(VecGetArrayRead(a->compliance->row, &along));
    for (PetscInt p = 0; p < rows->n_pairs; p++) {
      PetscReal *const pair = &local[p * k->width];

      pair[0] = rows->slide[p];
      pair[1] = rows->law[p].mu;
      for (PetscInt i = 0; i < rows->law[p].d; i++) pair[2 + i * k->m + j] = w[rows->first[p] + i];
      if (rows->slide[p] != 0) pair[2 + k->m + j] = PetscRealPart(along[rows->first[p]]);
    }
    PetscCall(VecRestoreArrayRead(a->compliance->row, &along));
  }
  PetscCall(PetscFree(w));
  PetscFunctionReturn(0);
}

static PetscErrorCode RigidPairsCreate(const Active *a, const Hold *free, RigidPairs *k)
{
  PetscReal *local;

  PetscFunctionBeginUser;
  k->m     = free->n;
  k->width = 2 + 3 * k->m;
  PetscCall(PetscCalloc1(a->rows->n_pairs * k->width, &local));
  PetscCall(PetscMalloc1(k->m, &k->push));
  PetscCall(VecMDot(a->f, k->m, free->r, k->push));
  PetscCall(RigidPairsFill(a, free, k, local));
  PetscCall(
    GatherRecords(a->rows->comm, a->rows->n_pairs, (size_t)k->width * sizeof(PetscReal), local, &k->n_pairs, &k->pair));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* Whether no contact forces balance the loads, and the motion c [m] that proves it. worst is the largest work of a
   pair's forces along c, at most 0 but for rounding: forces that balance the loads all the same would sum to at least
   left^2 / worst, in the unit in which the longest edge is 1. */
static PetscErrorCode CertificateTry(const RigidPairs *k, PetscReal friction, PetscReal c[], PetscBool *proven)
{
  PetscReal worst, left = 0, whole = 0;

  PetscFunctionBeginUser;
  PetscCall(BalanceLoads(k, friction, c, &worst));
  for (PetscInt i = 0; i < k->m; i++) {
    left += PetscSqr(c[i]);
    whole += PetscSqr(k->push[i]);
  }
  left    = PetscSqrtReal(left);
  whole   = PetscSqrtReal(whole);
  *proven = left > 0 && left > PROOF_RATIO * whole * PetscMax(worst / left, PROOF_ROUNDING) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* The motion as displacements of all unknowns; whether the loads push along it by more than rounding */
static PetscErrorCode CertificateMotion(const Active *a, const Hold *free, const PetscReal c[], Vec r, PetscBool *push)
{
  PetscReal   largest;
  PetscScalar work;

  PetscFunctionBeginUser;
  PetscCall(VecSet(r, 0));
  PetscCall(VecMAXPY(r, free->n, c, free->r));
  PetscCall(VecNorm(r, NORM_INFINITY, &largest));
  PetscCall(VecDot(a->f, r, &work));
  *push = PetscRealPart(work) > PROOF_PUSH * a->size * largest ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Part of the friction that can be balanced, of which all cannot, and none can: 40 halvings of [0, 1], to 1e-12 */
static PetscErrorCode CertificateBisect(const RigidPairs *k, PetscReal *friction)
{
  PetscReal *c, most = 1;
  PetscBool  proven;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(k->m, &c));
  *friction = 0;
  for (int i = 0; i < FRICTION_STEPS; i++) {
    const PetscReal middle = (*friction + most) / 2;

    PetscCall(CertificateTry(k, middle, c, &proven));
    if (proven)
      most = middle;
    else
      *friction = middle;
  }
  PetscCall(PetscFree(c));
  PetscFunctionReturn(0);
}

/* friction: factor of all coefficients. A motion that proves it with friction but not without gives the largest
   factor that is not proven against, by bisection between 0 and 1. */
PetscErrorCode CertificateFind(const Active *a, PetscReal friction, Certificate *certificate)
{
  Hold       free = {.n = 0};
  RigidPairs k    = {.m = 0};
  PetscBool  push = PETSC_FALSE, without;
  PetscReal *c;
  Mat        K;

  PetscFunctionBeginUser;
  *certificate = (Certificate){.friction = 0};
  PetscCall(OperatorsGetBodies(a->operators, a->p, &K, NULL, NULL));
  PetscCall(FreeMotionsCreate(a->operators, a->p, K, &free));
  if (!free.n) PetscFunctionReturn(0);
  PetscCall(RigidPairsCreate(a, &free, &k));
  PetscCall(PetscMalloc1(k.m, &c));
  PetscCall(CertificateTry(&k, 0, c, &without));
  PetscCall(CertificateTry(&k, friction, c, &certificate->proven));
  if (certificate->proven) {
    PetscCall(VecDuplicate(a->u, &certificate->motion));
    PetscCall(CertificateMotion(a, &free, c, certificate->motion, &push));
    if (!without) PetscCall(CertificateBisect(&k, &certificate->friction));
    if (!push) PetscCall(VecDestroy(&certificate->motion));
  }
  certificate->proven       = (PetscBool)(certificate->proven && push);
  certificate->frictionless = without;
  PetscCall(PetscFree(c));
  PetscCall(PetscFree(k.pair));
  PetscCall(PetscFree(k.push));
  PetscCall(HoldDestroy(&free));
  PetscFunctionReturn(0);
}

PetscErrorCode CertificateCheck(const Active *a)
{
  Certificate certificate;
  char        moves[512];

  PetscFunctionBeginUser;
  PetscCall(CertificateFind(a, 1, &certificate));
  if (!certificate.proven) PetscFunctionReturn(0);
  PetscCall(RigidDescribe(a->operators, certificate.motion, sizeof(moves), moves));
  PetscCall(VecDestroy(&certificate.motion));
  PetscCheck(
    certificate.frictionless || PairRowsCoulomb(a->rows), a->rows->comm, PETSC_ERR_NOT_CONVERGED,
    "no sliding equilibrium%s: the loads with the friction %s, against which no force of a pair acts; friction "
    "may be at most %.7g of its value; lower the friction coefficient, or give -supports or -springs",
    a->place, moves, certificate.friction > FRICTION_NONE ? (double)certificate.friction : 0.0);
  PetscCheck(certificate.frictionless, a->rows->comm, PETSC_ERR_NOT_CONVERGED,
             "no equilibrium%s: the loads with the friction of what slides %s, against which no force of a pair acts; "
             "lower the friction coefficient of what slides, raise that of what holds, or give -supports or -springs",
             a->place, moves);
  SETERRQ(a->rows->comm, PETSC_ERR_NOT_CONVERGED,
          "no equilibrium%s: the loads %s, against which no force of a pair acts, %s friction; give -loads that press "
          "the contacts together, within their edges, %s-supports or -springs",
          a->place, moves, PairRowsCoulomb(a->rows) ? "with its" : "with or without",
          PairRowsCoulomb(a->rows) ? "a higher friction coefficient, " : "or ");
}
