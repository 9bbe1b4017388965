/*
   Checkpoint (private to dynamics/) - arrays of a run on disk, so that a run killed at any moment goes on bitwise.
*/
#pragma once

#include <squeal/checksum.h>
#include <squeal/results.h>

#define CHECKPOINT_FILE "checkpoint.bin"

/* Numbers of a struct that is made of reals alone */
#define N_REALS(type) ((PetscInt)(sizeof(type) / sizeof(PetscReal)))

/* Array of this rank; n and values are of the writer, at reading n must agree (n < 0: any, the reader allocates values)
 */
typedef struct {
  const char *name;
  PetscInt    n;
  PetscReal  *values;
} CheckpointItem;

/*
   CheckpointWrite - writes `checkpoint.bin` in the folder of the results under a temporary name, flushes it to the disk
   and renames it, so that at any moment the last complete one is there. Collective. Errors: PETSC_ERR_FILE_WRITE with
   the file and the reason (no space left on device); the last good one is kept.
*/
PETSC_INTERN PetscErrorCode CheckpointWrite(MPI_Comm comm, Results results, Checksum scene, PetscInt n,
                                            const CheckpointItem item[]);

/*
   CheckpointRead - reads it back; items in the same order. Collective.
   Errors: PETSC_ERR_FILE_OPEN without a file; PETSC_ERR_FILE_READ for one that is truncated or damaged (length,
   checksum), PETSC_ERR_FILE_UNEXPECTED for one of another version, number of ranks, or scene: what differs is said.
*/
PETSC_INTERN PetscErrorCode CheckpointRead(MPI_Comm comm, Results results, Checksum scene, PetscInt n,
                                           CheckpointItem item[]);

/* What bears the name of a checkpoint in the folder of the results: nothing, a file of somebody else, or one that begins
   as squeal's do. Collective. */
typedef enum { CHECKPOINT_NONE, CHECKPOINT_FOREIGN, CHECKPOINT_OURS } CheckpointKind;
PETSC_INTERN PetscErrorCode CheckpointFind(MPI_Comm comm, Results results, CheckpointKind *kind);
