/*
   The reduced model about steady sliding: pairs that are closed stay so and slide along t, so that their forces are
   lambda = e lambda_n with e = (1, -mu, 0) on the slave (mu + p d mu / dp where it depends on the pressure p), and
   their gaps N y do not change. With N, E the matrices of these and S = (N W E)^-1 N P, N W E plus 1 / k_n of a law in
   series at its force, without damping lambda_n = -S eta. With damping, to first order in that of the residual,

      T = (N W E)^-1 N (Cm' - Cx E S),   lambda_n = -S eta + T eta',
      eta'' + (C - Cm E S - P'E T) eta' + (Omega^2 + P'E S) eta = 0.

   Branches of parts add forces as a damping S does that is multiplied by E_j / (s + 1 / tau_j) (branches.c).

   What the modes leave out has in e^(s t) the compliance sum phi phi' / (omega^2 + s^2), to first order W - s^2 Mx,
   exact in all modes above the cut-off but for (omega / their own frequency)^2 of itself:

      lambda_n = -S eta + (N W E)^-1 N Mx E lambda_n'',   so that eta'' gets the mass 1 + P'E (N W E)^-1 N Mx E S.

   Friction turns against the direction of the slip velocity v t + (r_t', r_b'): to first order its change is -mu'
   lambda_n r_t' along t and -mu lambda_n r_b' / v along b, dampers between the bodies (the residual moves 1e-4 as fast
   and is left out there).
*/
#include "reduced/reducedimpl.h"

/* The closed pairs, and work */
typedef struct {
  const ReducedModel *model;
  const PetscReal    *lambda_n; /* [n_pairs] N, or NULL */
  PetscInt            n, *pair; /* [n] */
  PetscReal          *A;        /* [n][n] LU factors of N W E */
  PetscBLASInt       *pivot;
  PetscReal          *S, *T; /* [m][n] */
} ClosedPairs;

/* The law of closed pair j at its pressure */
static FrictionLaw ClosedFriction(const ClosedPairs *c, PetscInt j)
{
  return FrictionPressed(&c->model->friction[c->pair[j]], c->lambda_n ? c->lambda_n[c->pair[j]] : 0);
}

/* Change of friction over that of the normal force in steady sliding: mu, where it knows no pressure */
static PetscReal ClosedMu(const ClosedPairs *c, PetscInt j)
{
  const FrictionLaw law = ClosedFriction(c, j);

  return FrictionSteadyTangent(&law);
}

/* 1 / k_n, m/N, at the pair's force, N, or at none */
static PetscReal ClosedYield(const ClosedPairs *c, PetscInt i, const PetscReal lambda_n[])
{
  const PairSpring *spring = &c->model->spring[c->pair[i]];

  return SpringTangent(spring, SpringClosing(spring, lambda_n ? lambda_n[c->pair[i]] : 0)).compliance;
}

/* A = N W E [n][n] of the closed pairs, A_ij = W_(n i, n j) - mu_j W_(n i, t j), m/N, and its LU factors; mu of
   steady sliding. */
static PetscErrorCode ClosedCreate(const ReducedModel *model, const PetscBool closed[], const PetscReal lambda_n[],
                                   ClosedPairs *c)
{
  const PetscInt N = model->n_ports;
  PetscInt       n = 0;
  PetscBool      singular;

  PetscFunctionBeginUser;
  *c = (ClosedPairs){.model = model, .lambda_n = lambda_n};
  PetscCall(PetscMalloc1(model->n_pairs, &c->pair));
  for (PetscInt i = 0; i < model->n_pairs; i++)
    if (closed[i]) c->pair[n++] = i;
  c->n = n;
  PetscCall(PetscCalloc4(n * n, &c->A, n, &c->pivot, n * model->m, &c->S, n * model->m, &c->T));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal *w = &model->W[3 * c->pair[i] + N * (3 * c->pair[j])];

      c->A[i + n * j] = w[0] - ClosedMu(c, j) * w[N];
    }
  for (PetscInt i = 0; i < n && model->spring; i++) c->A[i + n * i] += ClosedYield(c, i, lambda_n);
  if (!n) PetscFunctionReturn(0);
  PetscCall(DenseFactor(n, c->A, c->pivot, &singular));
  PetscCheck(!singular, PETSC_COMM_SELF, PETSC_ERR_MAT_LU_ZRPVT,
             "the compliance of the closed pairs is singular: take a lower -dynamics_cutoff");
  PetscFunctionReturn(0);
}

