/*
   What a change of contact status does to modes. Where pairs open or close, with rows L_k, R_k,

      Q(p') = Q(p) + sum_k d_k L_k' R_k,     x = -Q(p)^-1 sum_k L_k' (d_k R_k x),

   so that the right vectors at all statuses lie in Q^-1 L' and those at one of them, left vectors in Q^-T R': as many
   directions as there are such pairs, whatever the number of statuses. The factors P of corrections (correct.c) stand
   for Q(lambda), which differs from them by modes above the window, and by friction and moduli at other points.

   A direction counts by what it does: the force of the modes at the first point when the pair alone changes,
   d R x / (1 + d R P^-1 L'), d = -c of a pair that is closed there, c of one that is open. Those of little energy are
   left out as corrections are.
*/
#include "greedywork.h"
#include "base/events.h"
#include "solver/block/orthonormal.h"

#define PAIR_OMEGA 0.01 /* slower modes count as if they were at this part of the upper end of the window */
#define LEAST_DROP 1e-3 /* of 1 + d R P^-1 L', which may pass through zero */

/* Terms of pairs that open and close at one interface and in one group: normal ones and those of friction, N, T */
typedef struct {
  PetscInt normal, friction; /* terms; friction -1: none */
  PetscInt rank, first[2];   /* rows; the first of their columns for right vectors, for left ones */
} PairGroup;

/* Whether a term is of pairs that open and close */
static PetscBool TermSwitches(const Reduced *r, PetscInt t)
{
  for (PetscInt k = 0; k < r->n_parameters; k++)
    if (r->parameter[k].internal && r->term[t].left && r->term[t].kind == OPERATORS_STIFFNESS &&
        OperatorsTermDepends(&r->term[t], k))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Those of all groups that have rows */
static void GroupsFind(const Reduced *r, PetscInt *n, PairGroup group[])
{
  *n = 0;
  for (PetscInt t = 0; t < r->n_terms; t++) {
    const OperatorsTerm *term = &r->term[t];
    PairGroup           *g    = &group[*n];

    if (!term->symmetric || !TermSwitches(r, t)) continue;
    *g = (PairGroup){.normal = t, .friction = -1, .rank = r->factors[t].rank};
    for (PetscInt k = 0; k < r->n_terms; k++)
      if (r->term[k].frictional && r->term[k].group == term->group && r->term[k].interface == term->interface &&
          TermSwitches(r, k))
        g->friction = k;
    *n += g->rank ? 1 : 0;
  }
}

/* Columns at .. of the block: the rows of A */
static PetscErrorCode RowsAppend(Mat A, PetscInt *at, BV block)
{
  PetscInt n, begin, end;
  Vec      unit, column;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &n, NULL));
  PetscCall(MatCreateVecs(A, NULL, &unit));
  PetscCall(VecGetOwnershipRange(unit, &begin, &end));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(VecSet(unit, 0));
    if (k >= begin && k < end) PetscCall(VecSetValue(unit, k, 1, INSERT_VALUES));
    PetscCall(VecAssemblyBegin(unit));
    PetscCall(VecAssemblyEnd(unit));
    PetscCall(BVGetColumn(block, *at, &column));
    PetscCall(MatMultTranspose(A, unit, column));
    PetscCall(BVRestoreColumn(block, (*at)++, &column));
  }
  PetscCall(VecDestroy(&unit));
  PetscFunctionReturn(0);
}

/* Columns of both sides: N and T of each group for right vectors, those of R for left ones */
static PetscErrorCode RowsCollect(const Basis *basis, PetscInt n, PairGroup group[], CorrectionBlock *block)
{
  const OperatorsTerm *term  = basis->reduced.term;
  PetscInt             at[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt g = 0; g < n; g++) {
    for (int i = 0; i < 2; i++) group[g].first[i] = block->n[i];
    block->n[0] += group[g].rank * (group[g].friction < 0 ? 1 : 2);
    block->n[1] += group[g].rank;
  }
  for (int i = 0; i < 2; i++) PetscCall(BlockCreate(basis->space.V, block->n[i], &block->side[i]));
  for (PetscInt g = 0; g < n; g++) {
    PetscCall(RowsAppend(term[group[g].normal].left, &at[0], block->side[0]));
    if (group[g].friction >= 0) PetscCall(RowsAppend(term[group[g].friction].left, &at[0], block->side[0]));
    PetscCall(RowsAppend(term[group[g].normal].right, &at[1], block->side[1]));
  }
  PetscFunctionReturn(0);
}

