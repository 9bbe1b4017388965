/*
   Stop (private to dynamics/) - lets a long run end well when it is asked to: the first SIGINT, SIGTERM or SIGUSR1
   only leaves a mark, which the run looks for at steps that all ranks agree on; a second one of the same kind ends the
   process as ever.

   How much time there is, measured with Open MPI 4.1.4, T = odls_base_sigkill_timeout (1 s by default): when mpirun
   gets SIGINT or SIGTERM, the ranks get SIGTERM after T and SIGKILL after 2 T. So a stop must be complete within T of
   the mark; `mpirun --mca odls_base_sigkill_timeout 30` gives it half a minute. scripts/mpirun sets T = 0, with which
   the ranks die at once. mpirun passes SIGUSR1 on to all ranks at once and kills none, whatever T is: `kill -USR1
   <pid of mpirun>` is the sure way (batch systems send it ahead of the end: sbatch --signal=USR1@60).
   Whatever comes, the last checkpoint stays.
*/
#pragma once

#include <petscsys.h>

#define STOP_INTERVAL 50 /* steps between two looks at signals */
/* What a run says that was stopped; the rows are under their final name where no checkpoints were asked for */
#define STOP_GOES_ON "-dynamics_restart goes on from there"
#define STOP_ROWS    "transient.csv holds the rows until then, "

/*@ StopInstall - begins to listen; the mark is taken away. Not collective. @*/
PETSC_INTERN PetscErrorCode StopInstall(void);

/*@ StopRemove - gives the signals back to those who had them. Not collective. @*/
PETSC_INTERN PetscErrorCode StopRemove(void);

/*@ StopRequested - whether this rank was asked to stop; ranks may differ, the caller reduces it (MPI_LOR). Not
    collective. @*/
PETSC_INTERN PetscBool StopRequested(void);
