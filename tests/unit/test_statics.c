/*
   The statics on 200 scenes drawn at random with a fixed seed: each ends with the laws of contact and equilibrium obeyed
   or with an error of PETSC_ERR_NOT_CONVERGED or PETSC_ERR_USER_INPUT, and never goes on for ever.
*/
#include <squeal/statics.h>
#include "check.h"
#include "enumerate.h"
#include "randomscene.h"

#define N_SCENES  200
#define LAW       1e-10 /* residuals of the laws, relative */
#define FORCES    1e-8  /* forces beside those of brute force, relative to the largest */
#define MOST_IT   400

/* What became of the scenes */
typedef struct {
  int       n, solved, refused, unsolved, other_error, wrong, not_found, unlike, slow, known, must;
  PetscReal kkt, equilibrium, forces, scaled;
} Tally;

/* Loads as a vector of the unknowns */
static PetscErrorCode LoadsCreate(const Chain *chain, Vec *f)
{
  const PetscInt    *unknowns;
  const PetscScalar *value;
  const Load        *loads;
  PetscInt           n, n_loads;
  Vec                coordinates, local;
  DM                 dm;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(chain->operators, f));
  PetscCall(VecSetOption(*f, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  PetscCall(ModelGetDM(chain->model, &dm));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecDuplicate(coordinates, &local));
  PetscCall(VecSet(local, 0));
  PetscCall(ModelGetLoads(chain->model, &n_loads, &loads));
  for (PetscInt i = 0; i < n_loads; i++) PetscCall(ModelAddLoad(chain->model, i, local));
  PetscCall(ModelGetUnknowns(chain->model, &unknowns));
  PetscCall(VecGetLocalSize(local, &n));
  PetscCall(VecGetArrayRead(local, &value));
  PetscCall(VecSetValues(*f, n, unknowns, value, INSERT_VALUES));
  PetscCall(VecRestoreArrayRead(local, &value));
  PetscCall(VecAssemblyBegin(*f));
  PetscCall(VecAssemblyEnd(*f));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}

/* b += factor * rows' (component of the states), component 0 lambda_n, 1 and 2 lambda_t */
static PetscErrorCode ForcesAdd(Mat rows, const ContactState state[], int component, PetscReal factor, Vec b)
{
  PetscScalar *value;
  PetscInt     n;
  Vec          l;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(rows, NULL, &l));
  PetscCall(VecGetLocalSize(l, &n));
  PetscCall(VecGetArray(l, &value));
  for (PetscInt p = 0; p < n; p++) value[p] = factor * (component ? state[p].lambda_t[component - 1] : state[p].lambda_n);
  PetscCall(VecRestoreArray(l, &value));
  PetscCall(MatMultTransposeAdd(rows, l, b, b));
  PetscCall(VecDestroy(&l));
  PetscFunctionReturn(0);
}

/* |K u + N'lambda_n - T'lambda_t - B'lambda_b - f| / |f|, and what rounding of u leaves of it, eps max|K| |u| / |f| */
static PetscErrorCode Imbalance(const Chain *chain, const ContactState state[], Vec u, PetscReal *error,
                                PetscReal *rounding)
{
  PetscReal norm, load, stiffest, move;
  Mat       K, rows[3];
  Vec       f, r, diagonal;

  PetscFunctionBeginUser;
  PetscCall(LoadsCreate(chain, &f));
  PetscCall(VecDuplicate(f, &r));
  PetscCall(VecDuplicate(f, &diagonal));
  PetscCall(OperatorsGetBodies(chain->operators, &K));
  PetscCall(MatMult(K, u, r));
  PetscCall(VecAXPY(r, -1, f));
  PetscCall(ContactCreateOperators(chain->contact, 0, &rows[0], &rows[1], &rows[2]));
  for (int i = 0; i < 3; i++) {
    PetscCall(ForcesAdd(rows[i], state, i, i ? -1 : 1, r));
    PetscCall(MatDestroy(&rows[i]));
  }
  PetscCall(VecNorm(r, NORM_2, &norm));
  PetscCall(VecNorm(f, NORM_2, &load));
  PetscCall(MatGetDiagonal(K, diagonal));
  PetscCall(VecNorm(diagonal, NORM_INFINITY, &stiffest));
  PetscCall(VecNorm(u, NORM_2, &move));
  *error    = norm / load;
  *rounding = PETSC_MACHINE_EPSILON * stiffest * move / load;
  PetscCall(VecDestroy(&f));
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&diagonal));
  PetscFunctionReturn(0);
}

