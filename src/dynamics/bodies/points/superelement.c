/*
   Superelements in time. With q = B x their unknowns, those of nodes sums of displacements (operators/superelement),
   and one number of the state for each that is apart, they add forces B'(K q + C q') and the mass B'M B to the diagonal
   masses D of the nodes. Unknowns apart get the diagonal of M as their D, and M keeps the rest, W = M - D there. As for
   points (mass.c), the integrator, which divides by D, needs beside the forces f those of inertia,

      (D + B'W B)^-1 f = D^-1 (f - B'X B D^-1 f),   X = W (I + S W)^-1,   S = B D^-1 B'   (1/kg),

   and the critical step, in which fast modes of superelements count, the symmetric root of the same inverse,
   D^-1/2 (I + G'Y G), G = B D^-1/2. With S = P s P' and the eigenvalues t, V of (P s^1/2)' W (P s^1/2):

      X = F diag(t / (1 + t)) F',   Y = F diag((1 + t)^-1/2 - 1) F',   F = P s^-1/2 V.

   1 + t is positive where the mass can be factored. X and Y are the first rank's on all ranks, and each rank multiplies
   some rows of a matrix, which all then take over: copies of the unknowns apart stay alike to the last digit.
*/
#include "dynamics/bodies/bodiesimpl.h"
#include <petscblaslapack.h>

#define SUPER_MOST 3000  /* unknowns: matrices of 72 MB, eigenvalues in half a minute */
#define SUPER_FLAT 1e-12 /* of the largest eigenvalue of S: motions that nothing of the mesh makes */

/* Shares of this rank's nodes, copies too, along the components of the state */
static PetscErrorCode SuperSetEntries(Bodies b, const OperatorsSuperelements *all)
{
  const Mesh *mesh = b->mesh;
  Super      *s    = &b->super;
  PetscInt   *number, *vertex, at;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_nodes, &number, mesh->n_nodes, &vertex));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) number[v] = mesh->number[v], vertex[v] = v;
  PetscCall(PetscSortIntWithArray(mesh->n_nodes, number, vertex));
  PetscCall(PetscMalloc1(3 * all->n_nodes, &s->entry));
  for (PetscInt k = 0; k < all->n_nodes; k++) {
    const OperatorsSuperelementNode *node = &all->node[k];

    PetscCall(PetscFindInt(node->number, mesh->n_nodes, number, &at));
    for (PetscInt j = 0; at >= 0 && j < 3; j++) {
      const PetscInt  v = vertex[at];
      const PetscReal w = node->weight * b->layout.basis[9 * v + 3 * j + node->direction];

      if (w == 0) continue;
      s->entry[s->n_entries++] =
        (SuperEntry){node->row, v, b->layout.at[v] + j * b->layout.step[v], w, mesh->owned[v], b->share.shared[v]};
    }
  }
  PetscCall(PetscFree2(number, vertex));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperLayOut(Bodies b)
{
  Super      *s = &b->super;
  PetscMPIInt n_ranks, rank;

  PetscFunctionBeginUser;
  if (!OperatorsCountSuperelements(b->operators)) PetscFunctionReturn(0);
  PetscCall(OperatorsCheckEven(b->operators, PETSC_TRUE, "a transient"));
  PetscCall(OperatorsGetSuperelements(b->operators, NULL, &s->all));
  s->n = s->all.n;
  PetscCheck(s->n <= SUPER_MOST, b->comm, PETSC_ERR_SUP,
             "superelements with %" PetscInt_FMT
             " unknowns, more than %d, are not supported in time on the mesh: reduce "
             "them (-analysis superelement)",
             s->n, SUPER_MOST);
  PetscCallMPI(MPI_Comm_size(b->comm, &n_ranks));
  PetscCallMPI(MPI_Comm_rank(b->comm, &rank));
  PetscCall(PetscMalloc2(n_ranks, &s->count, n_ranks, &s->start));
  for (PetscMPIInt r = 0; r < n_ranks; r++) {
    s->start[r] = (PetscMPIInt)(s->n * r / n_ranks);
    s->count[r] = (PetscMPIInt)(s->n * (r + 1) / n_ranks) - s->start[r];
  }
  s->first = s->start[rank];
  s->last  = s->first + s->count[rank];
  PetscCall(PetscMalloc5(s->n, &s->slot, s->n, &s->q, s->n, &s->g, s->n, &s->h, s->n, &s->part));
  for (PetscInt i = 0; i < s->n; i++) s->slot[i] = s->all.apart[i] < 0 ? -1 : b->layout.n + s->all.apart[i];
  b->layout.apart   = b->layout.n;
  b->layout.n_apart = s->all.n_apart;
  b->layout.n += s->all.n_apart;
  PetscFunctionReturn(0);
}

