/*
   Free modes of the bodies from the modes that were found, without a solution of their own. In a body by itself a mode
   obeys (K + lambda^2 M) x = f, f the forces of contacts and bushings, so that

      x = sum_k phi_k (phi_k' f) / (kappa_k + lambda^2):

   the free modes next to it, and a tail, which is what f deforms. Right and left vectors of many modes span the free
   modes of the band, for their tails differ; rigid motions are added. The Ritz method is that of ritz.c, the error that
   of judge.c.
*/
#include "components.h"

#define FOUND_WORST 0.1  /* relative error of a frequency: a worse one is no free mode */
#define FOUND_REACH 1.5  /* of the highest mode: free modes up to there */
#define FOUND_LEAST 0.02 /* of the energy of an unstable mode: a free mode that is looked for */
#define FOUND_NAME  0.2  /* of the energy of the body, in a mode that is named after a part */
#define FOUND_APART                                                                                                    \
  1.01 /* condition, one over the cosine of right and left vector, from which on the left one serves */
/* modes, whose right vectors have tails enough: then left ones serve from FOUND_FAR on, and of complex vectors parts of
   FOUND_SMALL of the other; of a mode that asks for shares all do */
#define FOUND_MANY  48
#define FOUND_FAR   1.3
#define FOUND_SMALL 0.1
#define FOUND_MOST  600 /* vectors; where there are more, those of modes that ask come first */

/* The vectors of a mode, and their columns, -1 for none */
typedef struct {
  Vec      x[4]; /* right and left, real and imaginary part */
  PetscInt column[4];
} FoundVectors;

/* Sizes of the parts of the vectors of mode i, those that are to serve; 0 for others */
static PetscErrorCode VectorsMeasure(const Modes modes, PetscInt i, const FoundVectors *v, PetscReal size[4])
{
  const PetscBool many = modes->n > FOUND_MANY ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool few  = many && !ComponentsAsks(modes, i) ? PETSC_TRUE : PETSC_FALSE; /* parts */

  PetscFunctionBeginUser;
  for (int part = 0; part < 4; part++) {
    const PetscReal apart = part < 2 || modes->mode[i].unstable ? 0 : many ? FOUND_FAR : FOUND_APART;
    PetscReal      *first = &size[part / 2 * 2];

    size[part] = 0;
    if (v->x[part] && !(modes->mode[i].condition < apart)) PetscCall(VecDot(v->x[part], v->x[part], &size[part]));
    size[part] = PetscSqrtReal(size[part]);
    if (part % 2 && few && size[part] < FOUND_SMALL * first[0]) size[part] = 0;
    if (part % 2 && few && first[0] < FOUND_SMALL * size[part]) first[0] = 0;
  }
  PetscFunctionReturn(0);
}

/* Columns for the vectors of a mode: none for a part that is zero, nor for a left vector that is the right one or next
   to it, which adds little; and none at all where there is no room for them, unless it is unstable */
static PetscErrorCode ModeCount(Modes modes, PetscInt i, FoundVectors *v, PetscInt *n)
{
  const PetscInt before = *n;
  PetscReal      size[4];

  PetscFunctionBeginUser;
  PetscCall(ModesGetVectors(modes, i, &v->x[0], &v->x[1], &v->x[2], &v->x[3]));
  PetscCall(VectorsMeasure(modes, i, v, size));
  for (int part = 0; part < 4; part++) {
    PetscBool same = PETSC_FALSE;

    v->column[part] = -1;
    if (size[part] == 0) continue;
    if (part >= 2 && v->x[part - 2]) PetscCall(VecEqual(v->x[part], v->x[part - 2], &same));
    v->column[part] = same ? v->column[part - 2] : (*n)++;
  }
  if (*n <= FOUND_MOST || modes->mode[i].unstable) PetscFunctionReturn(0);
  for (int part = 0; part < 4; part++) v->column[part] = -1;
  *n = before;
  PetscFunctionReturn(0);
}

/* What a mode asks for: shares, a name, nothing */
static int ModeRank(const Modes modes, PetscInt i)
{
  if (modes->mode[i].unstable) return 0;
  return ComponentsAsks(modes, i) ? 1 : 2;
}