/* Forces of the modes on the rows of a term, the largest |R_k x| h / |lambda|, h the upper end of the window */
static void RowsForce(const Reduced *r, PetscInt t, const ReducedModes *modes, PetscReal h, PetscReal force[])
{
  const PetscInt rank = r->factors[t].rank;

  for (PetscInt k = 0; k < rank; k++) {
    force[k] = 0;
    for (PetscInt i = 0; i < modes->n; i++) {
      const PetscComplex *x = modes->x + i * modes->size, *y = modes->y + i * modes->size;
      const PetscReal     part  = h / PetscMax(cabs(modes->lambda[i]), PAIR_OMEGA * h);
      PetscComplex        right = 0, left = 0;

      for (PetscInt j = 0; j < modes->size; j++) {
        right += r->factors[t].right[j * rank + k] * x[j];
        left += r->factors[t].right[j * rank + k] * y[j];
      }
      force[k] = PetscMax(force[k], part * PetscMax(cabs(right), cabs(left)));
    }
  }
}

/* Turns the columns of one group into what they do to modes */
static PetscErrorCode GroupScale(GreedyWork *run, const PetscReal p[], const PairGroup *g, const ReducedModes *modes,
                                 const CorrectionBlock *block, BV Z)
{
  const Reduced  *r = &run->basis->reduced;
  const PetscInt  n = g->rank, *at = g->first;
  const PetscBool closed = OperatorsTermCoefficient(&r->term[g->normal], p) != 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscReal      *force, *all, c[2];
  Vec             z, row;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &force, r->n_parameters, &all));
  for (PetscInt k = 0; k < r->n_parameters; k++) all[k] = r->parameter[k].internal ? 1 : p[k];
  c[0] = OperatorsTermCoefficient(&r->term[g->normal], all);
  c[1] = g->friction < 0 ? 0 : OperatorsTermCoefficient(&r->term[g->friction], all);
  RowsForce(r, g->normal, modes, run->guarded.high, force);
  for (PetscInt k = 0; k < n; k++) {
    PetscReal give;

    PetscCall(BVGetColumn(Z, at[0] + k, &z));
    PetscCall(BVGetColumn(block->side[1], at[1] + k, &row));
    PetscCall(VecDot(z, row, &give));
    PetscCall(BVRestoreColumn(block->side[1], at[1] + k, &row));
    PetscCall(BVRestoreColumn(Z, at[0] + k, &z));
    force[k] /= PetscMax(PetscAbsReal(1 + (closed ? -c[0] : c[0]) * give), LEAST_DROP);
    PetscCall(BVScaleColumn(Z, at[0] + k, c[0] * force[k]));
    if (g->friction >= 0) PetscCall(BVScaleColumn(Z, at[0] + n + k, c[1] * force[k]));
    PetscCall(BVScaleColumn(Z, block->n[0] + at[1] + k, c[0] * force[k]));
  }
  PetscCall(PetscFree2(force, all));
  PetscFunctionReturn(0);
}

/* All groups; omega of the columns is the upper end of the window, to which forces are scaled */
static PetscErrorCode GroupsScale(GreedyWork *run, const PetscReal p[], PetscInt n, const PairGroup group[],
                                  CorrectionBlock *block, BV Z)
{
  ReducedModes modes;

  PetscFunctionBeginUser;
  PetscCall(ReducedSolve(&run->basis->reduced, p, &run->guarded, &modes));
  PetscCall(ReducedModesBroadcast(run->basis->comm, 0, &modes));
  for (PetscInt g = 0; g < n; g++) PetscCall(GroupScale(run, p, &group[g], &modes, block, Z));
  PetscCall(ReducedModesDestroy(&modes));
  for (int i = 0; i < 2; i++) {
    PetscCall(PetscMalloc1(block->n[i], &block->omega[i]));
    for (PetscInt k = 0; k < block->n[i]; k++) block->omega[i][k] = run->guarded.high;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PairsTake(GreedyWork *run, const PetscReal p[])
{
  Basis          *basis = run->basis;
  CorrectionBlock block = {0};
  PairGroup      *group;
  PetscInt        n, n_added;
  BV              Z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(basis->reduced.n_terms, &group));
  GroupsFind(&basis->reduced, &n, group);
  if (n) {
    PetscCall(EventBegin(EVENT_CORRECT));
    PetscCall(FactorMake(run, p));
    PetscCall(RowsCollect(basis, n, group, &block));
    PetscCall(CorrectionSolve(run->correction, basis, &block, &Z));
    PetscCall(GroupsScale(run, p, n, group, &block, Z));
    PetscCall(CorrectionAppend(run->correction, run->drop, basis, &block, Z, &n_added));
    PetscCall(BVDestroy(&Z));
    PetscCall(BasisUse(basis, basis->reduced.n));
    PetscCall(EventEnd(EVENT_CORRECT));
  }
  PetscCall(PetscFree(group));
  PetscFunctionReturn(0);
}
