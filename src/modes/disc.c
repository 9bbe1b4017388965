/*
   Fit of a disc's out-of-plane displacement (see label.c for the formula): frame from the inertia tensor, normal equations by
   BLAS, and the reading of nodal diameters, nodal circles and the antinode at the contact.
*/
#include "disc.h"
#include <petscblaslapack.h>

#define SAMPLES 41   /* radii at which the profile is read */
#define ANGLES  360  /* angles at which the rim is read */
#define RIPPLE  0.005 /* turns of the rim's displacement smaller than this part of the largest do not count */

static PetscReal Dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Mass (kg), centre (m) and inertia tensor sum m d d' (kg m^2) over all ranks */
static PetscErrorCode Moments(MPI_Comm comm, PetscInt n, const PetscReal x[], const PetscReal mass[], PetscReal centre[3], PetscReal inertia[9])
{
  PetscReal sums[4] = {0, 0, 0, 0};

  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < n; v++) {
    sums[3] += mass[v];
    for (int d = 0; d < 3; d++) sums[d] += mass[v] * x[3 * v + d];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 4, MPIU_REAL, MPI_SUM, comm));
  for (int d = 0; d < 3; d++) centre[d] = sums[d] / sums[3];
  PetscCall(PetscArrayzero(inertia, 9));
  for (PetscInt v = 0; v < n; v++)
    for (int k = 0; k < 9; k++) inertia[k] += mass[v] * (x[3 * v + k / 3] - centre[k / 3]) * (x[3 * v + k % 3] - centre[k % 3]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, inertia, 9, MPIU_REAL, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

/* Axis = principal direction whose moment differs from the other two; these must agree within 5 % */
static PetscErrorCode FindAxis(const PetscReal inertia[9], PetscReal axis[3], PetscBool *found)
{
  PetscReal    a[9], values[3], work[32];
  PetscBLASInt n = 3, n_work = 32, info;
  int          k;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(a, inertia, 9));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, a, &n, values, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK syev: info %d", (int)info);
  k      = values[1] - values[0] > values[2] - values[1] ? 0 : 2;
  *found = PetscAbsReal(values[1] - values[2 - k]) < 0.05 * values[2] ? PETSC_TRUE : PETSC_FALSE;
  for (int d = 0; d < 3; d++) axis[d] = a[3 * k + d];
  PetscFunctionReturn(0);
}

/* e1 across the axis towards `to`, or in any direction; e2 = axis x e1 */
static void FindPlane(Disc *disc, const PetscReal to[])
{
  PetscReal along, length;
  int       least = 0;

  for (int d = 0; d < 3; d++) {
    if (PetscAbsReal(disc->axis[d]) < PetscAbsReal(disc->axis[least])) least = d;
    disc->e1[d] = to ? to[d] - disc->centre[d] : 0;
  }
  if (!to) disc->e1[least] = 1;
  along = Dot(disc->e1, disc->axis);
  for (int d = 0; d < 3; d++) disc->e1[d] -= along * disc->axis[d];
  length = PetscSqrtReal(Dot(disc->e1, disc->e1));
  for (int d = 0; d < 3; d++) disc->e1[d] /= length;
  for (int d = 0; d < 3; d++)
    disc->e2[d] = disc->axis[(d + 1) % 3] * disc->e1[(d + 2) % 3] - disc->axis[(d + 2) % 3] * disc->e1[(d + 1) % 3];
}

/* P_0 .. P_4 at rho */
static void Legendre(PetscReal rho, PetscReal p[DISC_POLYNOMIALS])
{
  p[0] = 1;
  p[1] = rho;
  for (int j = 2; j < DISC_POLYNOMIALS; j++) p[j] = ((2 * j - 1) * rho * p[j - 1] - (j - 1) * p[j - 2]) / j;
}

/* Radius mapped to [-1, 1] */
static PetscReal DiscRho(const Disc *disc, PetscReal r)
{
  return (2 * r - disc->r_inner - disc->r_outer) / (disc->r_outer - disc->r_inner);
}

/* Polar coordinates of a point */
static void DiscPolar(const Disc *disc, const PetscReal x[3], PetscReal *r, PetscReal *theta)
{
  const PetscReal d[3] = {x[0] - disc->centre[0], x[1] - disc->centre[1], x[2] - disc->centre[2]};
  const PetscReal a = Dot(d, disc->e1), b = Dot(d, disc->e2);

  *r     = PetscSqrtReal(a * a + b * b);
  *theta = atan2(b, a);
}

