/*
   Decisions of several ranks compared. Preloaded under mpirun, it looks at every collective call of MPI before it is made: all ranks
   of the communicator must have come to it by the same calls of the program, and bring as many bytes. A rank that has decided
   otherwise than another, from its own rows, its own clock or its own disk, shows at the first call after that, where without this
   the ranks would wait for each other for ever, or take numbers of one call for those of another.

     scripts/mpirun -n 3 -x LD_PRELOAD=$PWD/build/tests/libcollective.so build/squeal ...

   Each rank then says where it is, as the call and places in the program, the innermost first (addr2line -fie PROGRAM PLACE...), and
   the run is aborted. Calls of Fortran, hence those within MUMPS, are not seen. An optimising compiler makes two places of one, hence
   functions are compared; with -DEXACT, for a program that was compiled without optimisation, places.
*/
#define _GNU_SOURCE
#include <inttypes.h>
#include <link.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <unwind.h>

#define MOST_FRAMES 64

typedef struct {
  uintptr_t base, begin, end; /* of the program: where it was loaded, its code */
  uintptr_t place[MOST_FRAMES];
  int       n;
  uint64_t  hash; /* of the places, or of the functions that they are in */
} Stack;

#ifdef EXACT
  #define Compared(frame) _Unwind_GetIP(frame)
#else
  #define Compared(frame) _Unwind_GetRegionStart(frame)
#endif

static uint64_t Mixed(uint64_t hash, uint64_t value)
{
  return (hash ^ value) * 1099511628211u;
}

/* The program is the first of what is loaded */
static int ProgramFind(struct dl_phdr_info *info, size_t size, void *ctx)
{
  Stack *const stack = ctx;

  (void)size;
  stack->base = info->dlpi_addr;
  for (int i = 0; i < info->dlpi_phnum; i++) {
    const ElfW(Phdr) *const part = &info->dlpi_phdr[i];

    if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
    stack->begin = stack->base + part->p_vaddr;
    stack->end   = stack->begin + part->p_memsz;
  }
  return 1;
}

static _Unwind_Reason_Code FrameAdd(struct _Unwind_Context *frame, void *ctx)
{
  Stack *const    stack = ctx;
  const uintptr_t at    = _Unwind_GetIP(frame);

  if (at < stack->begin || at >= stack->end || stack->n == MOST_FRAMES) return _URC_NO_REASON;
  stack->place[stack->n++] = at - stack->base - 1;
  stack->hash              = Mixed(stack->hash, Compared(frame) - stack->base);
  return _URC_NO_REASON;
}

static void Say(MPI_Comm comm, const char call[], uint64_t bytes, const Stack *stack)
{
  char text[4096];
  int  rank, n;

  PMPI_Comm_rank(comm, &rank);
  n = snprintf(text, sizeof(text), "collective: rank %d %s of %" PRIu64 " bytes at", rank, call, bytes);
  for (int i = 0; i < stack->n && n < (int)sizeof(text) - 32; i++)
    n += snprintf(text + n, sizeof(text) - (size_t)n, " 0x%" PRIxPTR, stack->place[i]);
  text[n++] = '\n';
  (void)!write(STDERR_FILENO, text, (size_t)n);
}

/* Whether all ranks make the same call; ends the run where they do not */
static void Check(MPI_Comm comm, const char call[], uint64_t bytes)
{
  static Stack program;
  Stack        stack;
  uint64_t     of[2];
  int          size, between;

  PMPI_Comm_test_inter(comm, &between);
  PMPI_Comm_size(comm, &size);
  if (between || size == 1) return;
  if (!program.end) (void)dl_iterate_phdr(ProgramFind, &program);
  stack      = program;
  stack.hash = 14695981039346656037u;
  (void)_Unwind_Backtrace(FrameAdd, &stack);
  for (const char *c = call; *c; c++) stack.hash = Mixed(stack.hash, (unsigned char)*c);
  stack.hash = Mixed(stack.hash, bytes);
  of[0]      = stack.hash;
  of[1]      = ~stack.hash;
  PMPI_Allreduce(MPI_IN_PLACE, of, 2, MPI_UINT64_T, MPI_MAX, comm);
  if (of[0] == ~of[1]) return;
  Say(comm, call, bytes, &stack);
  (void)sleep(1); /* for the others to say it too */
  PMPI_Abort(comm, 86);
}