/* The contact problem of a scene in long double; n = 0 where it has too many pairs */
static PetscErrorCode DenseContactCreate(const Scene *scene, const Chain *chain, DenseContact *c)
{
  const ContactPair *pairs;
  const PetscScalar *value;
  PetscInt           n, n_all, n_unknowns;
  Mat                K, N, T;
  Vec                f;

  PetscFunctionBeginUser;
  *c = (DenseContact){.n = 0};
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pairs));
  if (n > ENUMERATE_MAX) PetscFunctionReturn(0);
  c->n = (int)n;
  PetscCall(OperatorsGetBodies(chain->operators, &K));
  PetscCall(MatGetSize(K, &n_unknowns, NULL));
  c->n_unknowns = (int)n_unknowns;
  PetscCall(ContactCreateOperators(chain->contact, 0, &N, &T, NULL));
  PetscCall(LongMatrix(K, &c->K));
  PetscCall(LongMatrix(N, &c->N));
  PetscCall(LongMatrix(T, &c->T));
  PetscCall(LoadsCreate(chain, &f));
  PetscCall(VecGetArrayRead(f, &value));
  c->f = calloc((size_t)n_unknowns, sizeof(*c->f));
  for (PetscInt i = 0; i < n_unknowns; i++) c->f[i] = value[i];
  PetscCall(VecRestoreArrayRead(f, &value));
  for (PetscInt p = 0; p < n; p++) {
    c->g0[p]    = pairs[p].gap;
    c->slack[p] = 1 / (long double)scene->kn;
  }
  PetscCall(VecDestroy(&f));
  PetscCall(MatDestroy(&N));
  PetscCall(MatDestroy(&T));
  PetscFunctionReturn(0);
}

/* Whether a solution was found by brute force too, where the scene is of the kind that it can do; the most that forces
   differ by from the nearest */
static PetscErrorCode CompareForces(const Scene *scene, const Chain *chain, const ContactState state[], Solutions *s,
                                    PetscBool *known, PetscReal *error)
{
  DenseContact c;

  PetscFunctionBeginUser;
  *known = PETSC_FALSE;
  if (!scene->held || !(scene->slides || scene->mu == 0)) PetscFunctionReturn(0);
  PetscCall(DenseContactCreate(scene, chain, &c));
  if (!c.n) PetscFunctionReturn(0);
  *known = Enumerate(&c, scene->mu, s);
  *error = PETSC_MAX_REAL;
  for (int i = 0; i < PetscMin(s->n, 8) && state; i++) {
    PetscReal worst = 0, largest = 0;

    for (int p = 0; p < c.n; p++) {
      worst   = PetscMax(worst, PetscAbsReal(s->force[i][p] - state[p].lambda_n));
      largest = PetscMax(largest, s->force[i][p]);
    }
    *error = PetscMin(*error, largest > 0 ? worst / largest : worst);
  }
  free(c.K);
  free(c.N);
  free(c.T);
  free(c.f);
  PetscFunctionReturn(0);
}

/* Residuals of a scene that was solved */
static PetscErrorCode JudgeSolution(PetscInt number, const Chain *chain, Statics statics, Tally *t)
{
  const ContactState *state;
  ContactKKT          kkt;
  PetscReal           said, found, rounding, worst;
  Vec                 u;

  PetscFunctionBeginUser;
  PetscCall(StaticsGetState(statics, &state, &u));
  PetscCall(StaticsGetKKT(statics, &kkt, &said));
  PetscCall(Imbalance(chain, state, u, &found, &rounding));
  worst = PetscMax(PetscMax(kkt.penetration, kkt.sign), PetscMax(kkt.complementarity, PetscMax(kkt.cone, kkt.dissipation)));
  t->kkt         = PetscMax(t->kkt, worst);
  t->equilibrium = PetscMax(t->equilibrium, said);
  t->scaled      = PetscMax(t->scaled, (found - said) / rounding);
  if (!(worst <= LAW) || !(said <= PetscMax(LAW, rounding)) || !(found <= said + 10 * rounding)) {
    t->wrong++;
    printf("     scene %d: laws %.1e %.1e %.1e %.1e %.1e, equilibrium %.1e, by the matrices %.1e, rounding %.1e\n",
           (int)number, kkt.penetration, kkt.sign, kkt.complementarity, kkt.cone, kkt.dissipation, said, found, rounding);
  }
  PetscFunctionReturn(0);
}

