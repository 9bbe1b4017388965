/*
   Memory that may not be had: where `ulimit -v` bounds the address space, the buffer that BLAS works in is taken at the
   start, since OpenBLAS asks for it again and again, for ever, where it gets none in the midst of a run. And what is
   free on this machine: MemAvailable of /proc/meminfo (proc(5)), or less where the control group of the process, or one
   above it, allows less. The C library keeps what is freed: SuperLU_DIST, which PETSc may be linked to, forbids it to
   give anything back (mallopt(3), M_MMAP_MAX 0 and M_TRIM_THRESHOLD -1) for the whole process. For small problems that
   spares the system's work; large ones would hold matrices and factors that are long gone.
*/
#include <squeal/options.h>
#include "memory.h"
#include <malloc.h>
#include <math.h>
#include <petscblaslapack.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#define MEMORY_BUFFER ((size_t)160 << 20) /* bytes: buffers of OpenBLAS (32 to 128 MB), and some */
#define MEMORY_ORDER  128                 /* of a product that is too large for kernels without a buffer */

/* Where the two versions of control groups tell limit and use, bytes */
static const struct {
  const char *line, *folder, *limit, *used; /* beginning of the line of /proc/self/cgroup after its number */
} groups[] = {{":", "/sys/fs/cgroup", "memory.max", "anon"},
              {"memory:", "/sys/fs/cgroup/memory", "memory.limit_in_bytes", "total_rss"}};

static PetscReal allowed       = 0; /* -squeal_memory, MB */
static int       machine_ranks = 1; /* log handle: ranks of the run on this machine */

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

/* The number after a word at the beginning of a line of a file; INFINITY where there is none */
static double MemoryRead(const char path[], const char word[])
{
  FILE  *file  = fopen(path, "r");
  double value = INFINITY;
  char   line[512], format[64];

  if (!file) return INFINITY;
  (void)snprintf(format, sizeof(format), "%s %%lf", word);
  while (fgets(line, sizeof(line), file))
    if (sscanf(line, format, &value) == 1) break;
  (void)fclose(file);
  return value;
}

/* VmHWM of proc(5); getrusage(2) would tell the program's that started this one, where that was larger */
double MemoryPeak(void)
{
  const double  peak = 1024 * MemoryRead("/proc/self/status", "VmHWM:");
  struct rusage usage;

  if (isfinite(peak)) return peak;
  return getrusage(RUSAGE_SELF, &usage) ? 0 : 1024 * (double)usage.ru_maxrss;
}

/* Bytes that a control group and those above it leave; path is that of the group and is shortened to nothing */
static double GroupFree(int version, char path[])
{
  double least = INFINITY;

  for (;;) {
    char   file[1024];
    double limit, used;
    char  *slash = strrchr(path, '/');

    (void)snprintf(file, sizeof(file), "%s%s/%s", groups[version].folder, path, groups[version].limit);
    limit = MemoryRead(file, "");
    (void)snprintf(file, sizeof(file), "%s%s/memory.stat", groups[version].folder, path);
    used = MemoryRead(file, groups[version].used);
    if (isfinite(used)) least = fmin(least, limit - used);
    if (!slash) return least;
    *slash = '\0';
  }
}

/* MB that are free on this machine, to all ranks there together; infinite where nothing tells */
static double MemoryFree(void)
{
  double bytes = 1024 * MemoryRead("/proc/meminfo", "MemAvailable:");
  FILE  *file  = fopen("/proc/self/cgroup", "r");
  char   line[768];

  while (file && fgets(line, sizeof(line), file)) {
    char *const after = strchr(line, ':');

    line[strcspn(line, "\n")] = '\0';
    for (int version = 0; after && version < 2; version++)
      if (!strncmp(after + 1, groups[version].line, strlen(groups[version].line)))
        bytes = fmin(bytes, GroupFree(version, after + 1 + strlen(groups[version].line)));
  }
  if (file) (void)fclose(file);
  return 1e-6 * fmax(0, bytes);
}

void MemoryReturn(void)
{
#if defined(__GLIBC__)
  (void)malloc_trim(0);
#endif
}

int MemoryRanks(void)
{
  return machine_ranks;
}

PetscErrorCode MemoryAllow(MPI_Comm comm, PetscReal megabytes)
{
  MPI_Comm machine;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine));
  PetscCallMPI(MPI_Comm_size(machine, &machine_ranks));
  PetscCallMPI(MPI_Comm_free(&machine));
  allowed = megabytes;
  PetscFunctionReturn(0);
}

double MemoryRoom(PetscBool *given)
{
  *given = allowed > 0 ? PETSC_TRUE : PETSC_FALSE;
  return allowed > 0 ? allowed : MemoryFree();
}
