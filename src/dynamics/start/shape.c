/*
   Shape: a mode that was read is laid on the mesh of this run.

   A place in space does not name a node, since nodes of bodies in contact may coincide; cells do not overlap, so that
   their centres are unique. Every local cell is looked up by its centre, and then its nodes among those of the cell
   found. Cells of the file are sorted by their height along an oblique direction: few centres of a regular mesh share
   one.
*/
#include "shape.h"

/* of positions, relative to the diagonal of the mesh: files hold all digits */
#define TOLERANCE 1e-9

/* Powers -1, -2 and -4 of the plastic number (p^3 = p + 1): a unit vector without small rational ratios */
static const PetscReal oblique[3] = {0.754877666246692760, 0.569840290998053266, 0.324717957244746026};

/* The local nodes on which the shape is laid */
typedef struct {
  Model       model;
  const char *option;  /* that asks for it */
  PetscReal  *re, *im; /* [nodes][3] */
} ShapeTarget;

static PetscReal ShapeHeight(const PetscReal x[3])
{
  return oblique[0] * x[0] + oblique[1] * x[1] + oblique[2] * x[2];
}

static PetscReal ShapeDistance(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}

/* Tolerance, centres, and cells by height */
static PetscErrorCode ShapeSort(Shape *shape)
{
  PetscReal lower[3], upper[3];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) lower[d] = PETSC_MAX_REAL, upper[d] = PETSC_MIN_REAL;
  for (PetscInt i = 0; i < 3 * shape->n_points; i++) {
    lower[i % 3] = PetscMin(lower[i % 3], shape->points[i]);
    upper[i % 3] = PetscMax(upper[i % 3], shape->points[i]);
  }
  shape->tolerance = TOLERANCE * ShapeDistance(lower, upper);
  PetscCall(PetscCalloc1(3 * shape->n_cells, &shape->centres));
  PetscCall(PetscMalloc2(shape->n_cells, &shape->height, shape->n_cells, &shape->cell));
  for (PetscInt c = 0; c < shape->n_cells; c++) {
    PetscReal *const x = &shape->centres[3 * c];
    const PetscInt   n = shape->first[c + 1] - shape->first[c];

    for (PetscInt i = shape->first[c]; i < shape->first[c + 1]; i++)
      for (int d = 0; d < 3; d++) x[d] += shape->points[3 * shape->nodes[i] + d] / (PetscReal)n;
    shape->height[c] = ShapeHeight(x);
    shape->cell[c]   = c;
  }
  PetscCall(PetscSortRealWithArrayInt(shape->n_cells, shape->height, shape->cell));
  PetscFunctionReturn(0);
}

/* Cell of the file with this centre, -1 without one */
static PetscInt ShapeFindCell(const Shape *shape, const PetscReal centre[3])
{
  const PetscReal height = ShapeHeight(centre);
  PetscInt        low = 0, high = shape->n_cells;

  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;

    if (shape->height[middle] < height - shape->tolerance)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < shape->n_cells && shape->height[low] <= height + shape->tolerance; low++)
    if (ShapeDistance(&shape->centres[3 * shape->cell[low]], centre) <= shape->tolerance) return shape->cell[low];
  return -1;
}

/* Point of the file at x among the nodes of a cell, -1 without one */
static PetscInt ShapeFindNode(const Shape *shape, PetscInt cell, const PetscReal x[3])
{
  if (cell < 0) return -1;
  for (PetscInt i = shape->first[cell]; i < shape->first[cell + 1]; i++)
    if (ShapeDistance(&shape->points[3 * shape->nodes[i]], x) <= shape->tolerance) return shape->nodes[i];
  return -1;
}

/* Lays the shape on the nodes of local cell c */
static PetscErrorCode ShapeFillCell(const Shape *shape, PetscInt c, const ShapeTarget *to, Fault *fault)
{
  const Element *element;
  PetscInt       nodes[ELEMENT_MAX_NODES], cell;
  PetscReal      x[3 * ELEMENT_MAX_NODES], centre[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(ModelGetCell(to->model, c, &element, nodes, x));
  for (PetscInt i = 0; i < 3 * element->n_nodes; i++) centre[i % 3] += x[i] / (PetscReal)element->n_nodes;
  cell = ShapeFindCell(shape, centre);
  for (PetscInt i = 0; i < element->n_nodes && !fault->code; i++) {
    const PetscInt v = nodes[i], p = ShapeFindNode(shape, cell, &x[3 * i]);

    if (p < 0)
      PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                          "the mesh of %s has no node at %.9g, %.9g, %.9g m of a cell about %.9g, %.9g, %.9g "
                          "m; it must be the mesh of this run",
                          to->option, (double)x[3 * i], (double)x[3 * i + 1], (double)x[3 * i + 2], (double)centre[0],
                          (double)centre[1], (double)centre[2]));
    for (int d = 0; d < 3 && p >= 0; d++) {
      to->re[3 * v + d] = shape->re[3 * p + d];
      to->im[3 * v + d] = shape->im[3 * p + d];
    }
  }
  PetscFunctionReturn(0);
}

/* Lays the shape on all local cells */
static PetscErrorCode ShapeFillCells(MPI_Comm comm, const Shape *shape, const ShapeTarget *to, Fault *fault)
{
  const Mesh *mesh;
  PetscInt    n_cells;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(to->model, &mesh));
  PetscCall(PetscArrayzero(to->re, 3 * mesh->n_nodes));
  PetscCall(PetscArrayzero(to->im, 3 * mesh->n_nodes));
  n_cells = mesh->n_cells;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_cells, 1, MPIU_INT, MPI_SUM, comm));
  for (PetscInt c = 0; c < mesh->n_cells && !fault->code; c++) PetscCall(ShapeFillCell(shape, c, to, fault));
  PetscCall(FaultsAgree(comm, fault)); /* a place says more than numbers */
  if (n_cells != shape->n_cells)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                        "the mesh of %s has %" PetscInt_FMT " cells, that of this run %" PetscInt_FMT, to->option,
                        shape->n_cells, n_cells));
  PetscFunctionReturn(0);
}

PetscErrorCode ShapeRead(Model model, const ShapeSource *source, PetscReal re[], PetscReal im[], PetscReal lambda[2])
{
  ShapeTarget to    = {.model = model, .option = source->option, .re = re, .im = im};
  Shape       shape = {.n_cells = 0};
  Fault       fault = {.code = 0};
  MPI_Comm    comm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ShapeReadTable(source, lambda, &fault));
  PetscCall(ShapeReadField(source, lambda[1], &shape, &fault));
  PetscCall(FaultsAgree(comm, &fault));
  if (!fault.code) {
    PetscCall(ShapeSort(&shape));
    PetscCall(ShapeFillCells(comm, &shape, &to, &fault));
  }
  PetscCall(PetscFree(shape.points));
  PetscCall(PetscFree(shape.re));
  PetscCall(PetscFree(shape.im));
  PetscCall(PetscFree(shape.first));
  PetscCall(PetscFree(shape.nodes));
  PetscCall(PetscFree(shape.centres));
  PetscCall(PetscFree2(shape.height, shape.cell));
  PetscCall(FaultsRaise(comm, &fault));
  PetscFunctionReturn(0);
}
