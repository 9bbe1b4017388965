/*
   Names of a disc's in-plane shapes, of harmonic n of u_r and u_theta: IP-R(n) where the ring moves more along the
   radius, IP-C(n) where it moves more around the circumference. IP-R(0) is breathing, IP-C(0) torsion; n nodal
   diameters, + for an antinode of that displacement at the contact.

   A thin ring with u_r = a cos n theta, u_theta = b sin n theta has (A. E. H. Love, Mathematical Theory of Elasticity,
   sec. 293)

      flexure      a = -n b   its circumference keeps its length: a + n b = 0   radial for n >= 2
      extension    b = n a    orthogonal to flexure                             circumferential for n >= 2

   Where the profile of that displacement along the radius changes its sign, c times, the name has c before n: the shear
   of a wide ring, which turns its inner edge against its outer one, is IP-C(1,0).

   For n = 1 both directions have half of the energy: then the hoop strain (a + n b) / r decides. Without it the ring
   moves as a whole, IP-R(1); where the circumference is stretched and compressed it is IP-C(1).
*/
#include "disc.h"

#define INPLANE_EVEN 0.05 /* from one half: shares of the energy that are about even */

/* Harmonic n in the plane: energy along the radius, around the circumference, and of extension */
typedef struct {
  int       n;
  PetscReal radial, around, stretched;
} InPlane;

/* Energy of the component of (a, b) along (1, n) / sqrt(1 + n^2) for n > 0, over cosine and sine, re and im */
static PetscReal StretchedEnergy(const Disc *disc, PetscInt mode, int n)
{
  PetscReal sum = 0, a[N_DISC_VALUES], b[N_DISC_VALUES];

  for (int k = 0; k < DISC_SAMPLES; k++) {
    const PetscReal s = DiscSample(disc, k), r = DiscSampleWeight(disc, s);

    DiscProfile(disc, mode, DISC_RADIAL, n, s, a);
    DiscProfile(disc, mode, DISC_TANGENTIAL, n, s, b);
    for (int part = 0; part < 2; part++) /* d/dtheta turns a sine into n cos, a cosine into -n sin */
      sum += r * (PetscSqr(a[DISC_COS_RE + part] + n * b[DISC_SIN_RE + part]) +
                  PetscSqr(a[DISC_SIN_RE + part] - n * b[DISC_COS_RE + part]));
  }
  return sum / (1 + n * n);
}

/* Whether the shape counts as radial */
static PetscBool InPlaneIsRadial(const InPlane *shape)
{
  const PetscReal total = shape->radial + shape->around;

  if (shape->n && PetscAbsReal(shape->radial - 0.5 * total) < INPLANE_EVEN * total)
    return shape->stretched < 0.5 * total ? PETSC_TRUE : PETSC_FALSE;
  return shape->radial > shape->around ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode DiscNameInPlane(const Disc *disc, PetscInt mode, char name[], size_t size, PetscReal *energy)
{
  InPlane   most        = {.n = 0};
  char      circles[16] = "";
  int       n_circles;
  PetscReal m[N_DISC_VALUES * N_DISC_VALUES], even;
  PetscBool radial = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (int n = 0; n < disc->n_harmonics; n++) {
    const InPlane is = {.n      = n,
                        .radial = DiscMomentsOf(disc, mode, DISC_RADIAL, n, m),
                        .around = DiscMomentsOf(disc, mode, DISC_TANGENTIAL, n, m)};

    if (is.radial + is.around > most.radial + most.around) most = is;
  }
  most.stretched = StretchedEnergy(disc, mode, most.n);
  radial         = InPlaneIsRadial(&most);
  even           = DiscMomentsOf(disc, mode, radial ? DISC_RADIAL : DISC_TANGENTIAL, most.n, m);
  PetscCall(DiscNodalCircles(disc, mode, radial ? DISC_RADIAL : DISC_TANGENTIAL, most.n, m, &n_circles));
  if (n_circles) PetscCall(PetscSNPrintf(circles, sizeof(circles), "%d,", n_circles));
  even = m[0] + m[5] - 0.5 * even;
  PetscCall(PetscSNPrintf(name, size, "IP-%c(%s%d%s)", radial ? 'R' : 'C', circles, most.n,
                          disc->has_contact && most.n && even > 0 ? "+" : ""));
  PetscCall(DiscExplain(disc, mode, most.n, DISC_RADIAL, DISC_TANGENTIAL, energy));
  PetscFunctionReturn(0);
}
