/*
   LU factors in single precision, of a base whose factors leave the cache of a core: half of the bytes, and twice
   as many operations at a time. chord.c takes a direction from them and measures what the laws miss in double
   precision: an iteration that gains two or three figures does not feel that they have seven.
*/
#include "base/algebra/versions.h"
#include "contact/compliance/complianceimpl.h"

#define LU_SINGLE
#include "contact/compliance/lufactors.h"

VERSIONS
PetscReal ComplianceSingleFactor(PetscInt n, float A[])
{
  return LUFactor(n, A);
}

VERSIONS
/* X := A^-1 X of columns [n], work as large */
static void SingleSolve(PetscInt n, const float LU[], PetscInt columns, PetscReal X[], float work[])
{
  PetscReal largest = 0;

  for (PetscInt i = 0; i < n * columns; i++) largest = PetscMax(largest, PetscAbsReal(X[i]));
  if (!(largest > 0)) return;
  for (PetscInt i = 0; i < n * columns; i++) work[i] = (float)(X[i] / largest);
  LUSolveColumns(n, LU, columns, work);
  for (PetscInt i = 0; i < n * columns; i++) X[i] = largest * (PetscReal)work[i];
}

void ComplianceChordBaseSolve(const ContactCompliance c, PetscInt columns, PetscReal X[])
{
  const ComplianceChord *h  = &c->chord;
  float                 *LU = (float *)h->LU;

  if (h->single)
    SingleSolve(h->m, LU, columns, X, &LU[h->m * h->m]);
  else if (columns == 1)
    ComplianceLUSolve(h->m, h->LU, X);
  else
    ComplianceLUSolveColumns(h->m, h->LU, columns, X);
}
