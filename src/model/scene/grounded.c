/*
   Grounded springs and dashpots: a stiffness (N/m) or a viscosity (N s/m) in x, y, z on a named set. At node v it is
   the value times the share s_v (spread.c): at every node, in all, or per area of a surface. With the latter two a
   finer mesh is as stiff as a coarse one.
*/
#include "model/modelimpl.h"
#include "base/algebra/vec3.h"

/* Which of the three values is given, and its row; raises an error for none, two, and zeros alone */
static PetscErrorCode GroundedSet(MPI_Comm comm, const QuantityTable *table, Grounded *g)
{
  const Quantity *row   = &table->row[1]; /* behind -set */
  PetscInt        found = -1;

  PetscFunctionBeginUser;
  for (PetscInt s = SPREAD_EACH; s <= SPREAD_AREA; s++) {
    PetscCheck(!g->given[s] || found < 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s and -%s_%s are given; give one of them",
               g->name, row[PetscMax(found, 0)].name + 1, g->name, row[s].name + 1);
    if (g->given[s]) found = s;
  }
  PetscCheck(found >= 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s, -%s_%s or -%s_%s must be given: three values, not all zero", g->name, row[SPREAD_EACH].name + 1,
             g->name, row[SPREAD_TOTAL].name + 1, g->name, row[SPREAD_AREA].name + 1);
  g->spread   = (Spread)found;
  g->quantity = row[found].name + 1;
  g->unit     = row[found].unit;
  PetscCall(PetscArraycpy(g->value, g->asked[found], 3));
  PetscCheck(Vec3Dot(g->value, g->value) > 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s must be given: three values, not all zero", g->name, g->quantity);
  PetscFunctionReturn(0);
}

PetscErrorCode SpringCheck(MPI_Comm comm, void *owner, void *record)
{
  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(GroundedSet(comm, &spring_quantities, record));
  PetscFunctionReturn(0);
}

PetscErrorCode DashpotCheck(MPI_Comm comm, void *owner, void *record)
{
  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(GroundedSet(comm, &dashpot_quantities, record));
  PetscFunctionReturn(0);
}

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

PetscErrorCode GroundedView(Model model, const Grounded *g, const char kind[], PetscViewer viewer)
{
  static const char *const how[] = {" per node", " in all", ""}; /* N/m^3 is per area */
  const char              *unit;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(model, g->unit, &unit));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %s %s on %s: %.6g, %.6g, %.6g %s%s\n", kind, g->name, g->set,
                                   (double)g->value[0], (double)g->value[1], (double)g->value[2], unit,
                                   how[g->spread]));
  PetscFunctionReturn(0);
}
