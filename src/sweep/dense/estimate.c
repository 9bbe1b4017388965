/*
   Errors of the eigenvalues of the reduced model, estimated from vectors Z of the basis [V Z] that the model does not
   use. Z is first made free of couplings to V at a real shift (complement.c), right Z_r = Z - V T and left Z_l = Z - V
   T'. With Q in blocks, elimination of the coordinates of Z leaves on V the exact

      Q_eff(lambda) = Q_vv - Q_vz Q_zz^-1 Q_zv,   Q_vz = V^T Q Z_r,  Q_zv = Z_l^T Q V,  Q_zz = Z_l^T Q Z_r.

   The model has Q_vv x = 0, y^T Q_vv = 0. With r = Q_zv(lambda) x, s = Q_vz(lambda)^T y and lambda + d in place of
   lambda

      0 = y^T Q_eff(lambda + d) x = d y^T Q_vv'(lambda) x - s^T Q_zz^-1 r + higher orders,
      d = s^T Q_zz(lambda)^-1 r / (y^T Q'(lambda) x),    y^T Q' x = 2 lambda y^T D x.

   Higher orders are small as Q_vz Q_zz^-1 Q_zv is small beside Q_vv on all of V, which takes the vectors Z_r and Z_l:
   of plain Z the couplings between stiff vectors are as large as their stiffness, and the first order alone was up to
   300 times too small.
   This is the customary y^T (residual) / (y^T Q' x) with the left vector improved in Z_l, [y; -Q_zz^-T s]: with the
   left vector of the model itself it is zero, since the residual is orthogonal to V (Galerkin). It is of second order,
   the product of the errors of the right and the left vector, and it estimates what Z adds: what lies outside [V Z] it
   cannot see. Without damping Q = K - kappa M is linear in kappa = -lambda^2, and

      d kappa = -s^T Q_zz^-1 r / (y^T M x),    d lambda = -d kappa / (lambda_new + lambda).

   Where eigenvalues are closer than NEAR_CHANGES times these changes (pairs close to defective, double modes), they
   are treated together (cluster.c), as the first order means nothing there: y^T D x tends to zero. A rigid mode has
   x^T K x = 0, and its error is the frequency that would turn it into, sqrt(|d kappa|).

   To each estimate a floor is added: what rounding does in the dense problem, SOLVER_ROUNDING eps sqrt(sum |K_ii|
   |x_i|^2 sum |K_ii| |y_i|^2) in kappa, and in the matrices of the mesh, MESH_ROUNDING eps sqrt(x^H E x y^H E y) with
   E = sum |c_t| V' |diag A_t| V, the energy without cancellation between neighbouring nodes.
*/
#include "estimate.h"

#define NEAR_CHANGES    20   /* eigenvalues closer than this many changes belong together */
#define FARTHEST        1e-2 /* but not if they are farther apart than this, relative: the basis is merely poor there */
#define MESH_ROUNDING   3    /* roundings of K on the mesh: its terms in a sum, products with it, their sums */
#define SOLVER_ROUNDING 16   /* errors of LU and QR of a dense problem beside rounding in its matrix: 8 were measured */
#define MEETING         1e-4 /* modes closer than this, relative, may meet */
/* Shift of the complement, times the largest |lambda|: Q_vv(h) = K + h C + h^2 M has no eigenvalue at a real h
   above all of them. Just above, a factor near 1 could meet a mode outside the window. */
#define ESTIMATE_ABOVE 1.7
#define EQUAL          1e-9 /* closer than this, relative, they always do */

/* Qx [m][n] = Q(lambda) V x, or Q(lambda)^T V x, in coordinates of the whole basis */
static PetscErrorCode PencilTimes(const Estimate *e, const PetscComplex lambda[], PetscBool left, PetscInt m,
                                  const PetscComplex x[], PetscComplex Qx[])
{
  const PetscReal *matrix[] = {e->pencil.K, e->pencil.C, e->pencil.M};
  const PetscInt   n        = e->pencil.n;
  PetscComplex    *part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m * n, &part));
  PetscCall(PetscArrayzero(Qx, m * n));
  for (int k = 0; k < 3; k++) {
    if (k == 1 && !e->pencil.damped) continue;
    PetscCall(DenseTimes(&(DenseBlock){matrix[k], n, e->n_v, n}, left, m, x, part));
    for (PetscInt a = 0; a < m; a++) {
      const PetscComplex power = k == 0 ? 1 : k == 1 ? lambda[a] : lambda[a] * lambda[a];

      for (PetscInt i = a * n; i < (a + 1) * n; i++) Qx[i] += power * part[i];
    }
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(0);
}

