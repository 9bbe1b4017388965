/*
   Forces of superelements, B'(K q + C q') with q = B x, those of inertia, and what they add to the sums of a step
   (superelement.c). Nodes that ranks share have these from their owner, as those of bushings (joint.c); unknowns apart
   have them on every rank, and the first rank counts their energies.
*/
#include "dynamics/bodies/bodiesimpl.h"
#include <petscblaslapack.h>

/* y = A x, A [n][n] symmetric by columns: rows of this rank, then those of the others */
static PetscErrorCode SuperMultiply(Bodies b, const PetscReal A[], const PetscReal x[], PetscReal y[])
{
  const Super       *s    = &b->super;
  const PetscScalar  unit = 1, zero = 0;
  const PetscBLASInt one = 1;
  PetscBLASInt       n, rows;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(s->n, &n));
  PetscCall(PetscBLASIntCast(s->last - s->first, &rows));
  if (rows)
    PetscCallBLAS("BLASgemv", BLASgemv_("T", &n, &rows, &unit, &A[n * s->first], &n, x, &one, &zero, s->part, &one));
  PetscCallMPI(MPI_Allgatherv(s->part, rows, MPIU_REAL, y, s->count, s->start, MPIU_REAL, b->comm));
  PetscFunctionReturn(0);
}

/* q = B (scale x), on all ranks; scale NULL for 1 */
static PetscErrorCode SuperMotion(Bodies b, const PetscReal scale[], const PetscReal x[], PetscReal q[])
{
  const Super *s = &b->super;
  PetscMPIInt  n;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(q, s->n));
  for (PetscInt i = 0; i < s->n_entries; i++) {
    const SuperEntry *e = &s->entry[i];

    if (e->owned) q[e->row] += e->weight * x[e->at] * (scale ? scale[e->at] : 1);
  }
  PetscCall(PetscMPIIntCast(s->n, &n));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q, n, MPIU_REAL, MPI_SUM, b->comm));
  for (PetscInt i = 0; i < s->n; i++)
    if (s->slot[i] >= 0) q[i] = x[s->slot[i]] * (scale ? scale[s->slot[i]] : 1);
  PetscFunctionReturn(0);
}

/* x += a scale B'g, at all copies */
static void SuperSpread(const Super *s, PetscReal a, const PetscReal scale[], const PetscReal g[], PetscReal x[])
{
  for (PetscInt i = 0; i < s->n_entries; i++) {
    const SuperEntry *e = &s->entry[i];

    x[e->at] += a * e->weight * g[e->row] * (scale ? scale[e->at] : 1);
  }
  for (PetscInt i = 0; i < s->n; i++)
    if (s->slot[i] >= 0) x[s->slot[i]] += a * g[i] * (scale ? scale[s->slot[i]] : 1);
}

/* Of the unknowns apart the whole of a step: nothing else writes there */
static void SuperAdvanceApart(const Super *s, PetscBool counts, BodiesWork *w)
{
  for (PetscInt i = 0; i < s->n; i++) {
    const PetscInt at = s->slot[i];

    if (at < 0) continue;
    if (counts) w->sums.strain += 0.5 * w->u[at] * w->ku[at];
    w->ku[at] += w->dt * s->g[i];
    w->f[at] = -w->ku[at];
    if (!w->d) continue;
    if (counts) w->sums.damping_old += w->v[at] * w->d[at];
    w->d[at] = s->all.C ? s->h[i] : 0;
    w->f[at] -= w->d[at];
    if (counts) w->sums.damping += w->v[at] * w->d[at];
  }
}

/* K q, C q and the kinetic energy of q = B v; then the unknowns apart */
static PetscErrorCode SuperBegin(Bodies b, BodiesWork *w)
{
  Super      *s = &b->super;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(b->comm, &rank));
  PetscCall(SuperMotion(b, NULL, w->v, s->q));
  if (s->all.M) {
    PetscCall(SuperMultiply(b, s->all.M, s->q, s->g));
    for (PetscInt i = 0; i < s->n && !rank; i++) w->sums.kinetic += 0.5 * s->q[i] * s->g[i];
  }
  PetscCall(PetscArrayzero(s->g, s->n));
  if (s->all.K) PetscCall(SuperMultiply(b, s->all.K, s->q, s->g));
  if (s->all.C && w->d) PetscCall(SuperMultiply(b, s->all.C, s->q, s->h));
  SuperAdvanceApart(s, rank ? PETSC_FALSE : PETSC_TRUE, w);
  PetscFunctionReturn(0);
}

PetscErrorCode SuperAdvance(Bodies b, PetscBool early, BodiesWork *w)
{
  const Super *s = &b->super;

  PetscFunctionBeginUser;
  if (!s->n) PetscFunctionReturn(0);
  if (early) PetscCall(SuperBegin(b, w));
  for (PetscInt i = 0; i < s->n_entries; i++) {
    const SuperEntry *e = &s->entry[i];
    const PetscReal   g = e->weight * s->g[e->row];

    if (!e->owned || e->shared != early) continue;
    w->ku[e->at] += w->dt * g;
    w->f[e->at] -= w->dt * g;
    if (!w->d || !s->all.C) continue;
    w->d[e->at] += e->weight * s->h[e->row];
    w->f[e->at] -= e->weight * s->h[e->row];
    w->sums.damping += w->v[e->at] * e->weight * s->h[e->row];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SuperAddForces(Bodies b, const PetscReal u[], PetscReal ku[])
{
  Super *s = &b->super;

  PetscFunctionBeginUser;
  if (!s->n || !s->all.K) PetscFunctionReturn(0);
  PetscCall(SuperMotion(b, NULL, u, s->q));
  PetscCall(SuperMultiply(b, s->all.K, s->q, s->g));
  for (PetscInt i = 0; i < s->n_entries; i++)
    if (s->entry[i].owned) ku[s->entry[i].at] += s->entry[i].weight * s->g[s->entry[i].row];
  for (PetscInt i = 0; i < s->n; i++)
    if (s->slot[i] >= 0) ku[s->slot[i]] += s->g[i];
  PetscFunctionReturn(0);
}

PetscErrorCode SuperAddInertia(Bodies b, PetscReal f[])
{
  Super *s = &b->super;

  PetscFunctionBeginUser;
  if (!s->n || !s->all.M) PetscFunctionReturn(0);
  PetscCall(SuperMotion(b, b->layout.minv, f, s->q));
  PetscCall(SuperMultiply(b, s->X, s->q, s->g));
  SuperSpread(s, -1, NULL, s->g, f);
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesApplyRoot(Bodies b, const PetscReal scale[], PetscReal x[])
{
  Super *s = &b->super;

  PetscFunctionBeginUser;
  if (!s->n || !s->all.M) PetscFunctionReturn(0);
  PetscCall(SuperMotion(b, scale, x, s->q));
  PetscCall(SuperMultiply(b, s->Y, s->q, s->g));
  SuperSpread(s, 1, scale, s->g, x);
  PetscFunctionReturn(0);
}
