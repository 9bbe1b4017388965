/*
   Stiffness that the forces of the sliding state add to small motions about it.

   Geometric stiffness, of the stress sigma (Pa) in the bodies:

      K_g = int grad N_i . sigma . grad N_j dV   times the 3 x 3 identity                    (kernels/geometric.h)

   Follower stiffness, of the contact forces on the surfaces. Pair p: normal force l, friction f_t, f_b on the master
   along t, b (N); internal forces N' l - T' f_t - B' f_b. When the master's surface turns, by Theta_t u = t . delta n
   and Theta_b u = b . delta n,

      delta n = t Theta_t u + b Theta_b u,   delta t = - n Theta_t u,   delta b = - n Theta_b u:

   t and b stay the projections of directions fixed in space, as the sliding velocity is one, and do not turn about n.
   A slave that slides by -T u along t and -B u along b takes the normal force with it over the master, whose work on
   n . u_m thus changes by its slope -Theta u: the second pair of terms. Together, with L = diag(l), F = diag(f),

      K_f = T' L Theta_t + B' L Theta_b + Theta_t' L T + Theta_b' L B + N' (F_t Theta_t + F_b Theta_b).

   Without friction K_f is symmetric, as the forces have a potential: a load l on a slope of angle phi, s beside its
   hinge, lies s phi higher. A rigid rotation w without part along n turns the forces with the bodies, to w x f; about n
   the friction keeps its direction. Left out: the curvature of the surface; the strain and spin of the master in its
   plane, on which friction works when it moves over it; and the rotations of the sliding state itself, since all
   operators keep the geometry of the mesh.

   Reference for the frictionless part: P. Wriggers, Computational Contact Mechanics, 2006, chapter 9 (linearised normal
   contact of a node with a surface).
*/
#include "preload.h"

/* Adds local cell c with displacements u, three values per local vertex */
static PetscErrorCode GeometricAddCell(Model model, PetscInt c, const Elasticity *material, const PetscReal u[], Mat K)
{
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscInt          n, vertices[ELEMENT_MAX_NODES], rows[ELEMENT_MAX_DOFS];
  PetscReal         x[ELEMENT_MAX_DOFS], ue[ELEMENT_MAX_DOFS], ke[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(model, &scene));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetCell(model, c, vertices, x));
  n = 3 * scene->element->n_nodes;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt at = 3 * vertices[i / 3] + i % 3;

    rows[i] = mesh->unknown[at];
    ue[i]   = u[at];
  }
  PetscCheck(!scene->element->geometric(x, material, ue, ke), PETSC_COMM_SELF, PETSC_ERR_PLIB, "element is inverted");
  PetscCall(MatSetValues(K, n, rows, n, rows, ke, ADD_VALUES));
  PetscFunctionReturn(0);
}

/* Adds all local cells */
static PetscErrorCode GeometricAddCells(Operators operators, const PetscReal p[], Model model, const PetscReal u[],
                                        Mat K)
{
  const ModelScene *scene;
  const Mesh       *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetScene(model, &scene));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Part       *part = &scene->parts[mesh->cell_part[c]];
    OperatorsMaterial values;
    Elasticity        material;

    PetscCall(OperatorsGetMaterial(operators, p, mesh->cell_part[c], &values));
    material = ElasticityFromEngineering(values.young, part->poisson, part->density);
    PetscCall(GeometricAddCell(model, c, &material, u, K));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode GeometricStiffnessCreate(Operators operators, const PetscReal p[], Vec u, Mat *K)
{
  const Mesh *mesh;
  PetscReal  *displacement;
  Model       model;
  Mat         bodies;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(OperatorsGetBodies(operators, p, &bodies, NULL, NULL)); /* couples the same unknowns */
  PetscCall(MatDuplicate(bodies, MAT_DO_NOT_COPY_VALUES, K));
  PetscCall(MatSetOption(*K, MAT_NO_OFF_PROC_ENTRIES, PETSC_FALSE)); /* which sums of matrices set */
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PetscMalloc1(3 * mesh->n_vertices, &displacement));
  PetscCall(ModelGetNodal(model, u, displacement));
  PetscCall(GeometricAddCells(operators, p, model, displacement, *K));
  PetscCall(PetscFree(displacement));
  PetscCall(MatAssemblyBegin(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*K, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Operators of all pairs, rows of the local ones in their order, and the forces of the closed ones, N */
typedef struct {
  Mat N, T, B, tilt_t, tilt_b;
  Vec normal, friction_t, friction_b;
} FollowerPairs;

/* Forces of the closed pairs */
static PetscErrorCode FollowerCreateForces(PetscInt n, const ContactState state[], FollowerPairs *p)
{
  PetscScalar *force[3];

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(p->N, NULL, &p->normal));
  PetscCall(VecDuplicate(p->normal, &p->friction_t));
  PetscCall(VecDuplicate(p->normal, &p->friction_b));
  PetscCall(VecGetArray(p->normal, &force[0]));
  PetscCall(VecGetArray(p->friction_t, &force[1]));
  PetscCall(VecGetArray(p->friction_b, &force[2]));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal closed = state[i].status == CONTACT_OPEN ? 0 : 1;

    force[0][i] = closed * state[i].lambda_n;
    force[1][i] = closed * state[i].lambda_t[0];
    force[2][i] = closed * state[i].lambda_t[1];
  }
  PetscCall(VecRestoreArray(p->normal, &force[0]));
  PetscCall(VecRestoreArray(p->friction_t, &force[1]));
  PetscCall(VecRestoreArray(p->friction_b, &force[2]));
  PetscFunctionReturn(0);
}

