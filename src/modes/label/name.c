/*
   Reading of a disc's fitted shape (disc.c): nodal diameters, nodal circles, and the antinode at the contact.
*/
#include "disc.h"
#include "base/algebra/dense.h"

#define ANGLES 360   /* angles at which the rim is read */
#define RIPPLE 0.005 /* turns of the rim's displacement smaller than this part of the largest do not count */

PetscErrorCode DiscNodalCircles(const Disc *disc, PetscInt mode, int direction, int m, const PetscReal moments[],
                                int *n)
{
  PetscReal a[16], values[4], profile[DISC_SAMPLES], v[4], largest = 0, last = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(a, moments, 16));
  PetscCall(DenseSymmetricEigen(4, a, NULL, values, NULL));
  for (int s = 0; s < DISC_SAMPLES; s++) {
    DiscProfile(disc, mode, direction, m, DiscSample(disc, s), v);
    profile[s] = 0;
    for (int k = 0; k < 4; k++) profile[s] += a[12 + k] * v[k];
    largest = PetscMax(largest, PetscAbsReal(profile[s]));
  }
  *n = 0;
  for (int s = 0; s < DISC_SAMPLES; s++) {
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
  for (int m = 0; m < disc->n_harmonics; m++) {
    PetscReal       moments[16];
    const PetscReal energy = DiscMomentsOf(disc, mode, DISC_AXIAL, m, moments);
    int             n;

    PetscCall(DiscNodalCircles(disc, mode, DISC_AXIAL, m, moments, &n));
    n                 = PetscMin(n, DISC_POLYNOMIALS - 1);
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
    DiscProfile(disc, mode, DISC_AXIAL, m, disc->range[1], v);
    for (int part = 0; part < 2; part++)
      w[part] += v[part] * PetscCosReal(m * theta) + v[2 + part] * PetscSinReal(m * theta);
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

/* Nodal diameters = half the antinodes around the rim. Antinodes are extrema, not lobes between zeros: the antinode
   at a stiff contact is so low that it need not cross zero. Two turns are walked; turning points are counted in the
   second one. */
static int NodalDiameters(const Disc *disc, PetscInt mode, const Family *family)
{
  PetscReal       shape[ANGLES], extreme;
  const PetscReal ripple    = RIPPLE * RimShape(disc, mode, family, shape);
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

PetscErrorCode DiscName(const Disc *disc, PetscInt mode, char name[], size_t size, PetscReal *energy)
{
  Family family;
  int    diameters;

  PetscFunctionBeginUser;
  PetscCall(FamilyFind(disc, mode, &family));
  diameters = family.strongest && disc->has_contact ? NodalDiameters(disc, mode, &family) : family.strongest;
  PetscCall(PetscSNPrintf(name, size, "(%d,%d%s)", family.circles, diameters,
                          disc->has_contact && diameters && family.even > family.odd ? "+" : ""));
  PetscCall(DiscExplain(disc, mode, PetscMin(diameters, DISC_HARMONICS - 1), DISC_AXIAL, DISC_AXIAL, energy));
  PetscFunctionReturn(0);
}
