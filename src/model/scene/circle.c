/*
   Circles: nodes of a body at equal angles, whose motion along the circle's axis histories and responses record. Node k
   of n is the one nearest to the place at the angle 2 pi k / n on the circle, from the axis + 1 towards axis + 2 (from
   x towards y for z), on that side of the body where the circle lies: as far along the axis as any of its nodes at this
   radius.
*/
#include "model/modelimpl.h"
#include "base/gather.h"
#include <stdlib.h>
#include <string.h>

#define MOST_NODES 1000
#define NEAR       0.05 /* of the radius: default of -tolerance */

/* The axis of words such as z+ */
static PetscErrorCode CircleSetFace(MPI_Comm comm, Circle *c)
{
  const char *axis = c->face[0] ? strchr("xyz", c->face[0]) : NULL;

  PetscFunctionBeginUser;
  PetscCheck(axis && (c->face[1] == '+' || c->face[1] == '-') && !c->face[2], comm, PETSC_ERR_USER_INPUT,
             "-%s_face '%s' must be x+, x-, y+, y-, z+ or z-: the side of the body on which the circle lies", c->name,
             c->face);
  c->axis = (int)(axis - "xyz");
  c->side = c->face[1] == '+' ? 1 : -1;
  PetscFunctionReturn(0);
}

PetscErrorCode CircleCheck(MPI_Comm comm, void *owner, void *record)
{
  Circle *c = record;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(CircleSetFace(comm, c));
  if (!c->has_tolerance) c->tolerance = NEAR * c->radius;
  PetscCheck(c->radius > 0, comm, PETSC_ERR_USER_INPUT, "-%s_radius %.6g must be given: a positive length (m)", c->name,
             (double)c->radius);
  PetscCheck(c->n >= 3 && c->n <= MOST_NODES, comm, PETSC_ERR_USER_INPUT,
             "-%s_count %" PetscInt_FMT " must be given: nodes of the circle, 3 to %d", c->name, c->n, MOST_NODES);
  PetscCheck(c->tolerance > 0, comm, PETSC_ERR_USER_INPUT, "-%s_tolerance %.6g must be a positive length (m)", c->name,
             (double)c->tolerance);
  PetscFunctionReturn(0);
}

/* Distance from the circle's axis, m */
static PetscReal CircleRadius(const Circle *c, const PetscReal x[3])
{
  const int a = (c->axis + 1) % 3, b = (c->axis + 2) % 3;

  return hypot(x[a] - c->centre[a], x[b] - c->centre[b]);
}

/* The middle of a part's bounding box */
static PetscErrorCode PartFindMiddle(Model model, PetscInt part, PetscReal centre[3])
{
  const Mesh *mesh = &model->mesh;
  PetscReal   low[6];

  PetscFunctionBeginUser;
  for (int d = 0; d < 6; d++) low[d] = PETSC_MAX_REAL;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (mesh->cell_part[c] != part) continue;
    for (PetscInt i = 3 * mesh->cell_first[c]; i < 3 * mesh->cell_first[c + 1]; i++) {
      const PetscReal x = mesh->x[3 * mesh->cell_node[i / 3] + i % 3];

      low[i % 3]     = PetscMin(low[i % 3], x);
      low[3 + i % 3] = PetscMin(low[3 + i % 3], -x);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, low, 6, MPIU_REAL, MPI_MIN, model->comm));
  for (int d = 0; d < 3; d++) centre[d] = 0.5 * (low[d] - low[3 + d]);
  PetscFunctionReturn(0);
}

/* How far along its axis the circle lies: as the outermost node of the part near its radius. Errors: none is near */
static PetscErrorCode CircleFindHeight(Model model, PetscInt part, Circle *c)
{
  const Mesh *mesh   = &model->mesh;
  PetscReal   far[3] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL}; /* height, -least and largest radius */

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < mesh->n_cells; k++) {
    for (PetscInt i = mesh->cell_first[k]; i < mesh->cell_first[k + 1] && mesh->cell_part[k] == part; i++) {
      const PetscReal *x      = &mesh->x[3 * mesh->cell_node[i]];
      const PetscReal  radius = CircleRadius(c, x);

      far[1] = PetscMax(far[1], -radius);
      far[2] = PetscMax(far[2], radius);
      if (PetscAbsReal(radius - c->radius) <= c->tolerance) far[0] = PetscMax(far[0], c->side * x[c->axis]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, far, 3, MPIU_REAL, MPI_MAX, model->comm));
  PetscCheck(
    far[0] > -PETSC_MAX_REAL, model->comm, PETSC_ERR_USER_INPUT,
    "-%s_radius %.6g m: no node of %s is within -%s_tolerance %.6g m of it; its nodes are %.6g to %.6g m from the "
    "axis",
    c->name, (double)c->radius, c->part, c->name, (double)c->tolerance, (double)-far[1], (double)far[2]);
  c->centre[c->axis] = c->side * far[0];
  PetscFunctionReturn(0);
}

