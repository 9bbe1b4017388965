/*
   Where on a part a mass, a spring or a dashpot lowers the growth of a mode most, and along which direction.

   At a node the rate of growth along the unit vector d is d'S d, S = Re(factor (y x' + x y') / 2): the least is the
   lowest eigenvalue of S, its vector the direction. It is m - 2 p at least, with m the mean of the three eigenvalues,
   3 m = tr S, and 6 p^2 = |S - m I|^2, and |S| <= |factor| |x| |y|, so that most nodes need no eigenvalues.
   Of nodes that are alike within rounding, as in a scene with symmetry, the first in the order of places is named, so
   that the answer is the same on any number of ranks.

   Between nodes i and j the motions x_i - x_j and y_i - y_j stand in their place. All pairs of nodes are too many: one
   end is held and the other looked for, in turns. What is found no move of one end improves; another pair may be better
   still.
*/
#include "effects.h"
#include "base/algebra/dense.h"
#include "base/algebra/vec3.h"

#define DIRECTION_ZERO 1e-12 /* components of a direction below it are rounding */
#define PAIR_TURNS     8     /* of the ends; two or three are the rule */

/* What no eigenvalue of a symmetric S [3][3] is below, but for rounding */
static PetscReal LowestBound(const PetscReal S[9])
{
  const PetscReal mean   = (S[0] + S[4] + S[8]) / 3;
  PetscReal       square = 0;

  for (int i = 0; i < 9; i++) square += PetscSqr(S[i] - (i % 4 ? 0 : mean));
  return mean - 2 * PetscSqrtReal(square / 6);
}

/* Lowest rate of growth at a node, and where along; 0 where it cannot be below `least` */
static PetscErrorCode NodeLowest(const ModeEffects *e, EffectKind kind, PetscInt node, PetscReal least,
                                 EffectBest *here)
{
  PetscComplex form[3][3];
  PetscReal    S[9], w[3];
  PetscBool    definite;

  PetscFunctionBeginUser;
  *here = (EffectBest){.at = {e->mesh->x[3 * node], e->mesh->x[3 * node + 1], e->mesh->x[3 * node + 2]}};
  for (int a = 0; a < 3; a++) {
    here->vector[0][a] = e->xr[3 * node + a], here->vector[1][a] = e->xi[3 * node + a];
    here->vector[2][a] = e->yr[3 * node + a], here->vector[3][a] = e->yi[3 * node + a];
  }
  EffectAtNode(e, kind, node, form);
  if (kind == EFFECT_MASS) {
    here->rate = form[0][0] + form[1][1] + form[2][2];
    PetscFunctionReturn(0);
  }
  for (int i = 0; i < 9; i++) S[i] = creal(form[i / 3][i % 3]);
  if (LowestBound(S) > least * (1 - 2 * e->rounding)) PetscFunctionReturn(0);
  PetscCall(DenseSymmetricEigen(3, S, NULL, w, &definite));
  for (int a = 0; a < 3; a++) here->direction[a] = PetscAbsReal(S[a]) < DIRECTION_ZERO ? 0 : S[a];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) here->rate += here->direction[a] * form[a][b] * here->direction[b];
  PetscFunctionReturn(0);
}

/* The largest that any change of a kind may do at a node */
static PetscReal NodeBound(const ModeEffects *e, EffectKind kind, PetscInt node)
{
  PetscReal xx = 0, yy = 0;

  for (int a = 0; a < 3; a++) {
    const PetscInt i = 3 * node + a;

    xx += PetscSqr(e->xr[i] - e->end[0][a]) + PetscSqr(e->xi[i] - e->end[1][a]);
    yy += PetscSqr(e->yr[i] - e->end[2][a]) + PetscSqr(e->yi[i] - e->end[3][a]);
  }
  return e->strength[kind] * PetscSqrtReal(xx * yy);
}

/* Takes the change at a node where it is better than the best so far, or as good and earlier in place */
static PetscErrorCode BestTry(const ModeEffects *e, EffectKind kind, PetscInt node, EffectBest *best)
{
  const PetscReal least = best->found ? creal(best->rate) : 0;
  EffectBest      here;

  PetscFunctionBeginUser;
  if (NodeBound(e, kind, node) < -least * (1 - e->rounding)) PetscFunctionReturn(0);
  PetscCall(NodeLowest(e, kind, node, least, &here));
  if (!(creal(here.rate) < 0) || creal(here.rate) > least * (1 - e->rounding)) PetscFunctionReturn(0);
  here.found = PETSC_TRUE;
  if (creal(here.rate) < least * (1 + e->rounding) || Vec3ComparePlaces(here.at, best->at) < 0) *best = here;
  PetscFunctionReturn(0);
}

/* The better of two, by the same rule */
static EffectBest BestOf(const EffectBest *a, const EffectBest *b, PetscReal rounding)
{
  if (!a->found || !b->found) return a->found ? *a : *b;
  if (creal(b->rate) < creal(a->rate) * (1 + rounding)) return *b;
  if (creal(a->rate) < creal(b->rate) * (1 + rounding)) return *a;
  return Vec3ComparePlaces(b->at, a->at) < 0 ? *b : *a;
}