static PetscErrorCode ClosedDestroy(ClosedPairs *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(c->pair));
  PetscCall(PetscFree4(c->A, c->pivot, c->S, c->T));
  PetscFunctionReturn(0);
}

/* S [m][n] = (N W E)^-1 N P, N / (m sqrt(kg)): the normal forces, -S eta, that keep the gaps. */
static PetscErrorCode ClosedSolveStiffness(ClosedPairs *c)
{
  const PetscInt m = c->model->m, n = c->n;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m; k++)
    for (PetscInt i = 0; i < n; i++) c->S[i + n * k] = c->model->P[k + m * 3 * c->pair[i]];
  PetscCall(DenseSolve(n, c->A, c->pivot, PETSC_FALSE, m, c->S));
  PetscFunctionReturn(0);
}

/* K += scale Q E S, Q [3 n_pairs][m] with m numbers for each port */
static void ClosedAdd(const ClosedPairs *c, PetscReal scale, const PetscReal Q[], const PetscReal S[], PetscReal K[])
{
  const PetscInt m = c->model->m;

  for (PetscInt i = 0; i < c->n; i++) {
    const PetscReal *q = &Q[m * 3 * c->pair[i]], mu = ClosedMu(c, i);

    for (PetscInt k = 0; k < m; k++)
      for (PetscInt l = 0; l < m; l++) K[l + m * k] += scale * (q[l] - mu * q[m + l]) * S[i + c->n * k];
  }
}

/* Y [m][n] := (N W E)^-1 (Y - N X E S), X [3 n_pairs][3 n_pairs] */
static PetscErrorCode ClosedSolveForm(ClosedPairs *c, const PetscReal X[], PetscReal Y[])
{
  const PetscInt m = c->model->m, n = c->n, N = 3 * c->model->n_pairs;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m; k++) {
    for (PetscInt i = 0; i < n; i++) {
      for (PetscInt j = 0; j < n; j++) {
        const PetscReal *x = &X[3 * c->pair[i] + N * 3 * c->pair[j]];

        Y[i + n * k] -= (x[0] - ClosedMu(c, j) * x[N]) * c->S[j + n * k];
      }
    }
  }
  PetscCall(DenseSolve(n, c->A, c->pivot, PETSC_FALSE, m, Y));
  PetscFunctionReturn(0);
}

/* Adds C - Cm E S - P'E T of a damping to its C; T is that of it */
static PetscErrorCode ClosedAddDamping(ClosedPairs *c, const PetscReal Cm[], const PetscReal Cx[], PetscReal C[])
{
  const PetscInt m = c->model->m, n = c->n;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m; k++)
    for (PetscInt i = 0; i < n; i++) c->T[i + n * k] = Cm[k + m * 3 * c->pair[i]];
  PetscCall(ClosedSolveForm(c, Cx, c->T));
  ClosedAdd(c, -1, Cm, c->S, C);
  ClosedAdd(c, -1, c->model->P, c->T, C);
  PetscFunctionReturn(0);
}

/* The n matrices A [m][m] over the mass 1 + P'E (N W E)^-1 N Mx E S; ClosedSolveForm() from Y = 0 gives -(N W E)^-1 N
   Mx E S, hence the sign. */
static PetscErrorCode ClosedDivideByMass(ClosedPairs *c, PetscInt n, PetscReal *const A[])
{
  const PetscInt m = c->model->m;
  PetscReal     *mass, *Y;
  PetscBLASInt  *pivot;

  PetscFunctionBeginUser;
  if (!c->n) PetscFunctionReturn(0);
  PetscCall(PetscCalloc3(m * m, &mass, m * c->n, &Y, m, &pivot));
  PetscCall(ClosedSolveForm(c, c->model->Mx, Y));
  for (PetscInt k = 0; k < m; k++) mass[k + m * k] = 1;
  ClosedAdd(c, -1, c->model->P, Y, mass);
  PetscCall(DenseFactor(m, mass, pivot, NULL));
  for (PetscInt i = 0; i < n; i++) PetscCall(DenseSolve(m, mass, pivot, PETSC_FALSE, m, A[i]));
  PetscCall(PetscFree3(mass, Y, pivot));
  PetscFunctionReturn(0);
}

