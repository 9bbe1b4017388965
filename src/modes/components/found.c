/*
   Free modes of the bodies from the modes that were found, without a solution of their own. In a body by itself a mode
   obeys (K + lambda^2 M) x = f, f the forces of contacts and bushings, so that

      x = sum_k phi_k (phi_k' f) / (kappa_k + lambda^2):

   the free modes next to it, and a tail, which is what f deforms. Right and left vectors of many modes span the free
   modes of the band, for their tails differ; rigid motions are added. The Ritz method is that of ritz.c.

   Error: the residual r = (K - kappa M) phi is a force where the tails are, and kappa is too large by what it deforms,

      r' (K - kappa M)^-1 r,  about FOUND_SOFT r' D^-1 r,  D = diag K.

   Without the factor that is 0.05 to 0.7 of it, on massi2005.yaml and brake.yaml at all free modes. Two free modes are
   mixed by as much over the distance of their kappa.
*/
#include "components.h"
#include "solver/block/orthonormal.h"

#define FOUND_SOFT  30   /* what a force deforms beyond its own unknown */
#define FOUND_WORST 0.1  /* relative error of a frequency: a worse one is no free mode */
#define FOUND_REACH 1.5  /* of the highest mode: free modes up to there */
#define FOUND_LEAST 0.02 /* of the energy of an unstable mode: a free mode that is looked for */
#define FOUND_NAME  0.2  /* of the energy of the body, in a mode that is named after a part */
#define FOUND_APART 1.01 /* condition, one over the cosine of right and left vector */
#define FOUND_MOST  600  /* vectors; more are not worth it */

/* The vectors of a mode, and their columns, -1 for none */
typedef struct {
  Vec      x[4]; /* right and left, real and imaginary part */
  PetscInt column[4];
} FoundVectors;

/* One free mode among the bodies' */
typedef struct {
  PetscInt  column, body; /* column in F */
  PetscReal kappa, error;
  PetscBool rigid;
} FoundMode;

/* Columns for the vectors of all modes: none for a part that is zero, nor for a left vector that is the right one or
   next to it, which adds little */
static PetscErrorCode VectorsCount(Modes modes, FoundVectors v[], PetscInt *n)
{
  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt i = 0; i < modes->n; i++) {
    PetscCall(ModesGetVectors(modes, i, &v[i].x[0], &v[i].x[1], &v[i].x[2], &v[i].x[3]));
    for (int part = 0; part < 4; part++) {
      PetscReal size = 0;
      PetscBool same = PETSC_FALSE;

      v[i].column[part] = -1;
      if (v[i].x[part]) PetscCall(VecNorm(v[i].x[part], NORM_INFINITY, &size));
      if (size == 0 || (part >= 2 && modes->mode[i].condition < FOUND_APART)) continue;
      if (part >= 2 && v[i].x[part - 2]) PetscCall(VecEqual(v[i].x[part], v[i].x[part - 2], &same));
      v[i].column[part] = same ? v[i].column[part - 2] : (*n)++;
    }
  }
  PetscFunctionReturn(0);
}

/* Rigid motion k of everything, at unknowns that no support holds */
static PetscErrorCode MotionSet(const Mesh *mesh, int k, Vec u)
{
  const int axis = k - 3, a = (axis + 1) % 3, b = (axis + 2) % 3;

  PetscFunctionBeginUser;
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
  PetscFunctionReturn(0);
}