PetscErrorCode SuperSetMasses(Bodies b)
{
  const Super *s = &b->super;

  PetscFunctionBeginUser;
  if (s->n) PetscCall(SuperSetEntries(b, &s->all));
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscInt at = s->slot[i];

    if (at < 0) continue;
    b->layout.total[at] = s->all.M[i + s->n * i];
    b->layout.minv[at]  = 1 / b->layout.total[at];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SuperGetMarks(Bodies b, unsigned char mark[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < b->super.n_entries; i++) mark[b->super.entry[i].vertex] |= BODIES_AT_SUPER;
  PetscFunctionReturn(0);
}

/* Raises an error for a node that other masses, contact or a motion move too */
static PetscErrorCode SuperCheckNodes(Bodies b, const unsigned char mark[])
{
  static const char *const what[] = {"are on a contact surface", "are of a point that is joined rigidly",
                                     "are of a point with a mass", "are driven by a motion"};
  PetscInt                 fault[PETSC_STATIC_ARRAY_LENGTH(what)] = {0};
  const Super             *s                                      = &b->super;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n_entries; i++) {
    const SuperEntry *e    = &s->entry[i];
    PetscBool         held = PETSC_FALSE;

    for (int d = 0; d < 3; d++)
      if (b->mesh->unknown[3 * e->vertex + d] < 0) held = PETSC_TRUE;
    for (int k = 0; k < 3; k++)
      if (mark[e->vertex] & (1 << k)) fault[k] = 1;
    if (!held && b->layout.minv[e->at] == 0) fault[3] = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, fault, PETSC_STATIC_ARRAY_LENGTH(what), MPIU_INT, MPI_MAX, b->comm));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(what); k++)
    PetscCheck(
      !fault[k] || (k == 0 && !s->all.M), b->comm, PETSC_ERR_SUP,
      "superelements are joined to nodes that %s, which is not supported in time on the mesh: join them to other "
      "nodes, or take -dynamics_model reduced",
      what[k]);
  PetscFunctionReturn(0);
}

/* S = B D^-1 B', on all ranks */
static PetscErrorCode SuperCompliance(Bodies b, PetscReal S[])
{
  const Super *s = &b->super;
  PetscInt    *first, *order;
  PetscMPIInt  n;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(S, s->n * s->n));
  PetscCall(PetscMalloc2(s->n_entries, &first, s->n_entries, &order));
  for (PetscInt i = 0; i < s->n_entries; i++) first[i] = s->entry[i].at, order[i] = i;
  PetscCall(PetscSortIntWithArray(s->n_entries, first, order));
  for (PetscInt i = 0; i < s->n_entries; i++) {
    const SuperEntry *e = &s->entry[order[i]];

    for (PetscInt k = i; e->owned && k < s->n_entries && first[k] == first[i]; k++) {
      const SuperEntry *f     = &s->entry[order[k]];
      const PetscReal   value = e->weight * b->layout.minv[e->at] * f->weight;

      S[e->row + s->n * f->row] += value;
      if (k > i) S[f->row + s->n * e->row] += value;
    }
  }
  PetscCall(PetscFree2(first, order));
  PetscCall(PetscMPIIntCast(s->n, &n));
  for (PetscInt j = 0; j < s->n; j++)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &S[s->n * j], n, MPIU_REAL, MPI_SUM, b->comm));
  for (PetscInt i = 0; i < s->n; i++)
    if (s->slot[i] >= 0) S[i * (s->n + 1)] = b->layout.minv[s->slot[i]];
  PetscFunctionReturn(0);
}

