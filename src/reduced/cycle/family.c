/*
   Reduced models over a parameter p of the bodies (a modulus, a density, stiffness of springs, damping). The bodies are
   reduced at the Chebyshev points of a range, with as many modes as in the scene, and what lies between is interpolated
   (parametric reduction by interpolation of matrices: H. Panzer, J. Mohring, R. Eid, B. Lohmann, at -
   Automatisierungstechnik 58, 2010, 475). Modes Phi_k at p_k have signs, an order and among equal frequencies
   directions of their own: coordinates eta of the scene's modes Phi become

      eta_k = T_k eta,    T_k the orthogonal polar factor of Phi_k'M_k Phi,    so that Phi_k T_k is as near to Phi as
      can be,

   and with them smooth functions of t are

      K_k = T_k'Omega_k^2 T_k,   T_k'C_k T_k,   P_k T_k,   W_k,   Cm_k T_k,   Cx_k.

   t in [-1, 1] is linear in log p, in which what goes with p or 1 / p converges fastest, or in p where the range begins
   at 0. At p K = Q Omega^2 Q' has the modes of the model again, of which the coordinates are Q'eta.

   5 points become 9 and 17 of them until the last coefficients of the Chebyshev series fall below FAMILY_RTOL of the
   largest entry, those of K_ij below FAMILY_RTOL omega_i omega_j: what the series leaves out is smaller.
*/
#include "cycleimpl.h"
#include <petsctime.h>

/* Chebyshev points cos(pi k / (n - 1)): those of n are among those of 2 n - 1. */
#define FAMILY_FEWEST 5
/* Of points, each a whole reduction; a range that needs more is refused. */
#define FAMILY_MOST 17
#define FAMILY_RTOL 1e-6
/* Least over largest singular value of Phi_k'M_k Phi, squared: below it some combination of the modes has less than
   a tenth of its length in the other set. */
#define FAMILY_ALIKE  1e-2
#define FAMILY_RIGID  1e-13 /* of the largest: squares of frequencies that are rounding of 0 */
#define FAMILY_BEYOND 1.1   /* |t| to which is extrapolated */

/* Sizes of the matrices that depend on p, 0 for one that is not there */
static void FamilyListSizes(const ReducedModel *model, PetscInt size[FAMILY_N_PARTS])
{
  const PetscInt m = model->m, n = 3 * model->n_pairs, N = model->n_ports;

  size[FAMILY_K]  = m * m;
  size[FAMILY_C]  = model->C ? m * m : 0;
  size[FAMILY_P]  = m * N;
  size[FAMILY_W]  = N * N;
  size[FAMILY_CM] = model->Cm ? m * n : 0;
  size[FAMILY_CX] = model->Cx ? n * n : 0;
}

/* t of p; a value at or below 0 of a logarithmic range is far outside. */
static PetscReal FamilyCoordinate(const CycleFamily *f, PetscReal p)
{
  const PetscReal a = f->logarithmic ? PetscLogReal(f->range[0]) : f->range[0];
  const PetscReal b = f->logarithmic ? PetscLogReal(f->range[1]) : f->range[1];
  const PetscReal x = f->logarithmic ? PetscLogReal(PetscMax(p, PETSC_SMALL * f->range[0])) : p;

  return (2 * x - a - b) / (b - a);
}

PetscBool CycleFamilyHolds(const CycleFamily *f, PetscReal value)
{
  return PetscAbsReal(FamilyCoordinate(f, value)) <= FAMILY_BEYOND ? PETSC_TRUE : PETSC_FALSE;
}

static PetscReal FamilyValue(const CycleFamily *f, PetscReal t)
{
  const PetscReal a = f->range[0], b = f->range[1], part = 0.5 * (1 + t);

  if (t <= -1) return a;
  if (t >= 1) return b;
  return f->logarithmic ? a * PetscPowReal(b / a, part) : a + part * (b - a);
}

/* S = V diag(1 / sqrt(w)) V', [m][m] by columns: with A'A = V diag(w) V' the polar factor is A S. */
static void FamilyInvertRoot(PetscInt m, const PetscReal V[], const PetscReal w[], PetscReal S[])
{
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < m; i++) {
      S[i + m * j] = 0;
      for (PetscInt k = 0; k < m; k++) S[i + m * j] += V[i + m * k] * V[j + m * k] / PetscSqrtReal(w[k]);
    }
}

