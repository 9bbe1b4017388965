/*
   Unit tests of statics/preload on one and on several ranks, by rigid motions.
*/
#include "statics/preload.h"
#include "freebodies.h"
#include "check.h"

/* Any smooth displacement, m */
static void Wave(const PetscReal x[3], const PetscReal value[3], PetscReal u[3])
{
  (void)value;
  for (int d = 0; d < 3; d++) u[d] = 1e-5 * sin(40 * x[d] + 25 * x[(d + 1) % 3] * x[(d + 2) % 3] / 0.01 + d);
}

static void Turned(const PetscReal x[3], const PetscReal value[3], PetscReal u[3])
{
  (void)x;
  Vec3Cross(turn, value, u);
}

/* Breaks when: a rank takes no displacements of its neighbours' vertices, or the stress is that of another Young's
   modulus. The stress of any displacement u turns with the bodies: K_g (w x x) = w x K u at each vertex, K u by
   OperatorsInternalForces(). */
static PetscErrorCode TestGeometric(const Chain *chain, int *failed)
{
  PetscReal error, largest, asymmetry;
  Vec       u, x, y, local;
  Mat       K, transposed;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(chain->model, &local));
  PetscCall(FieldCreate(chain, Wave, NULL, NULL, &u));
  PetscCall(GeometricStiffnessCreate(chain->operators, NULL, u, NULL, &K));
  PetscCall(OperatorsInternalForces(chain->operators, NULL, u, local));
  PetscCall(FieldCreate(chain, Rotation, NULL, NULL, &x));
  PetscCall(FieldCreate(chain, Turned, NULL, local, &y));
  PetscCall(Mismatch(K, x, y, &error));
  *failed += CheckClose("rotation turns the internal forces, relative", error, 0, 1e-12);
  PetscCall(MatTranspose(K, MAT_INITIAL_MATRIX, &transposed));
  PetscCall(MatNorm(K, NORM_FROBENIUS, &largest));
  PetscCall(MatAXPY(transposed, -1, K, SAME_NONZERO_PATTERN));
  PetscCall(MatNorm(transposed, NORM_FROBENIUS, &asymmetry));
  *failed += CheckClose("asymmetry of the geometric stiffness, relative", asymmetry / largest, 0, 1e-14);
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&transposed));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}

/* Made-up states: every fourth pair open, friction along t and b where `friction` is not 0 */
static PetscErrorCode StatesCreate(Contact contact, PetscReal friction, ContactState **state)
{
  const ContactPair *pairs;
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pairs));
  PetscCall(PetscCalloc1(n, state));
  for (PetscInt p = 0; p < n; p++) {
    ContactState *s = &(*state)[p];

    s->status      = p % 4 == 3 ? CONTACT_OPEN : CONTACT_SLIP;
    s->lambda_n    = 100 + 60 * sin(300 * pairs[p].x[0] + 500 * pairs[p].x[1]);
    s->lambda_t[0] = friction * s->lambda_n;
    s->lambda_t[1] = -0.3 * friction * s->lambda_n;
  }
  PetscFunctionReturn(0);
}

/* Unit vector along the projection of fixed d on the plane across n */
static void Project(const PetscReal d[3], const PetscReal n[3], PetscReal t[3])
{
  const PetscReal along = Vec3Dot(d, n);

  for (int k = 0; k < 3; k++) t[k] = d[k] - along * n[k];
  for (int k = 0; k < 3; k++) t[k] /= PetscSqrtReal(1 - along * along);
}

/* Adds scale times the internal forces of the closed pairs with all normals turned by `angle` about `turn` */
static PetscErrorCode ForcesAdd(Contact contact, const ContactState state[], PetscReal angle, PetscReal scale, Vec f)
{
  const ContactPair *pairs;
  PetscInt           n, n_all, *pair;
  PetscReal(*force)[3];
  Mat rows;
  Vec ones;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pairs));
  PetscCall(PetscCalloc2(n, &pair, n, &force));
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal length = PetscSqrtReal(Vec3Dot(turn, turn)), a = angle * length;
    PetscReal       side[3], turned[3], t[3], b[3];

    Vec3Cross(turn, pairs[p].n, side);
    for (int d = 0; d < 3; d++) /* Rodrigues */
      turned[d] = cos(a) * pairs[p].n[d] + sin(a) * side[d] / length +
                  (1 - cos(a)) * Vec3Dot(turn, pairs[p].n) * turn[d] / (length * length);
    Project(pairs[p].t, turned, t);
    Project(pairs[p].b, turned, b);
    pair[p] = p;
    for (int d = 0; d < 3 && state[p].status != CONTACT_OPEN; d++)
      force[p][d] = state[p].lambda_n * turned[d] - state[p].lambda_t[0] * t[d] - state[p].lambda_t[1] * b[d];
  }
  PetscCall(ContactCreateRows(contact, n, pair, (const PetscReal(*)[3])force, &rows));
  PetscCall(MatCreateVecs(rows, NULL, &ones));
  PetscCall(VecSet(ones, scale));
  PetscCall(MatMultTransposeAdd(rows, ones, f, f));
  PetscCall(VecDestroy(&ones));
  PetscCall(MatDestroy(&rows));
  PetscCall(PetscFree2(pair, force));
  PetscFunctionReturn(0);
}

