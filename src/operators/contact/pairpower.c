/*
   Power that friction gives to a mode at each pair. At constant amplitude, u = Re(x e^(i omega t)), the force -A u of a
   stiffness term has the mean power -(omega / 2) Im(x^H A x), the force -A u' of a damping term
   -(omega / 2) omega Re(x^H A x), W. With A = L'R, a row for each pair p, these are sums over the pairs of

      q_p = conj((L x)_p) (R x)_p .

   Exact contact, N u = 0 with forces N' - mu T', has pressures that no displacement tells. Its share in the balance
   (causes.c) is w = mu (Zl q)^H r of the forces r = (lambda^2 M + lambda C + K) x, Zl q = -n (T x)_p at a slave, so
   that

      w_p = -mu_p conj((T x)_p) n' (P'r)_p,   power -(omega / 2) Im w_p,

   P filling in displacements that follow others (constraint.c).
*/
#include "operators/pencilimpl.h"

const char *const PencilPowerNames[PENCIL_N_POWERS] = {[PENCIL_FRICTION]         = "friction",
                                                       [PENCIL_FRICTION_DAMPING] = "friction damping",
                                                       [PENCIL_FALLING_FRICTION] = "falling friction"};

/* y = A x of both parts, y made here; x[1] NULL where it is real, and its product zero */
static PetscErrorCode PartsMultiply(Mat A, const Vec x[2], Vec y[2])
{
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    PetscCall(MatCreateVecs(A, NULL, &y[k]));
    if (x[k]) PetscCall(MatMult(A, x[k], y[k]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PartsDestroy(Vec x[2])
{
  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&x[k]));
  PetscFunctionReturn(0);
}

/* form[rows of this rank] = conj(l_i) r_i */
static PetscErrorCode RowsForm(const Vec l[2], const Vec r[2], PetscComplex form[])
{
  const PetscScalar *lr, *li, *rr, *ri;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(l[0], &n));
  PetscCall(VecGetArrayRead(l[0], &lr));
  PetscCall(VecGetArrayRead(l[1], &li));
  PetscCall(VecGetArrayRead(r[0], &rr));
  PetscCall(VecGetArrayRead(r[1], &ri));
  for (PetscInt i = 0; i < n; i++) form[i] = CMPLX(lr[i], -li[i]) * CMPLX(rr[i], ri[i]);
  PetscCall(VecRestoreArrayRead(l[0], &lr));
  PetscCall(VecRestoreArrayRead(l[1], &li));
  PetscCall(VecRestoreArrayRead(r[0], &rr));
  PetscCall(VecRestoreArrayRead(r[1], &ri));
  PetscFunctionReturn(0);
}

/* Adds a term with rows, of kind `power` */
static PetscErrorCode TermAddPowers(Pencil pencil, const OperatorsTerm *term, PencilPower power, PetscReal omega,
                                    const Vec x[2], PetscReal powers[])
{
  const ContactPair *pair;
  PetscInt           n, n_all, row = 0;
  PetscComplex      *form;
  Vec                l[2], r[2];

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(pencil->operators->contact, &n, &n_all, &pair));
  PetscCall(PartsMultiply(term->left, x, l));
  PetscCall(PartsMultiply(term->right, x, r));
  PetscCall(PetscMalloc1(n, &form));
  PetscCall(RowsForm(l, r, form));
  for (PetscInt p = 0; p < n; p++) {
    if (pair[p].interface != term->interface || pencil->group[p] != term->group) continue;
    powers[p * PENCIL_N_POWERS + power] -=
      omega / 2 * term->scale * (term->kind == OPERATORS_DAMPING ? omega * creal(form[row]) : cimag(form[row]));
    row++;
  }
  PetscCall(PetscFree(form));
  PetscCall(PartsDestroy(l));
  PetscCall(PartsDestroy(r));
  PetscFunctionReturn(0);
}

/* r = P'(lambda^2 M + lambda C + K) x, of all unknowns, made here */
static PetscErrorCode ForcesCreate(Pencil pencil, PetscComplex lambda, const Vec x[2], Vec r[2])
{
  const Operators o = pencil->operators;
  PencilParts     parts;
  Vec             y, q;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParts(pencil, &parts));
  const Mat          A[] = {parts.K, parts.H, parts.C, parts.M};
  const PetscComplex c[] = {1, parts.mu, lambda, lambda * lambda};

  PetscCall(MatCreateVecs(parts.K, &y, NULL));
  for (int k = 0; k < 2; k++) {
    PetscCall(VecDuplicate(y, &r[k]));
    PetscCall(VecSet(r[k], 0));
  }
  for (int t = 0; t < 4; t++)
    for (int k = 0; k < 2 && A[t] && x[k]; k++) { /* c (i^k y) to the real and the imaginary part */
      PetscCall(MatMult(A[t], x[k], y));
      PetscCall(VecAXPY(r[0], k ? -cimag(c[t]) : creal(c[t]), y));
      PetscCall(VecAXPY(r[1], k ? creal(c[t]) : cimag(c[t]), y));
    }
  if (o->Z) PetscCall(MatCreateVecs(o->Z, &q, NULL));
  for (int k = 0; k < 2 && o->Z; k++) {
    PetscCall(MatMultTranspose(o->Z, r[k], q));
    PetscCall(MatMult(o->E, q, r[k]));
  }
  if (o->Z) PetscCall(VecDestroy(&q));
  for (int k = 0; k < 2 && pencil->T; k++) {
    PetscCall(MatMultTranspose(pencil->T, r[k], y));
    PetscCall(VecCopy(y, r[k]));
  }
  PetscCall(VecDestroy(&y));
  PetscFunctionReturn(0);
}

