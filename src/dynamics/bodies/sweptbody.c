/*
   Advance of a swept body, a block of nodes of a line at a time and without further passes over memory:
      g = K v;  strain += u.ku / 2;  kinetic += v.M v / 2;  damping_old += v.d;
      ku += dt g;  d = beta g + alpha M v;  damping += v.d;  f = -ku - d
   On lines between parts of different beta the first term of d is a stencil of its own.
*/
#include "base/algebra/versions.h"
#include "bodiesimpl.h"

typedef struct {
  StencilVector kinetic, strain, damping_old, damping;
} SweptSums;

/* A range of all lines; `ends` is known where it is made, so that blocks without ends have no code for them */
typedef struct {
  const SweptBody  *s;
  const SweptRange *range;
  PetscBool         ends;
  const BodiesWork *w;
} SweptPass;

/* A block of nodes of a line: g = K v and h = C v without the part of the mass, in three rows */
typedef struct {
  PetscReal     alpha;
  StencilVector mass, g[3], h[3];
} SweptBlock;

/* Stores eight numbers, or four; the compiler drops what leads to numbers that are not stored */
STENCIL_INLINE void SweptStoreRow(int n, StencilVector y, PetscReal x[])
{
  if (n == STENCIL_WIDTH)
    StencilStore(y, x);
  else
    *(StencilLanes *)x = y.a;
}

/* Row i of eight (or four) nodes, from `at` on: one load of u, v and ku (and d), one store of ku and f (and d).
   Sums hold the products of the step before too: strain needs K u before this step, damping_old d of the last one. */
STENCIL_INLINE void SweptAdvanceRow(int n, const BodiesWork *w, PetscInt at, const SweptBlock *block, int i,
                                    SweptSums *sums)
{
  const StencilVector v  = StencilLoad(w->v + at);
  StencilVector       ku = StencilLoad(w->ku + at), f, h, momentum = StencilTimes(block->mass, v);

  StencilAddProduct(StencilLoad(w->u + at), ku, &sums->strain);
  StencilAddProduct(momentum, v, &sums->kinetic);
  StencilAdd(w->dt, block->g[i], &ku);
  SweptStoreRow(n, ku, w->ku + at);
  f = (StencilVector){-ku.a, -ku.b};
  if (w->d) {
    h = block->h[i];
    StencilAddProduct(v, StencilLoad(w->d + at), &sums->damping_old);
    StencilAdd(block->alpha, momentum, &h);
    StencilAddProduct(v, h, &sums->damping);
    SweptStoreRow(n, h, w->d + at);
    f = StencilMinus(f, h);
  }
  SweptStoreRow(n, f, w->f + at);
}

/* Takes `missing` off at the node where `at` is 1 */
STENCIL_INLINE void SweptTakeMissing(const double missing[3], const double at[], StencilVector g[3])
{
  for (int i = 0; i < 3; i++) StencilAdd(-missing[i], StencilLoad(at), &g[i]);
}

/* g = K v, or likewise with other coefficients, at nodes k .. k + 7 of a line, zero in the padding. The stencil is
   that of an inner node: at the ends of an open line the cells that are not there (`missing`) are taken off again. */
STENCIL_INLINE void SweptApply(const SweptPass *pass, const StencilLine *line, const ptrdiff_t row[3], PetscInt k,
                               StencilVector g[3])
{
  const SweptBody *s = pass->s;
  const PetscReal *v = pass->w->v + s->begin;
  double           missing[3];

  StencilApply(line, k, row, v, g);
  if (pass->ends && pass->range->first) {
    StencilMissing(line, 0, 1, row, v, missing);
    SweptTakeMissing(missing, &s->first[k], g);
  }
  if (pass->ends && pass->range->last) {
    StencilMissing(line, s->lines->n_nodes - 1, -1, row, v, missing);
    SweptTakeMissing(missing, &s->last[k], g);
  }
  for (int i = 0; i < 3; i++) g[i] = StencilTimes(g[i], StencilLoad(s->inside + k));
}

