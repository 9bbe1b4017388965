/*
   Unit test of frequency responses against closed forms.

   Rod: n masses m between springs k (with dashpots b k), fixed below the first, free beyond the last, where the force
   acts. With 2 cos t = 2 - omega^2 m / (k (1 + i omega b)) the answer of mass j is

      u_j = f sin(j t) / (k (1 + i omega b) (sin((n + 1) t) - sin(n t))).

   Few of the n modes are in the window, so that most of the answer at an end is the residual term. Three unknowns with
   an unsymmetric stiffness: the inverse of the 3 x 3 matrix by cofactors, and the sum over all modes of
   (l'x)(y'f) / (y'M x (kappa_k - omega^2)).
*/
#include "check.h"
#include "scratch.h"
#include <complex.h>
#include <slepcsys.h>
#include <squeal/frf.h>

#define N_MASSES 120
#define SPRING   3.0
#define MASS     2.0
#define THREE    "-operators_dense_k 4,-1,0.5,-1,3,-1,0.2,-1.4,5 -operators_dense_m 2,0.1,0,0.1,1,0,0,0,1 "
#define TURNED   "-operators_dense_k 4,-1,0.2,-1,3,-1.4,0.5,-1,5 -operators_dense_m 2,0.1,0,0.1,1,0,0,0,1 "
#define LOSS     "-operators_dense_c 0.1,0,0.02,0,0.05,0,0,-0.01,0.2 "

typedef struct {
  Operators operators;
  Pencil    pencil;
  Modes     modes;
  Frf       frf;
} Run;

static PetscErrorCode RunCreate(const char options[], Run *r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, options));
  PetscCall(OperatorsCreate(PETSC_COMM_WORLD, &r->operators));
  PetscCall(OperatorsSetFromOptions(r->operators));
  PetscCall(OperatorsSetUp(r->operators));
  PetscCall(OperatorsLinearise(r->operators, NULL, &r->pencil));
  PetscCall(ModesCreate(PETSC_COMM_WORLD, &r->modes));
  PetscCall(ModesSetFromOptions(r->modes));
  PetscCall(FrfCreate(PETSC_COMM_WORLD, &r->frf));
  PetscCall(FrfSetFromOptions(r->frf));
  PetscCall(FrfSetOperators(r->frf, r->operators));
  PetscCall(FrfSetModes(r->frf, r->modes));
  PetscCall(FrfSetPencil(r->frf, r->pencil));
  PetscCall(FrfSetUp(r->frf));
  PetscCall(FrfSolve(r->frf));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunDestroy(Run *r)
{
  PetscFunctionBeginUser;
  PetscCall(FrfDestroy(&r->frf));
  PetscCall(ModesDestroy(&r->modes));
  PetscCall(PencilDestroy(&r->pencil));
  PetscCall(OperatorsDestroy(&r->operators));
  PetscFunctionReturn(0);
}

