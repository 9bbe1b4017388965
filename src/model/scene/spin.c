/*
   Parts that spin about an axis of their own while the frame stays: -<part>_spin, rad/s, -<part>_spin_axis and
   -<part>_spin_centre. What they add to the modes is in kernels/element/spin.h. That holds for bodies of revolution
   alone: their first and second moments about the axis,

      s = int r dV,  S = int r r' dV,   r = (I - e e') (x - c),

   are checked, s = 0 and S the same in all directions across the axis, and that the material turns into itself. A
   square bar passes these. Its surface does not: the velocity Omega w, w = e x r, must lie in it,

      int |w . n| dA << int |w| |n - e e'n| dA    over the faces around the axis, ends across it left out.

   An N-gon has sin(pi / N) by the normals of its faces at their nodes; a square bar of many faces 0.44, a hexagonal one
   0.27.
*/
#include "model/modelimpl.h"
#include "base/algebra/vec3.h"
#include "kernels/contact/facet.h"

#define ROUND  0.01 /* of the moments: room for holes and blocks of the mesh */
#define SMOOTH 0.25 /* of the velocity: room for bolt holes, and for 13 facets around */
#define ALONG  1e-8 /* sine of the angle below which two directions are the same */

PetscErrorCode PartCheckSpin(MPI_Comm comm, Part *part)
{
  Spin *s = &part->spin;

  PetscFunctionBeginUser;
  PetscCheck(!s->given || (s->has_axis && s->has_centre), comm, PETSC_ERR_USER_INPUT,
             "-%s_spin %.6g needs -%s_spin_axis x,y,z and -%s_spin_centre x,y,z", part->name, (double)s->rate,
             part->name, part->name);
  PetscCheck(s->given || !(s->has_axis || s->has_centre), comm, PETSC_ERR_USER_INPUT,
             "-%s_spin_%s does nothing without -%s_spin", part->name, s->has_axis ? "axis" : "centre", part->name);
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
  Part     *p       = &model->scene.parts[part];
  PetscReal sum[13] = {0}, radius, off = 0;

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
  p->spin.radius = radius;
  PetscFunctionReturn(0);
}

/* Raises an error for a part whose surface the spin would move */
static PetscErrorCode SpinCheckSurface(Model model, PetscInt part)
{
  const Part *p      = &model->scene.parts[part];
  PetscReal   sum[2] = {0, 0};
  ModelFaces  faces;

  PetscFunctionBeginUser;
  PetscCall(PartGetFaces(model, part, &faces));
  for (PetscInt f = 0; f < faces.n; f++) {
    const PetscInt *node;
    double          x[FACET_NODES][3], area[FACET_NODES][3], w[3], r[3];
    const int       n = (int)ModelFacesGet(&faces, &model->mesh, f, &node, x);

    FacetNodeNormals(n, (const double(*)[3])x, area);
    for (int i = 0; i < n; i++) {
      for (int d = 0; d < 3; d++) r[d] = x[i][d] - p->spin.centre[d];
      Vec3Cross(p->spin.axis, r, w);
      sum[0] += PetscAbsReal(Vec3Dot(w, area[i]));
      Vec3Cross(p->spin.axis, area[i], r);
      sum[1] += Vec3Length(w) * Vec3Length(r);
    }
  }
  PetscCall(ModelFacesDestroy(&faces));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, model->comm));
  PetscCheck(
    sum[0] <= SMOOTH * sum[1], model->comm, PETSC_ERR_USER_INPUT,
    "-%s_spin needs a body of revolution: of the velocity of the faces of part %s around -%s_spin_axis %.2g is "
    "along their normals, more than %g",
    p->name, p->name, p->name, (double)(sum[0] / sum[1]), SMOOTH);
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
  PetscCheck((a->n == 2 || a->cylinder) && Vec3Length(across) < ALONG, model->comm, PETSC_ERR_USER_INPUT,
             "-%s_spin needs a material that turns into itself: isotropic, two -%s_young with -%s_axis_3 along "
             "-%s_spin_axis, or three with -%s_cylinder_axis along it",
             p->name, p->name, p->name, p->name, p->name);
  Vec3Cross(off, p->spin.axis, across);
  PetscCheck(Vec3Length(across) <= ALONG * Vec3Length(off), model->comm, PETSC_ERR_USER_INPUT,
             "-%s_cylinder_centre is not on the axis of -%s_spin", p->name, p->name);
  PetscFunctionReturn(0);
}

/* Whether two parts turn with the same velocity about the same line, or both stand still */
static PetscBool SpinIsSame(const Spin *a, const Spin *b)
{
  PetscReal off[3], across[3], beside[3];

  if (a->given != b->given) return PETSC_FALSE;
  if (!a->given) return PETSC_TRUE;
  for (int d = 0; d < 3; d++) off[d] = b->centre[d] - a->centre[d];
  Vec3Cross(a->axis, b->axis, across);
  Vec3Cross(a->axis, off, beside);
  return a->rate == b->rate && Vec3Dot(a->axis, b->axis) > 0 && Vec3Length(across) < ALONG &&
             Vec3Length(beside) <= ALONG * Vec3Length(off)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Whether two parts share a node; on = room for all nodes */
static PetscErrorCode PartsShareNodes(Model model, PetscInt a, PetscInt b, PetscBool on[], PetscBool *share)
{
  const Mesh *mesh = &model->mesh;

  PetscFunctionBeginUser;
  *share = PETSC_FALSE;
  PetscCall(PetscArrayzero(on, mesh->n_nodes));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1] && mesh->cell_part[c] == a; i++)
      on[mesh->cell_node[i]] = PETSC_TRUE;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1] && mesh->cell_part[c] == b; i++)
      if (on[mesh->cell_node[i]]) *share = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, share, 1, MPIU_BOOL, MPI_LOR, model->comm));
  PetscFunctionReturn(0);
}

/* The body of each part that spins; raises an error for parts that share nodes and do not spin alike */
static PetscErrorCode SpinsJoin(Model model)
{
  const PetscInt n    = model->scene.n_parts;
  Part *const    part = model->scene.parts;
  PetscBool     *on, share;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(model->mesh.n_nodes, &on));
  for (PetscInt i = 0; i < n; i++) part[i].spin.body = i;
  for (PetscInt k = 0; k < n * n; k++) {
    const PetscInt i = k / n, j = k % n;

    if (i >= j || !(part[i].spin.given || part[j].spin.given)) continue;
    PetscCall(PartsShareNodes(model, i, j, on, &share));
    if (!share) continue;
    PetscCheck(SpinIsSame(&part[i].spin, &part[j].spin), model->comm, PETSC_ERR_USER_INPUT,
               "parts %s and %s share nodes but do not spin alike: give both the same -..._spin, -..._spin_axis and a "
               "-..._spin_centre on one line",
               part[i].name, part[j].name);
    for (PetscInt l = 0, old = part[j].spin.body; l < n; l++)
      if (part[l].spin.body == old) part[l].spin.body = part[i].spin.body;
  }
  PetscCall(PetscFree(on));
  PetscFunctionReturn(0);
}

PetscErrorCode SpinsCheck(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(SpinsJoin(model));
  for (PetscInt part = 0; part < model->scene.n_parts; part++) {
    if (!model->scene.parts[part].spin.given) continue;
    PetscCall(SpinCheckShape(model, part));
    PetscCall(SpinCheckSurface(model, part));
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