/* Breaks when: a term has the wrong sign, open pairs take part, or t turns about n. All bodies turn: the forces change
   as their central difference over 2e-4, whose own error is 1e-8. */
static PetscErrorCode TestFollower(const Chain *chain, int *failed)
{
  const PetscReal step = 1e-4;
  ContactState   *state;
  PetscReal       error;
  Vec             x, change;
  Mat             K;

  PetscFunctionBeginUser;
  PetscCall(StatesCreate(chain->contact, 0.5, &state));
  PetscCall(FollowerStiffnessCreate(chain->operators, state, &K));
  PetscCall(FieldCreate(chain, Rotation, NULL, NULL, &x));
  PetscCall(VecDuplicate(x, &change));
  PetscCall(VecSet(change, 0));
  PetscCall(ForcesAdd(chain->contact, state, step, 1 / (2 * step), change));
  PetscCall(ForcesAdd(chain->contact, state, -step, -1 / (2 * step), change));
  PetscCall(Mismatch(K, x, change, &error));
  *failed += CheckClose("rotation of all bodies turns the contact forces, relative", error, 0, 1e-7);
  PetscCall(MatDestroy(&K));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&change));
  PetscCall(PetscFree(state));
  PetscFunctionReturn(0);
}

/* Rotation of the master about the direction (-4, 3, 0) / 5 = b through the origin by 1 rad */
static void Slope(const PetscReal x[3], const PetscReal value[3], PetscReal u[3])
{
  const PetscReal axis[3] = {-0.8, 0.6, 0};

  (void)value;
  Vec3Cross(axis, x, u);
}

/* Translation of the slave by 2 m along (3, 4, 0) / 5 = t */
static void Slide(const PetscReal x[3], const PetscReal value[3], PetscReal u[3])
{
  (void)x, (void)value;
  u[0] = 1.2;
  u[1] = 1.6;
  u[2] = 0;
}

/* Breaks when: forces stay where they are while the slave slides. Without friction the forces have a potential: K_f is
   symmetric, and a load on a surface z = 0 of slope -phi along t, s downhill, lies s phi lower: u' K_f u / 2 = - s phi
   sum l, with phi = 1 and s = 2. */
static PetscErrorCode TestPotential(const Chain *chain, int *failed)
{
  const ContactPair *pairs;
  ContactState      *state;
  PetscInt           n, n_all;
  PetscReal          total = 0, largest, asymmetry;
  PetscScalar        energy;
  Vec                x, slide, y;
  Mat                K, transposed;

  PetscFunctionBeginUser;
  PetscCall(StatesCreate(chain->contact, 0, &state));
  PetscCall(FollowerStiffnessCreate(chain->operators, state, &K));
  PetscCall(FieldCreate(chain, Slope, "disc", NULL, &x));
  PetscCall(FieldCreate(chain, Slide, "pad", NULL, &slide));
  PetscCall(VecAXPY(x, 1, slide));
  PetscCall(VecDuplicate(x, &y));
  PetscCall(MatMult(K, x, y));
  PetscCall(VecDot(x, y, &energy));
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pairs));
  for (PetscInt p = 0; p < n; p++)
    if (state[p].status != CONTACT_OPEN) total += state[p].lambda_n;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  *failed += CheckClose("energy of a load that slides down a slope, relative", energy / 2 / (2 * total), -1, 1e-12);
  PetscCall(MatTranspose(K, MAT_INITIAL_MATRIX, &transposed));
  PetscCall(MatNorm(K, NORM_FROBENIUS, &largest));
  PetscCall(MatAXPY(transposed, -1, K, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatNorm(transposed, NORM_FROBENIUS, &asymmetry));
  *failed += CheckClose("asymmetry without friction, relative", asymmetry / largest, 0, 1e-14);
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&transposed));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscCall(VecDestroy(&slide));
  PetscCall(PetscFree(state));
  PetscFunctionReturn(0);
}

/* All tests on one mesh */
static PetscErrorCode TestMesh(const char title[], const char scene[], int *failed)
{
  Chain chain;

  PetscFunctionBeginUser;
  printf("--- %s\n", title);
  PetscCall(ChainCreate(scene, BODIES_1, &chain));
  PetscCall(TestGeometric(&chain, failed));
  PetscCall(TestFollower(&chain, failed));
  PetscCall(TestPotential(&chain, failed));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestMesh("node on node", FREE, &failed));
  PetscCall(TestMesh("nodes between nodes", FREE BETWEEN, &failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