/* A direction and its opposite are one: its largest component is positive */
static void BestTurn(EffectBest *best)
{
  int largest = 0;

  for (int a = 1; a < 3; a++)
    if (PetscAbsReal(best->direction[a]) > (1 + 1e-6) * PetscAbsReal(best->direction[largest])) largest = a;
  if (best->direction[largest] >= 0) return;
  for (int a = 0; a < 3; a++) best->direction[a] = best->direction[a] == 0 ? 0 : -best->direction[a];
}

/* The same of this rank's nodes of each part, or of that or those asked for */
static PetscErrorCode BestOfParts(const ModeEffects *e, EffectKind kind, const EffectParts *of, EffectBest best[])
{
  const PetscInt n_parts = e->mesh->n_parts;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(best, (size_t)n_parts * sizeof(*best)));
  for (PetscInt part = 0; part < n_parts; part++) {
    if (of && (part == of->part) != of->within) continue;
    for (PetscInt k = e->first[part]; k < e->first[part + 1]; k++) PetscCall(BestTry(e, kind, e->node[k], &best[part]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode EffectsListNodes(const Mesh *mesh, PetscInt **first, PetscInt **nodes)
{
  PetscInt *seen, n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &seen));
  PetscCall(PetscMalloc1(mesh->n_parts + 1, first));
  PetscCall(PetscMalloc1(mesh->cell_first[mesh->n_cells], nodes));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) seen[i] = -1;
  for (PetscInt part = 0; part < mesh->n_parts; part++) {
    (*first)[part] = n;
    for (PetscInt c = 0; c < mesh->n_cells; c++)
      for (PetscInt k = mesh->cell_first[c]; mesh->cell_part[c] == part && k < mesh->cell_first[c + 1]; k++) {
        if (seen[mesh->cell_node[k]] == part) continue;
        seen[mesh->cell_node[k]] = part;
        (*nodes)[n++]            = mesh->cell_node[k];
      }
  }
  (*first)[mesh->n_parts] = n;
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(0);
}

PetscErrorCode EffectsFindBest(MPI_Comm comm, const ModeEffects *e, EffectKind kind, const EffectParts *of,
                               EffectBest best[])
{
  const PetscInt n_parts = e->mesh->n_parts;
  PetscMPIInt    size, bytes = (PetscMPIInt)((size_t)n_parts * sizeof(EffectBest));
  EffectBest    *all;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1((PetscInt)size * n_parts, &all));
  PetscCall(BestOfParts(e, kind, of, best));
  PetscCallMPI(MPI_Allgather(best, bytes, MPI_BYTE, all, bytes, MPI_BYTE, comm));
  for (PetscInt k = 0; k < n_parts; k++) {
    best[k] = all[k];
    for (PetscMPIInt r = 1; r < size; r++) best[k] = BestOf(&best[k], &all[r * n_parts + k], e->rounding);
    BestTurn(&best[k]);
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* The part with the best node; -1 where none lowers the growth */
static PetscInt PairChoose(const EffectBest best[], PetscInt n_parts, PetscReal rounding)
{
  PetscInt chosen = -1;

  for (PetscInt k = 0; k < n_parts; k++) {
    if (!best[k].found) continue;
    if (chosen < 0 || creal(best[k].rate) < creal(best[chosen].rate) * (1 + rounding)) chosen = k;
  }
  return chosen;
}

PetscErrorCode EffectsFindPair(MPI_Comm comm, ModeEffects *e, EffectKind kind, PetscInt part, PetscBool within,
                               EffectPair *pair)
{
  const PetscInt n_parts = e->mesh->n_parts;
  EffectBest    *best;

  PetscFunctionBeginUser;
  *pair = (EffectPair){.part = {part, -1}};
  PetscCall(PetscMalloc1(n_parts, &best));
  PetscCall(EffectsFindBest(comm, e, kind, &(EffectParts){part, PETSC_TRUE}, best));
  pair->end[0] = best[part];
  for (int turn = 0; turn < PAIR_TURNS && pair->end[0].found; turn++) {
    const int         moves = turn % 2 ? 0 : 1; /* this end, the other one is held */
    const EffectParts of    = {part, moves == 0 || within ? PETSC_TRUE : PETSC_FALSE};
    PetscInt          k;

    PetscCall(PetscMemcpy(e->end, pair->end[1 - moves].vector, sizeof(e->end)));
    PetscCall(EffectsFindBest(comm, e, kind, &of, best));
    k = PairChoose(best, n_parts, e->rounding);
    if (k < 0) break;
    if (turn > 0 && Vec3ComparePlaces(best[k].at, pair->end[moves].at) == 0 && k == pair->part[moves]) break;
    pair->end[moves]  = best[k];
    pair->part[moves] = k;
    if (moves == 0) {
      pair->end[1].rate = best[k].rate;
      PetscCall(PetscArraycpy(pair->end[1].direction, best[k].direction, 3));
    }
  }
  PetscCall(PetscArrayzero(&e->end[0][0], 12));
  PetscCall(PetscFree(best));
  PetscFunctionReturn(0);
}
