/*
   A disc: frame from the inertia tensor, the friction ring, the harmonics that its mesh resolves.
*/
#include "disc.h"
#include "base/algebra/dense.h"
#include "base/algebra/vec3.h"

#define DISC_BINS    720  /* of the rim, to find gaps between columns of nodes */
#define DISC_SECTORS 8    /* all of which a surface around the axis has nodes in */
#define DISC_ROUND   0.05 /* of the largest second moment: two of a body of revolution differ by less, holes included */
#define DISC_RIM     0.98 /* of the outer radius: nodes beyond it are on the rim */

/* Centre (m) and second moments per mass, sum m d d' / sum m (m^2), over all ranks */
static PetscErrorCode DiscMoments(MPI_Comm comm, PetscInt n, const PetscReal x[], const PetscReal mass[],
                                  PetscReal centre[3], PetscReal inertia[9])
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
    for (int k = 0; k < 9; k++)
      inertia[k] += mass[v] * (x[3 * v + k / 3] - centre[k / 3]) * (x[3 * v + k % 3] - centre[k % 3]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, inertia, 9, MPIU_REAL, MPI_SUM, comm));
  for (int k = 0; k < 9; k++) inertia[k] /= sums[3];
  PetscFunctionReturn(0);
}

/* Axis = principal direction whose second moment differs from the other two; these must agree within DISC_ROUND */
static PetscErrorCode DiscFindAxis(const PetscReal inertia[9], PetscReal axis[3], PetscBool *found)
{
  PetscReal a[9], values[3];
  int       k;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(a, inertia, 9));
  PetscCall(DenseSymmetricEigen(3, a, NULL, values, NULL));
  k      = values[1] - values[0] > values[2] - values[1] ? 0 : 2;
  *found = PetscAbsReal(values[1] - values[2 - k]) < DISC_ROUND * values[2] ? PETSC_TRUE : PETSC_FALSE;
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
  along = Vec3Dot(disc->e1, disc->axis);
  for (int d = 0; d < 3; d++) disc->e1[d] -= along * disc->axis[d];
  length = Vec3Length(disc->e1);
  if (to && length < 1e-3 * disc->size) { /* a contact all around the axis has no angle */
    disc->has_contact = PETSC_FALSE;
    FindPlane(disc, NULL);
    return;
  }
  for (int d = 0; d < 3; d++) disc->e1[d] /= length;
  Vec3Cross(disc->axis, disc->e1, disc->e2);
}

/* Least values over all ranks */
static PetscErrorCode LeastOfAll(MPI_Comm comm, int n, PetscReal values[])
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, n, MPIU_REAL, MPI_MIN, comm));
  PetscFunctionReturn(0);
}

/* Least radius of the friction ring: that of a contact surface that goes all around the axis, else 0 */
static PetscErrorCode DiscFindRing(const Disc *disc, const DiscPart *part, PetscReal *inner)
{
  PetscReal least[1 + DISC_SECTORS] = {PETSC_MAX_REAL}, r, theta;

  PetscFunctionBeginUser;
  for (PetscInt v = 0; part->surface && v < part->n_vertices; v++) {
    if (!part->surface[v] || part->mass[v] <= 0) continue;
    DiscPolar(disc, &part->x[3 * v], &r, &theta);
    least[0]                                                                            = PetscMin(least[0], r);
    least[1 + (int)((theta + PETSC_PI) / (2 * PETSC_PI) * DISC_SECTORS) % DISC_SECTORS] = -1;
  }
  PetscCall(LeastOfAll(disc->comm, 1 + DISC_SECTORS, least));
  *inner = least[0] < PETSC_MAX_REAL ? least[0] * (1 - 1e-6) : 0;
  for (int k = 0; k < DISC_SECTORS; k++)
    if (least[1 + k] == 0) *inner = 0;
  PetscFunctionReturn(0);
}

/* Bounds of what counts as the disc: radii, and how far the outer half of the ring reaches along the axis. A hat or a
   bell inside of it does not count */
static PetscErrorCode DiscFindBounds(const Disc *disc, const DiscPart *part, PetscReal radius[2], PetscReal along[2])
{
  PetscReal least[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, r, theta;

  PetscFunctionBeginUser;
  PetscCall(DiscFindRing(disc, part, &radius[0]));
  for (PetscInt v = 0; v < part->n_vertices; v++) {
    if (part->mass[v] <= 0) continue;
    DiscPolar(disc, &part->x[3 * v], &r, &theta);
    least[0] = PetscMin(least[0], -r);
  }
  PetscCall(LeastOfAll(disc->comm, 1, least));
  radius[1] = -least[0];
  along[0] = along[1] = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < part->n_vertices; v++) {
    const PetscReal z = Vec3Dot(&part->x[3 * v], disc->axis);

    DiscPolar(disc, &part->x[3 * v], &r, &theta);
    if (part->mass[v] <= 0 || (radius[0] > 0 && r < (radius[0] + radius[1]) / 2)) continue;
    along[0] = PetscMin(along[0], z);
    along[1] = PetscMin(along[1], -z);
  }
  PetscCall(LeastOfAll(disc->comm, 2, along));
  along[0] -= 1e-6 * disc->size;
  along[1] = -along[1] + 1e-6 * disc->size;
  PetscFunctionReturn(0);
}

