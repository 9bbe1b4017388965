/*
   By which mechanism a mode grows.

   1. What feeds it. Let Q(lambda) x = 0, lambda = sigma + i omega, Q = lambda^2 M + lambda (C + G) + K + S with M, C,
   K symmetric, G, S skew. The imaginary part of x^H Q x = 0 is, for omega > 0 (causes.c of operators/),

      sigma D = -omega c - a,   D = 2 omega x^H M x + Im x^H G x,   c = x^H C x,   a = Im x^H S x,

   and c = c- + c+, the sums over the terms with a negative and with a positive form. So three things alone can feed a
   mode: damping of negative sign, -omega c- / D; damping of positive sign where D < 0, -omega c+ / D; circulation, an
   unsymmetric stiffness, -a / D. Gyroscopic terms feed nothing; but where D = 0, they let a mode grow that nothing
   feeds. For a real lambda the vector is real, and x' Q x = 0 is

      sigma^2 x'M x = -sigma c- - sigma c+ - k,   k = x'K x,

   to which only c- < 0 and k < 0 contribute: damping of negative sign beyond the critical one, or divergence. The
   larger of the two names it.

   2. What it needs. Feeding is no proof: of two oscillators that circulation couples too weakly for growth, uneven
   positive damping makes one grow (Ziegler); the balance has circulation as the source and damping as a loss, and yet
   the mode is stable without damping. So the question is asked what becomes of lambda where terms X are taken away.
   In the companion form with w = (x; lambda x) terms X(lambda) = lambda X_C + X_K change the pair of lambda_1,
   lambda_2 to the eigenvalues of the 2 x 2 matrix

      A_ab = lambda_a delta_ab + y_a' X(lambda_b) x_b / (y_a' Q'(lambda_a) x_a),

   the Petrov-Galerkin projection on the right and left vectors of both. Its diagonal has the derivatives -dlambda /
   ds by the scale s of X. It is exact where the plane of both is invariant, in particular for the two amplitudes z of
   weakly damped oscillators of nearly one frequency,

      (z + d_1 - i D)(z + d_2 + i D) = v^2 - k^2 - g^2 + 2 i v g

   (d damping, 2 D difference of the frequencies, v circulation, k symmetric, g gyroscopic coupling, of velocity),
   which is linear in each of them; and near a coalescence, where the derivatives of either eigenvalue have no limit,
   its trace and determinant have. One mode at a time (n = 1) it is the first order. What is left out is of second
   order in X over the distance of the next modes and of the conjugates, 2 omega.

   3. The rule. Let s_X be the growth without X, followed from s = 1 to 0. X is needed where s_X < sigma / 2.
      negative damping   -omega c- / D > 0 is at least the circulation's -a / D, and it is needed
      damping-induced    else: damping of positive sign is needed
      gyroscopic         else: gyroscopic terms are needed, or nothing else feeds the mode
      coupling           else: circulation feeds it

   The kinds exclude each other and cover what can happen. With omega > 0 and no damping of either sign nor gyroscopic
   term, M lambda^2 + K has real lambda^2 and no growth: sigma > 0 needs one of the four. If c- = 0, no mode is called
   negative damping, if C = 0, none damping-induced, if G = 0, none gyroscopic, and if S = 0, none coupling: a name is
   given only where its terms are there. Where circulation and damping of negative sign both feed, the larger one
   names it; then s_X < sigma / 2 holds where the pair does not turn round, s_X = sigma - (-omega c- / D) for a single
   mode. Coupling and damping-induced differ in whether the pair grows without damping. In the amplitudes above with g
   = 0 and d_1, d_2 >= 0 this is sqrt(v^2 - k^2 - D^2) against 0: the pair is damping-induced below v^2 = k^2 + D^2
   (lock-in without damping), and in a strip above it, where more than half of the growth is made by uneven damping.
*/
#include "mechanism.h"
#include <complex.h>

#define TAKEN_STEPS 64 /* on the way from all of X to none */

/* Adds y_a' X(lambda_b) x_b for coefficients of the products and the turned ones: 1, 0 whole, 1/2, -1/2 skew part */
static void TakenAdd(MechanismPair *pair, const PencilForms *forms, MechanismWithout what, PetscReal own,
                     PetscReal turned)
{
  pair->has[what] = PETSC_TRUE;
  for (PetscInt a = 0; a < pair->n; a++)
    for (PetscInt b = 0; b < pair->n; b++) {
      PetscComplex factor = 1;

      for (int k = forms->kind; k > OPERATORS_STIFFNESS; k--) factor *= pair->lambda[b];
      pair->taken[what][a][b] += factor * (own * forms->product[a][b] + turned * forms->turned[a][b]);
    }
}