/* The node of place k. Errors: it is not near */
static PetscErrorCode CircleFindNode(Model model, Circle *c, PetscInt k)
{
  const PetscReal angle    = 2 * PETSC_PI * (PetscReal)k / (PetscReal)c->n;
  Probe          *probe    = &c->probe[k];
  PetscReal       distance = 0;
  char            name[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s_%03" PetscInt_FMT, c->name, k));
  PetscCall(PetscStrallocpy(name, &probe->name));
  PetscCall(PetscStrallocpy(c->part, &probe->part));
  PetscCall(PetscArraycpy(probe->at, c->centre, 3));
  probe->at[(c->axis + 1) % 3] += c->radius * PetscCosReal(angle);
  probe->at[(c->axis + 2) % 3] += c->radius * PetscSinReal(angle);
  PetscCall(ProbeLocate(model, probe));
  for (int d = 0; d < 3; d++) distance += PetscSqr(probe->x[d] - probe->at[d]);
  distance = PetscSqrtReal(distance);
  PetscCheck(distance <= c->tolerance, model->comm, PETSC_ERR_USER_INPUT,
             "-%s_count %" PetscInt_FMT
             ": no node of %s is within -%s_tolerance %.6g m of %.6g, %.6g, %.6g m on the circle; "
             "the nearest is %.3g m away",
             c->name, c->n, c->part, c->name, (double)c->tolerance, (double)probe->at[0], (double)probe->at[1],
             (double)probe->at[2], (double)distance);
  PetscFunctionReturn(0);
}

static int PlaceCompare(const void *a, const void *b)
{
  return memcmp(a, b, 3 * sizeof(PetscReal));
}

/* Raises an error where two places of a circle have the same node */
static PetscErrorCode CircleCheckNodes(Model model, const Circle *c)
{
  PetscReal *x;
  PetscInt   n_different = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * c->n, &x));
  for (PetscInt k = 0; k < c->n; k++) PetscCall(PetscArraycpy(&x[3 * k], c->probe[k].x, 3));
  if (c->n) qsort(x, (size_t)c->n, 3 * sizeof(*x), PlaceCompare);
  for (PetscInt k = 1; k < c->n; k++) n_different += PlaceCompare(&x[3 * k], &x[3 * k - 3]) != 0;
  PetscCall(PetscFree(x));
  PetscCheck(n_different == c->n, model->comm, PETSC_ERR_USER_INPUT,
             "-%s_count %" PetscInt_FMT " is too many: there are %" PetscInt_FMT " different nodes near the circle",
             c->name, c->n, n_different);
  PetscFunctionReturn(0);
}

PetscErrorCode CirclesLocate(Model model)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_circles; i++) {
    Circle   *c = &model->scene.circles[i];
    PetscReal middle[3];
    PetscInt  part;

    PetscCall(ModelFindPart(model, c->name, c->part, &part));
    PetscCall(PartFindMiddle(model, part, middle));
    if (!c->has_centre) PetscCall(PetscArraycpy(c->centre, middle, 3));
    PetscCall(CircleFindHeight(model, part, c));
    PetscCall(PetscCalloc1(c->n, &c->probe));
    for (PetscInt k = 0; k < c->n; k++) PetscCall(CircleFindNode(model, c, k));
    PetscCall(CircleCheckNodes(model, c));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CirclesView(Model model, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_circles; i++) {
    const Circle *c    = &model->scene.circles[i];
    PetscReal     most = 0;

    for (PetscInt k = 0; k < c->n; k++) most = PetscMax(most, PetscAbsReal(CircleRadius(c, c->probe[k].x) - c->radius));
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  circle %s: %" PetscInt_FMT " nodes of %s about %.6g, %.6g, %.6g m, radius %.6g m to %.1e, along %c\n",
      c->name, c->n, c->part, (double)c->centre[0], (double)c->centre[1], (double)c->centre[2], (double)c->radius,
      (double)most, "xyz"[c->axis]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CirclesDestroy(Model model)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_circles; i++) {
    Circle *c = &model->scene.circles[i];

    for (PetscInt k = 0; k < c->n && c->probe; k++) {
      PetscCall(PetscFree(c->probe[k].name));
      PetscCall(PetscFree(c->probe[k].part));
    }
    PetscCall(PetscFree(c->probe));
  }
  PetscFunctionReturn(0);
}