/* Whether theory says that there is a solution: Coulomb's law on bodies that are held, for any friction (fixed point of
   the problem with given friction; J. Haslinger, Math. Methods Appl. Sci. 5, 1983, 422); a complementarity problem with
   positive principal minors; pressing without friction */
static PetscBool MustSolve(const Scene *scene, PetscBool known, const Solutions *s)
{
  if (scene->held && !scene->slides) return PETSC_TRUE;
  if (scene->pressed && scene->mu == 0) return PETSC_TRUE;
  return (PetscBool)(known && s->unique && s->sharp);
}

/* One scene */
static PetscErrorCode TestScene(PetscInt number, Tally *t)
{
  const ContactState *state = NULL;
  PetscErrorCode      error;
  PetscReal           difference = 0;
  PetscBool           known, must;
  Solutions           solutions;
  Statics             statics;
  Scene               scene;
  Chain               chain;

  PetscFunctionBeginUser;
  PetscCall(SceneDraw(number, &scene));
  PetscCall(SceneCreate(&scene, &chain));
  PetscCall(StaticsCreate(PETSC_COMM_WORLD, &statics));
  PetscCall(StaticsSetFromOptions(statics));
  PetscCall(StaticsSetOperators(statics, chain.operators));
  if (!getenv("TRACE")) PetscCall(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  error = StaticsSolve(statics);
  if (!getenv("TRACE")) PetscCall(PetscPopErrorHandler());
  if (!error) PetscCall(StaticsGetState(statics, &state, NULL));
  PetscCall(CompareForces(&scene, &chain, state, &solutions, &known, &difference));
  must = MustSolve(&scene, known, &solutions);
  t->n++;
  t->known += known;
  t->must += must;
  if (error == PETSC_ERR_NOT_CONVERGED) t->unsolved++;
  else if (error == PETSC_ERR_USER_INPUT) t->refused++;
  else if (error) t->other_error++;
  else {
    t->solved++;
    PetscCall(JudgeSolution(number, &chain, statics, t));
    if (known) t->forces = PetscMax(t->forces, difference);
    if (known && difference > FORCES) t->unlike++;
  }
  if (error && must) t->not_found++;
  if ((error && must) || getenv("SHOW"))
    printf("     scene %d: error %d, %s%s%s mu %.3f kn %.1e gaps %d, brute force: %d solutions%s%s, %s\n", (int)number, error,
           scene.held ? "held " : "", scene.slides ? "slides" : "Coulomb", scene.pressed ? " pressed" : "", scene.mu,
           scene.kn, (int)scene.gaps, known ? solutions.n : -1, known && solutions.unique ? " unique" : "",
           known && solutions.sharp ? " sharp" : "", scene.options);
  PetscCall(StaticsDestroy(&statics));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Tally t      = {0};
  int   failed = 0;
  PetscInt first = 0, n = N_SCENES;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  if (getenv("FIRST")) first = atoi(getenv("FIRST"));
  if (getenv("COUNT")) n = atoi(getenv("COUNT"));
  for (PetscInt i = first; i < first + n; i++) PetscCall(TestScene(i, &t));
  printf("     %d solved, %d without equilibrium, %d refused; brute force on %d, solvable for certain %d\n", t.solved,
         t.unsolved, t.refused, t.known, t.must);
  failed += CheckClose("other errors", t.other_error, 0, 0);
  failed += CheckClose("solved, but a law or equilibrium is off by more than 1e-10", t.wrong, 0, 0);
  failed += CheckClose("solvable for certain, but not solved", t.not_found, 0, 0);
  failed += CheckClose("forces unlike those of brute force", t.unlike, 0, 0);
  printf("worst: kkt %.1e eq %.1e scaled %.1e forces %.1e\n", t.kkt, t.equilibrium, t.scaled, t.forces);
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