/* Eigenvalues, ascending, and vectors in the place of a symmetric matrix */
static PetscErrorCode SuperEigen(PetscInt size, PetscReal A[], PetscReal w[])
{
  PetscBLASInt n, n_work, info;
  PetscReal   *work;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCall(PetscBLASIntCast(34 * size, &n_work));
  PetscCall(PetscMalloc1(n_work, &work));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, A, &n, w, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's syev failed with info %d", (int)info);
  PetscCall(PetscFree(work));
  PetscFunctionReturn(0);
}

/* C = A B, or A'B, or A B', [n][n] by columns */
static PetscErrorCode SuperTimes(PetscInt size, const char a[], const PetscReal A[], const char c[],
                                 const PetscReal B[], PetscReal C[])
{
  const PetscScalar unit = 1, zero = 0;
  PetscBLASInt      n;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(size, &n));
  PetscCallBLAS("BLASgemm", BLASgemm_(a, c, &n, &n, &n, &unit, A, &n, B, &n, &zero, C, &n));
  PetscFunctionReturn(0);
}

/* Times numbers, columns of a matrix */
static void SuperScale(PetscInt n, PetscReal A[], const PetscReal factor[])
{
  for (PetscInt i = 0; i < n * n; i++) A[i] *= factor[i / n];
}

/* Trace of T'A T, 0 without A */
static PetscErrorCode SuperTrace(PetscInt n, const PetscReal A[], const PetscReal T[], PetscReal *trace)
{
  PetscReal *AT;

  PetscFunctionBeginUser;
  *trace = 0;
  if (!A) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n * n, &AT));
  PetscCall(SuperTimes(n, "N", A, "N", T, AT));
  for (PetscInt i = 0; i < n * n; i++) *trace += T[i] * AT[i];
  PetscCall(PetscFree(AT));
  PetscFunctionReturn(0);
}

/* What K and C add to the largest omega^2 at most, (S^-1 + W)^-1 = T T' with T = P s^1/2 V (1 + t)^-1/2: traces */
static PetscErrorCode SuperSetBound(Super *s, const PetscReal Ps[], const PetscReal V[], const PetscReal t[])
{
  const PetscInt n = s->n;
  PetscReal     *T, *f;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * n, &T, n, &f));
  PetscCall(SuperTimes(n, "N", Ps, "N", V, T));
  for (PetscInt i = 0; i < n; i++) f[i] = 1 / PetscSqrtReal(1 + t[i]);
  SuperScale(n, T, f);
  PetscCall(SuperTrace(n, s->all.K, T, &s->bound[0]));
  PetscCall(SuperTrace(n, s->all.C, T, &s->bound[1]));
  PetscCall(PetscFree2(T, f));
  PetscFunctionReturn(0);
}

/* Z = F diag(factor) F' */
static PetscErrorCode SuperSandwich(PetscInt n, const PetscReal F[], const PetscReal factor[], PetscReal Z[])
{
  PetscReal *T;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &T));
  PetscCall(PetscArraycpy(T, F, n * n));
  SuperScale(n, T, factor);
  PetscCall(SuperTimes(n, "N", T, "T", F, Z));
  PetscCall(PetscFree(T));
  PetscFunctionReturn(0);
}

