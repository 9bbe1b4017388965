/*
   Size, volume and mass of the parts, and a warning where they tell of mixed units (unit.c).
*/
#include "model/modelimpl.h"

#define SLOW_PERIODS 50. /* of the highest frequency of a window while a wave crosses a part: thousands of modes */

/* Bounding boxes and volumes of this rank's cells, then of all */
static PetscErrorCode ExtentsMeasure(Model model)
{
  const PetscInt n = model->scene.n_parts;
  PetscReal     *low, *volume;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &model->extent));
  PetscCall(PetscMalloc2(6 * n, &low, n, &volume)); /* [part][3] least coordinates, then the negative largest ones */
  for (PetscInt i = 0; i < 6 * n; i++) low[i] = PETSC_MAX_REAL;
  PetscCall(PetscArrayzero(volume, n));
  for (PetscInt c = 0; c < model->mesh.n_cells; c++) {
    const PetscInt part = model->mesh.cell_part[c];
    const Element *element;
    PetscInt       nodes[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS], cell, jacobian;

    PetscCall(ModelGetCellAt(model, c, model->scene.parts[part].layer.thickness, &element, nodes, x));
    element->measure(element->solid, x, &cell, &jacobian);
    volume[part] += cell;
    for (PetscInt k = 0; k < 3 * element->n_nodes; k++) {
      low[6 * part + k % 3]     = PetscMin(low[6 * part + k % 3], x[k]);
      low[6 * part + 3 + k % 3] = PetscMin(low[6 * part + 3 + k % 3], -x[k]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, low, (PetscMPIInt)(6 * n), MPIU_REAL, MPI_MIN, model->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, volume, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, model->comm));
  for (PetscInt i = 0; i < n; i++) {
    for (int d = 0; d < 3; d++) model->extent[i].size[d] = -low[6 * i + d] - low[6 * i + 3 + d];
    model->extent[i].volume = volume[i];
  }
  PetscCall(PetscFree2(low, volume));
  PetscFunctionReturn(0);
}

/* Time that a wave takes along the longest side L, s: L / sqrt(E / rho), sqrt(E / rho) the speed of waves in a bar */
static PetscReal PartCrossing(const Part *p, const PartExtent *e)
{
  return PetscMax(e->size[0], PetscMax(e->size[1], e->size[2])) / PetscSqrtReal(p->young / p->density);
}

PetscErrorCode PartsCheckUnits(Model model)
{
  PetscFunctionBeginUser;
  PetscCall(ExtentsMeasure(model));
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    const Part       *p     = &model->scene.parts[i];
    const PartExtent *e     = &model->extent[i];
    const char       *doubt = PartDoubt(p, e);

    if (!doubt) continue;
    PetscCall(
      PetscFPrintf(model->comm, stderr,
                   "squeal: warning: units of part %s: size %.4g x %.4g x %.4g, mass %.4g, E %.4g, rho %.4g; probably "
                   "%s\n",
                   p->name, (double)e->size[0], (double)e->size[1], (double)e->size[2],
                   (double)(e->volume * p->density), (double)p->young, (double)p->density, doubt));
    break; /* the others will be alike */
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDescribeDoubt(Model model, PetscReal hz, size_t size, char text[])
{
  PetscInt  slowest = -1;
  PetscReal longest = SLOW_PERIODS / hz;

  PetscFunctionBeginUser;
  text[0] = '\0';
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    const PetscReal crossing = PartCrossing(&model->scene.parts[i], &model->extent[i]);

    if (crossing <= longest) continue;
    longest = crossing;
    slowest = i;
  }
  if (slowest < 0) PetscFunctionReturn(0);
  const Part *p     = &model->scene.parts[slowest];
  const char *doubt = PartDoubt(p, &model->extent[slowest]);

  PetscCall(PetscSNPrintf(text, size,
                          "a wave along part %s takes %.3g s, %.0f periods of %.6g Hz; probably %s%s (-%s_young %.6g, "
                          "-%s_density %.6g)",
                          p->name, (double)longest, (double)(longest * hz), (double)hz,
                          doubt ? "" : "its modulus, density or mesh has other units", doubt ? doubt : "", p->name,
                          (double)p->young, p->name, (double)p->density));
  PetscFunctionReturn(0);
}

PetscErrorCode PartView(Model model, PetscInt part, PetscViewer viewer)
{
  const Part       *p = &model->scene.parts[part];
  const PartExtent *e = &model->extent[part];
  const char       *pascal, *dense, *metre, *volume, *kilogram;
  char              law[256];

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(model, "Pa", &pascal));
  PetscCall(ModelGetUnit(model, "kg/m^3", &dense));
  PetscCall(ModelGetUnit(model, "m", &metre));
  PetscCall(ModelGetUnit(model, "m^3", &volume));
  PetscCall(ModelGetUnit(model, "kg", &kilogram));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  part %s: E %.6g %s, nu %.6g, rho %.6g %s, alpha %.6g 1/s, beta %.6g s\n",
                                   p->name, (double)p->young, pascal, (double)p->poisson, (double)p->density, dense,
                                   (double)p->alpha, (double)p->beta));
  if (p->anisotropy.n) PetscCall(AnisotropyView(model, &p->anisotropy, viewer));
  if (p->spin.given) PetscCall(SpinView(&p->spin, viewer));
  if (p->layer.given)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "    layer: %.6g %s thick, %.6g in the mesh, along %.4g,%.4g,%.4g\n", (double)p->layer.thickness, metre,
      (double)p->layer.mesh, (double)p->layer.normal[0], (double)p->layer.normal[1], (double)p->layer.normal[2]));
  if (p->law.kind) PetscCall(ViscoelasticDescribe(&p->law, sizeof(law), law));
  if (p->law.kind) PetscCall(PetscViewerASCIIPrintf(viewer, "    %s\n", law));
  if (p->loss > 0 && model->scene.loss_frequency > 0)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "    loss factor %.6g at %.6g Hz, in beta: %.6g at half that frequency, %.6g at twice it\n",
      (double)p->loss, (double)model->scene.loss_frequency, (double)(p->loss / 2), (double)(2 * p->loss)));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "    %.4g x %.4g x %.4g %s, %.4g %s, %.4g %s; a wave along it takes %.3g s\n",
                                   (double)e->size[0], (double)e->size[1], (double)e->size[2], metre, (double)e->volume,
                                   volume, (double)(e->volume * p->density), kilogram, (double)PartCrossing(p, e)));
  PetscFunctionReturn(0);
}
