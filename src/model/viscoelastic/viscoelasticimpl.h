/* Private to model/viscoelastic: laws from options */
#pragma once

#include <squeal/viscoelastic.h>

/* table.c - rows of a table that a file or lists give. Collective */
PETSC_INTERN PetscErrorCode ViscoelasticReadTable(MPI_Comm comm, const char name[], const ViscoelasticAsked *asked,
                                                  Viscoelastic *law);