/* All terms at one point: for each m the cosine, then (m > 0) the sine, each times the polynomials */
static void DiscTerms(const Disc *disc, PetscReal r, PetscReal theta, PetscReal terms[DISC_TERMS])
{
  PetscReal p[DISC_POLYNOMIALS];
  int       k = 0;

  Legendre(DiscRho(disc, r), p);
  for (int m = 0; m < DISC_HARMONICS; m++) {
    for (int j = 0; j < DISC_POLYNOMIALS; j++) terms[k++] = p[j] * PetscCosReal(m * theta);
    for (int j = 0; j < DISC_POLYNOMIALS && m > 0; j++) terms[k++] = p[j] * PetscSinReal(m * theta);
  }
}

/* Nodes of the disc on this rank, their weights, and the radii over all ranks */
static PetscErrorCode DiscNodes(Disc *disc, PetscInt n_vertices, const PetscReal x[], const PetscReal mass[])
{
  PetscReal range[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL}, r, theta;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n_vertices, &disc->node, n_vertices, &disc->weight));
  for (PetscInt v = 0; v < n_vertices; v++) {
    if (mass[v] <= 0) continue;
    disc->weight[disc->n_nodes] = mass[v];
    disc->node[disc->n_nodes++] = v;
    DiscPolar(disc, &x[3 * v], &r, &theta);
    range[0] = PetscMax(range[0], -r);
    range[1] = PetscMax(range[1], r);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, disc->comm));
  disc->r_inner = -range[0];
  disc->r_outer = range[1];
  PetscFunctionReturn(0);
}

/* gram = basis' W basis; basis is row-major, hence column-major transposed */
static PetscErrorCode DiscGram(Disc *disc, const PetscReal x[])
{
  const PetscBLASInt terms = DISC_TERMS;
  const PetscReal    one = 1, zero = 0;
  PetscBLASInt       n;
  PetscReal         *scaled, r, theta;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(disc->n_nodes, &n));
  PetscCall(PetscMalloc1(disc->n_nodes * DISC_TERMS, &disc->basis));
  PetscCall(PetscMalloc1(disc->n_nodes * DISC_TERMS, &scaled));
  PetscCall(PetscCalloc1(DISC_TERMS * DISC_TERMS, &disc->gram));
  for (PetscInt i = 0; i < disc->n_nodes; i++) {
    PetscReal *row = &disc->basis[i * DISC_TERMS];

    DiscPolar(disc, &x[3 * disc->node[i]], &r, &theta);
    DiscTerms(disc, r, theta, row);
    for (int k = 0; k < DISC_TERMS; k++) scaled[i * DISC_TERMS + k] = disc->weight[i] * row[k];
  }
  if (n) PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &terms, &terms, &n, &one, disc->basis, &terms, scaled, &terms, &zero, disc->gram, &terms));
  PetscCall(PetscFree(scaled));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, disc->gram, DISC_TERMS * DISC_TERMS, MPIU_REAL, MPI_SUM, disc->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscCreate(MPI_Comm comm, PetscInt n_vertices, const PetscReal x[], const PetscReal mass[], const PetscReal contact[], PetscInt n_modes,
                          Disc *disc, PetscBool *is_disc)
{
  PetscReal inertia[9];

  PetscFunctionBeginUser;
  disc->comm        = comm;
  disc->has_contact = contact ? PETSC_TRUE : PETSC_FALSE;
  disc->n_columns   = 2 * n_modes;
  PetscCall(Moments(comm, n_vertices, x, mass, disc->centre, inertia));
  PetscCall(FindAxis(inertia, disc->axis, is_disc));
  if (!*is_disc) PetscFunctionReturn(0);
  FindPlane(disc, contact);
  PetscCall(DiscNodes(disc, n_vertices, x, mass));
  PetscCall(DiscGram(disc, x));
  PetscCall(PetscCalloc1(disc->n_columns * DISC_TERMS, &disc->fit));
  PetscFunctionReturn(0);
}

PetscReal DiscProject(Disc *disc, PetscInt column, const PetscReal u[])
{
  PetscReal *const rhs = &disc->fit[column * DISC_TERMS], energy = 0;

  for (PetscInt i = 0; i < disc->n_nodes; i++) {
    const PetscReal w = Dot(&u[3 * disc->node[i]], disc->axis), weighted = w * disc->weight[i];

    energy += weighted * w;
    for (int k = 0; k < DISC_TERMS; k++) rhs[k] += weighted * disc->basis[i * DISC_TERMS + k];
  }
  return energy;
}