/* r [m][n_z] = Z_l^T Q(lambda) V x, or Z_r^T Q^T V y: with Qx of the whole basis and Z_l = Z - V T' the rows of Z
   less T'^T times those of V. The right side takes T' (left), the left side T (right). */
PetscErrorCode EstimateCouple(const Estimate *e, const PetscComplex lambda[], PetscBool left, PetscInt m,
                              const PetscComplex x[], PetscComplex r[])
{
  const PetscInt n_v = e->n_v, n_z = e->n_z, n = e->pencil.n;
  PetscComplex  *Qx, *top;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m * n, &Qx, m * n_v, &top));
  PetscCall(PencilTimes(e, lambda, left, m, x, Qx));
  for (PetscInt a = 0; a < m; a++) PetscCall(PetscArraycpy(top + a * n_v, Qx + a * n, n_v));
  PetscCall(DenseTimes(&(DenseBlock){left ? e->right : e->left, n_z, n_v, n_v}, PETSC_TRUE, m, top, r));
  for (PetscInt a = 0; a < m; a++)
    for (PetscInt i = 0; i < n_z; i++) r[a * n_z + i] = Qx[a * n + n_v + i] - r[a * n_z + i];
  PetscCall(PetscFree2(Qx, top));
  PetscFunctionReturn(0);
}

/* The same with real lambda^2 = square and no damping */
static PetscErrorCode SolveReal(const Estimate *e, PetscReal square, PetscInt m, PetscComplex r[], PetscBool *singular)
{
  const PetscInt n_z = e->n_z;
  PetscReal     *Q, *parts;
  PetscBLASInt  *pivot;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n_z * n_z, &Q, 2 * m * n_z, &parts, n_z, &pivot));
  for (PetscInt i = 0; i < n_z * n_z; i++) Q[i] = e->complement.K[i] + square * e->complement.M[i];
  DenseSplit(m * n_z, r, parts);
  PetscCall(DenseFactor(n_z, Q, pivot, singular));
  if (!*singular) PetscCall(DenseSolve(n_z, Q, pivot, PETSC_FALSE, 2 * m, parts));
  DenseUnite(m * n_z, parts, r);
  PetscCall(PetscFree3(Q, parts, pivot));
  PetscFunctionReturn(0);
}

/* r := Q_zz(lambda)^-1 r, [m][n_z]; undamped with a real lambda^2 by a real factorisation of both parts, at a
   quarter of the cost. */
PetscErrorCode EstimateSolve(const Estimate *e, PetscComplex lambda, PetscInt m, PetscComplex r[], PetscBool *singular)
{
  const PetscInt     n_z    = e->n_z;
  const PetscComplex square = lambda * lambda;
  PetscComplex      *Q;
  PetscBLASInt      *pivot;

  PetscFunctionBeginUser;
  if (!e->pencil.damped && cimag(square) == 0) {
    PetscCall(SolveReal(e, creal(square), m, r, singular));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc2(n_z * n_z, &Q, n_z, &pivot));
  DensePencilEvaluate(&e->complement, lambda, 0, n_z, Q);
  PetscCall(DenseComplexFactor(n_z, Q, pivot, singular));
  if (!*singular) PetscCall(DenseComplexSolve(n_z, Q, pivot, PETSC_FALSE, m, r));
  PetscCall(PetscFree2(Q, pivot));
  PetscFunctionReturn(0);
}

/* Where Z is made free of V: far enough above all modes for Q_vv to be regular, the largest of which may grow without
   oscillation, a real eigenvalue */
