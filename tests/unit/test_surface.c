/*
   Unit test of contact/surface/surface.h by refinement, on one and on several ranks: slaves that lie exactly on a cylinder of
   radius R face a master whose vertices do, node between nodes. Normals of the pairs and gaps converge to those of the
   cylinder with order 2; the normals of the facets alone would with order 1.
*/
#include "check.h"
#include "contact/contactimpl.h"
#include "kernels/contact/facet.h"

#define R 0.2 /* m */
#define SCENE                                                                                                          \
  "-model_source rig -rig_disc_mesh axisymmetric -rig_disc_outer 0.14 -rig_pad_radius 0.095 "                          \
  "-rig_pad_size 0.05,0.06,0.01 -rig_pad_elements 13,17,1 -rig_beam_elements 3 -disc_young 1e9 -disc_density 1000 "    \
  "-pad_young 1e9 -pad_density 1000 -beam_young 1e9 -beam_density 1000 -contacts contact "                             \
  "-contact_surfaces pad_face,disc_face -contact_slip 0,1,0 -contact_kn 1e8 -contact_tolerance 1e-3 "
#define LEVELS 3

/* Bends the plane z = 0 into the cylinder y^2 + (z + R)^2 = R^2 */
static PetscErrorCode Bend(Model model)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    PetscReal      *x     = (PetscReal *)&mesh->x[3 * v];
    const PetscReal angle = x[1] / R, r = R + x[2];

    x[1] = r * sin(angle);
    x[2] = r * cos(angle) - R;
  }
  PetscFunctionReturn(0);
}

/* Raises a to |n - exact| for a slave at x on the cylinder */
static void NormalRaise(const PetscReal x[3], const PetscReal n[3], PetscReal *a)
{
  *a = PetscMax(*a, PetscSqrtReal(n[0] * n[0] + PetscSqr(n[1] - x[1] / R) + PetscSqr(n[2] - (x[2] + R) / R)));
}

/* Largest errors of the normals, the gaps (m), and the normals of the facets alone */
static PetscErrorCode ErrorsFind(const char disc[], PetscReal error[3])
{
  const ContactSurface *surface;
  const ContactPair    *pair;
  PetscInt              n, n_all;
  Model                 model;
  Contact               contact;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, SCENE));
  PetscCall(PetscOptionsInsertString(NULL, disc));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, &model));
  PetscCall(ModelSetFromOptions(model));
  PetscCall(ContactCreate(model, &contact));
  PetscCall(ContactSetFromOptions(contact));
  PetscCall(ModelSetUp(model));
  PetscCall(Bend(model));
  PetscCall(ContactSetUp(contact));
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  PetscCall(ContactGetSurface(contact, 0, &surface));
  error[0] = error[1] = error[2] = 0;
  for (PetscInt p = 0; p < n; p++) {
    ContactFoot foot;
    PetscReal   own[3], length;

    NormalRaise(pair[p].x, pair[p].n, &error[0]);
    error[1] = PetscMax(error[1], PetscAbsReal(pair[p].gap));
    ContactFootNearest(surface, pair[p].x, &foot);
    FacetNormal(4, (const double(*)[3])surface->facet[foot.facet].x, foot.natural, own);
    length = PetscSqrtReal(own[0] * own[0] + own[1] * own[1] + own[2] * own[2]);
    for (int d = 0; d < 3; d++) own[d] /= length;
    NormalRaise(pair[p].x, own, &error[2]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, error, 3, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(ContactDestroy(&contact));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

/* Breaks when: the normals of pairs are not the means at the vertices, interpolated, or the foot is not found along
   them. Reference: the cylinder; the finest facets turn by 1.4 degrees, the coarsest by 5.4 */
int main(int argc, char **argv)
{
  static const char *const disc[LEVELS] = {"-rig_disc_elements 9,36,1", "-rig_disc_elements 18,72,1",
                                           "-rig_disc_elements 36,144,1"};
  PetscReal                error[LEVELS][3];
  int                      failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (int k = 0; k < LEVELS; k++) {
    PetscCall(ErrorsFind(disc[k], error[k]));
    printf("     normal %.3e  gap %.3e m  of the facet %.3e\n", error[k][0], error[k][1], error[k][2]);
  }
  for (int k = 1; k < LEVELS; k++) {
    failed += CheckClose("order of the normal", log2(error[k - 1][0] / error[k][0]), 2, 0.3);
    failed += CheckClose("order of the gap", log2(error[k - 1][1] / error[k][1]), 2, 0.3);
    failed += CheckClose("order of the facets' normals", log2(error[k - 1][2] / error[k][2]), 1, 0.3);
  }
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