/* T [m][m] = A (A'A)^-1/2, A = Phi_k'M_k Phi, the orthogonal factor of the bodies `at` the value that they have. */
static PetscErrorCode FamilyAlign(CycleFamily *f, ReducedRun at, PetscReal value, PetscReal T[])
{
  const PetscInt m = f->scene->reduction.model.m;
  PetscReal     *A, *V, *S, *w;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(m * m, &A, m * m, &V, m * m, &S, m, &w));
  PetscCall(BlockGram(at->reduction.MPhi, f->scene->reduction.Phi, A));
  ReducedTimesTransposed(&(DenseBlock){A, m, m, m}, &(DenseBlock){A, m, m, m}, V);
  PetscCall(DenseSymmetricEigen(m, V, NULL, w, NULL));
  PetscCheck(w[0] > FAMILY_ALIKE * w[m - 1], f->scene->comm, PETSC_ERR_USER_INPUT,
             "-cycle_range: modes of the bodies at %s %.6g do not resemble those of the scene at %.6g: take a smaller "
             "range, or a higher -dynamics_cutoff",
             f->parameter->name, (double)value, (double)f->parameter->value);
  FamilyInvertRoot(m, V, w, S);
  ReducedTimes(&(DenseBlock){A, m, m, m}, &(DenseBlock){S, m, m, m}, T);
  PetscCall(PetscFree4(A, V, S, w));
  PetscFunctionReturn(0);
}

/* T'S T */
static PetscErrorCode FamilyTurn(PetscInt m, const PetscReal S[], const PetscReal T[], PetscReal out[])
{
  PetscReal *ST;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m * m, &ST));
  ReducedTimes(&(DenseBlock){S, m, m, m}, &(DenseBlock){T, m, m, m}, ST);
  ReducedTimesTransposed(&(DenseBlock){T, m, m, m}, &(DenseBlock){ST, m, m, m}, out);
  PetscCall(PetscFree(ST));
  PetscFunctionReturn(0);
}

/* Matrices of a reduced model in the coordinates eta, T [m][m] */
static PetscErrorCode FamilyTakeModel(CycleFamily *f, const ReducedModel *model, const PetscReal T[], PetscReal *part[])
{
  const PetscInt   m = model->m, n = 3 * model->n_pairs, N = model->n_ports;
  const DenseBlock turn = {T, m, m, m};
  PetscReal       *omega2;

  PetscFunctionBeginUser;
  for (int k = 0; k < FAMILY_N_PARTS; k++) PetscCall(PetscMalloc1(f->size[k], &part[k]));
  PetscCall(PetscCalloc1(m * m, &omega2));
  for (PetscInt i = 0; i < m; i++) omega2[i + m * i] = model->omega2[i];
  PetscCall(FamilyTurn(m, omega2, T, part[FAMILY_K]));
  PetscCall(PetscFree(omega2));
  if (model->C) PetscCall(FamilyTurn(m, model->C, T, part[FAMILY_C]));
  ReducedTimesTransposed(&turn, &(DenseBlock){model->P, m, N, m}, part[FAMILY_P]);
  PetscCall(PetscArraycpy(part[FAMILY_W], model->W, N * N));
  if (model->Cm) ReducedTimesTransposed(&turn, &(DenseBlock){model->Cm, m, n, m}, part[FAMILY_CM]);
  if (model->Cx) PetscCall(PetscArraycpy(part[FAMILY_CX], model->Cx, n * n));
  PetscFunctionReturn(0);
}

/* Reduces the bodies at t */
static PetscErrorCode FamilyReduce(CycleFamily *f, PetscReal t, PetscReal *part[])
{
  const PetscReal value = FamilyValue(f, t), was = f->p[f->parameter->index];
  PetscBool       same;
  PetscReal       rise;
  PetscReal      *T;
  ReducedRun      at;

  PetscFunctionBeginUser;
  PetscCall(ReducedParameterGetRise(f->parameter, value, &rise));
  f->p[f->parameter->index] = value;
  PetscCall(ReducedReduceAt(f->scene, rise * f->scene->request.cutoff, f->p, f->scene, &at));
  f->p[f->parameter->index] = was;
  same                      = !at->reduction.model.C == !f->scene->reduction.model.C ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(same, f->scene->comm, PETSC_ERR_USER_INPUT,
             "-cycle_parameter %s: the bodies are damped at some of its values only; give the scene a damping that is "
             "there at all of them",
             f->parameter->name);
  PetscCall(PetscMalloc1(PetscSqr(at->reduction.model.m), &T));
  PetscCall(FamilyAlign(f, at, value, T));
  PetscCall(FamilyTakeModel(f, &at->reduction.model, T, part));
  PetscCall(PetscFree(T));
  PetscCall(ReducedDestroy(&at));
  f->n_reductions++;
  PetscFunctionReturn(0);
}

/* Weight of point k in the j-th coefficient of the Chebyshev series through n points (discrete cosine transform of
   type I, ends halved). */
static PetscReal FamilyCosine(PetscInt n, PetscInt j, PetscInt k)
{
  const PetscReal ends = (k == 0 || k == n - 1 ? 0.5 : 1) * (j == 0 || j == n - 1 ? 0.5 : 1);

  return 2 * ends * PetscCosReal(PETSC_PI * (PetscReal)(j * k) / (PetscReal)(n - 1)) / (PetscReal)(n - 1);
}