/* Nodes of the disc on this rank, their weights; over all ranks its radii, and where its profiles are read */
static PetscErrorCode DiscNodes(Disc *disc, const DiscPart *part)
{
  PetscReal range[4], radius[2], along[2], r, theta;

  PetscFunctionBeginUser;
  for (int k = 0; k < 4; k++) range[k] = PETSC_MAX_REAL;
  PetscCall(DiscFindBounds(disc, part, radius, along));
  PetscCall(PetscMalloc2(part->n_vertices, &disc->node, part->n_vertices, &disc->weight));
  for (PetscInt v = 0; v < part->n_vertices; v++) {
    const PetscReal z = Vec3Dot(&part->x[3 * v], disc->axis), s = DiscAlong(disc, &part->x[3 * v]);

    DiscPolar(disc, &part->x[3 * v], &r, &theta);
    if (part->mass[v] <= 0 || r < radius[0] || z < along[0] || z > along[1]) continue;
    disc->weight[disc->n_nodes] = part->mass[v];
    disc->node[disc->n_nodes++] = v;
    range[0]                    = PetscMin(range[0], r);
    range[1]                    = PetscMin(range[1], -r);
    range[2]                    = PetscMin(range[2], s);
    range[3]                    = PetscMin(range[3], -s);
  }
  PetscCall(LeastOfAll(disc->comm, 4, range));
  disc->r_inner = range[0];
  disc->r_outer = -range[1];
  disc->is_drum = -range[3] - range[2] > 2 * (disc->r_outer - disc->r_inner) ? PETSC_TRUE : PETSC_FALSE;
  for (int k = 0; k < 2; k++) disc->range[k] = (k ? -1 : 1) * range[2 * disc->is_drum + k];
  PetscFunctionReturn(0);
}

/* Harmonics that the mesh resolves, three columns of nodes to a wave: the widest gap between columns at the rim
   decides, seen in bins of half a degree */
static PetscErrorCode DiscResolution(Disc *disc, const PetscReal x[])
{
  int       seen[DISC_BINS] = {0}, gap = 0, widest = 1;
  PetscReal r, theta;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < disc->n_nodes; i++) {
    DiscPolar(disc, &x[3 * disc->node[i]], &r, &theta);
    if (r > DISC_RIM * disc->r_outer) seen[(int)((theta + PETSC_PI) / (2 * PETSC_PI) * DISC_BINS) % DISC_BINS] = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seen, DISC_BINS, MPI_INT, MPI_MAX, disc->comm));
  for (int a = 0; a < 2 * DISC_BINS; a++) {
    gap    = seen[a % DISC_BINS] ? 1 : gap + 1;
    widest = PetscMax(widest, gap);
  }
  disc->n_harmonics = PetscMin(DISC_HARMONICS, DISC_BINS / widest / 3 + 1);
  PetscFunctionReturn(0);
}

PetscErrorCode DiscCreate(MPI_Comm comm, const DiscPart *part, Disc *disc, PetscBool *is_disc)
{
  PetscReal inertia[9];

  PetscFunctionBeginUser;
  disc->comm        = comm;
  disc->has_contact = part->contact ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(DiscMoments(comm, part->n_vertices, part->x, part->mass, disc->centre, inertia));
  PetscCall(DiscFindAxis(inertia, disc->axis, is_disc));
  if (!*is_disc) PetscFunctionReturn(0);
  disc->size = PetscSqrtReal(inertia[0] + inertia[4] + inertia[8]);
  FindPlane(disc, part->contact);
  PetscCall(DiscNodes(disc, part));
  *is_disc = disc->r_outer - disc->r_inner > 1e-6 * disc->r_outer ? PETSC_TRUE : PETSC_FALSE;
  if (!*is_disc) PetscFunctionReturn(0);
  PetscCall(DiscResolution(disc, part->x));
  PetscCall(DiscFitCreate(disc, part->x));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscDestroy(Disc *disc)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(disc->node, disc->weight));
  PetscCall(PetscFree(disc->place));
  PetscCall(PetscFree2(disc->basis, disc->turn));
  PetscCall(PetscFree(disc->gram));
  PetscCall(PetscFree2(disc->waiting, disc->waiting_from));
  PetscCall(PetscFree2(disc->rhs, disc->fit));
  PetscFunctionReturn(0);
}