/* Eigenvalues s = sigma + i omega (rad/s) of s^2 + C s + K by the first-order system A = [0 1; -K -C], and vectors
   [2 m][2 m] in LAPACK's real storage (of a pair of conjugates the real part, then the imaginary one), or NULL. */
static PetscErrorCode QuadraticEigen(PetscInt m, PetscReal *const system[2], PetscReal sigma[], PetscReal omega[],
                                     PetscReal vectors[])
{
  const PetscInt n = 2 * m;
  PetscReal     *A;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * n, &A));
  for (PetscInt k = 0; k < m; k++) {
    A[k + n * (m + k)] = 1;
    for (PetscInt l = 0; l < m; l++) {
      A[m + l + n * k]       = -system[0][l + m * k];
      A[m + l + n * (m + k)] = -system[1][l + m * k];
    }
  }
  PetscCall(DenseEigen(n, A, sigma, omega, NULL, vectors));
  PetscCall(PetscFree(A));
  PetscFunctionReturn(0);
}

/* C += d L R of a damper d (N s/m) at a port: its displacement R eta, modal force L of a force there, both with the
   gaps of the closed pairs kept: R = P_i - W_i E S, L = P_i' - P'E (N W E)^-1 N W_i */
static PetscErrorCode ClosedAddDamper(ClosedPairs *c, PetscInt port, PetscReal d, PetscReal C[])
{
  const ReducedModel *model = c->model;
  const PetscInt      m = model->m, n = c->n, N = model->n_ports;
  PetscReal          *x, *L, *R;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &x, m, &L, m, &R));
  for (PetscInt j = 0; j < n; j++) x[j] = model->W[3 * c->pair[j] + N * port];
  PetscCall(DenseSolve(n, c->A, c->pivot, PETSC_FALSE, 1, x));
  for (PetscInt k = 0; k < m; k++) L[k] = R[k] = model->P[k + m * port];
  for (PetscInt j = 0; j < n; j++) {
    const PetscInt   other = 3 * c->pair[j];
    const PetscReal *P = &model->P[m * other], mu = ClosedMu(c, j);
    const PetscReal  w = model->W[port + N * other] - mu * model->W[port + N * (other + 1)];

    for (PetscInt k = 0; k < m; k++) {
      L[k] -= (P[k] - mu * P[m + k]) * x[j];
      R[k] -= w * c->S[j + n * k];
    }
  }
  for (PetscInt k = 0; k < m; k++)
    for (PetscInt l = 0; l < m; l++) C[l + m * k] += d * L[l] * R[k];
  PetscCall(PetscFree3(x, L, R));
  PetscFunctionReturn(0);
}

/* What friction damps, N s/m: mu lambda_n / v along b, since the friction force turns with the direction of slip,
   and mu' lambda_n along t; mu' < 0 feeds. */
static PetscErrorCode ClosedAddFriction(ClosedPairs *c, const PetscReal lambda_n[], PetscReal C[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n; i++) {
    const PetscInt    p      = c->pair[i];
    const FrictionLaw law    = ClosedFriction(c, i);
    const PetscReal   along  = FrictionSteadySlope(&law) * lambda_n[p];
    const PetscReal   across = law.speed > 0 ? FrictionSteady(&law) * lambda_n[p] / law.speed : 0;

    if (along != 0) PetscCall(ClosedAddDamper(c, 3 * p + 1, along, C));
    if (across != 0) PetscCall(ClosedAddDamper(c, 3 * p + 2, across, C));
  }
  PetscFunctionReturn(0);
}