/* The larger of the last two coefficients of an entry; `largest` becomes its size where that is larger */
static PetscReal FamilyLast(const CycleFamily *f, int part, PetscInt i, PetscReal *largest)
{
  const PetscInt n    = f->n;
  PetscReal      c[2] = {0, 0};

  for (PetscInt k = 0; k < n; k++) {
    const PetscReal a = f->part[k][part][i];

    *largest = PetscMax(*largest, PetscAbsReal(a));
    c[0] += FamilyCosine(n, n - 1, k) * a;
    c[1] += FamilyCosine(n, n - 2, k) * a;
  }
  return PetscMax(PetscAbsReal(c[0]), PetscAbsReal(c[1]));
}

/* Of K_ij over omega_i omega_j of the scene, so that no frequency is off by more, however far below the cut-off; modes
   that are rigid count as the lowest one that is not */
static PetscReal FamilyStiffnessError(const CycleFamily *f)
{
  const ReducedModel *scene = &f->scene->reduction.model;
  const PetscInt      m     = scene->m;
  PetscReal           least = scene->omega2[m - 1], error = 0, unused = 0;

  for (PetscInt i = 0; i < m; i++)
    if (scene->omega2[i] > FAMILY_RIGID * scene->omega2[m - 1]) least = PetscMin(least, scene->omega2[i]);
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < m; i++) {
      const PetscReal size = PetscSqrtReal(PetscMax(least, scene->omega2[i]) * PetscMax(least, scene->omega2[j]));

      error = PetscMax(error, FamilyLast(f, FAMILY_K, i + m * j, &unused) / size);
    }
  return error;
}

/* Of the other matrices over the largest entry of each */
static void FamilySetError(CycleFamily *f)
{
  f->error = FamilyStiffnessError(f);
  for (int part = FAMILY_K + 1; part < FAMILY_N_PARTS; part++) {
    PetscReal largest = 0, last = 0;

    for (PetscInt i = 0; i < f->size[part]; i++) last = PetscMax(last, FamilyLast(f, part, i, &largest));
    f->error = PetscMax(f->error, largest > 0 ? last / largest : 0);
  }
}

/* From n points to 2 n - 1, of which every other one is there */
static PetscErrorCode FamilyRefine(CycleFamily *f)
{
  const PetscInt n = f->n ? 2 * f->n - 1 : FAMILY_FEWEST;
  PetscReal *(*part)[FAMILY_N_PARTS];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &part));
  for (PetscInt k = 0; k < f->n; k++) PetscCall(PetscArraycpy(part[2 * k], f->part[k], FAMILY_N_PARTS));
  for (PetscInt k = 0; k < n; k++)
    if (!part[k][0]) PetscCall(FamilyReduce(f, PetscCosReal(PETSC_PI * (PetscReal)k / (PetscReal)(n - 1)), part[k]));
  PetscCall(PetscFree(f->part));
  f->part = part;
  f->n    = n;
  FamilySetError(f);
  PetscFunctionReturn(0);
}

/* Collective. The reductions are the cost: 5, 9 or 17 of them. The model that is handed out is overwritten by each
   CycleFamilySet(). */
PetscErrorCode CycleFamilyCreate(ReducedRun scene, const ReducedParameter *parameter, const PetscReal range[2],
                                 PetscReal p[], const CycleFamily *beside, CycleFamily **family)
{
  PetscLogDouble begin, end;
  CycleFamily   *f;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&begin));
  PetscCall(PetscNew(family));
  f              = *family;
  f->scene       = scene;
  f->parameter   = parameter;
  f->p           = p;
  f->beside      = beside;
  f->logarithmic = range[0] > 0 ? PETSC_TRUE : PETSC_FALSE;
  f->value       = parameter->value;
  PetscCall(PetscArraycpy(f->range, range, 2));
  FamilyListSizes(&scene->reduction.model, f->size);
  PetscCall(CycleFamilyCheckMemory(f, FAMILY_MOST));
  PetscCall(ReducedModelCopy(&scene->reduction.model, &f->model));
  PetscCall(PetscMalloc1(f->size[FAMILY_K], &f->Q));
  do {
    PetscCall(FamilyRefine(f));
  } while (f->error > FAMILY_RTOL && f->n < FAMILY_MOST);
  PetscCheck(f->error <= FAMILY_RTOL, scene->comm, PETSC_ERR_USER_INPUT,
             "-cycle_range %.6g,%.6g: reduced models at %" PetscInt_FMT " values of %s tell those between them to "
             "%.1e only, must be %.0e: take a smaller range, or another -dynamics_cutoff",
             (double)range[0], (double)range[1], f->n, parameter->name, (double)f->error, FAMILY_RTOL);
  PetscCall(PetscTime(&end));
  f->seconds = end - begin;
  PetscCall(CycleFamilySet(f, parameter->value));
  PetscFunctionReturn(0);
}