/* Columns for the vectors of all modes; n_left_out ask and have none */
static PetscErrorCode VectorsCount(Modes modes, FoundVectors v[], PetscInt *n, PetscInt *n_left_out)
{
  PetscFunctionBeginUser;
  *n = *n_left_out = 0;
  for (int rank = 0; rank < 3; rank++)
    for (PetscInt i = 0; i < modes->n; i++) {
      if (ModeRank(modes, i) != rank) continue;
      PetscCall(ModeCount(modes, i, &v[i], n));
      *n_left_out += rank < 2 && v[i].column[0] < 0 && v[i].column[1] < 0;
    }
  PetscFunctionReturn(0);
}

/* Rigid motion k of everything, at unknowns that no support holds; what follows others follows them */
static PetscErrorCode MotionSet(Operators operators, int k, Vec u)
{
  const int   axis = k - 3, a = (axis + 1) % 3, b = (axis + 2) % 3;
  const Mesh *mesh;
  Mat         Z, E;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMesh(operators, &mesh));
  PetscCall(VecSet(u, 0));
  for (PetscInt p = 0; p < 3 * mesh->n_nodes; p++) {
    const PetscReal *x = &mesh->x[3 * (p / 3)];
    const int        d = (int)(p % 3);

    if (mesh->unknown[p] < 0 || !mesh->owned[p / 3]) continue;
    if (k < 3 && d == k) PetscCall(VecSetValue(u, mesh->unknown[p], 1, INSERT_VALUES));
    if (k >= 3 && d == a) PetscCall(VecSetValue(u, mesh->unknown[p], -x[b], INSERT_VALUES));
    if (k >= 3 && d == b) PetscCall(VecSetValue(u, mesh->unknown[p], x[a], INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(u));
  PetscCall(VecAssemblyEnd(u));
  PetscCall(OperatorsGetDependents(operators, &Z, &E));
  if (Z) {
    Vec q;

    PetscCall(MatCreateVecs(Z, &q, NULL));
    PetscCall(MatMultTranspose(E, u, q));
    PetscCall(MatMult(Z, q, u));
    PetscCall(VecDestroy(&q));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBasisSetMotions(Operators operators, FreeBasis *basis)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < FREE_MOTIONS; k++) PetscCall(MotionSet(operators, k, basis->v[basis->n - FREE_MOTIONS + k]));
  PetscFunctionReturn(0);
}

/* Sets the vectors of the basis */
static PetscErrorCode BasisFill(Operators operators, PetscInt n, const FoundVectors v[], FreeBasis *basis)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    for (int part = 0; part < 4; part++)
      if (v[i].column[part] >= 0) basis->v[v[i].column[part]] = v[i].x[part];
  PetscCall(FreeBasisSetMotions(operators, basis));
  PetscFunctionReturn(0);
}

/* Energy of the right (side 0) or left vector of a mode in free mode k of body b; k = -1: in all of the body */
static PetscReal EnergyOf(const FreeBasis *basis, const FoundVectors *v, int side, PetscInt b, PetscInt k)
{
  const PetscInt n   = basis->n;
  PetscReal      sum = 0;

  for (int part = 2 * side; part < 2 * side + 2; part++) {
    const PetscReal *Mx;
    PetscReal        a = 0;

    if (v->column[part] < 0) continue;
    Mx = &basis->mass[(b * n + v->column[part]) * n];
    for (PetscInt j = 0; j < n && k >= 0; j++) a += basis->Z[(b * n + k) * n + j] * Mx[j];
    sum += k < 0 ? Mx[v->column[part]] : a * a;
  }
  return sum;
}

/* How many free modes of each body: up to the highest that takes part in a mode that asks */
static void ModesChoose(const Modes modes, const FreeBodies *of, const FreeBasis *basis, const FoundVectors v[],
                        PetscInt n[])
{
  const PetscReal top   = modes->has_band ? 2 * PETSC_PI * modes->band[1] : modes->mode[modes->n - 1].omega;
  const PetscReal limit = PetscSqr(FOUND_REACH * top);

  for (PetscInt b = 0; b < of->n; b++) n[b] = 0;
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscInt part = modes->label_part[i], named = part >= 0 ? of->of_part[part] : -1;

    for (int side = 0; side < 2 && ComponentsAsks(modes, i); side++) {
      PetscReal all = 0;

      for (PetscInt b = 0; b < of->n; b++) all += EnergyOf(basis, &v[i], side, b, -1);
      for (PetscInt b = 0; b < of->n; b++) {
        const PetscReal own   = EnergyOf(basis, &v[i], side, b, -1);
        const PetscReal least = PetscMin(modes->mode[i].unstable ? FOUND_LEAST * all : PETSC_MAX_REAL,
                                         b == named ? FOUND_NAME * own : PETSC_MAX_REAL);

        for (PetscInt k = n[b]; own > least && k < basis->n_modes[b] && basis->kappa[b * basis->n + k] <= limit; k++)
          if (EnergyOf(basis, &v[i], side, b, k) > least) n[b] = k + 1;
      }
    }
  }
}

