/*
   Checks of the undistributed mesh on rank 0, where cells still have the numbers of their source: every cell must have
   a positive Jacobian, and be so near to the origin that its coordinates have digits. Warnings of elements that are too
   stiff.
*/
#include "model/modelimpl.h"
#include "base/text.h"

#define FLAT      1e-8 /* smallest admissible Jacobian relative to that of the bounding box */
#define FAR       1e-9 /* relative rounding of the length of an edge above which digits of the results are lost, */
#define SHAPELESS 1e-3 /* and above which its shape is */

/* Shortest distance of two corners of a cell, 0 left out, and largest of their coordinates in absolute value, m */
static PetscReal CellSmallest(const Element *element, const PetscReal x[], PetscReal *most)
{
  PetscReal least = PETSC_MAX_REAL;

  *most = 0;
  for (PetscInt i = 0; i < element->n_corners; i++) {
    for (int d = 0; d < 3; d++) *most = PetscMax(*most, PetscAbsReal(x[3 * i + d]));
    for (PetscInt j = 0; j < i; j++) {
      PetscReal square = 0;

      for (int d = 0; d < 3; d++) square += PetscSqr(x[3 * i + d] - x[3 * j + d]);
      if (square > 0) least = PetscMin(least, PetscSqrtReal(square));
    }
  }
  return least;
}

/* The largest relative rounding of an edge, that of the distance from the origin, eps |x|, over its length; writes a
   message about its cell into text where it is too large */
static PetscErrorCode FindFarCell(Model model, size_t size, char text[], PetscReal *rounding)
{
  const Mesh *mesh = &model->mesh;

  PetscFunctionBeginUser;
  *rounding = FAR;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *element;
    PetscInt       nodes[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS], most, least;

    if (!mesh->element[c]) continue;
    PetscCall(ModelGetCell(model, c, &element, nodes, x));
    least = CellSmallest(element, x, &most);
    if (PETSC_MACHINE_EPSILON * most <= *rounding * least) continue;
    *rounding = PETSC_MACHINE_EPSILON * most / least;
    PetscCall(PetscSNPrintf(
      text, size,
      "element %" PetscInt_FMT " (%s, part %s) with an edge of %.3g m is %.3g m from the origin, where numbers "
      "are rounded to %.2g of that edge; move the mesh to the origin",
      c + 1, element->name, mesh->part[mesh->cell_part[c]], (double)least, (double)most, (double)*rounding));
  }
  PetscFunctionReturn(0);
}

/* Writes a message about the first bad cell into text, which stays empty when all are good */
static PetscErrorCode FindBadCell(Model model, size_t size, char text[])
{
  const Mesh *mesh = &model->mesh;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells && !text[0]; c++) {
    const Element *element;
    PetscInt       nodes[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS], centre[3] = {0, 0, 0}, volume, jacobian;

    PetscCheck(mesh->element[c], PETSC_COMM_SELF, PETSC_ERR_PLIB, "cell without a row in the table of elements");
    PetscCall(ModelGetCell(model, c, &element, nodes, x));
    element->measure(element->solid, x, &volume, &jacobian);
    if (jacobian > FLAT) continue;
    for (PetscInt i = 0; i < 3 * element->n_corners; i++) centre[i % 3] += x[i] / (PetscReal)element->n_corners;
    PetscCall(PetscSNPrintf(
      text, size, "element %" PetscInt_FMT " (%s, part %s, centre %.6g, %.6g, %.6g m) is inverted or has no volume%s",
      c + 1, element->name, mesh->part[mesh->cell_part[c]], (double)centre[0], (double)centre[1], (double)centre[2],
      element->n_nodes > element->n_corners ? " at a quadrature point or node" : ""));
  }
  PetscFunctionReturn(0);
}

/* Whether any rank has a cell for which -model_element chooses */
static PetscErrorCode FormulationIsUsed(Model model, PetscBool *used)
{
  PetscFunctionBeginUser;
  *used = PETSC_FALSE;
  for (PetscInt c = 0; c < model->mesh.n_cells && !*used; c++)
    *used = model->mesh.element[c] && model->mesh.element[c]->formulation ? PETSC_TRUE : PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, used, 1, MPIU_BOOL, MPI_LOR, model->comm));
  PetscFunctionReturn(0);
}

/* The rows of the table that the cells of all ranks have, by name, with their numbers; returns how many rows */
static PetscErrorCode ElementsCount(Model model, const Element *found[], PetscInt count[], PetscInt *n)
{
  PetscFunctionBeginUser;
  for (*n = 0; (found[*n] = ElementGet(*n)); ++*n) {
    count[*n] = 0;
    for (PetscInt c = 0; c < model->mesh.n_cells; c++) count[*n] += model->mesh.element[c] == found[*n];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, (PetscMPIInt)*n, MPIU_INT, MPI_SUM, model->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshDescribe(Model model, size_t size, char words[])
{
  const Element *found[ELEMENT_MAX_ROWS];
  PetscInt       count[ELEMENT_MAX_ROWS], n, n_used = 0;
  char           one[64];

  PetscFunctionBeginUser;
  PetscCall(ElementsCount(model, found, count, &n));
  words[0] = 0;
  for (PetscInt i = 0; i < n; i++) n_used += count[i] > 0;
  for (PetscInt i = 0; i < n; i++) {
    if (!count[i]) continue;
    if (n_used == 1) PetscCall(PetscStrncpy(words, found[i]->description, size));
    PetscCall(
      PetscSNPrintf(one, sizeof(one), "%s%" PetscInt_FMT " %s", words[0] ? ", " : "", count[i], found[i]->name));
    if (n_used > 1) PetscCall(WordsAdd(words, one, size));
  }
  PetscFunctionReturn(0);
}

/* Warns of elements that are too stiff */
static PetscErrorCode ElementsWarn(Model model)
{
  const Element *found[ELEMENT_MAX_ROWS];
  PetscInt       count[ELEMENT_MAX_ROWS], n;

  PetscFunctionBeginUser;
  PetscCall(ElementsCount(model, found, count, &n));
  for (PetscInt i = 0; i < n; i++)
    if (count[i] && found[i]->warning)
      PetscCall(PetscFPrintf(model->comm, stderr, "squeal: warning: %" PetscInt_FMT " cells are %s, which is %s\n",
                             count[i], found[i]->name, found[i]->warning));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshCheck(Model model)
{
  char      text[512] = "";
  PetscReal rounding;
  PetscBool used;

  PetscFunctionBeginUser;
  PetscCheck(ElementIsFormulation(model->formulation), model->comm, PETSC_ERR_USER_INPUT,
             "-model_element %s is no formulation; there are: %s", model->formulation, ElementFormulations());
  PetscCall(FindFarCell(model, sizeof(text), text, &rounding)); /* all cells are on rank 0 */
  if (text[0] && rounding < SHAPELESS) {
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, stderr, "squeal: warning: %s\n", text));
    text[0] = 0;
  }
  if (!text[0]) PetscCall(FindBadCell(model, sizeof(text), text));
  PetscCallMPI(MPI_Bcast(text, sizeof(text), MPI_CHAR, 0, model->comm));
  PetscCheck(!text[0], model->comm, PETSC_ERR_USER_INPUT, "%s", text);
  PetscCall(FormulationIsUsed(model, &used));
  PetscCheck(used || !model->has_formulation, model->comm, PETSC_ERR_USER_INPUT,
             "-model_element %s does nothing: it is for 8-node hexahedra, and the mesh has none", model->formulation);
  PetscCall(ElementsWarn(model));
  PetscFunctionReturn(0);
}
