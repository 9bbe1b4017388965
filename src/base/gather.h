/* Private: arrays of records, pieced together on every rank from those of all, or sent to ranks */
#pragma once

#include <petscsys.h>

/*@
   GatherRecords - concatenates the records of all ranks, in the order of the ranks, on every rank. Counts are of
   records, so that an int limits their number and not their bytes. Collective.

   Input Parameters:
+  n_local - number of this rank's records, 0 allowed
.  size    - of one record, bytes
-  local   - this rank's records

   Output Parameters:
+  n_all - number of all records, or NULL
-  all   - address of the pointer to them, set for the caller, who frees it with PetscFree()
@*/
PETSC_INTERN PetscErrorCode GatherRecords(MPI_Comm comm, PetscInt n_local, size_t size, const void *local,
                                          PetscInt *n_all, void *all);

/*@
   ExchangeRecords - sends each record to a rank; those that arrive are in the order of the ranks that they come from,
   and of each in its order. Counts as in GatherRecords(). Collective.

   Input/Output Parameters:
+  n     - number of this rank's records, 0 allowed; then of those that arrive
-  local - address of the pointer to this rank's records, of PetscMalloc(); they are freed once they are sorted

   Input Parameters:
+  size - of one record, bytes
-  rank - [n] to which each goes

   Output Parameter:
.  in - address of the pointer to those that arrive, set for the caller, who frees it with PetscFree()
@*/
PETSC_INTERN PetscErrorCode ExchangeRecords(MPI_Comm comm, PetscInt *n, size_t size, void *local,
                                            const PetscMPIInt rank[], void *in);
