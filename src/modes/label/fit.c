/*
   Fit of a disc's displacement (see label.c for the formula): normal equations by BLAS, the same ones for all three
   directions, and what its harmonics tell.

      min sum_i w_i |u_d(x_i) - sum_k c_k phi_k(x_i)|^2   ->   G c = b,   G = Phi' W Phi,   b = Phi' W u_d,

   phi_k = P_j(s) cos m theta and P_j(s) sin m theta, w_i the masses of the nodes (kg), d axial, radial, tangential.
   Nodes i at one place (s, theta), through the thickness, share the row sqrt(W) phi, W = sum w_i, and their right-hand
   side is sum w_i u_d(x_i) / sqrt(W).
   Over the harmonic m alone b'G_m^-1 b is the energy sum w u^2 that it explains.
*/
#include "disc.h"
#include "base/algebra/vec3.h"
#include <petscblaslapack.h>

/* of the mean of G's diagonal, added to it: of no weight beside the harmonics that a ring resolves */
#define REGULAR 1e-6

/* P_0 .. P_4 of the place s in the range mapped to [-1, 1] */
static void DiscLegendre(const Disc *disc, PetscReal s, PetscReal p[DISC_POLYNOMIALS])
{
  const PetscReal rho = (2 * s - disc->range[0] - disc->range[1]) / (disc->range[1] - disc->range[0]);

  p[0] = 1;
  p[1] = rho;
  for (int j = 2; j < DISC_POLYNOMIALS; j++) p[j] = ((2 * j - 1) * rho * p[j - 1] - (j - 1) * p[j - 2]) / j;
}

/* All terms at one point times a scale: for each m the cosine, then (m > 0) the sine, each times the polynomials */
static void DiscTerms(const Disc *disc, PetscReal s, PetscReal theta, PetscReal scale, PetscReal terms[DISC_TERMS])
{
  const PetscReal c1 = PetscCosReal(theta), s1 = PetscSinReal(theta);
  PetscReal       p[DISC_POLYNOMIALS], cm = scale, sm = 0;
  int             k = 0;

  DiscLegendre(disc, s, p);
  for (int m = 0; m < DISC_HARMONICS; m++) {
    const PetscReal next = cm * c1 - sm * s1; /* cos (m + 1) theta */

    for (int j = 0; j < DISC_POLYNOMIALS; j++) terms[k++] = p[j] * cm;
    for (int j = 0; j < DISC_POLYNOMIALS && m > 0; j++) terms[k++] = p[j] * sm;
    sm = sm * c1 + cm * s1;
    cm = next;
  }
}

/* Every entry from the upper half. Coarse rings alias high harmonics: beyond half as many as a ring has columns G would
   be singular */
static void DiscGramFinish(PetscReal gram[])
{
  PetscReal trace = 0;

  for (int k = 0; k < DISC_TERMS; k++) trace += gram[k * (DISC_TERMS + 1)];
  for (int j = 0; j < DISC_TERMS; j++) {
    for (int i = j + 1; i < DISC_TERMS; i++) gram[j * DISC_TERMS + i] = gram[i * DISC_TERMS + j];
    gram[j * (DISC_TERMS + 1)] += REGULAR * trace / DISC_TERMS;
  }
}

/* The rows of the basis, of all places */
static PetscErrorCode DiscBasisFill(Disc *disc, const PetscReal x[])
{
  PetscReal *weight; /* [places] kg */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(disc->n_places, &weight));
  for (PetscInt i = 0; i < disc->n_nodes; i++) weight[disc->place[i]] += disc->weight[i];
  PetscCall(PetscCalloc2(disc->n_places * DISC_TERMS, &disc->basis, disc->n_nodes, &disc->turn));
  for (PetscInt i = 0; i < disc->n_nodes; i++) {
    PetscReal *terms = &disc->basis[disc->place[i] * DISC_TERMS], s, theta;

    DiscPlace(disc, &x[3 * disc->node[i]], &s, &theta);
    if (terms[0] == 0) DiscTerms(disc, s, theta, PetscSqrtReal(weight[disc->place[i]]), terms);
    disc->turn[i] = (DiscTurned){disc->weight[i], terms[DISC_POLYNOMIALS] / terms[0],
                                 terms[2 * DISC_POLYNOMIALS] / terms[0], 1 / terms[0]};
  }
  PetscCall(PetscFree(weight));
  PetscFunctionReturn(0);
}