/* Within a body rigid ones first, then by frequency */
static void FoundSort(PetscInt n, FoundMode found[])
{
  for (PetscInt i = 1; i < n; i++)
    for (PetscInt j = i; j > 0; j--) {
      const FoundMode a = found[j - 1], b = found[j];

      if (a.body < b.body || a.rigid > b.rigid || (a.rigid == b.rigid && a.kappa <= b.kappa)) break;
      found[j - 1] = b;
      found[j]     = a;
    }
}

/* Puts a column of F into the free modes */
static PetscErrorCode FoundPut(Operators operators, const FoundMode *found, Mat F, Modes free)
{
  const PetscReal omega = found->rigid ? 0 : PetscSqrtReal(found->kappa);
  const PetscInt  i     = free->n++;
  Vec             column, u;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(operators, &u));
  PetscCall(MatDenseGetColumnVecRead(F, found->column, &column));
  PetscCall(VecCopy(column, u));
  PetscCall(MatDenseRestoreColumnVecRead(F, found->column, &column));
  PetscCall(SpectrumTake(&free->right, 0, omega, u, NULL));
  free->mode[i] = (Mode){
    .omega = omega, .condition = 1, .rigid = found->rigid, .error = found->rigid ? 0 : found->error / (2 * omega)};
  free->residual[i] = found->rigid ? 0 : found->error;
  PetscFunctionReturn(0);
}

/* dot[vectors] = phi' M v of a free mode phi and the vectors v of the basis */
static void FoundDot(const FreeBasis *basis, const FoundMode *found, PetscReal dot[])
{
  const PetscInt   n = basis->n, b = found->body;
  const PetscReal *z = &basis->Z[(b * n + found->of) * n];

  for (PetscInt j = 0; j < n; j++) {
    dot[j] = 0;
    for (PetscInt i = 0; i < n; i++) dot[j] += z[i] * basis->mass[(b * n + j) * n + i];
  }
}

/* Free modes, whose shapes are columns of F[PETSC_FALSE] where they are elastic, of F[PETSC_TRUE] where rigid */
typedef struct {
  PetscInt   n;
  FoundMode *mode; /* [n] body by body */
  Mat        F[2];
} FoundModes;

/* Those that are good */
static PetscErrorCode FoundCollect(Operators operators, const FreeBasis *basis, const FoundModes *modes,
                                   ModesComponents c, Modes free)
{
  const PetscInt n     = modes->n;
  FoundMode     *found = modes->mode;

  PetscFunctionBeginUser;
  PetscCall(SpectrumCreate(n, &free->right));
  PetscCall(PetscCalloc1(n, &free->mode));
  PetscCall(PetscCalloc1(n, &free->residual));
  FoundSort(n, found);
  PetscCall(PetscMalloc1(n, &c->found_of));
  PetscCall(PetscMalloc1(n * basis->n, &c->dot));
  for (PetscInt j = 0; j < n; j++) {
    if (!found[j].rigid && !(found[j].error <= 2 * FOUND_WORST * found[j].kappa)) continue;
    c->found_of[free->n] = found[j].body;
    FoundDot(basis, &found[j], &c->dot[free->n * basis->n]);
    PetscCall(FoundPut(operators, &found[j], modes->F[found[j].rigid], free));
  }
  if (free->n) PetscCall(ModesLabel(free));
  PetscFunctionReturn(0);
}

