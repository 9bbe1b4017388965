/* The pad of a coarse brake faces the disc with 5 x 5 nodes; the bodies are so small that three ranks share them */
#pragma once

#include "brake.h"
#include "check.h"

#define COARSE "-rig_disc_elements 6,8,1 -rig_pad_elements 4,4,1 -rig_beam_elements 3 -contact_mu 0.5 "

#define SIDE      5
#define MAX_PAIRS 64 /* of two interfaces */

/* Place of each local pair on the square, [pairs][2] from 0 to 4 */
static inline PetscErrorCode PlacesFind(Contact contact, PetscInt place[][2])
{
  const ContactPair *pair;
  PetscReal          end[2][2] = {
             {PETSC_MIN_REAL, PETSC_MIN_REAL},
             {PETSC_MIN_REAL, PETSC_MIN_REAL}
  };
  PetscInt n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  PetscCheck(n <= MAX_PAIRS, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%d pairs are too many for this test", (int)n);
  for (PetscInt p = 0; p < n; p++)
    for (int d = 0; d < 2; d++) {
      end[0][d] = PetscMax(end[0][d], -pair[p].x[d]);
      end[1][d] = PetscMax(end[1][d], pair[p].x[d]);
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, end, 4, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  for (PetscInt p = 0; p < n; p++)
    for (int d = 0; d < 2; d++)
      place[p][d] = (PetscInt)PetscFloorReal((SIDE - 1) * (pair[p].x[d] + end[0][d]) / (end[1][d] + end[0][d]) + 0.5);
  PetscFunctionReturn(0);
}

/* Group of each local pair, from -1 (open) to n_groups, by the row and the column of its slave node on the pad */
static inline PetscErrorCode GroupsMake(Contact contact, PetscInt n_groups, PetscInt group[])
{
  const ContactPair *pair;
  PetscInt           n, n_all, place[MAX_PAIRS][2];

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  PetscCall(PlacesFind(contact, place));
  for (PetscInt p = 0; p < n; p++) {
    group[p] = (3 * place[p][0] + place[p][1]) % 5 - 1;
    if (group[p] > n_groups) group[p] = 0;
  }
  PetscFunctionReturn(0);
}

/* Breaks when: a pencil with all pairs closed is not what it was at first, whatever other pencils were made. Reference:
   copies of the first pencil */
static inline PetscErrorCode TestSame(Operators o, Mat K, Mat C, int *failed)
{
  PencilMatrices m;
  PetscBool      same;
  Pencil         pencil;

  PetscFunctionBeginUser;
  PetscCall(OperatorsLinearise(o, NULL, &pencil));
  PetscCall(PencilGetMatrices(pencil, &m));
  PetscCall(MatEqual(K, m.K, &same));
  *failed += CheckTrue("K as at first, bit for bit", same, same);
  if (C) PetscCall(MatEqual(C, m.C, &same));
  if (C) *failed += CheckTrue("C as at first, bit for bit", same, same);
  PetscCall(PencilDestroy(&pencil));
  PetscFunctionReturn(0);
}
