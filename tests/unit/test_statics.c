/*
   The statics on 200 scenes drawn at random with a fixed seed, each with a dense problem of the pairs and every second with GMRES too: both
   end alike, with the laws of contact and equilibrium obeyed or with an error of PETSC_ERR_NOT_CONVERGED or
   PETSC_ERR_USER_INPUT, and never go on for ever.

   test_statics [-first <0>] [-count <200>] takes other scenes.
*/
#include <squeal/statics.h>
#include "check.h"
#include "enumerate.h"
#include "randomscene.h"
#include "scratch.h"

#define N_SCENES 200
#define LAW      1e-10 /* residuals of the laws, relative */
#define FORCES   1e-8  /* forces beside those of brute force, relative to the largest */

/* What became of the scenes */
typedef struct {
  int       solved, unsolved, refused, other; /* how they ended */
  int       known, must, missed;              /* done by brute force too; solvable for certain; and yet not solved */
  int       proven;                           /* without equilibrium for certain */
  int       apart;                            /* another end, or other forces, with GMRES */
  int       wrong, unlike, rounded;    /* a law is broken; other forces; equilibrium no better than rounding of u */
  PetscReal laws, equilibrium, forces; /* the worst */
} Tally;

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
  for (PetscInt p = 0; p < n; p++)
    value[p] = factor * (component ? state[p].lambda_t[component - 1] : state[p].lambda_n);
  PetscCall(VecRestoreArray(l, &value));
  PetscCall(MatMultTransposeAdd(rows, l, b, b));
  PetscCall(VecDestroy(&l));
  PetscFunctionReturn(0);
}

/* |K u + N'lambda_n - T'lambda_t - B'lambda_b - f| over the larger of |f| and the contact forces, and what rounding of
   u leaves of it, eps max|K| |u| */
static PetscErrorCode Imbalance(const Chain *chain, const ContactState state[], Vec u, PetscReal *error,
                                PetscReal *rounding)
{
  PetscReal norm, load, contact, stiffest, move;
  Mat       K, rows[3];
  Vec       f, r, diagonal;

  PetscFunctionBeginUser;
  PetscCall(ChainCreateLoads(chain, &f));
  PetscCall(VecDuplicate(f, &r));
  PetscCall(VecDuplicate(f, &diagonal));
  PetscCall(VecSet(r, 0));
  PetscCall(InterfaceOperators(chain->contact, 0, &rows[0], &rows[1], &rows[2]));
  for (int i = 0; i < 3; i++) {
    PetscCall(ForcesAdd(rows[i], state, i, i ? -1 : 1, r));
    PetscCall(MatDestroy(&rows[i]));
  }
  PetscCall(VecNorm(r, NORM_2, &contact));
  PetscCall(VecNorm(f, NORM_2, &load));
  PetscCall(VecAXPY(r, -1, f));
  PetscCall(OperatorsGetBodies(chain->operators, NULL, &K, NULL, NULL));
  PetscCall(MatMultAdd(K, u, r, r));
  PetscCall(VecNorm(r, NORM_2, &norm));
  PetscCall(MatGetDiagonal(K, diagonal));
  PetscCall(VecNorm(diagonal, NORM_INFINITY, &stiffest));
  PetscCall(VecNorm(u, NORM_2, &move));
  *error    = norm / PetscMax(load, contact);
  *rounding = PETSC_MACHINE_EPSILON * stiffest * move / PetscMax(load, contact);
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
  PetscCall(OperatorsGetBodies(chain->operators, NULL, &K, NULL, NULL));
  PetscCall(MatGetSize(K, &n_unknowns, NULL));
  c->n_unknowns = (int)n_unknowns;
  PetscCall(InterfaceOperators(chain->contact, 0, &N, &T, NULL));
  PetscCall(LongMatrix(K, &c->K));
  PetscCall(LongMatrix(N, &c->N));
  PetscCall(LongMatrix(T, &c->T));
  PetscCall(ChainCreateLoads(chain, &f));
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

/* Residuals of a scene that was solved: as the solver says, and by the matrices of another room */
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
  worst          = PetscMax(PetscMax(kkt.penetration, kkt.sign), PetscMax(kkt.complementarity, kkt.cone));
  worst          = PetscMax(worst, kkt.dissipation);
  t->laws        = PetscMax(t->laws, worst);
  t->equilibrium = PetscMax(t->equilibrium, said);
  t->rounded += said > LAW;
  if (worst <= LAW && said <= PetscMax(LAW, rounding) && found <= said + 10 * rounding) PetscFunctionReturn(0);
  t->wrong++;
  printf("     scene %d: laws %.1e %.1e %.1e %.1e %.1e, equilibrium %.1e, by the matrices %.1e, rounding %.1e\n",
         (int)number, kkt.penetration, kkt.sign, kkt.complementarity, kkt.cone, kkt.dissipation, said, found, rounding);
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

/* Counts how a scene ended; error is that of StaticsSolve() */
static PetscErrorCode Count(PetscInt number, const Scene *scene, const Chain *chain, Statics statics,
                            PetscErrorCode error, Tally *t)
{
  const ContactState *state      = NULL;
  PetscReal           difference = 0;
  Solutions           solutions  = {.n = 0};
  PetscBool           known, must;

  PetscFunctionBeginUser;
  if (!error) PetscCall(StaticsGetState(statics, &state, NULL));
  PetscCall(CompareForces(scene, chain, state, &solutions, &known, &difference));
  must = MustSolve(scene, known, &solutions);
  t->known += known;
  t->must += must;
  t->unsolved += error == PETSC_ERR_NOT_CONVERGED;
  t->refused += error == PETSC_ERR_USER_INPUT;
  t->other += error && error != PETSC_ERR_NOT_CONVERGED && error != PETSC_ERR_USER_INPUT;
  if (error && must)
    printf("     scene %d: error %d, though it can be solved: %s\n", (int)number, error, scene->options);
  t->missed += error && must;
  if (error) PetscFunctionReturn(0);
  t->solved++;
  PetscCall(JudgeSolution(number, chain, statics, t));
  if (known) t->forces = PetscMax(t->forces, difference);
  t->unlike += known && difference > FORCES;
  PetscFunctionReturn(0);
}

/* Solves; the error is kept with its message, and the forces of this rank's pairs where there is none */
static PetscErrorCode SolveWith(const char dense[], const Chain *chain, Scratch *end, Statics *statics)
{
  PetscFunctionBeginUser;
  *end = (Scratch){.code = 0};
  PetscCall(PetscOptionsSetValue(NULL, "-static_dense", dense));
  PetscCall(StaticsCreate(PETSC_COMM_WORLD, statics));
  PetscCall(StaticsSetFromOptions(*statics));
  PetscCall(StaticsSetOperators(*statics, chain->operators));
  PetscCall(PetscPushErrorHandler(ScratchKeepError, end));
  (void)StaticsSolve(*statics, NULL);
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(0);
}

/* Largest difference of the forces, beside the largest */
static PetscErrorCode CompareStates(const Chain *chain, Statics statics[2], PetscReal *difference)
{
  const ContactState *state[2];
  PetscReal           worst = 0, largest = 0;
  const ContactPair  *pairs;
  PetscInt            n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pairs));
  for (int i = 0; i < 2; i++) PetscCall(StaticsGetState(statics[i], &state[i], NULL));
  for (PetscInt p = 0; p < n; p++) {
    worst   = PetscMax(worst, PetscAbsReal(state[0][p].lambda_n - state[1][p].lambda_n));
    largest = PetscMax(largest, state[0][p].lambda_n);
  }
  *difference = largest > 0 ? worst / largest : worst;
  PetscFunctionReturn(0);
}