/* Barycentric weights of the points at t, their sum 1: (-1)^k / (t - t_k), halved at the ends (J.-P. Berrut, L. N.
   Trefethen, SIAM Review 46, 2004, 501); at a point itself that point alone. */
static void FamilyWeigh(PetscInt n, PetscReal t, PetscReal weight[])
{
  PetscReal sum = 0;

  for (PetscInt k = 0; k < n; k++) {
    const PetscReal far = t - PetscCosReal(PETSC_PI * (PetscReal)k / (PetscReal)(n - 1));

    weight[k] = (k % 2 ? -1 : 1) * (k == 0 || k == n - 1 ? 0.5 : 1);
    if (far == 0) {
      for (PetscInt i = 0; i < n; i++) weight[i] = i == k;
      return;
    }
    weight[k] /= far;
    sum += weight[k];
  }
  for (PetscInt k = 0; k < n; k++) weight[k] /= sum;
}

/* One interpolated matrix */
static void FamilyCombine(const CycleFamily *f, const PetscReal weight[], int part, PetscReal out[])
{
  for (PetscInt i = 0; i < f->size[part]; i++) {
    out[i] = 0;
    for (PetscInt k = 0; k < f->n; k++) out[i] += weight[k] * f->part[k][part][i];
  }
}

/* The model at a value in its own modes again: K = Q Omega^2 Q', all else turned by Q. Signs and order of Q are
   arbitrary, so that a state goes from one value to another by way of the scene's coordinates (CycleFamilyTurn()). */
PetscErrorCode CycleFamilySet(CycleFamily *f, PetscReal value)
{
  ReducedModel  *model = &f->model;
  const PetscInt m = model->m, n = 3 * model->n_pairs, N = model->n_ports;
  PetscReal      weight[FAMILY_MOST], *work;

  PetscFunctionBeginUser;
  PetscCheck(CycleFamilyHolds(f, value), f->scene->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "there is no reduced model at %s %.6g, which is beyond -cycle_range %.6g,%.6g", f->parameter->name,
             (double)value, (double)f->range[0], (double)f->range[1]);
  FamilyWeigh(f->n, FamilyCoordinate(f, value), weight);
  PetscCall(PetscMalloc1(m * PetscMax(m, N), &work));
  FamilyCombine(f, weight, FAMILY_K, f->Q);
  PetscCall(DenseSymmetricEigen(m, f->Q, NULL, model->omega2, NULL));
  for (PetscInt i = 0; i < m; i++)
    if (model->omega2[i] <= FAMILY_RIGID * model->omega2[m - 1]) model->omega2[i] = 0;
  FamilyCombine(f, weight, FAMILY_C, work);
  if (model->C) PetscCall(FamilyTurn(m, work, f->Q, model->C));
  FamilyCombine(f, weight, FAMILY_P, work);
  ReducedTimesTransposed(&(DenseBlock){f->Q, m, m, m}, &(DenseBlock){work, m, N, m}, model->P);
  FamilyCombine(f, weight, FAMILY_CM, work);
  if (model->Cm) ReducedTimesTransposed(&(DenseBlock){f->Q, m, m, m}, &(DenseBlock){work, m, n, m}, model->Cm);
  FamilyCombine(f, weight, FAMILY_W, model->W);
  FamilyCombine(f, weight, FAMILY_CX, model->Cx);
  f->value = value;
  PetscCall(PetscFree(work));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFamilyTurn(const CycleFamily *f, PetscBool to_scene, PetscInt columns, PetscInt stride,
                               PetscReal X[])
{
  const PetscInt   m = f->model.m;
  const DenseBlock Q = {f->Q, m, m, m};
  PetscReal       *Y;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m * columns, &Y));
  (to_scene ? ReducedTimes : ReducedTimesTransposed)(&Q, &(DenseBlock){X, m, columns, stride}, Y);
  for (PetscInt k = 0; k < columns; k++) PetscCall(PetscArraycpy(&X[stride * k], &Y[m * k], m));
  PetscCall(PetscFree(Y));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleFamilyDestroy(CycleFamily **family)
{
  CycleFamily *f = *family;

  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < f->n; k++)
    for (int i = 0; i < FAMILY_N_PARTS; i++) PetscCall(PetscFree(f->part[k][i]));
  PetscCall(PetscFree(f->part));
  PetscCall(ReducedModelDestroy(&f->model));
  PetscCall(PetscFree(f->Q));
  PetscCall(PetscFree(*family));
  PetscFunctionReturn(0);
}
