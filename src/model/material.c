/*
   Elasticity of a cell in global axes. Axes by a cylinder are those at the mean x of the cell's nodes: with the axis e
   and a point c of it, r = (I - e e') (x - c), the rows are r / |r|, e x r / |r|, e.
*/
#include "modelimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/element/orthotropic.h"

#define NO_RADIUS 1e-8 /* of a cell's size: nearer to its centre the axis leaves no radial direction */
#define CARRIED   1e-8 /* of the mesh, and of a unit vector: by how much axes that a sweep carries along may be off */

/* From the axis to the centre of a cell, radius[3] (m); and how far its nodes are from their centre, m */
static PetscErrorCode CellFindRadius(Model model, PetscInt c, const Anisotropy *a, PetscReal radius[3], PetscReal *size)
{
  const Element *element;
  PetscInt       n, nodes[ELEMENT_MAX_NODES];
  PetscReal      x[ELEMENT_MAX_DOFS], centre[3] = {0, 0, 0}, along = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetCell(model, c, &element, nodes, x));
  n = element->n_corners;
  for (PetscInt i = 0; i < 3 * n; i++) centre[i % 3] += x[i] / (PetscReal)n;
  *size = 0;
  for (PetscInt i = 0; i < 3 * n; i++) *size = PetscMax(*size, PetscAbsReal(x[i] - centre[i % 3]));
  for (int d = 0; d < 3; d++) radius[d] = centre[d] - a->centre[d];
  along = Vec3Dot(radius, a->axis[2]);
  for (int d = 0; d < 3; d++) radius[d] -= along * a->axis[2][d];
  PetscFunctionReturn(0);
}

/* Axes of the material at a local cell */
static PetscErrorCode CellFindAxes(Model model, PetscInt c, const Anisotropy *a, PetscReal axis[3][3])
{
  PetscReal size;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(axis[0], a->axis[0], 9));
  if (!a->cylinder) PetscFunctionReturn(0);
  PetscCall(CellFindRadius(model, c, a, axis[0], &size));
  (void)Vec3Normalise(axis[0]);
  Vec3Cross(axis[2], axis[0], axis[1]);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetElasticity(Model model, PetscInt c, PetscReal young, PetscReal density, Elasticity *elasticity)
{
  const Part       *part = &model->scene.parts[model->mesh.cell_part[c]];
  const Anisotropy *a    = &part->anisotropy;
  PetscReal         axis[3][3];

  PetscFunctionBeginUser;
  if (!a->n) {
    *elasticity = ElasticityFromEngineering(young, part->poisson, density);
    PetscFunctionReturn(0);
  }
  PetscCall(CellFindAxes(model, c, a, axis));
  elasticity->anisotropic = true;
  elasticity->density     = density;
  elasticity->lambda = elasticity->shear = 0;
  OrthotropicTurn((const double(*)[3])axis, a->C, young / a->constants.young[0], elasticity->C);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCheckAxes(Model model)
{
  PetscFunctionBeginUser;
  for (PetscInt part = 0; part < model->scene.n_parts; part++) {
    const Part *p   = &model->scene.parts[part];
    PetscInt    bad = 0;

    if (!p->anisotropy.cylinder) continue;
    for (PetscInt c = 0; c < model->mesh.n_cells; c++) {
      PetscReal radius[3], size;

      if (model->mesh.cell_part[c] != part) continue;
      PetscCall(CellFindRadius(model, c, &p->anisotropy, radius, &size));
      if (Vec3Length(radius) <= NO_RADIUS * size) bad = 1;
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPIU_INT, MPI_MAX, model->comm));
    PetscCheck(!bad, model->comm, PETSC_ERR_USER_INPUT,
               "-%s_cylinder_axis passes through the centre of a cell of part %s, where no direction is radial",
               p->name, p->name);
  }
  PetscFunctionReturn(0);
}

/* Whether sweeping a section carries the axes of its material along, so that all sections have one stencil. Along a
   straight path fixed axes stay, and those of a cylinder along it; about an axis go those of a cylinder about it, and
   transverse isotropy along it. */
PetscBool ModelMaterialIsSwept(Model model, PetscInt part, const ModelLines *lines)
{
  const Anisotropy *a     = &model->scene.parts[part].anisotropy;
  PetscReal         scale = 0, off[3];

  if (!a->n) return PETSC_TRUE;
  if (!a->cylinder && (!lines->turned || a->n != 2)) return lines->turned ? PETSC_FALSE : PETSC_TRUE;
  for (PetscInt i = 0; i < lines->n_lines * lines->n_nodes; i++)
    for (int d = 0; d < 3; d++) scale = PetscMax(scale, PetscAbsReal(model->mesh.x[3 * lines->vertex[i] + d]));
  for (int d = 0; d < 3; d++) off[d] = a->centre[d] - lines->centre[d];
  for (int i = 1; i < 3; i++) {
    const PetscReal *across = &lines->frame[3 * ((lines->axis + i) % 3)];

    if (PetscAbsReal(Vec3Dot(a->axis[2], across)) > CARRIED) return PETSC_FALSE;
    if (a->cylinder && lines->turned && PetscAbsReal(Vec3Dot(off, across)) > CARRIED * scale) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
