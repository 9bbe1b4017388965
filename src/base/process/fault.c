/*
   Faults: what one rank finds wrong (a damaged part of a file, a place of its own share of the mesh) becomes an error
   of all ranks, with the words of the lowest rank that found something.
*/
#include "fault.h"

PetscErrorCode FaultNote(Fault *fault, PetscErrorCode code, const char format[], ...)
{
  va_list values;

  PetscFunctionBeginUser;
  if (fault->code) PetscFunctionReturn(0);
  va_start(values, format);
  PetscCall(PetscVSNPrintf(fault->text, sizeof(fault->text), format, NULL, values));
  va_end(values);
  fault->code = code;
  PetscFunctionReturn(0);
}

PetscErrorCode FaultsAgree(MPI_Comm comm, Fault *fault)
{
  PetscMPIInt size, rank, first;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  first = fault->code ? rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, comm));
  if (first < size) PetscCallMPI(MPI_Bcast(fault, (PetscMPIInt)sizeof(*fault), MPI_BYTE, first, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode FaultsRaise(MPI_Comm comm, Fault *fault)
{
  PetscFunctionBeginUser;
  PetscCall(FaultsAgree(comm, fault));
  PetscCheck(!fault->code, comm, fault->code, "%s", fault->text);
  PetscFunctionReturn(0);
}