/* K and C [m][m] of the model about sliding */
static PetscErrorCode ClosedFill(ClosedPairs *c, const PetscReal lambda_n[], PetscReal K[], PetscReal C[])
{
  const ReducedModel *model = c->model;
  const PetscInt      m     = model->m;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m; k++) K[k + m * k] = model->omega2[k];
  if (model->C) PetscCall(PetscArraycpy(C, model->C, m * m));
  if (c->n) {
    PetscCall(ClosedSolveStiffness(c));
    ClosedAdd(c, 1, model->P, c->S, K);
  }
  if (c->n && model->Cx) PetscCall(ClosedAddDamping(c, model->Cm, model->Cx, C));
  if (c->n && lambda_n) PetscCall(ClosedAddFriction(c, lambda_n, C));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedLinearise(const ReducedModel *model, const PetscBool closed[], const PetscReal lambda_n[],
                                PetscBool inertia, PetscReal sigma[], PetscReal omega[])
{
  const PetscInt m = model->m, n = 2 + model->n_branches;
  PetscReal     *all, **system;
  ClosedPairs    c;

  PetscFunctionBeginUser;
  PetscCall(ClosedCreate(model, closed, lambda_n, &c));
  PetscCall(PetscCalloc2(n * m * m, &all, n, &system));
  for (PetscInt i = 0; i < n; i++) system[i] = &all[i * m * m];
  PetscCall(ClosedFill(&c, lambda_n, system[0], system[1]));
  for (PetscInt i = 2; i < n; i++) {
    PetscCall(PetscArraycpy(system[i], model->branch[i - 2].S, m * m));
    if (c.n) PetscCall(ClosedAddDamping(&c, model->branch[i - 2].Sm, model->branch[i - 2].Sx, system[i]));
  }
  if (inertia) PetscCall(ClosedDivideByMass(&c, n, system));
  if (n > 2)
    PetscCall(ReducedBranchesEigen(model, system, sigma, omega));
  else
    PetscCall(QuadraticEigen(m, system, sigma, omega, NULL));
  PetscCall(PetscFree2(all, system));
  PetscCall(ClosedDestroy(&c));
  PetscFunctionReturn(0);
}

/* The state of a mode of which z = (eta, rate): lambda_n = -S eta + T rate, lambda = e lambda_n. Forces are without
   those that friction itself damps with, which the eigenvalue and z know of: they are a guess of the cycle, and its
   size */
static void ClosedSetMode(const ClosedPairs *c, const PetscReal z[], ReducedState *mode)
{
  const PetscInt m = c->model->m;

  for (PetscInt k = 0; k < m; k++) {
    mode->eta[k]  = z[k];
    mode->rate[k] = z[m + k];
  }
  for (PetscInt i = 0; i < c->model->n_ports; i++) mode->p[i] = 0;
  for (PetscInt i = 0; i < 3 * c->model->n_pairs; i++) mode->q[i] = 0;
  for (PetscInt i = 0; i < c->n; i++) {
    const PetscInt port   = 3 * c->pair[i];
    PetscReal      lambda = 0;

    for (PetscInt k = 0; k < m; k++) lambda += c->T[i + c->n * k] * z[m + k] - c->S[i + c->n * k] * z[k];
    mode->p[port]     = lambda;
    mode->p[port + 1] = -ClosedMu(c, i) * lambda;
    mode->q[port]     = mode->p[port];
    mode->q[port + 1] = mode->p[port + 1];
  }
}

/* The mode with omega > 0 of largest growth; eigenvalue (-inf, 0) where none oscillates. mode[0] + i mode[1] is its
   vector. */
PetscErrorCode ReducedFastestMode(const ReducedModel *model, const ReducedState *sliding, PetscReal eigenvalue[2],
                                  ReducedState mode[2])
{
  const PetscInt m = model->m, n = 2 * m;
  PetscInt       at = -1;
  PetscReal     *K, *C, *sigma, *omega, *R, *lambda_n;
  PetscBool     *closed;
  ClosedPairs    c;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc7(m * m, &K, m * m, &C, n, &sigma, n, &omega, n * n, &R, model->n_pairs, &lambda_n,
                         model->n_pairs, &closed));
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    closed[i]   = sliding->status[i] != CONTACT_OPEN ? PETSC_TRUE : PETSC_FALSE;
    lambda_n[i] = sliding->p[3 * i];
  }
  PetscCall(ClosedCreate(model, closed, lambda_n, &c));
  PetscCall(ClosedFill(&c, lambda_n, K, C));
  PetscCall(QuadraticEigen(m, (PetscReal *const[2]){K, C}, sigma, omega, R));
  for (PetscInt k = 0; k < n; k++)
    if (omega[k] > 0 && (at < 0 || sigma[k] > sigma[at])) at = k;
  eigenvalue[0] = at < 0 ? -PETSC_INFINITY : sigma[at];
  eigenvalue[1] = at < 0 ? 0 : omega[at];
  for (int i = 0; i < 2 && at >= 0 && mode; i++) ClosedSetMode(&c, &R[n * (at + i)], &mode[i]);
  PetscCall(PetscFree7(K, C, sigma, omega, R, lambda_n, closed));
  PetscCall(ClosedDestroy(&c));
  PetscFunctionReturn(0);
}