/* mu of a pair at the present point */
static PetscReal PairFriction(Pencil pencil, PetscInt interface, PetscInt pair)
{
  const InterfaceParameters *q  = &pencil->operators->interface[interface];
  PetscReal                  mu = 0;

  for (PetscInt k = 0; k < q->n_nodes; k++)
    mu += PencilFrictionShare(pencil, interface, k, pair, FRICTION_TANGENT) *
          FrictionFactorValue(&q->node[k], PETSC_FALSE, pencil->parameters.p);
  return mu;
}

/* n' r at the slave of a pair of this rank, r from its unknown `first` on */
static PetscReal PairNormal(const ContactPair *pair, PetscInt first, const PetscScalar r[])
{
  PetscReal normal = 0;

  for (int d = 0; d < 3; d++) normal += pair->n[d] * r[pair->slave[0].unknown[d] - first];
  return normal;
}

/* Adds the friction of n pairs of exact contact, `list` of this rank, r times omega / 2 */
static PetscErrorCode ExactAddPowers(Pencil pencil, PetscInt n, const PetscInt list[], const Vec x[2], const Vec r[2],
                                     PetscReal powers[])
{
  const ContactPair *pair;
  const PetscScalar *slip[2], *force[2];
  PetscInt           n_pairs, n_all, first;
  Mat                T;
  Vec                Tx[2];

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(pencil->operators->contact, &n_pairs, &n_all, &pair));
  PetscCall(ContactCreatePairOperators(pencil->operators->contact, n, list, NULL, &T, NULL));
  PetscCall(PartsMultiply(T, x, Tx));
  PetscCall(VecGetOwnershipRange(r[0], &first, NULL));
  for (int k = 0; k < 2; k++) {
    PetscCall(VecGetArrayRead(Tx[k], &slip[k]));
    PetscCall(VecGetArrayRead(r[k], &force[k]));
  }
  for (PetscInt i = 0; i < n; i++) {
    const ContactPair *own = &pair[list[i]];
    const PetscReal im = slip[0][i] * PairNormal(own, first, force[1]) - slip[1][i] * PairNormal(own, first, force[0]);

    powers[list[i] * PENCIL_N_POWERS + PENCIL_FRICTION] += PairFriction(pencil, own->interface, list[i]) * im;
  }
  for (int k = 0; k < 2; k++) {
    PetscCall(VecRestoreArrayRead(Tx[k], &slip[k]));
    PetscCall(VecRestoreArrayRead(r[k], &force[k]));
  }
  PetscCall(PartsDestroy(Tx));
  PetscCall(MatDestroy(&T));
  PetscFunctionReturn(0);
}

/* Adds the friction of all exact contact */
static PetscErrorCode ExactAddAll(Pencil pencil, PetscComplex lambda, const Vec x[2], PetscReal powers[])
{
  const ContactPair      *pair;
  const ContactInterface *interface;
  PetscInt                n, n_all, n_interfaces, n_exact = 0, *list;
  Vec                     r[2];

  PetscFunctionBeginUser;
  if (!pencil->n_left) PetscFunctionReturn(0);
  PetscCall(ContactGetPairs(pencil->operators->contact, &n, &n_all, &pair));
  PetscCall(ContactGetInterfaces(pencil->operators->contact, &n_interfaces, &interface));
  PetscCall(PetscMalloc1(n, &list));
  for (PetscInt p = 0; p < n; p++)
    if (interface[pair[p].interface].law == CONTACT_CONSTRAINT && pencil->group[p] >= 0) list[n_exact++] = p;
  PetscCall(ForcesCreate(pencil, lambda, x, r));
  for (int k = 0; k < 2; k++) PetscCall(VecScale(r[k], cimag(lambda) / 2));
  PetscCall(ExactAddPowers(pencil, n_exact, list, x, r, powers));
  PetscCall(PartsDestroy(r));
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilMeasurePairPowers(Pencil pencil, PetscReal sigma, PetscReal omega, Vec ur, Vec ui,
                                       PetscReal power[])
{
  const Vec x[2] = {ur, ui};

  PetscFunctionBeginUser;
  PetscCheck(omega > 0, pencil->comm, PETSC_ERR_ARG_OUTOFRANGE, "a real eigenvalue has no mean power");
  PetscCall(PetscArrayzero(power, pencil->n_pairs * PENCIL_N_POWERS));
  for (PetscInt t = 0; t < pencil->causing.n; t++) {
    const OperatorsTerm *term = &pencil->causing.term[t];

    for (int k = 0; k < PENCIL_N_POWERS && term->left; k++)
      if (!strcmp(term->cause_kind, PencilPowerNames[k]))
        PetscCall(TermAddPowers(pencil, term, (PencilPower)k, omega, x, power));
  }
  PetscCall(ExactAddAll(pencil, CMPLX(sigma, omega), x, power));
  PetscFunctionReturn(0);
}
