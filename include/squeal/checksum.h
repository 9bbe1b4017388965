/*
   Checksum - tells whether a run that is to go on is one of the same scene. Each room adds what it has read of the
   options, and the mesh, under the names of the parts that they belong to ("the mesh", "contact pad"); a part has a sum
   of 64 bits, so that a difference can be named. Numbers count bit by bit, but -0 as 0. What all ranks know alike is
   added by each of them; what they have in pieces, in any order, is summed over them: the sums do not depend on the
   number of ranks.
*/
#pragma once

#include <petscsys.h>
#include <stdint.h>

typedef struct _p_Checksum *Checksum;

/* Of one part of the scene */
typedef struct {
  char     name[56];
  uint64_t sum;
} ChecksumPart;

#define CHECKSUM_BEGIN UINT64_C(0xcbf29ce484222325)

/*@
   ChecksumBytes - goes on from h, CHECKSUM_BEGIN at first, with `size` bytes: for each word w of eight of them (the
   last one filled up with zeros) h <- (h ^ w) p, h <- h ^ (h >> 32), and at the end one more with the number of bytes.
   Both maps are one to one in h and in w for odd p, so that a change within any single word is always seen; the shift
   carries the high bits, such as signs, back into the low ones. After the FNV-1a hash (Fowler, Noll, Vo; IETF
   draft-eastlake-fnv), whose offset basis it begins with. Not collective.
@*/
uint64_t ChecksumBytes(uint64_t h, const void *bytes, size_t size);

/*@ ChecksumCreate - without parts; the caller destroys it. Collective. @*/
PetscErrorCode ChecksumCreate(MPI_Comm comm, Checksum *checksum);

/*@ ChecksumSetPart - names the part that the following belongs to, a new one or one that is there; printf-like. Not
    collective, same call on all ranks. @*/
PetscErrorCode ChecksumSetPart(Checksum checksum, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

/*@ ChecksumDropPart - takes a part away, where there is one of that name. Not collective, same call on all ranks. @*/
PetscErrorCode ChecksumDropPart(Checksum checksum, const char name[]);

/*@ ChecksumAddReals - adds n numbers to the part; Ints and String alike (NULL counts as empty). Not collective, same
    values on all ranks. @*/
PetscErrorCode ChecksumAddReals(Checksum checksum, PetscInt n, const PetscReal values[]);
PetscErrorCode ChecksumAddInts(Checksum checksum, PetscInt n, const PetscInt values[]);
PetscErrorCode ChecksumAddString(Checksum checksum, const char text[]);

/*@ ChecksumAddPieces - adds what the ranks have in pieces: n of this rank, the checksum of each by ChecksumBytes().
    Collective. @*/
PetscErrorCode ChecksumAddPieces(Checksum checksum, PetscInt n, const uint64_t piece[]);

/*@ ChecksumGetParts - the parts so far (borrowed until the next one). Not collective. @*/
PetscErrorCode ChecksumGetParts(Checksum checksum, PetscInt *n, const ChecksumPart **parts);

/*@ ChecksumCompare - names of the parts that differ from n kept ones, or that one of the two lacks, as "supports, the
    mesh"; empty where all agree. Not collective. @*/
PetscErrorCode ChecksumCompare(Checksum checksum, PetscInt n, const ChecksumPart kept[], size_t size, char names[]);

/*@ ChecksumDestroy - frees it. Collective. @*/
PetscErrorCode ChecksumDestroy(Checksum *checksum);