static PetscErrorCode FollowerCreatePairs(Contact contact, const ContactState state[], FollowerPairs *p)
{
  const ContactPair *pairs;
  PetscInt           n, n_all, *pair;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pairs));
  PetscCall(PetscMalloc1(n, &pair));
  for (PetscInt i = 0; i < n; i++) pair[i] = i;
  PetscCall(ContactCreatePairOperators(contact, n, pair, &p->N, &p->T, &p->B));
  PetscCall(PetscFree(pair));
  PetscCall(ContactCreateTilt(contact, &p->tilt_t, &p->tilt_b));
  PetscCall(FollowerCreateForces(n, state, p));
  PetscFunctionReturn(0);
}

static PetscErrorCode FollowerDestroyPairs(FollowerPairs *p)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&p->N));
  PetscCall(MatDestroy(&p->T));
  PetscCall(MatDestroy(&p->B));
  PetscCall(MatDestroy(&p->tilt_t));
  PetscCall(MatDestroy(&p->tilt_b));
  PetscCall(VecDestroy(&p->normal));
  PetscCall(VecDestroy(&p->friction_t));
  PetscCall(VecDestroy(&p->friction_b));
  PetscFunctionReturn(0);
}

/* left' diag(force) right, added to *K, which is NULL before the first */
static PetscErrorCode FollowerAddProduct(Mat left, Vec force, Mat right, Mat *K)
{
  Mat scaled, product;

  PetscFunctionBeginUser;
  PetscCall(MatDuplicate(right, MAT_COPY_VALUES, &scaled));
  PetscCall(MatDiagonalScale(scaled, force, NULL));
  PetscCall(MatTransposeMatMult(left, scaled, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
  PetscCall(MatProductClear(product));
  PetscCall(MatDestroy(&scaled));
  if (*K) {
    PetscCall(MatAXPY(*K, 1, product, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatDestroy(&product));
  } else
    *K = product;
  PetscFunctionReturn(0);
}

PetscErrorCode FollowerStiffnessCreate(Operators operators, const ContactState state[], Mat *K)
{
  const ContactInterface *interfaces;
  PetscInt                n;
  Contact                 contact;
  FollowerPairs           p;

  PetscFunctionBeginUser;
  *K = NULL;
  PetscCall(OperatorsGetModel(operators, NULL, &contact));
  PetscCall(ContactGetInterfaces(contact, &n, &interfaces));
  if (!n) PetscFunctionReturn(0);
  PetscCall(FollowerCreatePairs(contact, state, &p));
  PetscCall(FollowerAddProduct(p.T, p.normal, p.tilt_t, K));
  PetscCall(FollowerAddProduct(p.B, p.normal, p.tilt_b, K));
  PetscCall(FollowerAddProduct(p.tilt_t, p.normal, p.T, K));
  PetscCall(FollowerAddProduct(p.tilt_b, p.normal, p.B, K));
  PetscCall(FollowerAddProduct(p.N, p.friction_t, p.tilt_t, K));
  PetscCall(FollowerAddProduct(p.N, p.friction_b, p.tilt_b, K));
  PetscCall(FollowerDestroyPairs(&p));
  PetscFunctionReturn(0);
}
