/*
   Equal eigenvalues, as several free bodies have at zero and equal bodies at each of their frequencies. In exact
   arithmetic a Krylov space of blocks of b vectors holds b vectors of one eigenvalue: what it has beyond these is
   rounding's, and right and left spaces may lack the same ones.
*/
#include "modes/modesimpl.h"

#define COPIES_EQUAL 1e-6 /* relative distance of eigenvalues that a space cannot tell apart soon */
#define COPIES_ROOM  2    /* vectors in a block for each equal eigenvalue that was found, */
#define COPIES_MORE  4    /* and at least so many times those that were in it */

/* The most eigenvalues in a row that are equal; those below `tiny` count as zeros */
static PetscInt CopiesMost(const Spectrum *s, PetscReal tiny)
{
  PetscInt most = 0;

  for (PetscInt first = 0, next; first < s->n; first = next) {
    for (next = first + 1; next < s->n; next++) {
      const PetscReal size  = hypot(s->sigma[next], s->omega[next]);
      const PetscReal apart = hypot(s->sigma[next] - s->sigma[next - 1], s->omega[next] - s->omega[next - 1]);

      if (apart > PetscMax(tiny, COPIES_EQUAL * size)) break;
    }
    most = PetscMax(most, next - first);
  }
  return most;
}

PetscBool CopiesDoubtful(const Modes modes, const Window *window, const Spectrum *s)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < s->n; i++) n += s->omega[i] >= window->edge[0] && s->omega[i] <= window->edge[1];
  if (window->known.expected >= 0 && n >= window->known.expected) return PETSC_FALSE;
  return CopiesMost(s, window->known.scale) >= modes->block[1] ? PETSC_TRUE : PETSC_FALSE;
}

void CopiesMakeRoom(Modes modes, const Window *window, const Spectrum *s)
{
  const PetscInt copies = CopiesMost(s, window->known.scale), block = modes->block[1];

  if (copies >= block) modes->block[0] = PetscMax(COPIES_MORE * block, COPIES_ROOM * copies);
}