/* Nodes k .. k + n - 1 of line l */
STENCIL_INLINE void SweptAdvanceBlock(int n, const SweptPass *pass, PetscInt l, PetscInt k, SweptSums *sums)
{
  const SweptBody *s  = pass->s;
  const PetscInt   at = s->begin + 3 * l * s->stride + k, p = (s->along + 1) % 3, q = (s->along + 2) % 3;
  const ptrdiff_t  row[3] = {p * s->stride, q * s->stride, s->along * s->stride};
  const PetscBool  own    = pass->w->d && s->damping[l].n ? PETSC_TRUE : PETSC_FALSE;
  SweptBlock       block  = {.alpha = s->alpha[l], .mass = StencilLoad(s->mass + l * s->stride + k)};

  SweptApply(pass, &s->stiffness[l], row, k, block.g);
  if (own)
    SweptApply(pass, &s->damping[l], row, k, block.h);
  else
    for (int i = 0; i < 3; i++) block.h[i] = (StencilVector){s->beta[l] * block.g[i].a, s->beta[l] * block.g[i].b};
  for (int i = 0; i < 3; i++) SweptAdvanceRow(n, pass->w, at + (PetscInt)row[i], &block, i, sums);
}

/* Adds the energies of a line; of its last four nodes the first half of the vectors */
STENCIL_INLINE void SweptAddSums(const SweptSums *line, const SweptSums *tail, BodiesSums *sums)
{
  sums->kinetic += 0.5 * (StencilSum(line->kinetic) + StencilSumLanes(&tail->kinetic.a));
  sums->strain += 0.5 * (StencilSum(line->strain) + StencilSumLanes(&tail->strain.a));
  sums->damping_old += StencilSum(line->damping_old) + StencilSumLanes(&tail->damping_old.a);
  sums->damping += StencilSum(line->damping) + StencilSumLanes(&tail->damping.a);
}

STENCIL_INLINE void SweptAdvanceLines(const SweptBody *s, const SweptRange *range, PetscBool ends, BodiesWork *w)
{
  const PetscInt  half = (range->end - range->begin) % STENCIL_WIDTH, end = range->end - half;
  const SweptPass pass = {.s = s, .range = range, .ends = ends, .w = w};

  for (PetscInt l = 0; l < s->lines->n_lines; l++) {
    SweptSums sums = {0}, tail = {0};

    for (PetscInt k = range->begin; k < end; k += STENCIL_WIDTH) SweptAdvanceBlock(STENCIL_WIDTH, &pass, l, k, &sums);
    if (half) SweptAdvanceBlock(STENCIL_WIDTH / 2, &pass, l, end, &tail);
    SweptAddSums(&sums, &tail, &w->sums);
  }
}

VERSIONS
static void SweptAdvanceRange(const SweptBody *s, const SweptRange *range, BodiesWork *w)
{
  if (range->first || range->last)
    SweptAdvanceLines(s, range, PETSC_TRUE, w);
  else
    SweptAdvanceLines(s, range, PETSC_FALSE, w);
}

static PetscErrorCode SweptAdvanceCounted(const SweptBody *s, const SweptRange *range, BodiesWork *w)
{
  PetscFunctionBeginUser;
  SweptAdvanceRange(s, range, w);
  PetscCall(PetscLogFlops((PetscLogDouble)(range->end - range->begin) *
                          (STENCIL_FLOPS * (PetscLogDouble)s->n_near + NODE_FLOPS * s->lines->n_lines)));
  PetscFunctionReturn(0);
}

/* Ghosts of a closed body: the last node before the first one and the reverse; or zeros, as padding has to be
   between calls */
