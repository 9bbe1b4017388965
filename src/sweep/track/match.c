/*
   Match of the modes of two points by biorthogonal products. With C_ij the coefficient of mode j of b in the expansion
   by the modes of a, and C'_ji that of mode i of a in the expansion by the modes of b (each with D of its own point), C
   C' = I for complete sets, so that the numbers C_ij C'_ji of a mode add up to one, whatever the scale of the vectors:

      strength(P, Q) = sum_{i in P, j in Q} C_ij C'_ji = trace of the product of the spectral projectors of P and Q

   for clusters P of a and Q of b, over the size of the smaller one. It is 1 when the smaller plane lies in the larger
   one and 0 when they have nothing in common; single modes near lock-in exceed 1.

   Clusters are connected when their strength is neither small (0.3) nor small beside that of a competitor (0.4). A
   component is certain when it is one cluster on one side at least, the numbers of modes agree, and nothing is lost
   (0.7): a mode that stays itself, a doublet that stays a doublet, two modes that lock in or a pair that locks out,
   modes that meet at the point. A mode without partner is certain when it left the window: its Rayleigh quotient y^T A
   x / y^T B x in the pencil of the other point is outside, or nearer to an end than it moved.
   Within a component modes are assigned greedily, the largest score first.
*/
#include "match.h"

#define SMALL   0.3
#define BESIDE  0.4
#define LOST    0.7
#define PLACE   0.1   /* score for keeping the place in the order of frequency */
#define LEAST   0.1   /* score below which modes of an uncertain component are not matched */
#define ROUNDED 1e-12 /* of an eigenvalue */

/* strength [na][nb] of all modes, by clusters: |tr(P Q)| over the smaller number of modes; alike for all modes of a
   cluster. na nb products of length N. */
static PetscErrorCode StrengthFind(const ModeFrame *a, const ModeFrame *b, Match *match)
{
  const PetscInt na = match->na, nb = match->nb;
  PetscInt      *size;
  PetscComplex  *sum, *there, *back;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(na * nb, &sum, nb, &size));
  PetscCall(PetscMalloc2(na * nb, &there, na * nb, &back));
  PetscCall(DenseComplexProducts(a->N, na, a->W, nb, b->X, there)); /* [nb][na] w_i^T x_j */
  PetscCall(DenseComplexProducts(a->N, nb, b->W, na, a->X, back));  /* [na][nb] w_j^T x_i */
  for (PetscInt j = 0; j < nb; j++) size[j] = ModeFrameClusterSize(b, j);
  for (PetscInt i = 0; i < na; i++)
    for (PetscInt j = 0; j < nb; j++)
      sum[a->cluster[i] * nb + b->cluster[j]] += there[j * na + i] * back[i * nb + j];
  for (PetscInt i = 0; i < na; i++) {
    const PetscInt own = ModeFrameClusterSize(a, i);

    for (PetscInt j = 0; j < nb; j++)
      match->strength[i * nb + j] = cabs(sum[a->cluster[i] * nb + b->cluster[j]]) / PetscMin(own, size[j]);
  }
  PetscCall(PetscFree2(there, back));
  PetscCall(PetscFree2(sum, size));
  PetscFunctionReturn(0);
}

/* Whether the modes i of a and j of b belong together: strength of at least SMALL, and BESIDE that of the best
   competitor of either. */
static PetscBool MatchConnects(const Match *match, PetscInt i, PetscInt j)
{
  const PetscReal s    = match->strength[i * match->nb + j];
  PetscReal       best = 0;

  for (PetscInt k = 0; k < match->nb; k++) best = PetscMax(best, match->strength[i * match->nb + k]);
  for (PetscInt k = 0; k < match->na; k++) best = PetscMax(best, match->strength[k * match->nb + j]);
  return s >= SMALL && s >= BESIDE * best ? PETSC_TRUE : PETSC_FALSE;
}

/* Connected components of the graph of clusters, numbered from 0: a label for each of na + nb modes, joined along
   each connection; numbers in the order of first members. */
static PetscErrorCode ComponentsFind(const ModeFrame *a, const ModeFrame *b, Match *match)
{
  const PetscInt na = match->na, nb = match->nb;
  PetscInt      *label, *number;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(na + nb, &label, na + nb, &number));
  for (PetscInt u = 0; u < na + nb; u++) label[u] = u < na ? a->cluster[u] : na + b->cluster[u - na];
  for (PetscInt i = 0; i < na; i++)
    for (PetscInt j = 0; j < nb; j++)
      if (label[i] != label[na + j] && MatchConnects(match, i, j)) ReducedClusterJoin(na + nb, i, na + j, label);
  match->n_components = 0;
  for (PetscInt u = 0; u < na + nb; u++) number[u] = label[u] == u ? match->n_components++ : number[label[u]];
  PetscCall(PetscArraycpy(match->component_a, number, na));
  PetscCall(PetscArraycpy(match->component_b, number + na, nb));
  PetscCall(PetscFree2(label, number));
  PetscFunctionReturn(0);
}