static PetscReal EstimateShift(const Estimate *e)
{
  PetscReal shift = 0;

  for (PetscInt i = 0; i < e->modes->n; i++) shift = PetscMax(shift, cabs(e->modes->lambda[i]));
  for (PetscInt i = 0; i < e->n_v && shift == 0; i++)
    shift = PetscSqrtReal(PetscAbsReal(e->pencil.K[i * (e->pencil.n + 1)] / e->pencil.M[i * (e->pencil.n + 1)]));
  return shift > 0 ? ESTIMATE_ABOVE * shift : 1;
}

static PetscErrorCode EstimateCreate(const Reduced *reduced, const PetscReal p[], const ReducedModes *modes,
                                     Estimate *e)
{
  PetscFunctionBeginUser;
  *e       = (Estimate){0};
  e->modes = modes;
  e->n_v   = reduced->n_used;
  e->n_z   = reduced->n - e->n_v;
  PetscCall(ReducedPencil(reduced, p, reduced->n, &e->pencil));
  e->form = (StandardForm){&e->pencil, e->n_v, e->pencil.damped, 1};
  if (e->n_z) PetscCall(EstimateComplement(e, EstimateShift(e)));
  PetscFunctionReturn(0);
}

static PetscErrorCode EstimateDestroy(Estimate *e)
{
  PetscFunctionBeginUser;
  if (e->n_z) PetscCall(DensePencilDestroy(&e->complement));
  if (e->n_z) PetscCall(PetscFree2(e->right, e->left));
  PetscCall(DensePencilDestroy(&e->pencil));
  PetscFunctionReturn(0);
}

/* a^H b */
static PetscReal Conjugated(PetscInt n, const PetscComplex a[], const PetscComplex b[])
{
  PetscComplex sum = 0;

  for (PetscInt i = 0; i < n; i++) sum += conj(a[i]) * b[i];
  return cabs(sum);
}

/* sharp = |s^T Q_zz^-1 r| of mode i with r and s [n_z], in the unit of kappa; f the same, but not below the mean of r
   and s each with itself: the product of right and left may pass through zero where neither does; not finite where
   Q_zz is singular */
static PetscErrorCode CoupleMode(const Estimate *e, PetscInt i, const PetscComplex r[], const PetscComplex s[],
                                 PetscReal *f, PetscReal *sharp)
{
  const PetscInt n = e->n_z;
  PetscComplex  *u, *v;
  PetscBool      singular;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &u));
  v = u + n;
  PetscCall(PetscArraycpy(u, r, n));
  PetscCall(PetscArraycpy(v, s, n));
  PetscCall(EstimateSolve(e, e->modes->lambda[i], 2, u, &singular));
  *sharp = singular ? INFINITY : cabs(DenseDot(n, s, u));
  *f     = PetscMax(*sharp, PetscSqrtReal(Conjugated(n, r, u)) * PetscSqrtReal(Conjugated(n, s, v)));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

/* Modes within MEETING of mode i, itself included, at least 2: so many can meet at a defective point */
static PetscInt ModesMeeting(const ReducedModes *modes, PetscInt i)
{
  PetscInt m = 0;

  for (PetscInt j = 0; j < modes->n; j++)
    if (cabs(modes->lambda[j] - modes->lambda[i]) <= MEETING * cabs(modes->lambda[i])) m++;
  return PetscMax(2, m);
}

/* |change| of kappa by a perturbation of size f, (rad/s)^2, of K: f / |y^T D x|, but not more than |kappa| (f /
   |kappa|)^(1/m), the m-th root that m modes meeting at a defective point have (V. B. Lidskii, USSR Comput. Math.
   Math. Phys. 6, 1966): near it y^T D x tends to zero and the first would be without bound. */
static PetscReal KappaChange(const ReducedModes *modes, PetscInt i, PetscReal f)
{
  const PetscReal size = cabs(modes->lambda[i]) * cabs(modes->lambda[i]), product = cabs(modes->product[i]);
  const PetscReal root = f < size ? size * PetscPowReal(f / size, 1 / (PetscReal)ModesMeeting(modes, i)) : f;

  return f < root * product ? f / product : root;
}

/* |change| of lambda, rad/s, from that of kappa = -lambda^2: dkappa / (2 |lambda|), or its root where that is
   larger than kappa itself. */