/* Fills the basis */
static PetscErrorCode BasisFill(Modes modes, Pencil bodies, const FoundVectors v[], FreeBasis *basis)
{
  Operators   operators;
  const Mesh *mesh;
  Vec         column, u;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n; i++)
    for (int part = 0; part < 4; part++) {
      if (v[i].column[part] < 0 || (part >= 2 && v[i].column[part] == v[i].column[part - 2])) continue;
      PetscCall(MatDenseGetColumnVecWrite(basis->V, v[i].column[part], &column));
      PetscCall(PencilRestrict(bodies, v[i].x[part], column));
      PetscCall(MatDenseRestoreColumnVecWrite(basis->V, v[i].column[part], &column));
    }
  PetscCall(PencilGetOperators(bodies, &operators));
  PetscCall(OperatorsGetMesh(operators, &mesh));
  PetscCall(OperatorsCreateVec(operators, &u));
  for (int k = 0; k < FREE_MOTIONS; k++) {
    PetscCall(MotionSet(mesh, k, u));
    PetscCall(MatDenseGetColumnVecWrite(basis->V, basis->n - FREE_MOTIONS + k, &column));
    PetscCall(PencilRestrict(bodies, u, column));
    PetscCall(MatDenseRestoreColumnVecWrite(basis->V, basis->n - FREE_MOTIONS + k, &column));
  }
  PetscCall(VecDestroy(&u));
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

/* Frequencies and errors of the columns of F */
static PetscErrorCode ColumnsJudge(const PencilMatrices *bodies, Mat F, PetscInt n, FoundMode found[])
{
  const Mat          A[2] = {bodies->K, bodies->M};
  const PetscScalar *f, *kf, *mf, *d;
  PetscInt           n_own, ld[3];
  PetscReal         *sums; /* [n][2] kappa, r' D^-1 r */
  Mat                AF[2];
  Vec                diagonal;
  MPI_Comm           comm = PetscObjectComm((PetscObject)F);

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) PetscCall(MatDuplicate(F, MAT_DO_NOT_COPY_VALUES, &AF[k]));
  PetscCall(BlockMultiplyEach(2, A, F, AF));
  PetscCall(MatCreateVecs(bodies->K, &diagonal, NULL));
  PetscCall(MatGetDiagonal(bodies->K, diagonal));
  PetscCall(VecGetLocalSize(diagonal, &n_own));
  PetscCall(PetscCalloc1(2 * n, &sums));
  PetscCall(MatDenseGetLDA(F, &ld[0]));
  PetscCall(MatDenseGetLDA(AF[0], &ld[1]));
  PetscCall(MatDenseGetLDA(AF[1], &ld[2]));
  PetscCall(MatDenseGetArrayRead(F, &f));
  PetscCall(MatDenseGetArrayRead(AF[0], &kf));
  PetscCall(MatDenseGetArrayRead(AF[1], &mf));
  PetscCall(VecGetArrayRead(diagonal, &d));
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n_own; i++) {
      const PetscReal phi = f[(size_t)j * ld[0] + i], K_phi = kf[(size_t)j * ld[1] + i];
      const PetscReal r = K_phi - found[j].kappa * mf[(size_t)j * ld[2] + i];

      sums[2 * j] += phi * K_phi;
      if (d[i] > 0) sums[2 * j + 1] += r * r / d[i];
    }
  PetscCall(VecRestoreArrayRead(diagonal, &d));
  PetscCall(MatDenseRestoreArrayRead(AF[1], &mf));
  PetscCall(MatDenseRestoreArrayRead(AF[0], &kf));
  PetscCall(MatDenseRestoreArrayRead(F, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)(2 * n), MPIU_REAL, MPI_SUM, comm));
  for (PetscInt j = 0; j < n; j++) {
    found[j].error = FOUND_SOFT * sums[2 * j + 1] + PetscAbsReal(sums[2 * j] - found[j].kappa);
    found[j].kappa = sums[2 * j];
  }
  PetscCall(PetscFree(sums));
  PetscCall(VecDestroy(&diagonal));
  for (int k = 0; k < 2; k++) PetscCall(MatDestroy(&AF[k]));
  PetscFunctionReturn(0);
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