/* gram = basis' W basis; basis is row-major, hence column-major transposed */
PetscErrorCode DiscFitCreate(Disc *disc, const PetscReal x[])
{
  const PetscBLASInt terms = DISC_TERMS;
  const PetscReal    one = 1, zero = 0;
  PetscBLASInt       n;

  PetscFunctionBeginUser;
  PetscCall(DiscFindPlaces(disc, x));
  PetscCall(DiscBasisFill(disc, x));
  PetscCall(PetscBLASIntCast(disc->n_places, &n));
  PetscCall(PetscCalloc1(DISC_TERMS * DISC_TERMS, &disc->gram));
  if (n)
    PetscCallBLAS("BLASsyrk", BLASsyrk_("U", "N", &terms, &n, &one, disc->basis, &terms, &zero, disc->gram, &terms));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, disc->gram, DISC_TERMS * DISC_TERMS, MPIU_REAL, MPI_SUM, disc->comm));
  DiscGramFinish(disc->gram);
  PetscFunctionReturn(0);
}

/* Coefficients of all fits */
static PetscInt DiscUnknowns(const Disc *disc)
{
  return disc->n_modes * N_DISC_DIRECTIONS * 2 * DISC_TERMS;
}

PetscErrorCode DiscFitBegin(Disc *disc, PetscInt n_modes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(disc->waiting, disc->waiting_from));
  PetscCall(PetscFree2(disc->rhs, disc->fit));
  disc->n_modes   = n_modes;
  disc->n_waiting = 0;
  PetscCall(PetscMalloc2(DISC_WAITING * disc->n_places, &disc->waiting, DISC_WAITING, &disc->waiting_from));
  PetscCall(PetscCalloc2(DiscUnknowns(disc), &disc->rhs, DiscUnknowns(disc), &disc->fit));
  PetscFunctionReturn(0);
}

/* Right-hand sides of the displacements that wait */
static PetscErrorCode DiscProduct(Disc *disc)
{
  const PetscBLASInt terms = DISC_TERMS;
  const PetscReal    one = 1, zero = 0;
  PetscReal         *products;
  PetscBLASInt       n, columns;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(disc->n_places, &n));
  PetscCall(PetscBLASIntCast(disc->n_waiting, &columns));
  disc->n_waiting = 0;
  if (!n || !columns) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(columns * DISC_TERMS, &products));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &terms, &columns, &n, &one, disc->basis, &terms, disc->waiting, &n,
                                      &zero, products, &terms));
  for (PetscBLASInt k = 0; k < columns; k++)
    PetscCall(PetscArraycpy(&disc->rhs[disc->waiting_from[k] * DISC_TERMS], &products[k * DISC_TERMS], DISC_TERMS));
  PetscCall(PetscFree(products));
  PetscFunctionReturn(0);
}

/* Displacement u of a node in the directions of the disc */
static void DiscTurn(const Disc *disc, const DiscTurned *at, const PetscReal u[3], PetscReal v[N_DISC_DIRECTIONS])
{
  const PetscReal a = Vec3Dot(u, disc->e1), b = Vec3Dot(u, disc->e2);

  v[DISC_AXIAL]      = Vec3Dot(u, disc->axis);
  v[DISC_RADIAL]     = a * at->cosine + b * at->sine;
  v[DISC_TANGENTIAL] = b * at->cosine - a * at->sine;
}

PetscErrorCode DiscProject(Disc *disc, PetscInt mode, PetscReal *const u[2], PetscReal energy[2])
{
  const PetscInt n = disc->n_places;

  PetscFunctionBeginUser;
  if (disc->n_waiting + 2 * N_DISC_DIRECTIONS > DISC_WAITING) PetscCall(DiscProduct(disc));
  for (int part = 0; part < 2 && u[part]; part++) {
    PetscReal *to = &disc->waiting[disc->n_waiting * n], v[N_DISC_DIRECTIONS];

    PetscCall(PetscArrayzero(to, N_DISC_DIRECTIONS * n));
    for (PetscInt i = 0; i < disc->n_nodes; i++) {
      const DiscTurned *at = &disc->turn[i];

      DiscTurn(disc, at, &u[part][3 * disc->node[i]], v);
      for (int d = 0; d < N_DISC_DIRECTIONS; d++) {
        to[d * n + disc->place[i]] += at->weight * at->scale * v[d];
        energy[0] += at->weight * v[d] * v[d];
      }
      energy[1] += at->weight * v[DISC_AXIAL] * v[DISC_AXIAL];
    }
    for (int d = 0; d < N_DISC_DIRECTIONS; d++)
      disc->waiting_from[disc->n_waiting++] = (mode * N_DISC_DIRECTIONS + d) * 2 + part;
  }
  PetscFunctionReturn(0);
}