/* The first n_modes of each body */
static PetscErrorCode FoundLift(const FreeMatrices *bodies, const FreeBasis *basis, const PetscInt n_modes[],
                                FoundModes *found)
{
  PetscInt n_own, columns[2] = {0, 0};

  PetscFunctionBeginUser;
  found->n = 0;
  for (PetscInt b = 0; b < basis->n_bodies; b++)
    for (PetscInt k = 0; k < n_modes[b]; k++) {
      const PetscBool rigid = k < basis->n_rigid[b] ? PETSC_TRUE : PETSC_FALSE;

      found->mode[found->n++] = (FoundMode){
        .column = columns[rigid]++, .body = b, .of = k, .kappa = basis->kappa[b * basis->n + k], .rigid = rigid};
    }
  PetscCall(MatGetLocalSize(bodies->M, &n_own, NULL));
  for (int k = 0; k < 2; k++)
    PetscCall(MatCreateDense(PetscObjectComm((PetscObject)bodies->M), n_own, PETSC_DECIDE, PETSC_DETERMINE, columns[k],
                             NULL, &found->F[k]));
  columns[0] = columns[1] = 0;
  for (PetscInt b = 0; b < basis->n_bodies; b++) {
    const PetscInt rigid = PetscMin(n_modes[b], basis->n_rigid[b]);

    PetscCall(FreeBasisLift(basis, b, &(LiftRange){rigid, n_modes[b], columns[0]}, found->F[0]));
    PetscCall(FreeBasisLift(basis, b, &(LiftRange){0, rigid, columns[1]}, found->F[1]));
    columns[0] += n_modes[b] - rigid;
    columns[1] += rigid;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBasisCollect(Operators operators, const FreeMatrices *bodies, const FreeBasis *basis,
                                const PetscInt n_modes[], ModesComponents c, Modes free)
{
  PetscInt   n = 0;
  FoundModes found;
  Mat        Z;

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < basis->n_bodies; b++) n += n_modes[b];
  PetscCall(PetscMalloc1(n, &found.mode));
  PetscCall(FoundLift(bodies, basis, n_modes, &found));
  PetscCall(OperatorsGetDependents(operators, &Z, NULL));
  PetscCall(FoundJudge(bodies, Z, found.F[0], n, found.mode));
  if (n) PetscCall(FoundCollect(operators, basis, &found, c, free));
  PetscCall(PetscFree(found.mode));
  for (int k = 0; k < 2; k++) PetscCall(MatDestroy(&found.F[k]));
  PetscFunctionReturn(0);
}

/* Keeps what shares are made of: the products of the vectors, and which these are */
static PetscErrorCode ProductsKeep(PetscInt n, const FoundVectors v[], FreeBasis *basis, ModesComponents c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &c->column));
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscArraycpy(c->column[i], v[i].column, 4));
  PetscCall(PetscMalloc1(c->bodies.n * basis->n * basis->n, &c->mass));
  PetscCall(PetscArraycpy(c->mass, basis->mass, c->bodies.n * basis->n * basis->n));
  c->n_vectors = basis->n;
  PetscFunctionReturn(0);
}

/* From n vectors of modes to free modes */
static PetscErrorCode FoundSolve(Modes modes, PetscInt n, const FoundVectors v[], ModesComponents c, Modes free)
{
  const FreeBodies *of = &c->bodies;
  FreeMatrices      bodies;
  FreeBasis         basis;
  Operators         operators;
  PetscInt         *n_modes;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(PencilGetMass(modes->pencil, &bodies.M));
  PetscCall(PencilGetStiffnessApart(modes->pencil, &bodies.K, &bodies.less));
  PetscCall(FreeBasisCreate(of, bodies.M, n + FREE_MOTIONS, &basis));
  PetscCall(BasisFill(operators, modes->n, v, &basis));
  PetscCall(FreeBasisSolve(&bodies, &basis));
  PetscCall(PetscMalloc1(of->n, &n_modes));
  ModesChoose(modes, of, &basis, v, n_modes);
  PetscCall(FreeBasisCollect(operators, &bodies, &basis, n_modes, c, free));
  PetscCall(PetscFree(n_modes));
  PetscCall(ProductsKeep(modes->n, v, &basis, c));
  PetscCall(FreeBasisDestroy(&basis));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeModesTake(Modes modes, ModesComponents c, Modes free)
{
  FoundVectors *v;
  PetscInt      n, n_left_out;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(modes->n, &v));
  PetscCall(VectorsCount(modes, v, &n, &n_left_out));
  free->weights = modes->weights; /* which stay those of modes */
  PetscCall(FoundSolve(modes, n, v, c, free));
  if (n_left_out)
    PetscCall(PetscPrintf(modes->comm,
                          "free modes of the bodies are sought among %d vectors of the modes: %" PetscInt_FMT
                          " modes beyond are named after the part alone; take a narrower -modes_band\n",
                          FOUND_MOST, n_left_out));
  free->weights = NULL;
  PetscCall(PetscFree(v));
  PetscFunctionReturn(0);
}
