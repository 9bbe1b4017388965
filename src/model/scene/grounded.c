/*
   Grounded springs and dashpots: a stiffness (N/m) or a viscosity (N s/m) in x, y, z on a named set. At node v it is
   the value times the share s_v (spread.c): at every node, in all, or per area of a surface. With the latter two a finer
   mesh is as stiff as a coarse one.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>

/* What a value may be called, its unit and help, by Spread */
typedef struct {
  const char *option, *unit, *help;
} GroundedName;

static const GroundedName spring_names[] = {
  [SPREAD_EACH]  = {"stiffness",          "N/m",   "stiffness in x,y,z at every node, N/m"            },
  [SPREAD_TOTAL] = {"stiffness_total",    "N/m",   "instead: stiffness in x,y,z of the whole set, N/m"},
  [SPREAD_AREA]  = {"stiffness_per_area", "N/m^3", "instead: stiffness in x,y,z per area, N/m^3"      }
};
static const GroundedName dashpot_names[] = {
  [SPREAD_EACH]  = {"viscosity",          "N s/m",   "viscosity in x,y,z at every node, N s/m"            },
  [SPREAD_TOTAL] = {"viscosity_total",    "N s/m",   "instead: viscosity in x,y,z of the whole set, N s/m"},
  [SPREAD_AREA]  = {"viscosity_per_area", "N s/m^3", "instead: viscosity in x,y,z per area, N s/m^3"      }
};

/* Raises an error for values that are all zero, negative or not finite */
static PetscErrorCode GroundedCheck(MPI_Comm comm, const Grounded *g)
{
  PetscFunctionBeginUser;
  PetscCheck(g->value[0] != 0 || g->value[1] != 0 || g->value[2] != 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s must be given: three values, not all zero", g->name, g->quantity);
  for (int d = 0; d < 3; d++)
    PetscCheck(g->value[d] >= 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s value %.6g must not be negative", g->name,
               g->quantity, (double)g->value[d]);
  PetscFunctionReturn(0);
}

static PetscErrorCode GroundedRead(OptionsItems PetscOptionsObject, const GroundedName names[], Grounded *g)
{
  const MPI_Comm comm  = PetscOptionsObject->comm;
  PetscInt       found = -1;

  PetscFunctionBeginUser;
  PetscCall(OptionsGetSet(PetscOptionsObject, &g->set));
  for (int s = SPREAD_EACH; s <= SPREAD_AREA; s++) {
    char      option[64];
    PetscReal value[3] = {0, 0, 0};
    PetscBool given;

    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", names[s].option));
    PetscCall(OptionsGetReals(PetscOptionsObject, option, names[s].help, 3, value, &given));
    PetscCheck(!given || found < 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s and -%s_%s are given; give one of them",
               g->name, names[found < 0 ? 0 : found].option, g->name, names[s].option);
    if (!given) continue;
    found = s;
    PetscCall(PetscArraycpy(g->value, value, 3));
  }
  PetscCheck(found >= 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s, -%s_%s or -%s_%s must be given: three values, not all zero", g->name, names[SPREAD_EACH].option,
             g->name, names[SPREAD_TOTAL].option, g->name, names[SPREAD_AREA].option);
  g->spread   = (Spread)found;
  g->quantity = names[g->spread].option;
  g->unit     = names[g->spread].unit;
  PetscCall(GroundedCheck(comm, g));
  PetscFunctionReturn(0);
}

static PetscErrorCode SpringRead(OptionsItems PetscOptionsObject, void *owner, void *record)
{
  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(GroundedRead(PetscOptionsObject, spring_names, record));
  PetscFunctionReturn(0);
}

static PetscErrorCode DashpotRead(OptionsItems PetscOptionsObject, void *owner, void *record)
{
  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(GroundedRead(PetscOptionsObject, dashpot_names, record));
  PetscFunctionReturn(0);
}

const OptionsList springs_list  = {"-springs", "each the prefix of its -set and value", "Grounded spring",
                                   sizeof(Grounded), SpringRead};
const OptionsList dashpots_list = {"-dashpots", "each the prefix of its -set and value", "Grounded dashpot",
                                   sizeof(Grounded), DashpotRead};

PetscErrorCode GroundedSetUp(Model model)
{
  const ModelScene *scene = &model->scene;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < scene->n_springs + scene->n_dashpots; i++) {
    const Grounded *g = i < scene->n_springs ? &scene->springs[i] : &scene->dashpots[i - scene->n_springs];
    Vec             shares;

    PetscCall(ModelCreateShares(model, g->name, g->set, g->spread, &shares));
    PetscCall(VecDestroy(&shares));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode GroundedView(const Grounded *g, const char kind[], PetscViewer viewer)
{
  static const char *const how[] = {" per node", " in all", ""}; /* N/m^3 is per area */

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %s %s on %s: %.6g, %.6g, %.6g %s%s\n", kind, g->name, g->set,
                                   (double)g->value[0], (double)g->value[1], (double)g->value[2], g->unit,
                                   how[g->spread]));
  PetscFunctionReturn(0);
}
