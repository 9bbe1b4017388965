/*
   Sequences of points in the unit cube.

      sobol   digits x_i = xor of v_k over the bits k of i ^ (i >> 1), v_k the direction numbers, scrambled as
              A. B. Owen has it (Monte Carlo and Quasi-Monte Carlo Methods in Scientific Computing, 1995): each
              binary digit is turned or not by a number that depends on all digits before it. Every elementary
              interval keeps its number of points, and each point by itself is uniform.
      latin   u = (stratum_i + r) / n, the strata a random permutation for each dimension
      random  u = r

   r and the choices of the scrambling are hashes of seed, dimension and place (splitmix64, G. L. Steele et al., OOPSLA
   2014), so that a point needs none of those before it.
*/
#include "sequence.h"

#define DIGITS 32

/* A number without structure of three others */
static uint64_t Hash(uint64_t seed, uint64_t stream, uint64_t place)
{
  uint64_t z = seed * 0x9e3779b97f4a7c15ULL + stream * 0xd1342543de82ef95ULL + place;

  for (int round = 0; round < 2; round++) {
    z += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
  }
  return z;
}

/* Uniform in (0, 1), never an end */
static PetscReal HashUniform(uint64_t seed, uint64_t stream, uint64_t place)
{
  return ((PetscReal)(Hash(seed, stream, place) >> 12) + 0.5) / (PetscReal)(1ULL << 52);
}

/* v_k, k = 0 .. 31, of a dimension: m_k = 2 a_1 m_(k-1) ^ ... ^ 2^s m_(k-s) ^ m_(k-s), v_k = m_k 2^(31-k) */
static void SobolDirections(PetscInt dimension, uint32_t v[DIGITS])
{
  if (dimension == 0) {
    for (int k = 0; k < DIGITS; k++) v[k] = 1U << (DIGITS - 1 - k);
    return;
  }
  const unsigned s = sobol_directions[dimension - 1].s, a = sobol_directions[dimension - 1].a;

  for (unsigned k = 0; k < DIGITS; k++) {
    if (k < s) {
      v[k] = (uint32_t)sobol_directions[dimension - 1].m[k] << (DIGITS - 1 - k);
      continue;
    }
    v[k] = v[k - s] ^ (v[k - s] >> s);
    for (unsigned i = 1; i < s; i++)
      if (a >> (s - 1 - i) & 1) v[k] ^= v[k - i];
  }
}

uint32_t SobolDigits(PetscInt i, PetscInt dimension)
{
  const uint32_t gray = (uint32_t)i ^ (uint32_t)i >> 1;
  uint32_t       v[DIGITS], x = 0;

  SobolDirections(dimension, v);
  for (int k = 0; k < DIGITS; k++)
    if (gray >> k & 1) x ^= v[k];
  return x;
}

/* Digit k from the top is turned by a number of the k digits above it, as they were */
static uint32_t OwenScramble(uint32_t x, uint64_t seed, PetscInt dimension)
{
  uint32_t turned = 0;

  for (int k = 0; k < DIGITS; k++) {
    const uint64_t above = k ? x >> (DIGITS - k) : 0, place = 1ULL << k | above;

    turned |= (uint32_t)(Hash(seed, (uint64_t)dimension, place) >> 63) << (DIGITS - 1 - k);
  }
  return x ^ turned;
}

/* A permutation for each dimension (R. Durstenfeld, CACM 7, 1964) */
PetscErrorCode SequenceSetUp(Sequence *s)
{
  PetscFunctionBeginUser;
  if (s->kind != SEQUENCE_LATIN) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(s->n * s->n_dimensions, &s->stratum));
  for (PetscInt d = 0; d < s->n_dimensions; d++) {
    PetscInt *stratum = &s->stratum[d * s->n];

    for (PetscInt i = 0; i < s->n; i++) stratum[i] = i;
    for (PetscInt i = s->n - 1; i > 0; i--) {
      const PetscInt j       = (PetscInt)(HashUniform(s->seed, (uint64_t)(s->n_dimensions + d), (uint64_t)i) * (i + 1));
      const PetscInt swapped = stratum[i];

      stratum[i] = stratum[j];
      stratum[j] = swapped;
    }
  }
  PetscFunctionReturn(0);
}

void SequencePoint(const Sequence *s, PetscInt i, PetscReal u[])
{
  for (PetscInt d = 0; d < s->n_dimensions; d++) {
    if (s->kind == SEQUENCE_SOBOL)
      u[d] = ((PetscReal)OwenScramble(SobolDigits(i, d), s->seed, d) + 0.5) / (PetscReal)(1ULL << DIGITS);
    else
      u[d] = HashUniform(s->seed, (uint64_t)d, (uint64_t)i);
    if (s->kind == SEQUENCE_LATIN) u[d] = ((PetscReal)s->stratum[d * s->n + i] + u[d]) / (PetscReal)s->n;
  }
}

PetscErrorCode SequenceDestroy(Sequence *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->stratum));
  PetscFunctionReturn(0);
}