PetscErrorCode DiscSolve(Disc *disc)
{
  const PetscBLASInt terms = DISC_TERMS;
  PetscBLASInt       columns, info;
  PetscReal          trace = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(disc->n_columns, &columns));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, disc->fit, (PetscMPIInt)(disc->n_columns * DISC_TERMS), MPIU_REAL, MPI_SUM, disc->comm));
  for (int k = 0; k < DISC_TERMS; k++) trace += disc->gram[k * (DISC_TERMS + 1)];
  for (int k = 0; k < DISC_TERMS; k++) disc->gram[k * (DISC_TERMS + 1)] += 1e-10 * trace / DISC_TERMS; /* coarse rings alias high harmonics */
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("U", &terms, disc->gram, &terms, &info));
  PetscCheck(!info, disc->comm, PETSC_ERR_LIB, "LAPACK potrf: info %d", (int)info);
  PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("U", &terms, &columns, disc->gram, &terms, disc->fit, &terms, &info));
  PetscFunctionReturn(0);
}

/* Radial profiles of harmonic m of one mode at a radius: cosine re, cosine im, sine re, sine im */
static void DiscProfile(const Disc *disc, PetscInt mode, int m, PetscReal r, PetscReal v[4])
{
  const int first = m ? (2 * m - 1) * DISC_POLYNOMIALS : 0;
  PetscReal p[DISC_POLYNOMIALS];

  Legendre(DiscRho(disc, r), p);
  for (int part = 0; part < 2; part++) {
    const PetscReal *a = &disc->fit[(2 * mode + part) * DISC_TERMS + first];

    v[part] = v[2 + part] = 0;
    for (int j = 0; j < DISC_POLYNOMIALS; j++) v[part] += a[j] * p[j];
    for (int j = 0; j < DISC_POLYNOMIALS && m; j++) v[2 + part] += a[DISC_POLYNOMIALS + j] * p[j];
  }
}

static PetscReal SampleRadius(const Disc *disc, int s)
{
  return disc->r_inner + (disc->r_outer - disc->r_inner) * (s + 0.5) / SAMPLES;
}

/* Second moments sum_r v v' r of the profiles of harmonic m; its trace is the energy */
static PetscReal ProfileMoments(const Disc *disc, PetscInt mode, int m, PetscReal moments[16])
{
  PetscReal v[4];

  for (int k = 0; k < 16; k++) moments[k] = 0;
  for (int s = 0; s < SAMPLES; s++) {
    const PetscReal r = SampleRadius(disc, s);

    DiscProfile(disc, mode, m, r, v);
    for (int k = 0; k < 16; k++) moments[k] += v[k / 4] * v[k % 4] * r * (m ? 1 : 2);
  }
  return moments[0] + moments[5] + moments[10] + moments[15];
}

/* Sign changes of the principal profile; values below a twentieth of the largest count as zero */
static PetscErrorCode NodalCircles(const Disc *disc, PetscInt mode, int m, const PetscReal moments[16], int *n)
{
  PetscReal    a[16], values[4], work[64], profile[SAMPLES], v[4], largest = 0, last = 0;
  PetscBLASInt four = 4, n_work = 64, info;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(a, moments, 16));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &four, a, &four, values, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK syev: info %d", (int)info);
  for (int s = 0; s < SAMPLES; s++) {
    DiscProfile(disc, mode, m, SampleRadius(disc, s), v);
    profile[s] = 0;
    for (int k = 0; k < 4; k++) profile[s] += a[12 + k] * v[k];
    largest = PetscMax(largest, PetscAbsReal(profile[s]));
  }
  *n = 0;
  for (int s = 0; s < SAMPLES; s++) {
    if (PetscAbsReal(profile[s]) < 0.05 * largest) continue;
    if (last * profile[s] < 0) ++*n;
    last = profile[s];
  }
  PetscFunctionReturn(0);
}

/* Harmonics of one mode that share the number of nodal circles with most energy */
typedef struct {
  int       circles;
  int       strongest;         /* harmonic with most energy */
  PetscReal energy, even, odd; /* even, odd about the contact */
  PetscBool has[DISC_HARMONICS];
} Family;