/* P in S, s^1/2 (0 where flat), V in W and t of W = M - D */
static PetscErrorCode SuperDecompose(const Super *s, PetscReal S[], PetscReal root[], PetscReal W[], PetscReal t[])
{
  const PetscInt n = s->n;
  PetscReal     *T;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &T));
  for (PetscInt i = 0; i < n * n; i++) W[i] = s->all.M ? s->all.M[i] : 0;
  for (PetscInt i = 0; i < n; i++)
    if (s->slot[i] >= 0) W[i * (n + 1)] = 0; /* D of an unknown apart is the diagonal of M */
  PetscCall(SuperEigen(n, S, root));
  for (PetscInt i = n - 1; i >= 0; i--)
    root[i] = root[i] > SUPER_FLAT * (i < n - 1 ? PetscSqr(root[n - 1]) : root[i]) ? PetscSqrtReal(root[i]) : 0;
  PetscCall(SuperTimes(n, "N", W, "N", S, T));
  SuperScale(n, T, root);
  PetscCall(SuperTimes(n, "T", S, "N", T, W));
  for (PetscInt i = 0; i < n * n; i++) W[i] *= root[i % n];
  PetscCall(SuperEigen(n, W, t));
  PetscCall(PetscFree(T));
  PetscFunctionReturn(0);
}

/* X, Y and the bound from S, which is lost; *least: the least 1 + t */
static PetscErrorCode SuperFactor(Super *s, PetscReal S[], PetscReal *least)
{
  const PetscInt n = s->n;
  PetscReal     *W, *F, *t, *root;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n * n, &W, n * n, &F, n, &t, n, &root));
  PetscCall(SuperDecompose(s, S, root, W, t));
  *least = 1 + t[0];
  if (*least > 0) {
    PetscCall(PetscArraycpy(F, S, n * n));
    SuperScale(n, F, root);
    PetscCall(SuperSetBound(s, F, W, t));
    for (PetscInt i = 0; i < n; i++) root[i] = root[i] > 0 ? 1 / root[i] : 0;
    SuperScale(n, S, root);
    PetscCall(SuperTimes(n, "N", S, "N", W, F));
    for (PetscInt i = 0; i < n; i++) root[i] = t[i] / (1 + t[i]);
    PetscCall(SuperSandwich(n, F, root, s->X));
    for (PetscInt i = 0; i < n; i++) root[i] = 1 / PetscSqrtReal(1 + t[i]) - 1;
    PetscCall(SuperSandwich(n, F, root, s->Y));
  }
  PetscCall(PetscFree4(W, F, t, root));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperSetUp(Bodies b, const unsigned char mark[])
{
  Super         *s = &b->super;
  const PetscInt n = s->n;
  PetscReal     *S, least = 1;
  PetscMPIInt    rank, count;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(SuperCheckNodes(b, mark));
  PetscCall(PetscMalloc2(n * n, &s->X, n * n, &s->Y));
  PetscCall(PetscMalloc1(n * n, &S));
  PetscCall(SuperCompliance(b, S));
  PetscCallMPI(MPI_Comm_rank(b->comm, &rank));
  if (!rank) PetscCall(SuperFactor(s, S, &least));
  PetscCallMPI(MPI_Bcast(&least, 1, MPIU_REAL, 0, b->comm));
  PetscCheck(
    least > 0, b->comm, PETSC_ERR_SUP,
    "superelements: their mass with that of the mesh is not positive definite, and cannot be factored in time on "
    "the mesh: take -dynamics_model reduced");
  PetscCallMPI(MPI_Bcast(s->bound, 2, MPIU_REAL, 0, b->comm));
  PetscCall(PetscMPIIntCast(n, &count));
  for (PetscInt j = 0; j < n; j++) {
    PetscCallMPI(MPI_Bcast(&s->X[n * j], count, MPIU_REAL, 0, b->comm));
    PetscCallMPI(MPI_Bcast(&s->Y[n * j], count, MPIU_REAL, 0, b->comm));
  }
  PetscCall(PetscFree(S));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperDestroy(Bodies b)
{
  Super *s = &b->super;

  PetscFunctionBeginUser;
  PetscCall(OperatorsDestroySuperelements(&s->all));
  PetscCall(PetscFree(s->entry));
  PetscCall(PetscFree5(s->slot, s->q, s->g, s->h, s->part));
  PetscCall(PetscFree2(s->X, s->Y));
  PetscCall(PetscFree2(s->count, s->start));
  PetscFunctionReturn(0);
}
