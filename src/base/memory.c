/*
   Memory that may not be had: where `ulimit -v` bounds the address space, the buffer that BLAS works in is taken at the
   start, since OpenBLAS asks for it again and again, for ever, where it gets none in the midst of a run.
*/
#include "memory.h"
#include <petscblaslapack.h>
#include <stdlib.h>
#include <sys/resource.h>

#define MEMORY_BUFFER ((size_t)160 << 20) /* bytes: buffers of OpenBLAS (32 to 128 MB), and some */
#define MEMORY_ORDER  128                 /* of a product that is too large for kernels without a buffer */

/* Bytes of address space that this process may have, 0 without bound */
static double MemoryLimit(void)
{
  struct rlimit limit;

  return getrlimit(RLIMIT_AS, &limit) || limit.rlim_cur == RLIM_INFINITY ? 0 : (double)limit.rlim_cur;
}

/* One product of matrices, for which BLAS takes its buffer */
static PetscErrorCode MemoryTakeBuffer(void)
{
  const PetscBLASInt n   = MEMORY_ORDER;
  const PetscScalar  one = 1, zero = 0;
  PetscScalar       *A;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(3 * n * n, &A));
  BLASgemm_("N", "N", &n, &n, &n, &one, A, &n, A + n * n, &n, &zero, A + 2 * n * n, &n);
  PetscCall(PetscFree(A));
  PetscFunctionReturn(0);
}

PetscErrorCode MemoryPrepare(MPI_Comm comm)
{
  const double limit = MemoryLimit();
  void        *room;

  PetscFunctionBeginUser;
  if (limit == 0) PetscFunctionReturn(0);
  room = malloc(MEMORY_BUFFER);
  PetscCheck(room, comm, PETSC_ERR_USER_INPUT,
             "ulimit -v allows %.0f MB of address space, which leave no room to compute in: allow %.0f MB or more",
             limit / 1e6, limit / 1e6 + 400);
  free(room);
  PetscCall(MemoryTakeBuffer());
  PetscFunctionReturn(0);
}

void MemoryExplain(char message[], size_t size)
{
  const double   limit     = MemoryLimit();
  PetscLogDouble used      = 0;
  char           bound[96] = "";

  if (limit > 0) (void)snprintf(bound, sizeof(bound), " (ulimit -v allows %.0f MB of address space)", limit / 1e6);
  (void)PetscMemoryGetCurrentUsage(&used);
  (void)snprintf(
    message, size,
    "out of memory: a rank has %.0f MB and gets no more%s; take a coarser mesh, a narrower -modes_band, or "
    "more machines",
    used / 1e6, bound);
}