/* Sorts the harmonics by their nodal circles and takes the family with most energy */
static PetscErrorCode FamilyFind(const Disc *disc, PetscInt mode, Family *best)
{
  Family    family[DISC_POLYNOMIALS] = {{0}};
  PetscReal most[DISC_POLYNOMIALS]   = {0};

  PetscFunctionBeginUser;
  for (int m = 0; m < DISC_HARMONICS; m++) {
    PetscReal       moments[16];
    const PetscReal energy = ProfileMoments(disc, mode, m, moments);
    int             n;

    PetscCall(NodalCircles(disc, mode, m, moments, &n));
    n = PetscMin(n, DISC_POLYNOMIALS - 1);
    family[n].circles = n;
    family[n].energy += energy;
    family[n].even += moments[0] + moments[5];
    family[n].odd += moments[10] + moments[15];
    family[n].has[m] = PETSC_TRUE;
    if (energy > most[n]) family[n].strongest = m, most[n] = energy;
  }
  *best = family[0];
  for (int n = 1; n < DISC_POLYNOMIALS; n++)
    if (family[n].energy > best->energy) *best = family[n];
  PetscFunctionReturn(0);
}

/* Displacement of the rim at one angle by the family's harmonics: real and imaginary part */
static void RimValue(const Disc *disc, PetscInt mode, const Family *family, PetscReal theta, PetscReal w[2])
{
  PetscReal v[4];

  w[0] = w[1] = 0;
  for (int m = 0; m < DISC_HARMONICS; m++) {
    if (!family->has[m]) continue;
    DiscProfile(disc, mode, m, disc->r_outer, v);
    for (int part = 0; part < 2; part++) w[part] += v[part] * PetscCosReal(m * theta) + v[2 + part] * PetscSinReal(m * theta);
  }
}

/* Rim values at ANGLES equal angles, in the phase in which the rim moves most; returns the largest */
static PetscReal RimShape(const Disc *disc, PetscInt mode, const Family *family, PetscReal shape[ANGLES])
{
  PetscReal w[ANGLES][2], rr = 0, ri = 0, ii = 0, phase, largest = 0;

  for (int a = 0; a < ANGLES; a++) {
    RimValue(disc, mode, family, 2 * PETSC_PI * a / ANGLES, w[a]);
    rr += w[a][0] * w[a][0], ri += w[a][0] * w[a][1], ii += w[a][1] * w[a][1];
  }
  phase = 0.5 * atan2(2 * ri, rr - ii);
  for (int a = 0; a < ANGLES; a++) {
    shape[a] = PetscCosReal(phase) * w[a][0] + PetscSinReal(phase) * w[a][1];
    largest  = PetscMax(largest, PetscAbsReal(shape[a]));
  }
  return largest;
}

/* Nodal diameters = half the antinodes around the rim. Antinodes are extrema, not lobes between zeros: the antinode at a stiff
   contact is so low that it need not cross zero. Two turns are walked; turning points are counted in the second one. */
static int NodalDiameters(const Disc *disc, PetscInt mode, const Family *family)
{
  PetscReal       shape[ANGLES], extreme;
  const PetscReal ripple = RIPPLE * RimShape(disc, mode, family, shape);
  int             direction = 0, extrema = 0;

  extreme = shape[0];
  for (int a = 0; a < 2 * ANGLES; a++) {
    const PetscReal w = shape[a % ANGLES];

    if (direction * (w - extreme) > 0) {
      extreme = w;
    } else if (PetscAbsReal(w - extreme) > ripple) {
      direction = w < extreme ? -1 : 1;
      extreme   = w;
      extrema += a >= ANGLES;
    }
  }
  return (extrema + 1) / 2;
}

PetscErrorCode DiscName(const Disc *disc, PetscInt mode, char name[], size_t size)
{
  Family family;
  int    diameters;

  PetscFunctionBeginUser;
  PetscCall(FamilyFind(disc, mode, &family));
  diameters = family.strongest && disc->has_contact ? NodalDiameters(disc, mode, &family) : family.strongest;
  PetscCall(PetscSNPrintf(name, size, "(%d,%d%s)", family.circles, diameters,
                          disc->has_contact && diameters && family.even > family.odd ? "+" : ""));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscDestroy(Disc *disc)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(disc->node, disc->weight));
  PetscCall(PetscFree(disc->basis));
  PetscCall(PetscFree(disc->gram));
  PetscCall(PetscFree(disc->fit));
  PetscFunctionReturn(0);
}