/* Whether a matrix that is not symmetric has a skew part in the pair */
static PetscBool FormsAreSkew(const PencilForms *forms, PetscInt n)
{
  for (PetscInt a = 0; a < n; a++)
    for (PetscInt b = 0; b < n; b++)
      if (cabs(forms->product[a][b] - forms->turned[a][b]) > 1e-12 * cabs(forms->product[a][b])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Im(lambda^k x^H A x), the share of circulation */
static PetscReal FormsTwist(const MechanismPair *pair, const PencilForms *forms)
{
  PetscComplex form =
    CMPLX(forms->exact ? forms->form[0] : 0, forms->form[1]); /* else M and C have no real part here */

  for (int k = forms->kind; k > OPERATORS_STIFFNESS; k--) form *= pair->lambda[0];
  return cimag(form);
}

void MechanismAdd(MechanismPair *pair, const PencilForms *forms)
{
  const PetscBool negative = forms->form[0] < 0 ? PETSC_TRUE : PETSC_FALSE;

  if (forms->kind != OPERATORS_DAMPING || forms->exact) { /* an unsymmetric mass has no skew share at omega = 0 */
    pair->twist += FormsTwist(pair, forms);
    TakenAdd(pair, forms, WITHOUT_ALL, forms->friction ? 1 : 0.5, forms->friction ? 0 : -0.5);
    return;
  }
  pair->damping[negative ? 0 : 1] += forms->form[0];
  pair->skew += forms->form[1];
  TakenAdd(pair, forms, WITHOUT_ALL, 0.5, 0.5);
  if (forms->form[0] != 0) TakenAdd(pair, forms, negative ? WITHOUT_NEGATIVE : WITHOUT_POSITIVE, 0.5, 0.5);
  if (FormsAreSkew(forms, pair->n)) TakenAdd(pair, forms, WITHOUT_GYROSCOPIC, 0.5, -0.5);
}

/* Both eigenvalues of a 2 x 2 matrix */
static void Eigenvalues(PetscComplex A[2][2], PetscComplex lambda[2])
{
  const PetscComplex mean = (A[0][0] + A[1][1]) / 2, half = (A[0][0] - A[1][1]) / 2;
  const PetscComplex root = csqrt(half * half + A[0][1] * A[1][0]);

  lambda[0] = mean + root;
  lambda[1] = mean - root;
}

void MechanismTake(const MechanismPair *pair, MechanismWithout what, PetscComplex lambda[2])
{
  PetscComplex A[2][2], next[2];

  for (PetscInt a = 0; a < pair->n; a++) lambda[a] = pair->lambda[a];
  if (pair->n == 1) lambda[0] += pair->taken[what][0][0] / pair->slope[0];
  for (int step = 1; step <= TAKEN_STEPS && pair->n == 2; step++) {
    for (int a = 0; a < 2; a++)
      for (int b = 0; b < 2; b++)
        A[a][b] = (a == b ? pair->lambda[a] : 0) + pair->taken[what][a][b] / pair->slope[a] * step / TAKEN_STEPS;
    Eigenvalues(A, next);
    if (cabs(next[0] - lambda[0]) > cabs(next[1] - lambda[0])) {
      const PetscComplex first = next[0];

      next[0] = next[1];
      next[1] = first;
    }
    lambda[0] = next[0];
    lambda[1] = next[1];
  }
}

/* Whether most of the growth goes with these terms */
static PetscBool PairNeeds(const MechanismPair *pair, MechanismWithout what)
{
  PetscComplex lambda[2];

  if (!pair->has[what]) return PETSC_FALSE;
  MechanismTake(pair, what, lambda);
  return creal(lambda[0]) < 0.5 * creal(pair->lambda[0]) ? PETSC_TRUE : PETSC_FALSE;
}

Mechanism MechanismDecide(const MechanismPair *pair)
{
  const PetscReal sigma = creal(pair->lambda[0]), omega = cimag(pair->lambda[0]);
  const PetscReal D        = 2 * omega * pair->mass + pair->skew;
  const PetscReal negative = -omega * pair->damping[0] / D, circulation = -pair->twist / D;

  if (!(sigma > 0)) return MECHANISM_NONE;
  if (omega == 0) {
    const PetscReal pushed = -sigma * pair->damping[0];
    const PetscReal k      = -sigma * sigma * pair->mass - sigma * (pair->damping[0] + pair->damping[1]);

    return pushed > -k ? MECHANISM_NEGATIVE_DAMPING : MECHANISM_DIVERGENCE;
  }
  if (negative > 0 && negative >= circulation && PairNeeds(pair, WITHOUT_NEGATIVE)) return MECHANISM_NEGATIVE_DAMPING;
  if (PairNeeds(pair, WITHOUT_POSITIVE)) return MECHANISM_DAMPING_INDUCED;
  if (PairNeeds(pair, WITHOUT_GYROSCOPIC)) return MECHANISM_GYROSCOPIC;
  if (circulation > PetscMax(negative, 0)) return MECHANISM_COUPLING;
  if (pair->has[WITHOUT_GYROSCOPIC]) return MECHANISM_GYROSCOPIC;
  return negative > 0 ? MECHANISM_NEGATIVE_DAMPING : MECHANISM_UNKNOWN;
}

PetscBool MechanismIsOfTwo(Mechanism mechanism)
{
  return mechanism == MECHANISM_COUPLING || mechanism == MECHANISM_DAMPING_INDUCED || mechanism == MECHANISM_GYROSCOPIC
           ? PETSC_TRUE
           : PETSC_FALSE;
}

const char *MechanismName(Mechanism mechanism, PetscBool words)
{
  static const char *const name[N_MECHANISMS][2] = {
    [MECHANISM_NONE]             = {"", ""},
    [MECHANISM_UNKNOWN]          = {"unknown", "mechanism unknown"},
    [MECHANISM_COUPLING]         = {"coupling", "coupling"},
    [MECHANISM_NEGATIVE_DAMPING] = {"negative_damping", "negative damping"},
    [MECHANISM_DIVERGENCE]       = {"divergence", "divergence"},
    [MECHANISM_DAMPING_INDUCED]  = {"damping_induced", "damping-induced"},
    [MECHANISM_GYROSCOPIC]       = {"gyroscopic", "gyroscopic"},
  };

  return name[mechanism][words ? 1 : 0];
}