/* Whether mode i of a, of which b has no partner, is outside the window there: first-order eigenvalue from the mean of
   its cluster, diagonals of H and G [na * na] of StandardProject() by the other point */
static PetscBool ModeHasLeft(const ModeFrame *a, PetscInt i, const ReducedWindow *window, const PetscComplex H[],
                             const PetscComplex G[])
{
  const PetscInt n    = a->modes.n;
  PetscComplex   move = 0, lambda = a->modes.lambda[i];
  PetscReal      inside, size     = 0;

  for (PetscInt k = 0; k < n; k++) {
    if (a->cluster[k] != a->cluster[i]) continue;
    move += H[k * n + k] / G[k * n + k] - StandardValue(&a->form, a->modes.lambda[k]);
    size += 1;
  }
  if (a->modes.rigid[i] && a->form.damped) move = 0;
  lambda = StandardLambda(&a->form, StandardValue(&a->form, lambda) + move / size);
  inside = PetscMin(cimag(lambda) - window->low, window->high - cimag(lambda));
  if (window->low <= 0) inside = window->high - cimag(lambda);
  inside = PetscMin(inside, window->growth - PetscAbsReal(creal(lambda)));
  return inside <= cabs(lambda - a->modes.lambda[i]) ? PETSC_TRUE : PETSC_FALSE;
}

/* Modes of a without partner in b: certain when they have left the window. Without a window, as between lines,
   nothing is asked of them. */
static PetscErrorCode LonelyCheck(const ModeFrame *a, const ModeFrame *b, const ReducedWindow *window,
                                  const PetscInt component[], const PetscInt partners[], PetscBool certain[])
{
  const PetscInt n    = a->modes.n;
  PetscBool      need = PETSC_FALSE;
  PetscComplex  *H, *G;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++)
    if (!partners[component[i]]) need = PETSC_TRUE;
  if (!need) PetscFunctionReturn(0);
  if (!window) {
    for (PetscInt i = 0; i < n; i++)
      if (!partners[component[i]]) certain[component[i]] = PETSC_TRUE;
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc2(n * n, &H, n * n, &G));
  PetscCall(StandardProject(&b->form, n, a->X, a->Y, H, G));
  for (PetscInt i = 0; i < n; i++)
    if (!partners[component[i]]) certain[component[i]] = ModeHasLeft(a, i, window, H, G);
  PetscCall(PetscFree2(H, G));
  PetscFunctionReturn(0);
}

/* sum = strengths of the component, each cluster pair once: with nothing lost it is the number of pieces on the
   side that has more. */
static PetscErrorCode ComponentsJudge(const ModeFrame *a, const ModeFrame *b, const ReducedWindow *window, Match *match)
{
  const PetscInt na = match->na, nb = match->nb, n = match->n_components;
  PetscInt      *modes_a, *modes_b, *clusters_a = match->clusters_a, *clusters_b = match->clusters_b;
  PetscReal     *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(n, &modes_a, n, &modes_b, n, &sum));
  for (PetscInt i = 0; i < na; i++) {
    modes_a[match->component_a[i]]++;
    clusters_a[match->component_a[i]] += a->cluster[i] == i;
    for (PetscInt j = 0; j < nb; j++)
      if (a->cluster[i] == i && b->cluster[j] == j && match->component_a[i] == match->component_b[j])
        sum[match->component_a[i]] += match->strength[i * nb + j];
  }
  for (PetscInt j = 0; j < nb; j++) {
    modes_b[match->component_b[j]]++;
    clusters_b[match->component_b[j]] += b->cluster[j] == j;
  }
  for (PetscInt c = 0; c < n; c++) {
    const PetscInt pieces = PetscMax(clusters_a[c], clusters_b[c]);

    match->certain[c] = PETSC_FALSE;
    if (modes_a[c] == modes_b[c] && PetscMin(clusters_a[c], clusters_b[c]) == 1 && sum[c] >= LOST * pieces)
      match->certain[c] = PETSC_TRUE;
  }
  PetscCall(LonelyCheck(a, b, window, match->component_a, modes_b, match->certain));
  PetscCall(LonelyCheck(b, a, window, match->component_b, modes_a, match->certain));
  match->all_certain = PETSC_TRUE;
  for (PetscInt c = 0; c < n; c++) match->all_certain = (PetscBool)(match->all_certain && match->certain[c]);
  PetscCall(PetscFree3(modes_a, modes_b, sum));
  PetscFunctionReturn(0);
}