/* Puts column j of F into the free modes */
static PetscErrorCode FoundPut(Pencil bodies, const FoundMode *found, Mat F, Modes free)
{
  const PetscReal omega = found->rigid ? 0 : PetscSqrtReal(found->kappa);
  const PetscInt  i     = free->n++;
  Operators       operators;
  Vec             column, u;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(bodies, &operators));
  PetscCall(OperatorsCreateVec(operators, &u));
  PetscCall(MatDenseGetColumnVecRead(F, found->column, &column));
  PetscCall(PencilExpand(bodies, PETSC_FALSE, column, u));
  PetscCall(MatDenseRestoreColumnVecRead(F, found->column, &column));
  PetscCall(SpectrumTake(&free->right, 0, omega, u, NULL));
  free->mode[i] = (Mode){
    .omega = omega, .condition = 1, .rigid = found->rigid, .error = found->rigid ? 0 : found->error / (2 * omega)};
  free->residual[i] = found->rigid ? 0 : found->error;
  PetscFunctionReturn(0);
}

/* The free modes of the columns of F that are good */
static PetscErrorCode FoundCollect(Pencil bodies, PetscInt n, FoundMode found[], Mat F, ModesComponents c, Modes free)
{
  PetscFunctionBeginUser;
  PetscCall(SpectrumCreate(n, &free->right));
  PetscCall(PetscCalloc1(n, &free->mode));
  PetscCall(PetscCalloc1(n, &free->residual));
  FoundSort(n, found);
  PetscCall(PetscMalloc1(n, &c->found_of));
  for (PetscInt j = 0; j < n; j++) {
    if (!found[j].rigid && !(found[j].error <= 2 * FOUND_WORST * found[j].kappa)) continue;
    c->found_of[free->n] = found[j].body;
    PetscCall(FoundPut(bodies, &found[j], F, free));
  }
  if (free->n) PetscCall(ModesLabel(free));
  PetscFunctionReturn(0);
}

/* Lifts, judges and collects */
static PetscErrorCode BasisCollect(Pencil bodies, const FreeBasis *basis, const PetscInt n_modes[], ModesComponents c,
                                   Modes free)
{
  PencilMatrices pencil;
  PetscInt       n_own, n = 0, first = 0;
  FoundMode     *found;
  Mat            F;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(bodies, &pencil));
  for (PetscInt b = 0; b < basis->n_bodies; b++) n += n_modes[b];
  PetscCall(MatGetLocalSize(basis->V, &n_own, NULL));
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)basis->V), n_own, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, &F));
  PetscCall(PetscMalloc1(n, &found));
  for (PetscInt b = 0; b < basis->n_bodies; b++) {
    for (PetscInt k = 0; k < n_modes[b]; k++)
      found[first + k] = (FoundMode){.column = first + k,
                                     .body   = b,
                                     .kappa  = basis->kappa[b * basis->n + k],
                                     .rigid  = k < basis->n_rigid[b] ? PETSC_TRUE : PETSC_FALSE};
    PetscCall(FreeBasisLift(basis, b, n_modes[b], first, F));
    first += n_modes[b];
  }
  if (n) PetscCall(ColumnsJudge(&pencil, F, n, found));
  if (n) PetscCall(FoundCollect(bodies, n, found, F, c, free));
  PetscCall(PetscFree(found));
  PetscCall(MatDestroy(&F));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeModesTake(Modes modes, Pencil bodies, ModesComponents c, Modes free)
{
  const FreeBodies *of = &c->bodies;
  PencilMatrices    pencil;
  FreeBasis         basis;
  FoundVectors     *v;
  PetscInt          n, *n_modes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(modes->n, &v));
  PetscCall(VectorsCount(modes, v, &n));
  free->weights = modes->weights; /* which stay those of modes */
  if (n <= FOUND_MOST) {
    PetscCall(FreeBasisCreate(bodies, of, n + FREE_MOTIONS, &basis));
    PetscCall(BasisFill(modes, bodies, v, &basis));
    PetscCall(PencilGetMatrices(bodies, &pencil));
    PetscCall(FreeBasisSolve(&pencil, &basis));
    PetscCall(PetscMalloc1(of->n, &n_modes));
    ModesChoose(modes, of, &basis, v, n_modes);
    PetscCall(BasisCollect(bodies, &basis, n_modes, c, free));
    PetscCall(PetscFree(n_modes));
    PetscCall(FreeBasisDestroy(&basis));
  }
  free->weights = NULL;
  PetscCall(PetscFree(v));
  PetscFunctionReturn(0);
}
