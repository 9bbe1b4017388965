/*
   Grounded springs and dashpots: a stiffness (N/m) or a viscosity (N s/m) in x, y, z at every node of a named set.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>

/* Raises an error for values that are all zero, or negative */
static PetscErrorCode GroundedCheck(MPI_Comm comm, const Grounded *g, const char option[])
{
  PetscFunctionBeginUser;
  PetscCheck(g->value[0] != 0 || g->value[1] != 0 || g->value[2] != 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s must be given: three values, not all zero", g->name, option);
  for (int d = 0; d < 3; d++)
    PetscCheck(g->value[d] >= 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s value %.6g must not be negative", g->name, option,
               (double)g->value[d]);
  PetscFunctionReturn(0);
}

static PetscErrorCode SpringRead(OptionsItems PetscOptionsObject, void *owner, void *record)
{
  Grounded *g = record;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(OptionsGetSet(PetscOptionsObject, &g->set));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-stiffness", "stiffness in x,y,z, N/m per node (required)", 3, g->value, NULL));
  PetscCall(GroundedCheck(PetscOptionsObject->comm, g, "stiffness"));
  PetscFunctionReturn(0);
}

static PetscErrorCode DashpotRead(OptionsItems PetscOptionsObject, void *owner, void *record)
{
  Grounded *g = record;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(OptionsGetSet(PetscOptionsObject, &g->set));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-viscosity", "viscosity in x,y,z, N s/m per node (required)", 3, g->value, NULL));
  PetscCall(GroundedCheck(PetscOptionsObject->comm, g, "viscosity"));
  PetscFunctionReturn(0);
}

const OptionsList springs_list  = {"-springs", "each the prefix of its -set and value", "Grounded spring",
                                   sizeof(Grounded), SpringRead};
const OptionsList dashpots_list = {"-dashpots", "each the prefix of its -set and value", "Grounded dashpot",
                                   sizeof(Grounded), DashpotRead};