/* Counts what differs between the ends of the dense and the other solution */
static PetscErrorCode CompareEnds(PetscInt number, const Chain *chain, const Scratch end[2], Statics statics[2],
                                  Tally *t)
{
  PetscReal difference = 0;
  PetscBool same       = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (!end[0].code && !end[1].code) PetscCall(CompareStates(chain, statics, &difference));
  if (end[0].code) same = !strncmp(end[0].message, end[1].message, 20) ? PETSC_TRUE : PETSC_FALSE;
  if (end[0].code == end[1].code && difference <= FORCES && same) PetscFunctionReturn(0);
  t->apart++;
  printf("     scene %d: forces differ by %.1e with GMRES; dense: %s; GMRES: %s\n", (int)number, (double)difference,
         end[0].message, end[1].message);
  PetscFunctionReturn(0);
}

static PetscErrorCode TestScene(PetscInt number, Tally *t)
{
  Scratch end[2];
  Statics statics[2];
  Scene   scene;
  Chain   chain;

  PetscFunctionBeginUser;
  PetscCall(SceneDraw(number, &scene));
  PetscCall(SceneCreate(&scene, &chain));
  PetscCall(SolveWith("2000", &chain, &end[0], &statics[0]));
  PetscCall(Count(number, &scene, &chain, statics[0], end[0].code, t));
  if (number % 2) {
    PetscCall(SolveWith("0", &chain, &end[1], &statics[1]));
    PetscCall(CompareEnds(number, &chain, end, statics, t));
    PetscCall(StaticsDestroy(&statics[1]));
  }
  if (end[0].code == PETSC_ERR_NOT_CONVERGED && strstr(end[0].message, "found"))
    printf("     scene %d: %s\n", (int)number, end[0].message);
  else
    t->proven += end[0].code == PETSC_ERR_NOT_CONVERGED;
  PetscCall(StaticsDestroy(&statics[0]));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* Breaks when: the active set gives up what has a solution or takes for one what is none, a rigid motion is held where
   it must not be, or refinement is left out. */
static PetscErrorCode TestScenes(PetscInt first, PetscInt n, int *failed)
{
  Tally t = {0};

  PetscFunctionBeginUser;
  for (PetscInt i = first; i < first + n; i++) PetscCall(TestScene(i, &t));
  printf("     %d solved, %d without equilibrium (%d proven), %d refused; %d by brute force, %d solvable for certain; "
         "worst: laws %.1e, "
         "equilibrium %.1e, above 1e-10 in %d by rounding, forces beside brute force %.1e\n",
         t.solved, t.unsolved, t.proven, t.refused, t.known, t.must, (double)t.laws, (double)t.equilibrium, t.rounded,
         (double)t.forces);
  *failed +=
    CheckTrue("there is something to solve, and to refuse", t.solved > n / 2 && t.unsolved && t.refused, t.solved);
  *failed += CheckTrue("there is something to compare", t.known > n / 5 && t.must > n / 3, t.known);
  *failed += CheckClose("another end with GMRES, or forces that differ by more than 1e-8", t.apart, 0, 0);
  *failed += CheckClose("errors of other kinds", t.other, 0, 0);
  *failed += CheckClose("solved, but a law or equilibrium is off by more than 1e-10", t.wrong, 0, 0);
  *failed += CheckClose("solvable for certain, but not solved", t.missed, 0, 0);
  *failed += CheckClose("forces unlike those of brute force by more than 1e-8", t.unlike, 0, 0);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscInt first = 0, n = N_SCENES;
  int      failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-first", &first, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-count", &n, NULL));
  PetscCall(TestScenes(first, n, &failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
