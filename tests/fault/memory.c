/*
   Allocations that the program asks for: by malloc() and its kin where the caller lies in the program's own code, or
   through PETSc, whose allocator stands behind a pointer (PetscTrMalloc, PetscTrRealloc). What PETSc and other libraries
   want for themselves is not counted, except as FAULT_PETSC. An allocation that fails in PETSc does so below it: its own
   allocator runs and gets nothing from the C library.
*/
#define _GNU_SOURCE
#include "inject.h"
#include <errno.h>
#include <link.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <petscsys.h>

#define MOST_ARRAYS 7 /* of PetscMallocA() */

typedef PetscErrorCode (*Allocate)(size_t, PetscBool, int, const char[], const char[], void **);
typedef PetscErrorCode (*MallocA)(int, PetscBool, int, const char *, const char *, size_t, void *, ...);
typedef PetscErrorCode (*Reallocate)(size_t, int, const char[], const char[], void **);

extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static uintptr_t    first, last;     /* addresses of the program's own code */
static __thread int starving, asked; /* the next allocation gets nothing; the program asks through PetscMallocA() */
static Allocate     petsc_allocate;
static Reallocate   petsc_reallocate;

/* The first object is the program */
static int FindCode(struct dl_phdr_info *info, size_t size, void *ctx)
{
  (void)size;
  (void)ctx;
  for (int i = 0; i < info->dlpi_phnum; i++) {
    if (info->dlpi_phdr[i].p_type != PT_LOAD || !(info->dlpi_phdr[i].p_flags & PF_X)) continue;
    first = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
    last  = first + info->dlpi_phdr[i].p_memsz;
  }
  return 1;
}

static int Own(const void *caller)
{
  return (uintptr_t)caller >= first && (uintptr_t)caller < last;
}

/* Whether this allocation gets nothing */
static int Starves(const void *caller, const char name[])
{
  if (starving || (Own(caller) && FaultTake(FAULT_OWN, name))) {
    starving = 0;
    errno    = ENOMEM;
    return 1;
  }
  return 0;
}

/* Counts an allocation of PETSc's, where it comes from being told by its caller */
static void Plan(int own, int line, const char function[], const char file[])
{
  char words[240];

  (void)snprintf(words, sizeof(words), "%s() %s:%d", function ? function : "", file ? file : "", line);
  starving = (own && FaultTake(FAULT_OWN, words)) || FaultTake(FAULT_PETSC, words);
}

static PetscErrorCode PetscAllocate(size_t size, PetscBool clear, int line, const char function[], const char file[],
                                    void **result)
{
  PetscErrorCode code;

  if (size) Plan(asked || Own(__builtin_return_address(0)), line, function, file);
  code     = petsc_allocate(size, clear, line, function, file, result);
  starving = 0;
  return code;
}

static PetscErrorCode PetscReallocate(size_t size, int line, const char function[], const char file[], void **result)
{
  PetscErrorCode code;

  if (size) Plan(Own(__builtin_return_address(0)), line, function, file);
  code     = petsc_reallocate(size, line, function, file, result);
  starving = 0;
  return code;
}

void FaultMemorySetUp(void)
{
  (void)dl_iterate_phdr(FindCode, NULL);
  if (petsc_allocate) return;
  petsc_allocate   = PetscTrMalloc;
  petsc_reallocate = PetscTrRealloc;
  PetscTrMalloc    = PetscAllocate;
  PetscTrRealloc   = PetscReallocate;
}

/* --- what stands before PETSc's and the C library's own */

/* Only marks who asks; its arrays come from PetscTrMalloc. Further pairs than n are not looked at */
PetscErrorCode PetscMallocA(int n, PetscBool clear, int line, const char *function, const char *file, size_t bytes,
                            void *array, ...)
{
  MallocA        next;
  size_t         size[MOST_ARRAYS] = {bytes};
  void          *to[MOST_ARRAYS]   = {array};
  va_list        more;
  PetscErrorCode code;

  FaultNext("PetscMallocA", &next);
  va_start(more, array);
  for (int i = 1; i < n && i < MOST_ARRAYS; i++) {
    size[i] = va_arg(more, size_t);
    to[i]   = va_arg(more, void *);
  }
  va_end(more);
  asked = Own(__builtin_return_address(0));
  code  = next(n, clear, line, function, file, size[0], to[0], size[1], to[1], size[2], to[2], size[3], to[3], size[4],
               to[4], size[5], to[5], size[6], to[6]);
  asked = 0;
  return code;
}

void *malloc(size_t size)
{
  return Starves(__builtin_return_address(0), "malloc") ? NULL : __libc_malloc(size);
}

void *calloc(size_t n, size_t size)
{
  return Starves(__builtin_return_address(0), "calloc") ? NULL : __libc_calloc(n, size);
}

void *realloc(void *old, size_t size)
{
  return Starves(__builtin_return_address(0), "realloc") ? NULL : __libc_realloc(old, size);
}

int posix_memalign(void **result, size_t align, size_t size)
{
  if (Starves(__builtin_return_address(0), "posix_memalign")) return ENOMEM;
  *result = __libc_memalign(align, size);
  return *result ? 0 : ENOMEM;
}