/* a I + b L of the rod into a file, L = [1 -1; -1 1] between neighbours and 1 at the fixed end */
static PetscErrorCode RodWrite(const Scratch *s, const char name[], PetscReal a, PetscReal b)
{
  char        path[PETSC_MAX_PATH_LEN + 32];
  PetscInt    first, last;
  PetscViewer file;
  Mat         A;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, N_MASSES, N_MASSES, 3, NULL, 2, NULL, &A));
  PetscCall(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; i++) {
    PetscCall(MatSetValue(A, i, i, a + (i + 1 < N_MASSES ? 2 : 1) * b, INSERT_VALUES));
    if (i > 0) PetscCall(MatSetValue(A, i, i - 1, -b, INSERT_VALUES));
    if (i + 1 < N_MASSES) PetscCall(MatSetValue(A, i, i + 1, -b, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscViewerBinaryOpen(PETSC_COMM_WORLD, ScratchPath(s, name, path), FILE_MODE_WRITE, &file));
  PetscCall(MatView(A, file));
  PetscCall(PetscViewerDestroy(&file));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

static PetscComplex RodExact(PetscReal freq, PetscReal b, PetscInt j)
{
  const PetscReal    omega = 2 * PETSC_PI * freq;
  const PetscComplex k = SPRING * CMPLX(1, omega * b), t = cacos(1 - omega * omega * MASS / (2 * k));

  return csin(j * t) / (k * (csin((N_MASSES + 1) * t) - csin(N_MASSES * t)));
}

/* Breaks when: a maximum over the frequencies is missed, or another is told; magnitude [n] of the closed form, m/N */
static PetscErrorCode CheckPeaks(const Run *r, PetscInt n, const PetscReal freq[], const PetscReal magnitude[],
                                 int *failed)
{
  const FrfPeak *peak;
  PetscInt       n_peaks, found = 0;
  PetscReal      wrong = 0;

  PetscFunctionBeginUser;
  PetscCall(FrfGetPeaks(r->frf, &n_peaks, &peak));
  for (PetscInt i = 1; i + 1 < n; i++) {
    if (magnitude[i] <= magnitude[i - 1] || magnitude[i] < magnitude[i + 1]) continue;
    if (found < n_peaks && peak[found].freq_hz == freq[i])
      wrong = PetscMax(wrong, PetscAbsReal(peak[found].magnitude / magnitude[i] - 1));
    else wrong = PETSC_MAX_REAL;
    found++;
  }
  *failed += CheckTrue("peaks", found > 0 && found == n_peaks, (double)found);
  *failed += CheckTrue("peaks where and as high as in closed form", wrong < 1e-8, wrong);
  PetscFunctionReturn(0);
}

/* Breaks when: the residual term, the force's or the outputs' place, or the real form of complex numbers is wrong */
static PetscErrorCode TestRod(const Scratch *s, PetscReal b, int *failed)
{
  static const PetscInt masses[] = {120, 1, 60};
  char                  options[4 * PETSC_MAX_PATH_LEN];
  const FrfOutput      *output;
  const PetscReal      *freq, *re, *im;
  PetscReal             magnitude[12];
  PetscInt              n, n_outputs;
  Run                   r;

  PetscFunctionBeginUser;
  PetscCall(RodWrite(s, "K.bin", 0, SPRING));
  PetscCall(RodWrite(s, "M.bin", MASS, 0));
  PetscCall(RodWrite(s, "C.bin", 0, SPRING * b));
  PetscCall(
    PetscSNPrintf(options, sizeof(options),
                  "-operators_load_k %s/K.bin -operators_load_m %s/M.bin %s%s%s -modes_band 0,0.06 -frf_force 120 "
                  "-frf_probes 120,1,60 -frf_frequencies 0.0011:0.045:12",
                  s->dir, s->dir, b > 0 ? "-operators_load_c " : "", b > 0 ? s->dir : "", b > 0 ? "/C.bin" : ""));
  PetscCall(RunCreate(options, &r));
  PetscCall(FrfGet(r.frf, &n, &freq, &n_outputs, &output));
  *failed += CheckClose("frequencies", (double)n, 12, 0) + CheckClose("outputs", (double)n_outputs, 3, 0);
  for (PetscInt i = 0; i < n; i++) {
    PetscReal error, wrong = 0, size = 0;

    PetscCall(FrfGetResponse(r.frf, i, &re, &im, &error));
    for (PetscInt p = 0; p < n_outputs; p++) {
      const PetscComplex exact = RodExact(freq[i], b, masses[p]);

      wrong = hypot(wrong, cabs(CMPLX(re[p], im[p]) - exact));
      size  = hypot(size, cabs(exact));
    }
    *failed += CheckClose(b > 0 ? "damped rod, relative error" : "rod, relative error", wrong / size, 0, 1e-8);
    *failed += CheckTrue("its error as stated, or rounding", wrong <= 3 * error + 1e-11 * size, wrong / error);
    magnitude[i] = size;
  }
  PetscCall(CheckPeaks(&r, n, freq, magnitude, failed));
  PetscCall(RunDestroy(&r));
  *failed += !ScratchRemove(s, "K.bin") || !ScratchRemove(s, "M.bin") || !ScratchRemove(s, "C.bin");
  for (int k = 0; k < 3; k++) (void)ScratchRemove(s, (const char *[]){"K.bin.info", "M.bin.info", "C.bin.info"}[k]);
  PetscFunctionReturn(0);
}

/* Entry (i, j) of the inverse of a 3 x 3 matrix, by cofactors */
static PetscComplex Inverse3(PetscComplex A[3][3], int i, int j)
{
  const int    r[] = {(j + 1) % 3, (j + 2) % 3}, c[] = {(i + 1) % 3, (i + 2) % 3};
  PetscComplex det = 0;

  for (int k = 0; k < 3; k++)
    det += A[0][k] * (A[1][(k + 1) % 3] * A[2][(k + 2) % 3] - A[1][(k + 2) % 3] * A[2][(k + 1) % 3]);
  return (A[r[0]][c[0]] * A[r[1]][c[1]] - A[r[0]][c[1]] * A[r[1]][c[0]]) / det;
}

/* Breaks when: left vectors are taken for right ones, or the transposed pencil is not. The response of the transposed
   matrices to a force on j is, at i, that of the matrices to a force on i, at j */
static PetscErrorCode TestThree(const char band[], PetscReal damped, int *failed)
{
  static const PetscReal K[3][3] = {
    {4,   -1,   0.5},
    {-1,  3,    -1 },
    {0.2, -1.4, 5  }
  };
  static const PetscReal M[3][3] = {
    {2,   0.1, 0},
    {0.1, 1,   0},
    {0,   0,   1}
  };
  static const PetscReal C[3][3] = {
    {0.1, 0,     0.02},
    {0,   0.05,  0   },
    {0,   -0.01, 0.2 }
  };
  const FrfOutput *output;
  const PetscReal *freq, *re, *im;
  PetscInt         n, n_outputs;
  PetscReal        error;
  PetscComplex     Q[3][3];
  char             options[1024];
  Run              r;

  PetscFunctionBeginUser;
  for (int turned = 0; turned < (damped > 0 ? 1 : 2); turned++)
    for (int j = 0; j < 3; j++) {
      PetscCall(PetscSNPrintf(options, sizeof(options),
                              "%s%s-modes_band %s -frf_force %d -frf_frequencies 0.05,0.2,0.31,0.5",
                              turned ? TURNED : THREE, damped > 0 ? LOSS : "", band, j + 1));
      PetscCall(RunCreate(options, &r));
      PetscCall(FrfGet(r.frf, &n, &freq, &n_outputs, &output));
      for (PetscInt i = 0; i < n; i++) {
        const PetscReal w = 2 * PETSC_PI * freq[i];

        for (int k = 0; k < 9; k++)
          Q[k / 3][k % 3] = CMPLX(K[k / 3][k % 3] - w * w * M[k / 3][k % 3], w * damped * C[k / 3][k % 3]);
        PetscCall(FrfGetResponse(r.frf, i, &re, &im, &error));
        for (int p = 0; p < 3; p++) {
          const PetscComplex exact = turned ? Inverse3(Q, j, p) : Inverse3(Q, p, j);

          *failed += CheckClose(turned       ? "transposed"
                                : damped > 0 ? "damped"
                                             : "undamped",
                                cabs(CMPLX(re[p], im[p]) - exact) / cabs(exact), 0, 1e-11);
        }
      }
      PetscCall(RunDestroy(&r));
    }
  PetscFunctionReturn(0);
}

/* Entry of a vector, on all ranks */
static PetscErrorCode EntryGet(Vec x, PetscInt i, PetscReal *value)
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  *value = 0;
  PetscCall(VecGetOwnershipRange(x, &first, &last));
  if (i >= first && i < last) PetscCall(VecGetValues(x, 1, &i, value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, value, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* What right and left vectors tell of u_a of a force on b without that of u_b of a force on a: nothing of a symmetric
   system. Breaks when they are scaled, paired or exchanged wrongly */
static PetscErrorCode TestExchange(int *failed)
{
  const PetscInt   a = 0, b = 2;
  const FrfOutput *output;
  const PetscReal *freq, *re, *im;
  const Mode      *mode;
  PetscInt         n, n_outputs, n_modes;
  PetscReal        error, H[2] = {0, 0}, sum = 0;
  Mat              M;
  Run              r;

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    PetscCall(RunCreate(k ? THREE "-modes_band 0,2 -frf_force 1 -frf_frequencies 0.3"
                          : THREE "-modes_band 0,2 -frf_force 3 -frf_frequencies 0.3",
                        &r));
    PetscCall(FrfGet(r.frf, &n, &freq, &n_outputs, &output));
    PetscCall(FrfGetResponse(r.frf, 0, &re, &im, &error));
    H[k] = re[k ? b : a];
    PetscCall(ModesGet(r.modes, &n_modes, &mode));
    PetscCall(PencilGetMass(r.pencil, &M));
    for (PetscInt i = 0; i < n_modes && !k; i++) {
      PetscReal xa, xb, ya, yb, yMx;
      Vec       x, xi, y, yi, Mx;

      PetscCall(ModesGetVectors(r.modes, i, &x, &xi, &y, &yi));
      PetscCall(VecDuplicate(x, &Mx));
      PetscCall(MatMult(M, x, Mx));
      PetscCall(VecDot(y, Mx, &yMx));
      PetscCall(VecDestroy(&Mx));
      PetscCall(EntryGet(x, a, &xa));
      PetscCall(EntryGet(x, b, &xb));
      PetscCall(EntryGet(y, a, &ya));
      PetscCall(EntryGet(y, b, &yb));
      sum += (xa * yb - xb * ya) / (yMx * (mode[i].omega * mode[i].omega - PetscSqr(2 * PETSC_PI * freq[0])));
    }
    PetscCall(RunDestroy(&r));
  }
  *failed += CheckTrue("Maxwell's reciprocity is violated", fabs(H[0] - H[1]) > 1e-3, H[0] - H[1]);
  *failed += CheckClose("by as much as left and right vectors tell", H[0] - H[1], sum, 1e-11);
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(int *failed)
{
  Scratch s = {.code = 0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &s.rank));
  PetscCall(ScratchMakeFolder(s.dir));
  PetscCall(TestRod(&s, 0, failed));
  PetscCall(TestRod(&s, 0.02, failed));
  PetscCall(TestThree("0,2", 0, failed));
  PetscCall(TestThree("0,0.3", 0, failed));
  PetscCall(TestThree("0,2", 1, failed));
  PetscCall(TestThree("0,0.3", 1, failed));
  PetscCall(TestExchange(failed));
  *failed += CheckTrue("scratch folder is empty", s.rank || !rmdir(s.dir), 0);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscFunctionBeginUser;
  PetscCall(SlepcInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Tests(&failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(SlepcFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