static PetscReal LambdaChange(const ReducedModes *modes, PetscInt i, PetscReal change)
{
  const PetscReal size = cabs(modes->lambda[i]);

  return modes->rigid[i] || change > size * size ? PetscSqrtReal(change) : change / (2 * size);
}

PetscReal ReducedLeftOut(const Reduced *reduced, const ReducedModes *modes, PetscInt i)
{
  const PetscReal size = cabs(modes->lambda[i]);

  return modes->rigid[i] ? 0 : LambdaChange(modes, i, KappaChange(modes, i, reduced->left_out * size * size));
}

/* change [modes] of each mode alone in the unit of s, error of lambda. A singular Q_zz means a mode of the
   complement at lambda itself: the error is then of the size of lambda. */
static PetscErrorCode Alone(const Estimate *e, ReducedModes *modes, PetscReal change[])
{
  const PetscInt n = e->n_z;
  PetscComplex  *r, *s;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(modes->n * n, &r, modes->n * n, &s));
  PetscCall(EstimateCouple(e, modes->lambda, PETSC_FALSE, modes->n, modes->x, r));
  PetscCall(EstimateCouple(e, modes->lambda, PETSC_TRUE, modes->n, modes->y, s));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscReal all = cabs(modes->lambda[i]) * cabs(modes->lambda[i]);
    PetscReal       f, sharp, kappa;

    PetscCall(CoupleMode(e, i, r + i * n, s + i * n, &f, &sharp));
    kappa           = isfinite(sharp) ? KappaChange(modes, i, sharp) : all;
    modes->sharp[i] = LambdaChange(modes, i, kappa);
    modes->error[i] = LambdaChange(modes, i, isfinite(sharp) ? KappaChange(modes, i, f) : all);
    change[i]       = e->pencil.damped ? modes->sharp[i] : kappa;
  }
  PetscCall(PetscFree2(r, s));
  PetscFunctionReturn(0);
}

/* Whether modes i and j belong together */
static PetscBool AreNear(const Estimate *e, const PetscReal change[], PetscInt i, PetscInt j)
{
  const ReducedModes *modes = e->modes;
  const PetscComplex  a = StandardValue(&e->form, modes->lambda[i]), b = StandardValue(&e->form, modes->lambda[j]);
  const PetscReal     reach = PetscMin(NEAR_CHANGES * PetscMax(change[i], change[j]), FARTHEST * cabs(a));

  if (modes->rigid[i] || modes->rigid[j]) return PETSC_FALSE;
  return cabs(a - b) <= PetscMax(reach, EQUAL * cabs(a)) ? PETSC_TRUE : PETSC_FALSE;
}

/* cluster[i] = number of the first mode of that of mode i */
static void Group(const Estimate *e, const PetscReal change[], PetscInt cluster[])
{
  const PetscInt n = e->modes->n;

  for (PetscInt i = 0; i < n; i++) cluster[i] = i;
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = i + 1; j < n; j++)
      if (cluster[i] != cluster[j] && AreNear(e, change, i, j)) ReducedClusterJoin(n, i, j, cluster);
}

/* |change| of lambda when s becomes another */
static PetscReal EstimateDistance(const Estimate *e, PetscComplex lambda, PetscComplex s)
{
  const PetscComplex now = e->pencil.damped ? s : csqrt(-s), d = s - StandardValue(&e->form, lambda);
  const PetscReal    sum = PetscMax(cabs(now + lambda), cabs(now - lambda)); /* of the two roots the nearer */

  if (e->pencil.damped) return cabs(s - lambda);
  return sum > 0 ? cabs(d) / sum : 0;
}

/* Errors of the modes of cluster number first, if it has more than one; what they were alone is replaced, except
   where Q_zz is singular. */