static uint64_t Bytes(int count, MPI_Datatype type)
{
  int size;

  PMPI_Type_size(type, &size);
  return (uint64_t)count * (uint64_t)size;
}

int MPI_Allreduce(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, MPI_Comm comm)
{
  Check(comm, "MPI_Allreduce", Bytes(n, t));
  return PMPI_Allreduce(a, b, n, t, op, comm);
}

int MPI_Reduce(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, int root, MPI_Comm comm)
{
  Check(comm, "MPI_Reduce", Bytes(n, t));
  return PMPI_Reduce(a, b, n, t, op, root, comm);
}

int MPI_Bcast(void *a, int n, MPI_Datatype t, int root, MPI_Comm comm)
{
  Check(comm, "MPI_Bcast", Bytes(n, t));
  return PMPI_Bcast(a, n, t, root, comm);
}

int MPI_Barrier(MPI_Comm comm)
{
  Check(comm, "MPI_Barrier", 0);
  return PMPI_Barrier(comm);
}

int MPI_Scan(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, MPI_Comm comm)
{
  Check(comm, "MPI_Scan", Bytes(n, t));
  return PMPI_Scan(a, b, n, t, op, comm);
}

int MPI_Exscan(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, MPI_Comm comm)
{
  Check(comm, "MPI_Exscan", Bytes(n, t));
  return PMPI_Exscan(a, b, n, t, op, comm);
}

int MPI_Allgather(const void *a, int n, MPI_Datatype t, void *b, int m, MPI_Datatype u, MPI_Comm comm)
{
  Check(comm, "MPI_Allgather", Bytes(m, u));
  return PMPI_Allgather(a, n, t, b, m, u, comm);
}

int MPI_Allgatherv(const void *a, int n, MPI_Datatype t, void *b, const int m[], const int at[], MPI_Datatype u, MPI_Comm comm)
{
  Check(comm, "MPI_Allgatherv", 0);
  return PMPI_Allgatherv(a, n, t, b, m, at, u, comm);
}

int MPI_Gather(const void *a, int n, MPI_Datatype t, void *b, int m, MPI_Datatype u, int root, MPI_Comm comm)
{
  Check(comm, "MPI_Gather", Bytes(n, t));
  return PMPI_Gather(a, n, t, b, m, u, root, comm);
}

int MPI_Gatherv(const void *a, int n, MPI_Datatype t, void *b, const int m[], const int at[], MPI_Datatype u, int root, MPI_Comm comm)
{
  Check(comm, "MPI_Gatherv", 0);
  return PMPI_Gatherv(a, n, t, b, m, at, u, root, comm);
}

int MPI_Scatter(const void *a, int n, MPI_Datatype t, void *b, int m, MPI_Datatype u, int root, MPI_Comm comm)
{
  Check(comm, "MPI_Scatter", Bytes(m, u));
  return PMPI_Scatter(a, n, t, b, m, u, root, comm);
}

int MPI_Scatterv(const void *a, const int n[], const int at[], MPI_Datatype t, void *b, int m, MPI_Datatype u, int root, MPI_Comm comm)
{
  Check(comm, "MPI_Scatterv", 0);
  return PMPI_Scatterv(a, n, at, t, b, m, u, root, comm);
}

int MPI_Alltoall(const void *a, int n, MPI_Datatype t, void *b, int m, MPI_Datatype u, MPI_Comm comm)
{
  Check(comm, "MPI_Alltoall", Bytes(n, t));
  return PMPI_Alltoall(a, n, t, b, m, u, comm);
}

int MPI_Alltoallv(const void *a, const int n[], const int at[], MPI_Datatype t, void *b, const int m[], const int to[], MPI_Datatype u,
                  MPI_Comm comm)
{
  Check(comm, "MPI_Alltoallv", 0);
  return PMPI_Alltoallv(a, n, at, t, b, m, to, u, comm);
}

int MPI_Comm_dup(MPI_Comm comm, MPI_Comm *copy)
{
  Check(comm, "MPI_Comm_dup", 0);
  return PMPI_Comm_dup(comm, copy);
}

int MPI_Comm_split(MPI_Comm comm, int color, int key, MPI_Comm *part)
{
  Check(comm, "MPI_Comm_split", 0);
  return PMPI_Comm_split(comm, color, key, part);
}
