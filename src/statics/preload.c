/*
   Stiffness that the forces of the sliding state add to small motions about it.

   Geometric stiffness, of the stress sigma (Pa) in the bodies:

      K_g = int grad N_i . sigma . grad N_j dV   times the 3 x 3 identity
      (kernels/element/geometric.h)

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
#include "operators/terms/terms.h"

PetscErrorCode GeometricStiffnessCreate(Operators operators, const PetscReal p[], Vec u, const PetscReal share[],
                                        Mat *K)
{
  const Mesh *mesh;
  PetscReal  *displacement;
  Model       model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &displacement));
  PetscCall(ModelGetDisplaced(model, u, displacement));
  PetscCall(OperatorsCreateGeometric(operators, p, displacement, share, K));
  PetscCall(PetscFree(displacement));
  PetscFunctionReturn(0);
}

/* Operators of all pairs, rows of the local ones in their order */
typedef enum { FOLLOWER_N, FOLLOWER_T, FOLLOWER_B, FOLLOWER_TILT_T, FOLLOWER_TILT_B, N_FOLLOWER } FollowerOperator;

/* Forces of the closed pairs: normal ones, friction along t and b, N */
static PetscErrorCode FollowerCreateForces(PetscInt n, const ContactState state[], Mat N, Vec force[3])
{
  PetscFunctionBeginUser;
  for (int k = 0; k < 3; k++) {
    PetscScalar *value;

    PetscCall(MatCreateVecs(N, NULL, &force[k]));
    PetscCall(VecGetArray(force[k], &value));
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal closed = state[i].status == CONTACT_OPEN ? 0 : 1;

      value[i] = closed * (k ? state[i].lambda_t[k - 1] : state[i].lambda_n);
    }
    PetscCall(VecRestoreArray(force[k], &value));
  }
  PetscFunctionReturn(0);
}

/* Operators of all local pairs */
static PetscErrorCode FollowerCreateOperators(Contact contact, PetscInt n, Mat A[N_FOLLOWER])
{
  PetscInt *pair;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &pair));
  for (PetscInt i = 0; i < n; i++) pair[i] = i;
  PetscCall(ContactCreatePairOperators(contact, n, pair, &A[FOLLOWER_N], &A[FOLLOWER_T], &A[FOLLOWER_B]));
  PetscCall(PetscFree(pair));
  PetscCall(ContactCreateTilt(contact, &A[FOLLOWER_TILT_T], &A[FOLLOWER_TILT_B]));
  PetscFunctionReturn(0);
}

/* The six products of the header, N/m, in its order: T'L Theta_t, B'L Theta_b, their transposes, N'F_t Theta_t, N'F_b
   Theta_b. force: 0 L, 1 F_t, 2 F_b. Open pairs have the force 0 and drop out; the pattern stays that of all pairs. */
PetscErrorCode FollowerStiffnessCreate(Operators operators, const ContactState state[], Mat *K)
{
  /* left' diag(force) right */
  static const struct {
    FollowerOperator left, right;
    int              force;
  } product[] = {{FOLLOWER_T, FOLLOWER_TILT_T, 0}, {FOLLOWER_B, FOLLOWER_TILT_B, 0}, {FOLLOWER_TILT_T, FOLLOWER_T, 0},
                 {FOLLOWER_TILT_B, FOLLOWER_B, 0}, {FOLLOWER_N, FOLLOWER_TILT_T, 1}, {FOLLOWER_N, FOLLOWER_TILT_B, 2}};
  const ContactPair *pairs;
  PetscInt           n, n_all;
  Contact            contact;
  Mat                A[N_FOLLOWER], one;
  Vec                force[3];

  PetscFunctionBeginUser;
  *K = NULL;
  PetscCall(OperatorsGetModel(operators, NULL, &contact));
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pairs));
  if (!n_all) PetscFunctionReturn(0);
  PetscCall(FollowerCreateOperators(contact, n, A));
  PetscCall(FollowerCreateForces(n, state, A[FOLLOWER_N], force));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(product); i++) {
    PetscCall(TermsProduct(1, A[product[i].left], force[product[i].force], A[product[i].right], i ? &one : K));
    if (!i) continue;
    PetscCall(MatAXPY(*K, 1, one, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatDestroy(&one));
  }
  for (int k = 0; k < N_FOLLOWER; k++) PetscCall(MatDestroy(&A[k]));
  for (int k = 0; k < 3; k++) PetscCall(VecDestroy(&force[k]));
  PetscFunctionReturn(0);
}