static PetscErrorCode Together(const Estimate *e, PetscInt first, const PetscInt cluster[], ReducedModes *modes)
{
  PetscInt     *list, m = 0;
  PetscComplex *s;
  PetscBool     singular = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(modes->n, &list, modes->n, &s));
  for (PetscInt i = first; i < modes->n; i++)
    if (cluster[i] == first) list[m++] = i;
  if (m > 1) PetscCall(EstimateCluster(e, m, list, s, &singular));
  for (PetscInt a = 0; a < m && m > 1 && !singular; a++)
    modes->error[list[a]] = modes->sharp[list[a]] = EstimateDistance(e, modes->lambda[list[a]], s[a]);
  PetscCall(PetscFree2(list, s));
  PetscFunctionReturn(0);
}

/* Adds what rounding does, in the matrices of the mesh and in the dense ones */
static PetscErrorCode AddFloor(const Estimate *e, const Reduced *reduced, const PetscReal p[], ReducedModes *modes)
{
  const PetscInt n = e->n_v;
  PetscReal     *E, *mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &E, modes->n, &mesh));
  PetscCall(RoundingEnergy(reduced, p, E));
  PetscCall(RoundingProducts(n, E, modes->n, modes->x, modes->y, mesh));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscReal own   = DensePencilNoise(&e->pencil, n, modes->x + i * n, modes->y + i * n);
    const PetscReal noise = SOLVER_ROUNDING * own + MESH_ROUNDING * mesh[i];

    modes->noise[i] = LambdaChange(modes, i, KappaChange(modes, i, noise));
    modes->error[i] += modes->noise[i];
    modes->sharp[i] += modes->noise[i];
  }
  PetscCall(PetscFree2(E, mesh));
  PetscFunctionReturn(0);
}

/* Not collective. error, sharp and noise of all modes, rad/s, are overwritten. Without Z (n = n_used) rounding
   alone is left. Cost: one LU of Q_zz(lambda) a mode, n_z^3, and one real LU of Q_vv. */
PetscErrorCode ReducedEstimate(const Reduced *reduced, const PetscReal p[], ReducedModes *modes)
{
  Estimate   e;
  PetscReal *change;
  PetscInt  *cluster;

  PetscFunctionBeginUser;
  if (!modes->n) PetscFunctionReturn(0);
  PetscCall(EstimateCreate(reduced, p, modes, &e));
  PetscCall(PetscMalloc2(modes->n, &change, modes->n, &cluster));
  PetscCall(PetscArrayzero(modes->error, modes->n));
  PetscCall(PetscArrayzero(modes->sharp, modes->n));
  if (e.n_z) {
    PetscCall(Alone(&e, modes, change));
    Group(&e, change, cluster);
    for (PetscInt i = 0; i < modes->n; i++)
      if (cluster[i] == i) PetscCall(Together(&e, i, cluster, modes));
  }
  PetscCall(AddFloor(&e, reduced, p, modes));
  PetscCall(PetscFree2(change, cluster));
  PetscCall(EstimateDestroy(&e));
  PetscFunctionReturn(0);
}

/* Modes beyond the growth of the window stay only where the basis knows them: estimated error at most window->rtol
   |lambda|, which needs vectors Z. All stay with rtol = PETSC_MAX_REAL, for a basis that is the whole space. */
PetscErrorCode ReducedDropInexact(const Reduced *reduced, const PetscReal p[], const ReducedWindow *window,
                                  ReducedModes *modes)
{
  PetscBool    outside = PETSC_FALSE;
  PetscInt     n       = 0, *list;
  ReducedModes all     = *modes;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < all.n; i++)
    if (PetscAbsReal(creal(all.lambda[i])) > window->growth) outside = PETSC_TRUE;
  if (!outside || window->rtol == PETSC_MAX_REAL) PetscFunctionReturn(0);
  PetscCall(ReducedEstimate(reduced, p, &all));
  PetscCall(PetscMalloc1(all.n, &list));
  for (PetscInt i = 0; i < all.n; i++) {
    const PetscBool known = reduced->n > reduced->n_used && all.error[i] <= window->rtol * cabs(all.lambda[i]);

    if (known || PetscAbsReal(creal(all.lambda[i])) <= window->growth) list[n++] = i;
  }
  PetscCall(ReducedModesSelect(&all, n, list, modes));
  PetscCall(PetscFree(list));
  PetscCall(ReducedModesDestroy(&all));
  PetscFunctionReturn(0);
}