PetscErrorCode MatchCreate(const ModeFrame *a, const ModeFrame *b, const ReducedWindow *window, Match *match)
{
  PetscInt n;

  PetscFunctionBeginUser;
  match->na    = a->modes.n;
  match->nb    = b->modes.n;
  match->least = 0;
  n            = match->na + match->nb;
  PetscCall(PetscCalloc7(match->na * match->nb, &match->strength, match->na, &match->component_a, match->nb,
                         &match->component_b, n, &match->clusters_a, n, &match->clusters_b, n, &match->certain,
                         match->nb, &match->from));
  PetscCall(StrengthFind(a, b, match));
  PetscCall(ComponentsFind(a, b, match));
  PetscCall(ComponentsJudge(a, b, window, match));
  PetscFunctionReturn(0);
}

/* Place of mode i in its component by ascending order[]; among equals the less stable is first, and of modes that
   rounding or their errors alone part, the earlier one */
static PetscInt ComponentPlace(const ReducedModes *modes, const PetscInt component[], const PetscReal order[],
                               PetscInt i)
{
  PetscInt place = 0;

  for (PetscInt k = 0; k < modes->n; k++) {
    const PetscReal close = 1e-6 * PetscAbsReal(order[i]), growth = creal(modes->lambda[k]) - creal(modes->lambda[i]);
    const PetscReal noise = ROUNDED * cabs(modes->lambda[i]) + modes->error[i] + modes->error[k];

    if (k == i || component[k] != component[i]) continue;
    if (PetscAbsReal(order[k] - order[i]) > close)
      place += order[k] < order[i];
    else
      place += PetscAbsReal(growth) > noise ? growth > 0 : k < i;
  }
  return place;
}

/* An assignment while it is made */
typedef struct {
  const Match     *match;
  const PetscReal *score; /* [na * nb] */
  PetscInt        *place_a, *place_b;
  PetscBool       *taken; /* [na] */
} Assignment;

/* Whether of all modes i and j alone reach the least strength with each other: in a damped pair two may */
static PetscBool MatchIsUnique(const Match *match, PetscInt i, PetscInt j)
{
  PetscInt n = 0;

  if (match->least <= 0) return PETSC_TRUE;
  for (PetscInt k = 0; k < match->nb; k++) n += match->strength[i * match->nb + k] >= match->least;
  for (PetscInt k = 0; k < match->na; k++) n += match->strength[k * match->nb + j] >= match->least;
  return match->strength[i * match->nb + j] >= match->least && n == 2 ? PETSC_TRUE : PETSC_FALSE;
}

/* The next pair to assign, the one of the largest score, with PLACE more for keeping its place; false when there is
   none left. Ties go to the lower indices, so that all ranks that hold the same numbers decide alike. */
static PetscBool BestPair(const Assignment *s, PetscInt *best_i, PetscInt *best_j)
{
  const Match *match = s->match;
  PetscReal    best  = PETSC_MIN_REAL;

  for (PetscInt i = 0; i < match->na; i++) {
    for (PetscInt j = 0; j < match->nb && !s->taken[i]; j++) {
      const PetscReal score   = s->score[i * match->nb + j] + (s->place_a[i] == s->place_b[j] ? PLACE : 0);
      const PetscBool certain = match->certain[match->component_a[i]];

      if (match->from[j] >= 0 || match->component_a[i] != match->component_b[j] || score <= best) continue;
      if (!certain && (score - PLACE < LEAST || !MatchIsUnique(match, i, j))) continue;
      best = score, *best_i = i, *best_j = j;
    }
  }
  return best > PETSC_MIN_REAL ? PETSC_TRUE : PETSC_FALSE;
}

/* from [nb] = mode of a, or -1. order [na], rad/s: what places in a are counted by, NULL: omega. na nb comparisons
   a pair, of small numbers. */
PetscErrorCode MatchAssign(const ModeFrame *a, const ModeFrame *b, const PetscReal score[], const PetscReal order[],
                           Match *match)
{
  Assignment s = {.match = match, .score = score};
  PetscInt   i, j;
  PetscReal *omega;

  PetscFunctionBeginUser;
  PetscCall(
    PetscCalloc4(match->na, &s.place_a, match->nb, &s.place_b, match->na + match->nb, &omega, match->na, &s.taken));
  for (i = 0; i < match->na; i++) omega[i] = cimag(a->modes.lambda[i]);
  for (i = 0; i < match->na; i++)
    s.place_a[i] = ComponentPlace(&a->modes, match->component_a, order ? order : omega, i);
  for (j = 0; j < match->nb; j++) omega[j] = cimag(b->modes.lambda[j]), match->from[j] = -1;
  for (j = 0; j < match->nb; j++) s.place_b[j] = ComponentPlace(&b->modes, match->component_b, omega, j);
  while (BestPair(&s, &i, &j)) {
    match->from[j] = i;
    s.taken[i]     = PETSC_TRUE;
  }
  PetscCall(PetscFree4(s.place_a, s.place_b, omega, s.taken));
  PetscFunctionReturn(0);
}

PetscErrorCode MatchDestroy(Match *match)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree7(match->strength, match->component_a, match->component_b, match->clusters_a, match->clusters_b,
                       match->certain, match->from));
  PetscFunctionReturn(0);
}
