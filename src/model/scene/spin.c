/*
   Parts that spin about an axis of their own while the frame stays: -<part>_spin, rad/s, -<part>_spin_axis and
   -<part>_spin_centre. What they add to the modes is in kernels/spin.h. That holds for bodies of revolution alone: their
   first and second moments about the axis,

      s = int r dV,  S = int r r' dV,   r = (I - e e') (x - c),

   are checked, s = 0 and S the same in all directions across the axis, and that the material turns into itself.
*/
#include "model/modelimpl.h"
#include "base/vec3.h"

#define ROUND 0.01 /* of the moments: room for holes and blocks of the mesh */

PetscErrorCode PartReadSpin(OptionsItems PetscOptionsObject, Part *part)
{
  const MPI_Comm comm = PetscOptionsObject->comm;
  Spin          *s    = &part->spin;
  PetscBool      has_axis, has_centre;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsReal("-spin", "rad/s about -spin_axis, in modes: gyroscopic and centrifugal terms", "model.h",
                             s->rate, &s->rate, &s->given));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-spin_axis", "x,y,z, about which it turns to the right", 3, s->axis,
                            &has_axis));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-spin_centre", "a point of that axis, m", 3, s->centre, &has_centre));
  PetscCheck(!s->given || (has_axis && has_centre), comm, PETSC_ERR_USER_INPUT,
             "-%s_spin %.6g needs -%s_spin_axis x,y,z and -%s_spin_centre x,y,z", part->name, (double)s->rate,
             part->name, part->name);
  PetscCheck(s->given || !(has_axis || has_centre), comm, PETSC_ERR_USER_INPUT,
             "-%s_spin_%s does nothing without -%s_spin", part->name, has_axis ? "axis" : "centre", part->name);
  PetscCheck(!s->given || Vec3Normalise(s->axis) > 0, comm, PETSC_ERR_USER_INPUT, "-%s_spin_axis 0,0,0 is no direction",
             part->name);
  PetscFunctionReturn(0);
}

/* Adds volume times 1, r and r r' of a local cell, its volume in the middle of its nodes */
static PetscErrorCode SpinAddMoments(Model model, PetscInt c, const Spin *s, PetscReal sum[13])
{
  const Element *element;
  PetscInt       n, nodes[ELEMENT_MAX_NODES];
  PetscReal      x[ELEMENT_MAX_DOFS], r[3] = {0, 0, 0}, volume, jacobian, along;

  PetscFunctionBeginUser;
  PetscCall(ModelGetCell(model, c, &element, nodes, x));
  n = element->n_corners;
  element->measure(element->solid, x, &volume, &jacobian);
  for (PetscInt i = 0; i < 3 * n; i++) r[i % 3] += (x[i] - s->centre[i % 3]) / (PetscReal)n;
  along = Vec3Dot(r, s->axis);
  for (int d = 0; d < 3; d++) r[d] -= along * s->axis[d];
  sum[0] += volume;
  for (int d = 0; d < 3; d++) sum[1 + d] += volume * r[d];
  for (int k = 0; k < 9; k++) sum[4 + k] += volume * r[k / 3] * r[k % 3];
  PetscFunctionReturn(0);
}

/* Raises an error for a part that is no body of revolution */
static PetscErrorCode SpinCheckShape(Model model, PetscInt part)
{
  const Part *p       = &model->scene.parts[part];
  PetscReal   sum[13] = {0}, radius, off = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < model->mesh.n_cells; c++)
    if (model->mesh.cell_part[c] == part) PetscCall(SpinAddMoments(model, c, &p->spin, sum));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 13, MPIU_REAL, MPI_SUM, model->comm));
  radius = PetscSqrtReal((sum[4] + sum[8] + sum[12]) / sum[0]);
  for (int k = 0; k < 9; k++) {
    const PetscReal across = (k % 4 ? 0 : 1) - p->spin.axis[k / 3] * p->spin.axis[k % 3];

    off = PetscMax(off, PetscAbsReal(sum[4 + k] / sum[0] - 0.5 * radius * radius * across) / (radius * radius));
  }
  off = PetscMax(off, Vec3Length(&sum[1]) / (sum[0] * radius));
  PetscCheck(
    off <= ROUND, model->comm, PETSC_ERR_USER_INPUT,
    "-%s_spin needs a body of revolution: the moments of part %s about -%s_spin_axis through -%s_spin_centre are "
    "off by %.2g of its radius %.4g, more than %g",
    p->name, p->name, p->name, p->name, (double)off, (double)radius, ROUND);
  PetscFunctionReturn(0);
}

/* Raises an error for a material that the turning would change */
static PetscErrorCode SpinCheckMaterial(Model model, const Part *p)
{
  const Anisotropy *a = &p->anisotropy;
  PetscReal         off[3], across[3];

  PetscFunctionBeginUser;
  if (!a->n) PetscFunctionReturn(0);
  for (int d = 0; d < 3; d++) off[d] = a->cylinder ? a->centre[d] - p->spin.centre[d] : 0;
  Vec3Cross(a->axis[2], p->spin.axis, across);
  PetscCheck((a->n == 2 || a->cylinder) && Vec3Length(across) < 1e-8, model->comm, PETSC_ERR_USER_INPUT,
             "-%s_spin needs a material that turns into itself: isotropic, two -%s_young with -%s_axis_3 along "
             "-%s_spin_axis, or three with -%s_cylinder_axis along it",
             p->name, p->name, p->name, p->name, p->name);
  Vec3Cross(off, p->spin.axis, across);
  PetscCheck(Vec3Length(across) <= 1e-8 * Vec3Length(off), model->comm, PETSC_ERR_USER_INPUT,
             "-%s_cylinder_centre is not on the axis of -%s_spin", p->name, p->name);
  PetscFunctionReturn(0);
}

PetscErrorCode SpinsCheck(Model model)
{
  PetscFunctionBeginUser;
  for (PetscInt part = 0; part < model->scene.n_parts; part++) {
    if (!model->scene.parts[part].spin.given) continue;
    PetscCall(SpinCheckShape(model, part));
    PetscCall(SpinCheckMaterial(model, &model->scene.parts[part]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SpinView(const Spin *s, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(
    PetscViewerASCIIPrintf(viewer,
                           "    spins at %.6g rad/s about %.6g, %.6g, %.6g through %.6g, %.6g, %.6g m: gyroscopic "
                           "and centrifugal terms in modes\n",
                           (double)s->rate, (double)s->axis[0], (double)s->axis[1], (double)s->axis[2],
                           (double)s->centre[0], (double)s->centre[1], (double)s->centre[2]));
  PetscFunctionReturn(0);
}
