/*
   The basis V of equilibria on the mesh, V'V = I, with what the contact problem has on it: V'A_t V of the terms of the
   bodies' stiffness, and the closings G V and slips S V of all pairs. Vectors are in the unknowns of the pencil.
*/
#include "many.h"
#include "base/gather.h"
#include "solver/block/orthonormal.h"

#define MANY_DROP  1e-11 /* beside the first equilibrium: shorter ones add nothing */
#define MANY_SAME  1e-13 /* of a load: what it has beyond others is rounding */
#define MANY_AGREE 1e-7  /* of |K u|: the bodies of statics are the terms of the pencil */

/* Whether sum_t c_t A_t u = K u of statics at the equilibrium found last, q its unknowns */
static PetscErrorCode BodiesAgree(const ManyBasis *b, Vec q, PetscBool *agree)
{
  Statics              s = b->statics;
  const OperatorsTerm *terms;
  PetscInt             n;
  PetscReal            size, difference;
  Vec                  sum, one, own, all;

  PetscFunctionBeginUser;
  PetscCall(PencilGetTerms(b->bodies, &n, &terms));
  PetscCall(VecDuplicate(q, &sum));
  PetscCall(VecDuplicate(q, &one));
  PetscCall(VecDuplicate(q, &own));
  PetscCall(VecDuplicate(s->u, &all));
  PetscCall(VecSet(sum, 0));
  for (PetscInt t = 0; t < b->n_terms; t++) {
    PetscCall(MatMult(terms[b->term[t]].A, q, one));
    PetscCall(VecAXPY(sum, OperatorsTermCoefficient(&terms[b->term[t]], s->p), one));
  }
  PetscCall(OperatorsApplyBodies(s->operators, s->p, s->u, all));
  PetscCall(PencilProjectForce(b->bodies, PETSC_FALSE, all, own));
  PetscCall(VecNorm(own, NORM_2, &size));
  PetscCall(VecAXPY(sum, -1, own));
  PetscCall(VecNorm(sum, NORM_2, &difference));
  *agree = difference <= MANY_AGREE * size ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(VecDestroy(&sum));
  PetscCall(VecDestroy(&one));
  PetscCall(VecDestroy(&own));
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

/* The terms of stiffness that neither friction nor spin makes */
static PetscErrorCode ManyTermsTake(ManyBasis *b)
{
  const OperatorsTerm *terms;
  PetscInt             n;

  PetscFunctionBeginUser;
  PetscCall(PencilGetTerms(b->bodies, &n, &terms));
  PetscCall(PetscMalloc1(n, &b->term));
  for (PetscInt t = 0; t < n; t++)
    if (terms[t].kind == OPERATORS_STIFFNESS && !terms[t].frictional) b->term[b->n_terms++] = t;
  PetscCall(SubspaceCreate(terms[b->term[0]].A, NULL, 0, &b->space));
  for (PetscInt t = 0; t < b->n_terms; t++)
    PetscCall(SubspaceAddTerm(&b->space, terms[b->term[t]].A, terms[b->term[t]].symmetric, PETSC_TRUE));
  PetscCall(PetscMalloc1(b->n_terms, &b->model.A));
  b->model.n_terms = b->n_terms;
  b->model.n_pairs = b->statics->rows.n_pairs_all;
  PetscFunctionReturn(0);
}

/* One column [n_pairs of all ranks] of R u */
static PetscErrorCode ManyRowsOf(const ManyBasis *b, Mat R, Vec u, Vec row, PetscReal column[])
{
  const PetscScalar *local;
  PetscReal         *all;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(column, b->model.n_pairs));
  if (!R) PetscFunctionReturn(0);
  PetscCall(MatMult(R, u, row));
  PetscCall(VecGetArrayRead(row, &local));
  PetscCall(GatherRecords(b->statics->comm, b->statics->rows.n, sizeof(*local), local, NULL, &all));
  PetscCall(VecRestoreArrayRead(row, &local));
  PetscCall(PetscArraycpy(column, all, b->model.n_pairs));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* The rows of the vectors first to the last one */
static PetscErrorCode ManyRowsExtend(ManyBasis *b, PetscInt first)
{
  const PairRows *rows = &b->statics->rows;
  const size_t    size = (size_t)(b->space.n * b->model.n_pairs) * sizeof(PetscReal);
  Vec             u, q, row;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc(size, &b->model.G));
  PetscCall(PetscRealloc(size, &b->model.S));
  PetscCall(VecDuplicate(b->statics->u, &u));
  PetscCall(MatCreateVecs(rows->G, NULL, &row));
  for (PetscInt j = first; j < b->space.n; j++) {
    PetscCall(BVGetColumn(b->space.V, j, &q));
    PetscCall(PencilExpand(b->bodies, PETSC_FALSE, q, u));
    PetscCall(BVRestoreColumn(b->space.V, j, &q));
    PetscCall(ManyRowsOf(b, rows->G, u, row, &b->model.G[j * b->model.n_pairs]));
    PetscCall(ManyRowsOf(b, rows->S, u, row, &b->model.S[j * b->model.n_pairs]));
  }
  PetscCall(VecDestroy(&row));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

/* V'loads of the vectors from the first on */
static PetscErrorCode ManyLoadsExtend(ManyBasis *b, PetscInt first)
{
  Vec v;

  PetscFunctionBeginUser;
  PetscCall(BVSetActiveColumns(b->loads, 0, b->n_loads));
  for (PetscInt j = first; j < b->space.n && b->n_loads; j++) {
    PetscReal part[MANY_LOADS];

    PetscCall(BVGetColumn(b->space.V, j, &v));
    PetscCall(BVDotVec(b->loads, v, part));
    PetscCall(BVRestoreColumn(b->space.V, j, &v));
    for (PetscInt k = 0; k < b->n_loads; k++) b->loaded[k * MANY_VECTORS + j] = part[k];
  }
  PetscFunctionReturn(0);
}

/* The model for the error has two thirds of the vectors: those that came first; behind influences these and half of
   what came later */
PetscErrorCode ManyBasisAdd(ManyBasis *b)
{
  const PetscInt first = b->space.n;
  BV             block;
  Vec            q;

  PetscFunctionBeginUser;
  PetscCall(BlockCreate(b->space.V, 1, &block));
  PetscCall(BVGetColumn(block, 0, &q));
  PetscCall(PencilRestrict(b->bodies, b->statics->u, q));
  if (b->scale == 0) PetscCall(VecNorm(q, NORM_2, &b->scale));
  PetscCall(VecScale(q, 1 / b->scale));
  PetscCall(BVRestoreColumn(block, 0, &q));
  PetscCall(SubspaceAdd(&b->space, MANY_DROP, block, NULL));
  PetscCall(BVDestroy(&block));
  for (PetscInt t = 0; t < b->n_terms; t++) b->model.A[t] = b->space.term[t].small;
  b->model.n      = b->space.n;
  b->model.n_less = b->n_influences ? (b->n_influences + b->space.n) / 2 : 2 * b->space.n / 3;
  PetscCall(ManyLoadsExtend(b, first));
  PetscCall(ManyRowsExtend(b, first));
  PetscFunctionReturn(0);
}

PetscErrorCode ManyBasisCreate(Statics statics, ManyBasis *b, PetscBool *good)
{
  Vec q;

  PetscFunctionBeginUser;
  *b = (ManyBasis){.statics = statics};
  PetscCall(OperatorsLineariseBodies(statics->operators, NULL, PETSC_FALSE, &b->bodies));
  PetscCall(ManyTermsTake(b));
  PetscCall(BlockCreate(b->space.V, MANY_LOADS, &b->loads));
  PetscCall(PetscCalloc1(MANY_LOADS * MANY_VECTORS, &b->loaded));
  PetscCall(BVCreateVec(b->space.V, &q));
  PetscCall(PencilRestrict(b->bodies, b->statics->u, q));
  PetscCall(BodiesAgree(b, q, good));
  PetscCall(VecDestroy(&q));
  PetscFunctionReturn(0);
}

PetscErrorCode ManyBasisExpand(const ManyBasis *b, PetscReal q[])
{
  Vec v;

  PetscFunctionBeginUser;
  PetscCall(BVCreateVec(b->space.V, &v));
  PetscCall(BVSetActiveColumns(b->space.V, 0, b->space.n));
  PetscCall(BVMultVec(b->space.V, 1, 0, v, q));
  PetscCall(PencilExpand(b->bodies, PETSC_FALSE, v, b->statics->u));
  PetscCall(VecDestroy(&v));
  PetscFunctionReturn(0);
}

/* Numbers of the pairs of this rank, for all */
static PetscErrorCode ManyPairsGather(const ManyBasis *b, const PetscReal local[], PetscReal all[])
{
  PetscReal *gathered;

  PetscFunctionBeginUser;
  PetscCall(GatherRecords(b->statics->comm, b->statics->rows.n_pairs, sizeof(*local), local, NULL, &gathered));
  PetscCall(PetscArraycpy(all, gathered, b->model.n_pairs));
  PetscCall(PetscFree(gathered));
  PetscFunctionReturn(0);
}

/* Laws of the pairs at p: with kappa = 1 their k are in N/m. StaticsFactor() sets them again for the mesh */
static PetscErrorCode LawsTake(const ManyBasis *b, const PetscReal p[], ManyPoint *point)
{
  PairRows  *rows = &b->statics->rows;
  PetscReal *local;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < rows->n_interfaces; i++)
    PetscCheck(!FrictionNeedsPressure(&rows->interface[i].friction), rows->comm, PETSC_ERR_SUP,
               "contact %s: -%s_friction_law table is for single states, not for those of many points",
               rows->interface[i].name, rows->interface[i].name);
  PetscCall(PairRowsSetLaws(b->statics->operators, p, 1, rows));
  PetscCall(PetscMalloc1(rows->n_pairs, &local));
  for (PetscInt i = 0; i < rows->n_pairs; i++) local[i] = rows->law[i].k;
  PetscCall(ManyPairsGather(b, local, point->k));
  for (PetscInt i = 0; i < rows->n_pairs; i++) local[i] = rows->law[i].g0;
  PetscCall(ManyPairsGather(b, local, point->gap));
  PetscCall(ManyPairsGather(b, rows->slide, point->slide));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* The load g at p in the unknowns of the basis, by its caller */
static PetscErrorCode LoadCreate(const ManyBasis *b, const PetscReal p[], Vec *g)
{
  PetscReal size = 0;
  Vec       f;

  PetscFunctionBeginUser;
  PetscCall(StaticsCreateLoad(b->statics->operators, p, StagesGet(b->statics, 0), &f, &size));
  PetscCall(BVCreateVec(b->space.V, g));
  PetscCall(PencilProjectForce(b->bodies, PETSC_FALSE, f, *g));
  PetscCall(VecDestroy(&f));
  PetscFunctionReturn(0);
}

/* The parts of a load, which may be one more for the basis; n stays -1 where there is no room for it */
static PetscErrorCode LoadFind(ManyBasis *b, Vec g, ManyLoad *load)
{
  const PetscInt n = b->n_loads;
  PetscReal      whole, rest;

  PetscFunctionBeginUser;
  if (n == MANY_LOADS) PetscFunctionReturn(0);
  PetscCall(BVInsertVec(b->loads, n, g));
  PetscCall(VecNorm(g, NORM_2, &whole));
  PetscCall(BVOrthogonalizeColumn(b->loads, n, load->part, &rest, NULL));
  load->n = n;
  if (rest <= MANY_SAME * whole) PetscFunctionReturn(0);
  load->part[load->n++] = rest;
  PetscCall(BVScaleColumn(b->loads, n, 1 / rest));
  b->n_loads++;
  PetscCall(BVGetColumn(b->loads, n, &g));
  PetscCall(BVDotVec(b->space.V, g, &b->loaded[n * MANY_VECTORS]));
  PetscCall(BVRestoreColumn(b->loads, n, &g));
  PetscFunctionReturn(0);
}

PetscErrorCode ManyBasisPoint(ManyBasis *b, const PetscReal p[], ManyLoad *load, ManyPoint *point)
{
  const OperatorsTerm *terms;
  PetscInt             n;
  Vec                  g = NULL;

  PetscFunctionBeginUser;
  PetscCall(PencilGetTerms(b->bodies, &n, &terms));
  for (PetscInt t = 0; t < b->n_terms; t++) point->c[t] = OperatorsTermCoefficient(&terms[b->term[t]], p);
  PetscCall(BVSetActiveColumns(b->space.V, 0, b->space.n));
  if (load->n < 0) PetscCall(LoadCreate(b, p, &g));
  if (g) PetscCall(LoadFind(b, g, load));
  if (load->n < 0) PetscCall(BVDotVec(b->space.V, g, point->f));
  for (PetscInt j = 0; j < b->space.n && load->n >= 0; j++) {
    point->f[j] = 0;
    for (PetscInt k = 0; k < load->n; k++) point->f[j] += load->part[k] * b->loaded[k * MANY_VECTORS + j];
  }
  PetscCall(VecDestroy(&g));
  PetscCall(LawsTake(b, p, point));
  PetscFunctionReturn(0);
}

PetscErrorCode ManyBasisDestroy(ManyBasis *b)
{
  PetscFunctionBeginUser;
  PetscCall(SubspaceDestroy(&b->space));
  PetscCall(BVDestroy(&b->loads));
  PetscCall(PetscFree(b->loaded));
  PetscCall(PencilDestroy(&b->bodies));
  PetscCall(PetscFree(b->term));
  PetscCall(PetscFree(b->model.A));
  PetscCall(PetscFree(b->model.G));
  PetscCall(PetscFree(b->model.S));
  PetscFunctionReturn(0);
}