static void SweptSetGhosts(const SweptBody *s, PetscBool zero, PetscReal v[])
{
  const PetscInt n = s->lines->n_nodes;

  for (PetscInt i = 0; i < 3 * s->lines->n_lines && s->lines->closed; i++) {
    PetscReal *row = v + s->begin + i * s->stride;

    row[-1] = zero ? 0 : row[n - 1];
    row[n]  = zero ? 0 : row[0];
  }
}

/* Ghosts of closed bodies are set before the first range and cleared after the last: others take padding for zeros. */
PetscErrorCode SweptAdvance(const SweptBody *s, PetscBool early, BodiesWork *w)
{
  PetscFunctionBeginUser;
  if (early) SweptSetGhosts(s, PETSC_FALSE, w->v);
  for (PetscInt i = 0; i < s->n_ranges; i++)
    if (s->range[i].early == early) PetscCall(SweptAdvanceCounted(s, &s->range[i], w));
  if (!early) SweptSetGhosts(s, PETSC_TRUE, w->v);
  PetscFunctionReturn(0);
}

/* Flags along the lines as numbers */
static PetscErrorCode SweptSetFlags(SweptBody *s)
{
  const PetscInt n = s->lines->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(s->stride, &s->inside, s->stride, &s->first, s->stride, &s->last));
  for (PetscInt k = 0; k < n; k++) s->inside[k] = 1;
  s->first[0]    = 1;
  s->last[n - 1] = 1;
  PetscFunctionReturn(0);
}

/* Whether the lines have shared nodes at nodes begin .. end - 1 */
static PetscBool SweptIsShared(const ModelLines *lines, PetscInt begin, PetscInt end, const PetscBool shared[])
{
  for (PetscInt l = 0; l < lines->n_lines; l++)
    for (PetscInt k = begin; k < PetscMin(end, lines->n_nodes); k++)
      if (shared[lines->vertex[lines->n_nodes * l + k]]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Ranges of blocks of STENCIL_WIDTH nodes, merged where alike: with shared nodes (early) or without, with the first
   or last node of open lines. The last block may be half a width, so that its padding is no longer than needed. */
PetscErrorCode SweptSetRanges(SweptBody *s, const PetscBool shared[])
{
  const PetscInt  n = s->lines->n_nodes, n_blocks = (n + STENCIL_WIDTH - 1) / STENCIL_WIDTH;
  const PetscBool open = s->lines->closed ? PETSC_FALSE : PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(SweptSetFlags(s));
  for (PetscInt l = 0; l < s->lines->n_lines; l++) s->n_near += s->stiffness[l].n + s->damping[l].n;
  PetscCall(PetscMalloc1(n_blocks, &s->range));
  for (PetscInt k = 0; k < n; k += STENCIL_WIDTH) {
    SweptRange *last  = s->n_ranges ? &s->range[s->n_ranges - 1] : NULL;
    SweptRange  range = {.begin = k, .end = k + (n - k <= STENCIL_WIDTH / 2 ? STENCIL_WIDTH / 2 : STENCIL_WIDTH)};

    range.early = SweptIsShared(s->lines, k, range.end, shared);
    range.first = open && k == 0 ? PETSC_TRUE : PETSC_FALSE;
    range.last  = open && range.end >= n ? PETSC_TRUE : PETSC_FALSE;
    if (last && last->early == range.early && last->first == range.first && last->last == range.last)
      last->end = range.end;
    else
      s->range[s->n_ranges++] = range;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SweptDestroy(SweptBody *s)
{
  PetscFunctionBeginUser;
  PetscCall(ModelDestroyLines(&s->lines));
  PetscCall(PetscFree2(s->stiffness, s->damping));
  PetscCall(PetscFree3(s->at, s->coefficient, s->before));
  PetscCall(PetscFree3(s->beta, s->alpha, s->mass));
  PetscCall(PetscFree3(s->inside, s->first, s->last));
  PetscCall(PetscFree(s->range));
  PetscFunctionReturn(0);
}
