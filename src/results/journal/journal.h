/*
   Journal (private to the rooms that write results) - what a run that is stopped goes on from: files of named arrays of
   all ranks, each with the checksum of the scene, so that nothing damaged and nothing of another run is taken.
*/
#pragma once

#include "base/process/fault.h"
#include <squeal/checksum.h>
#include <squeal/results.h>

/* Numbers of a struct that is made of reals alone */
#define N_REALS(type) ((PetscInt)(sizeof(type) / sizeof(PetscReal)))

/* Array of this rank; n and values are of the writer, at reading n must agree (n < 0: any, the reader allocates values)
 */
typedef struct {
  const char *name;
  PetscInt    n;
  PetscReal  *values;
} JournalItem;

/* The files of a run, all borrowed */
typedef struct {
  MPI_Comm    comm; /* ranks whose arrays stand in one file */
  Results     results;
  Checksum    scene;
  const char *reader; /* who goes on from them, for messages: "-dynamics_restart" */
  const char *run;    /* "sweep", of one that goes on by itself, whose files scene.yaml does not list; else NULL */
} Journal;

/*
   JournalWrite - writes file `name` in the folder of the results under a temporary name, flushes it to the disk and
   renames it, so that at any moment the last complete one is there. Collective. Errors: PETSC_ERR_FILE_WRITE with the
   file and the reason (no space left on device); the last good one is kept.
*/
PETSC_INTERN PetscErrorCode JournalWrite(const Journal *journal, const char name[], PetscInt n,
                                         const JournalItem item[]);

/* JournalKeep - the same for a run that can do without: where it fails there is a warning, and kept is false.
   Collective. */
PETSC_INTERN PetscErrorCode JournalKeep(const Journal *journal, const char name[], PetscInt n, const JournalItem item[],
                                        PetscBool *kept);

/* Whether the n-th piece of work is to be kept, whose file holds all before it: up to 100 each, then as often as one in
   a hundred comes, so that the writing grows as n log n and a kill loses a hundredth */
static inline PetscBool JournalIsDue(PetscInt n)
{
  return n <= 100 || n % (n / 100) == 0 ? PETSC_TRUE : PETSC_FALSE;
}

/*
   JournalRead - reads it back; items in the same order. Nothing is read where there is a fault, the same on all ranks.
   PETSC_ERR_FILE_OPEN: there is no file, or it cannot be opened; PETSC_ERR_FILE_READ: it is truncated or damaged
   (length, checksum), PETSC_ERR_FILE_UNEXPECTED: it is of another version, number of ranks, or scene: what differs is
   said. Collective.
*/
PETSC_INTERN PetscErrorCode JournalRead(const Journal *journal, const char name[], PetscInt n, JournalItem item[],
                                        Fault *fault);

/* JournalWarn - of a file that is there and that some of the ranks of `comm` have a fault with a warning says why it is
   not taken, and ends as `then`. Collective on `comm`, which may be larger than the journal's. */
PETSC_INTERN PetscErrorCode JournalWarn(const Journal *journal, MPI_Comm comm, const char name[], const char then[],
                                        Fault *fault, PetscBool *taken);

/* JournalTake - reads for a run that begins anew without, and warns. Collective. */
PETSC_INTERN PetscErrorCode JournalTake(const Journal *journal, const char name[], const char then[], PetscInt n,
                                        JournalItem item[], PetscBool *taken);

/* What bears the name in the folder of the results: nothing, a file of somebody else, or one that begins as squeal's
   do. Collective. */
typedef enum { JOURNAL_NONE, JOURNAL_FOREIGN, JOURNAL_OURS } JournalKind;
PETSC_INTERN PetscErrorCode JournalFind(MPI_Comm comm, Results results, const char name[], JournalKind *kind);

/* Bytes of different kinds as one array, in whole words: the same calls write them, and read them back */
typedef struct {
  PetscReal *word;
  PetscInt   n, room, at; /* words written; allocated; read */
  PetscBool  write, good; /* good: all that was asked for was there */
} JournalPack;

/* pack.c - moves bytes behind those before; frees the words. Not collective. */
PETSC_INTERN PetscErrorCode JournalPackMove(JournalPack *pack, void *bytes, size_t size);
PETSC_INTERN PetscErrorCode JournalPackDestroy(JournalPack *pack);
