/* Private to base/: the BLAS that the program runs on; see blas.c */
#pragma once

#include <petscsys.h>

/* Its name, e.g. "OpenBLAS 0.3.21 (Haswell)", the kernels in brackets */
PETSC_INTERN void BlasGetName(size_t length, char name[]);

/* What OPENBLAS_CORETYPE should be where OpenBLAS took kernels that are older than the processor; else NULL */
PETSC_INTERN const char *BlasBetterKernels(void);