/* B := A^-1 B, A of so many rows symmetric and positive definite, overwritten */
static PetscErrorCode DiscSolveNormal(MPI_Comm comm, PetscBLASInt rows, PetscReal A[], PetscInt m, PetscReal B[])
{
  PetscBLASInt columns, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(m, &columns));
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("U", &rows, A, &rows, &info));
  PetscCheck(!info, comm, PETSC_ERR_LIB, "LAPACK potrf: info %d", (int)info);
  PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("U", &rows, &columns, A, &rows, B, &rows, &info));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscSolve(Disc *disc)
{
  const PetscInt n = DiscUnknowns(disc);
  PetscReal     *A;

  PetscFunctionBeginUser;
  PetscCall(DiscProduct(disc));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, disc->rhs, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, disc->comm));
  PetscCall(PetscMalloc1(DISC_TERMS * DISC_TERMS, &A));
  PetscCall(PetscArraycpy(A, disc->gram, DISC_TERMS * DISC_TERMS));
  PetscCall(PetscArraycpy(disc->fit, disc->rhs, n));
  PetscCall(DiscSolveNormal(disc->comm, DISC_TERMS, A, n / DISC_TERMS, disc->fit));
  PetscCall(PetscFree(A));
  PetscFunctionReturn(0);
}

/* First term of harmonic m, and how many it has */
static int DiscFirst(int m)
{
  return m ? (2 * m - 1) * DISC_POLYNOMIALS : 0;
}

static int DiscCount(int m)
{
  return m ? 2 * DISC_POLYNOMIALS : DISC_POLYNOMIALS;
}

PetscErrorCode DiscExplain(const Disc *disc, PetscInt mode, int m, int first, int last, PetscReal *energy)
{
  const int        start = DiscFirst(m), n = DiscCount(m), columns = 2 * (last - first + 1);
  const PetscReal *rhs = &disc->rhs[(mode * N_DISC_DIRECTIONS + first) * 2 * DISC_TERMS + start];
  PetscReal        A[4 * DISC_POLYNOMIALS * DISC_POLYNOMIALS], x[2 * N_DISC_DIRECTIONS * 2 * DISC_POLYNOMIALS];

  PetscFunctionBeginUser;
  for (int i = 0; i < n * n; i++) A[i] = disc->gram[(start + i / n) * DISC_TERMS + start + i % n];
  for (int i = 0; i < n * columns; i++) x[i] = rhs[i / n * DISC_TERMS + i % n];
  PetscCall(DiscSolveNormal(disc->comm, n, A, columns, x));
  *energy = 0;
  for (int i = 0; i < n * columns; i++) *energy += x[i] * rhs[i / n * DISC_TERMS + i % n];
  PetscFunctionReturn(0);
}

void DiscProfile(const Disc *disc, PetscInt mode, int direction, int m, PetscReal s, PetscReal v[N_DISC_VALUES])
{
  PetscReal p[DISC_POLYNOMIALS];

  DiscLegendre(disc, s, p);
  for (int part = 0; part < 2; part++) {
    const PetscReal *a = &disc->fit[((mode * N_DISC_DIRECTIONS + direction) * 2 + part) * DISC_TERMS + DiscFirst(m)];

    v[DISC_COS_RE + part] = v[DISC_SIN_RE + part] = 0;
    for (int j = 0; j < DISC_POLYNOMIALS; j++) v[DISC_COS_RE + part] += a[j] * p[j];
    for (int j = 0; j < DISC_POLYNOMIALS && m; j++) v[DISC_SIN_RE + part] += a[DISC_POLYNOMIALS + j] * p[j];
  }
}

PetscReal DiscSample(const Disc *disc, int k)
{
  return disc->range[0] + (disc->range[1] - disc->range[0]) * (k + 0.5) / DISC_SAMPLES;
}

PetscReal DiscSampleWeight(const Disc *disc, PetscReal s)
{
  return disc->is_drum ? disc->r_outer : s;
}

PetscReal DiscMomentsOf(const Disc *disc, PetscInt mode, int direction, int m,
                        PetscReal moments[N_DISC_VALUES * N_DISC_VALUES])
{
  PetscReal v[4];

  for (int k = 0; k < 16; k++) moments[k] = 0;
  for (int i = 0; i < DISC_SAMPLES; i++) {
    const PetscReal s = DiscSample(disc, i), r = DiscSampleWeight(disc, s);

    DiscProfile(disc, mode, direction, m, s, v);
    for (int k = 0; k < 16; k++) moments[k] += v[k / 4] * v[k % 4] * r * (m ? 1 : 2);
  }
  return moments[0] + moments[5] + moments[10] + moments[15];
}
