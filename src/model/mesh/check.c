/*
   Checks of the undistributed mesh on rank 0, where cells still have the numbers of their source: every cell must
   have a row in the table of elements, and a positive Jacobian.
*/
#include "model/modelimpl.h"

#define FLAT 1e-8 /* smallest admissible Jacobian relative to the volume of the bounding box */

/* The first name among the parts that marks the cell, for messages */
static PetscErrorCode CellPartName(Model model, PetscInt cell, const char **name)
{
  PetscInt value;

  PetscFunctionBeginUser;
  *name = "none";
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    PetscCall(DMGetLabelValue(model->dm, model->scene.parts[i].name, cell, &value));
    if (value == 1) *name = model->scene.parts[i].name;
  }
  PetscFunctionReturn(0);
}

/* Corners x[n_nodes][3] of a cell of the serial mesh in the element's order, and their mean; false where a node stands
   twice, which a closure holds once */
static PetscErrorCode CellCorners(DM dm, const Element *element, PetscInt cell, PetscReal x[], PetscReal centre[3],
                                  PetscBool *whole)
{
  PetscScalar *values = NULL;
  PetscSection section;
  Vec          coordinates;
  PetscInt     n;

  PetscFunctionBeginUser;
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMPlexVecGetClosure(dm, section, coordinates, cell, &n, &values));
  *whole = n == 3 * element->n_nodes ? PETSC_TRUE : PETSC_FALSE;
  for (int d = 0; d < 3; d++) centre[d] = 0;
  for (PetscInt i = 0; i < element->n_nodes && *whole; i++)
    for (int d = 0; d < 3; d++) {
      x[3 * i + d] = values[3 * element->closure_order[i] + d];
      centre[d] += x[3 * i + d] / (PetscReal)element->n_nodes;
    }
  PetscCall(DMPlexVecRestoreClosure(dm, section, coordinates, cell, &n, &values));
  PetscFunctionReturn(0);
}

/* Writes a message about the first bad cell of the serial mesh into text, which stays empty when all are good */
static PetscErrorCode FindBadCell(Model model, char text[], size_t size)
{
  PetscInt cStart, cEnd;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, &cEnd));
  for (PetscInt c = cStart; c < cEnd && !text[0]; c++) {
    PetscReal      x[3 * ELEMENT_MAX_NODES], centre[3], volume, jacobian;
    DMPolytopeType shape;
    const Element *element;
    const char    *part;
    PetscBool      whole;

    PetscCall(DMPlexGetCellType(model->dm, c, &shape));
    element = ElementFind(shape, model->formulation);
    if (!element) {
      PetscCall(PetscSNPrintf(
        text, size, "element %" PetscInt_FMT " is a %s, for which there is no formulation '%s'; there are: %s",
        c - cStart + 1, DMPolytopeTypes[shape], model->formulation, ElementNames()));
      break;
    }
    PetscCall(CellCorners(model->dm, element, c, x, centre, &whole));
    if (whole) element->measure(x, &volume, &jacobian);
    if (whole && jacobian > FLAT) continue;
    PetscCall(CellPartName(model, c, &part));
    if (!whole) {
      PetscCall(PetscSNPrintf(
        text, size, "element %" PetscInt_FMT " (part %s) has a node twice; give %" PetscInt_FMT " different ones",
        c - cStart + 1, part, element->n_nodes));
      break;
    }
    PetscCall(PetscSNPrintf(
      text, size, "element %" PetscInt_FMT " (part %s, centre %.6g, %.6g, %.6g m) is inverted or has no volume",
      c - cStart + 1, part, (double)centre[0], (double)centre[1], (double)centre[2]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MeshCheck(Model model)
{
  char        text[512] = "";
  PetscMPIInt rank;
  PetscInt    cStart, shape = DM_POLYTOPE_UNKNOWN;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->comm, &rank));
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, NULL));
  if (rank == 0) {
    DMPolytopeType first;

    PetscCall(FindBadCell(model, text, sizeof(text)));
    PetscCall(DMPlexGetCellType(model->dm, cStart, &first));
    shape = (PetscInt)first;
  }
  PetscCallMPI(MPI_Bcast(text, sizeof(text), MPI_CHAR, 0, model->comm));
  PetscCallMPI(MPI_Bcast(&shape, 1, MPIU_INT, 0, model->comm));
  PetscCheck(!text[0], model->comm, PETSC_ERR_USER_INPUT, "%s", text);
  model->scene.element = ElementFind((DMPolytopeType)shape, model->formulation);
  PetscFunctionReturn(0);
}
