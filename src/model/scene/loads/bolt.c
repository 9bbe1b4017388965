/*
   Bolts. A bolt is cut at the nodes of a set, which two parts share, and its faces there are drawn over each other by
   the shortening d (m) along its axis n: the cells of one part, out of which n points, see the displacement u + d n at
   these nodes, all others u. With their stiffness K_a, and j = n at the nodes of the cut, the bodies are in equilibrium
   as under the load -d K_a j, and the tension that passes through the cut is

      T = j' K_a (u + d j)     (N).

   Under a -..._tension d is such that T is what is given at the end of the stage in which the bolt is tightened
   (statics/stages/bolt.c); then d stays, and T follows what else happens. The mesh is whole in all matrices.
*/
#include "model/modelimpl.h"
#include "base/algebra/vec3.h"

PetscErrorCode BoltCheck(MPI_Comm comm, Model model, Load *load)
{
  const char *name = load->name;

  PetscFunctionBeginUser;
  load->is_bolt = load->has_tension || load->has_shortening ? PETSC_TRUE : PETSC_FALSE;
  load->of_part = -1;
  PetscCheck(load->is_bolt || (!load->part[0] && !load->has_axis), comm, PETSC_ERR_USER_INPUT,
             "-%s_%s is that of a bolt: give its -%s_tension (N) or -%s_shortening (m), or leave it out", name,
             load->part[0] ? "part" : "axis", name, name);
  if (!load->is_bolt) PetscFunctionReturn(0);
  PetscCheck(!load->has_tension || !load->has_shortening, comm, PETSC_ERR_USER_INPUT,
             "-%s_tension and -%s_shortening are given; give one of them", name, name);
  PetscCheck(!load->on[0] && !load->has_force && !load->has_moment && !load->is_pressure, comm, PETSC_ERR_USER_INPUT,
             "-%s_%s: a bolt has no -%s_force, -%s_moment, -%s_pressure or -%s_point", name,
             load->has_tension ? "tension" : "shortening", name, name, name, name);
  PetscCheck(load->set[0], comm, PETSC_ERR_USER_INPUT, "-%s_set must be given: the nodes at which the bolt is cut",
             name);
  PetscCheck(load->part[0], comm, PETSC_ERR_USER_INPUT, "-%s_part must be given: the part on one side of the cut",
             name);
  PetscCall(ModelFindPart(model, name, load->part, &load->of_part));
  PetscCheck(load->has_axis && Vec3Length(load->axis) > 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_axis must be given: the direction out of part %s through the cut, not 0,0,0", name, load->part);
  (void)Vec3Normalise(load->axis);
  PetscFunctionReturn(0);
}

/* Of the nodes of the cut how many cells of the part, and others, have each; and the sum over the cells of the part at
   the cut of axis . (middle of the cell - node) */
static PetscErrorCode BoltCountCells(Model model, const Load *load, PetscInt n, const PetscInt node[], Vec count,
                                     PetscReal *side)
{
  const Mesh  *mesh = &model->mesh;
  PetscScalar *value;
  PetscInt     at;

  PetscFunctionBeginUser;
  *side = 0;
  PetscCall(VecGetArray(count, &value));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *element;
    PetscInt       vertices[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS], middle[3] = {0, 0, 0};

    PetscCall(ModelGetCell(model, c, &element, vertices, x));
    for (PetscInt i = 0; i < 3 * element->n_nodes; i++) middle[i % 3] += x[i] / element->n_nodes;
    for (PetscInt i = 0; i < element->n_nodes; i++) {
      PetscCall(PetscFindInt(vertices[i], n, node, &at));
      if (at < 0) continue;
      value[3 * vertices[i] + (mesh->cell_part[c] == load->of_part ? 0 : 1)] += 1;
      for (int d = 0; d < 3 && mesh->cell_part[c] == load->of_part; d++)
        *side += load->axis[d] * (middle[d] - x[3 * i + d]);
    }
  }
  PetscCall(VecRestoreArray(count, &value));
  PetscCall(ModelSumShared(model, count));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, side, 1, MPIU_REAL, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode BoltSetUp(Model model, Load *load)
{
  const PetscScalar *value;
  PetscInt           n, *node, missing[2] = {0, 0};
  PetscReal          side;
  Vec                count;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetNodes(model, load->set, &n, &node));
  PetscCall(ModelCreateNodal(model, &count));
  PetscCall(BoltCountCells(model, load, n, node, count, &side));
  PetscCall(VecGetArrayRead(count, &value));
  for (PetscInt i = 0; i < n; i++)
    for (int k = 0; k < 2; k++)
      if (model->mesh.owned[node[i]] && PetscRealPart(value[3 * node[i] + k]) == 0) missing[k]++;
  PetscCall(VecRestoreArrayRead(count, &value));
  PetscCall(VecDestroy(&count));
  PetscCall(PetscFree(node));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, missing, 2, MPIU_INT, MPI_SUM, model->comm));
  PetscCheck(!missing[0] && !missing[1], model->comm, PETSC_ERR_USER_INPUT,
             "-%s_set %s: %" PetscInt_FMT " of its nodes belong to no element of %s %s; a bolt is cut where two parts "
             "share nodes",
             load->name, load->set, missing[missing[0] ? 0 : 1], missing[0] ? "part" : "a part other than", load->part);
  PetscCheck(side < 0, model->comm, PETSC_ERR_USER_INPUT,
             "-%s_axis %.6g,%.6g,%.6g points from the cut %s into part %s: it must point out of it", load->name,
             (double)load->axis[0], (double)load->axis[1], (double)load->axis[2], load->set, load->part);
  PetscFunctionReturn(0);
}

PetscErrorCode BoltView(Model model, const Load *load, PetscViewer viewer)
{
  const char *metre;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(model, "m", &metre));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "  bolt %s: cut at %s, its side %s drawn by %.6g %s along %.6g,%.6g,%.6g\n", load->name, load->set,
    load->part, (double)(load->has_tension ? load->tension : load->shortening), load->has_tension ? "N" : metre,
    (double)load->axis[0], (double)load->axis[1], (double)load->axis[2]));
  PetscFunctionReturn(0);
}
