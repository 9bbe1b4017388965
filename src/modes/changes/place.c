/*
   Where a change at nodes acts. Along the unit vector d at a node a is d at its unknowns, less d at those of the other
   end, so that a'u is the motion between the ends. A point mass acts along x, y and z.
*/
#include "changes.h"
#include "base/algebra/vec3.h"
#include <string.h>

/* Unknowns of one end, 3 of a node (-1: held), 1 of a matrix; the place of the node */
static PetscErrorCode EndFind(Modes modes, Operators operators, struct _p_ModesChange *change, int end, PetscInt *n,
                              PetscInt unknown[3])
{
  const char *word = end ? change->to_unknown : change->unknown;
  const Mesh *mesh;
  PetscReal   x[3] = {0, 0, 0};
  PetscInt    vertex;
  Model       model;
  char        option[256];

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_%s", change->name, end ? "to_unknown" : "unknown"));
  PetscCheck(model || word[0], modes->comm, PETSC_ERR_USER_INPUT,
             "%s must be given: the matrices have no mesh, and so no node is near a place", option);
  PetscCheck(!model || !word[0], modes->comm, PETSC_ERR_USER_INPUT, "%s %s is for matrices without a mesh: give -%s_%s",
             option, word, change->name, end ? "to" : "at");
  *n = model ? 3 : 1;
  if (!model) {
    PetscCall(OperatorsFindUnknown(operators, option, word, unknown));
    PetscFunctionReturn(0);
  }
  PetscCall(
    ModelFindNode(model, change->name, end ? change->to_part : change->part, end ? change->to : change->at, &vertex));
  PetscCall(OperatorsGetNodeUnknowns(operators, vertex, unknown));
  PetscCall(ModelGetMesh(model, &mesh));
  if (vertex >= 0) PetscCall(PetscArraycpy(x, &mesh->x[3 * vertex], 3));
  PetscCallMPI(MPI_Allreduce(x, change->x[end], 3, MPIU_REAL, MPI_SUM, modes->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeGetDirection(Modes modes, const struct _p_ModesChange *change, PetscInt n, PetscReal direction[3])
{
  const PetscReal length = PetscSqrtReal(Vec3Dot(change->direction, change->direction));

  PetscFunctionBeginUser;
  PetscCheck((n == 3) == change->has_direction && (n == 1 || length > 0), modes->comm, PETSC_ERR_USER_INPUT,
             "-%s_direction %s", change->name,
             n == 3 ? "must be given: x,y,z, not all zero, along which its spring or dashpot acts"
                    : "is for nodes: an unknown has no other one");
  direction[0] = 1;
  for (PetscInt d = 0; d < n && n == 3; d++) direction[d] = change->direction[d] / length;
  PetscFunctionReturn(0);
}

/* The term along one direction, with both ends */
static PetscErrorCode TermFill(Modes modes, const struct _p_ModesChange *change, PetscInt n, PetscInt unknown[2][3],
                               const PetscReal direction[3], ChangeTerm *term)
{
  const PetscBool hung =
    change->mass > 0 && (change->stiffness > 0 || change->viscosity > 0) ? PETSC_TRUE : PETSC_FALSE;
  PetscReal back[3], length;
  Operators operators;

  PetscFunctionBeginUser;
  *term =
    (ChangeTerm){.mass = change->mass, .viscosity = change->viscosity, .stiffness = change->stiffness, .hung = hung};
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsCreateVec(operators, &term->force));
  for (PetscInt d = 0; d < n; d++) back[d] = -direction[d];
  PetscCall(OperatorsAddEntries(operators, term->force, n, unknown[0], direction));
  if (unknown[1][0] > -2) PetscCall(OperatorsAddEntries(operators, term->force, n, unknown[1], back));
  PetscCall(VecNorm(term->force, NORM_INFINITY, &length));
  PetscCheck(length > 0 || !change->has_direction, modes->comm, PETSC_ERR_USER_INPUT,
             "change %s does nothing: its nodes are held along -%s_direction, or are one", change->name, change->name);
  PetscFunctionReturn(0);
}

PetscErrorCode ChangeAddForces(Modes modes, ModesChange change, PetscInt *n, ChangeTerm terms[])
{
  const PetscBool alone =
    change->mass > 0 && !(change->stiffness > 0 || change->viscosity > 0) ? PETSC_TRUE : PETSC_FALSE;
  PetscInt  n_unknowns, unknown[2][3] = {{0}, {-2, -2, -2}}, held = 0;
  PetscReal direction[3];
  Operators operators;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(EndFind(modes, operators, change, 0, &n_unknowns, unknown[0]));
  if (change->has_to || change->to_unknown[0]) PetscCall(EndFind(modes, operators, change, 1, &n_unknowns, unknown[1]));
  if (!alone) {
    PetscCall(ChangeGetDirection(modes, change, n_unknowns, direction));
    PetscCall(TermFill(modes, change, n_unknowns, unknown, direction, &terms[(*n)++]));
    PetscFunctionReturn(0);
  }
  for (PetscInt d = 0; d < n_unknowns; d++) {
    if (unknown[0][d] < 0) held++;
    if (unknown[0][d] < 0) continue;
    for (int k = 0; k < 3; k++) direction[k] = k == d;
    PetscCall(TermFill(modes, change, n_unknowns, unknown, direction, &terms[(*n)++]));
  }
  PetscCheck(held < n_unknowns, modes->comm, PETSC_ERR_USER_INPUT,
             "-%s_mass does nothing: the node at %.6g, %.6g, %.6g m is held", change->name, (double)change->x[0][0],
             (double)change->x[0][1], (double)change->x[0][2]);
  PetscFunctionReturn(0);
}
