/*
   The contact problem of one point on the basis: u = V q,

      (V'K V + sum_closed k_i (g_i - mu_i s_i) g_i') q = V'f + sum_closed k_i g0_i (g_i - mu_i s_i),

   g_i = (G V)_i the closing of pair i and s_i = (S V)_i its slip; closed are those with g_i' q > g0_i. The statuses are
   found as on the mesh (activeset.c), all wrong ones at a time. The error is what the last vectors change: the same
   closed pairs on fewer vectors.
*/
#include "many.h"
#include "base/algebra/dense.h"
#include <petscblaslapack.h>

#define MANY_ITERATIONS 40
#define MANY_FLOOR      1e-9 /* of the largest closing: what is left of rounding in equilibria */

/* A [n][n] += L R', L and R [m][n] */
static PetscErrorCode AddProduct(PetscInt n, PetscInt m, const PetscReal L[], const PetscReal R[], PetscReal A[])
{
  const PetscReal one = 1;
  PetscBLASInt    size, inner;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(m, &inner));
  if (m) PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &size, &size, &inner, &one, L, &size, R, &size, &one, A, &size));
  PetscFunctionReturn(0);
}

/* A [n][n] and b [n] of the closed pairs; K is what the bodies have */
static PetscErrorCode SystemForm(const ManyModel *model, const ManyPoint *point, const PetscReal K[],
                                 const char closed[], PetscReal A[], PetscReal b[])
{
  const PetscInt n = model->n, n_pairs = model->n_pairs;
  PetscReal     *L, *R;
  PetscInt       m = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n_pairs, &L, n * n_pairs, &R));
  PetscCall(PetscArraycpy(A, K, n * n));
  PetscCall(PetscArraycpy(b, point->f, n));
  for (PetscInt i = 0; i < n_pairs; i++) {
    if (!closed[i]) continue;
    for (PetscInt j = 0; j < n; j++) {
      R[m * n + j] = model->G[j * n_pairs + i];
      L[m * n + j] = point->k[i] * (R[m * n + j] - point->slide[i] * model->S[j * n_pairs + i]);
      b[j] += point->gap[i] * L[m * n + j];
    }
    m++;
  }
  PetscCall(AddProduct(n, m, L, R, A));
  PetscCall(PetscFree2(L, R));
  PetscFunctionReturn(0);
}

/* The system A q = b */
typedef struct {
  PetscReal *A, *b, *q; /* [n][n], [n], [n] */
} ManySystem;

/* q [m] and closing [n_pairs] of the leading m vectors; the system is kept */
static PetscErrorCode SystemSolve(const ManyModel *model, const ManyPoint *point, const ManySystem *system, PetscInt m,
                                  PetscReal closing[], PetscBool *singular)
{
  const PetscReal *A = system->A, *b = system->b;
  PetscReal       *q = system->q;
  const PetscInt   n = model->n, n_pairs = model->n_pairs;
  PetscReal       *part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m * m, &part));
  for (PetscInt j = 0; j < m; j++) PetscCall(PetscArraycpy(&part[j * m], &A[j * n], m));
  PetscCall(PetscArraycpy(q, b, m));
  *singular = PETSC_FALSE;
  if (m) PetscCall(DenseSolveWith(m, part, 1, q, singular));
  for (PetscInt i = 0; i < n_pairs; i++) closing[i] = -point->gap[i];
  for (PetscInt j = 0; j < m && !*singular; j++)
    for (PetscInt i = 0; i < n_pairs; i++) closing[i] += q[j] * model->G[j * n_pairs + i];
  PetscCall(PetscFree(part));
  PetscFunctionReturn(0);
}

/* Closes and opens pairs as their closings say; how many changed */
static PetscInt StatusesChange(PetscInt n_pairs, const PetscReal closing[], char closed[])
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < n_pairs; i++) {
    const char now = closing[i] > 0;

    n += now != closed[i];
    closed[i] = now;
  }
  return n;
}

/* How far closings are from those of fewer vectors, and from 0 */
static PetscErrorCode AnswerJudge(const ManyModel *model, const ManyPoint *point, const ManySystem *system,
                                  const PetscReal closing[], ManyAnswer *answer)
{
  PetscReal *less, *q, largest = 0;
  PetscBool  singular;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(model->n_pairs, &less, model->n, &q));
  PetscCall(SystemSolve(model, point, &(ManySystem){system->A, system->b, q}, model->n_less, less, &singular));
  answer->error   = singular ? PETSC_MAX_REAL : 0;
  answer->nearest = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < model->n_pairs; i++) largest = PetscMax(largest, PetscAbsReal(closing[i]));
  answer->error = PetscMax(answer->error, MANY_FLOOR * largest);
  for (PetscInt i = 0; i < model->n_pairs; i++) {
    answer->error   = PetscMax(answer->error, PetscAbsReal(less[i] - closing[i]));
    answer->nearest = PetscMin(answer->nearest, PetscAbsReal(closing[i]));
  }
  PetscCall(PetscFree2(less, q));
  PetscFunctionReturn(0);
}

PetscErrorCode ManySolve(const ManyModel *model, const ManyPoint *point, char closed[], PetscReal closing[],
                         PetscReal q[], ManyAnswer *answer)
{
  const PetscInt n = model->n;
  PetscReal     *K, *A, *b;
  PetscBool      singular = PETSC_FALSE;

  PetscFunctionBeginUser;
  *answer = (ManyAnswer){PETSC_FALSE, PETSC_MAX_REAL, 0};
  PetscCall(PetscCalloc3(n * n, &K, n * n, &A, n, &b));
  for (PetscInt t = 0; t < model->n_terms; t++)
    for (PetscInt i = 0; i < n * n && point->c[t] != 0; i++) K[i] += point->c[t] * model->A[t][i];
  for (PetscInt it = 0; it < MANY_ITERATIONS && !answer->found && !singular; it++) {
    PetscCall(SystemForm(model, point, K, closed, A, b));
    PetscCall(SystemSolve(model, point, &(ManySystem){A, b, q}, n, closing, &singular));
    if (!singular && !StatusesChange(model->n_pairs, closing, closed)) answer->found = PETSC_TRUE;
  }
  if (answer->found) PetscCall(AnswerJudge(model, point, &(ManySystem){A, b, q}, closing, answer));
  PetscCall(PetscFree3(K, A, b));
  PetscFunctionReturn(0);
}
