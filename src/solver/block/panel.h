/* Private to solver/: products of tall matrices of a few hundred columns with blocks of few, which read the tall one as
   seldom as can be */
#pragma once

#include <petscsys.h>

/* Local rows of a tall matrix, by columns */
typedef struct {
  PetscInt     rows, columns, stride;
  PetscScalar *a;
} Panel;

/* product = V' W, [W.columns][V.columns] */
PETSC_INTERN PetscErrorCode PanelProduct(const Panel *V, const Panel *W, PetscScalar product[]);
/* W := (W - V C) T, C [W.columns][V.columns], T [W.columns][W.columns] by columns (the identity where NULL); with
   `product`, product = V' W and gram = W' W of the new W, from the same reading of V */
PETSC_INTERN PetscErrorCode PanelUpdate(const Panel *V, const PetscScalar C[], const PetscScalar T[], Panel *W,
                                        PetscScalar product[], PetscScalar gram[]);
