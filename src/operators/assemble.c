/*
   Matrices of the bodies, summed over cells: K (N/m), M (kg), and C = sum over parts of alpha M + beta K (N s/m);
   grounded springs on the diagonal of K, dashpots on that of C. C is made only where a part is damped or a dashpot
   exists.
*/
#include "operatorsimpl.h"

/* Whether anything of the model asks for a damping matrix */
static PetscErrorCode ModelIsDamped(Model model, PetscBool *damped)
{
  const Part     *parts;
  const Grounded *dashpots;
  PetscInt        n_parts, n_dashpots;

  PetscFunctionBeginUser;
  PetscCall(ModelGetParts(model, &n_parts, &parts));
  PetscCall(ModelGetDashpots(model, &n_dashpots, &dashpots));
  *damped = n_dashpots ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 0; i < n_parts; i++)
    if (parts[i].alpha > 0 || parts[i].beta > 0) *damped = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Replaces the consistent mass of an element by its row sums within each direction */
static void ElementLump(PetscInt n, PetscReal mass[])
{
  for (PetscInt i = 0; i < n; i++) {
    PetscReal sum = 0;

    for (PetscInt j = 0; j < n; j++) {
      if (j % 3 == i % 3) sum += mass[i * n + j];
      mass[i * n + j] = 0;
    }
    mass[i * n + i] = sum;
  }
}

/* Adds one cell of the given material to K, M and C */
static PetscErrorCode CellAdd(Operators o, const Element *element, const Part *part, const PetscReal x[],
                              const PetscInt rows[])
{
  const PetscInt   n        = 3 * element->n_nodes;
  const Elasticity material = ElasticityFromEngineering(part->young, part->poisson, part->density);
  PetscReal        ke[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS], me[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCheck(!element->matrices(x, &material, ke, me), PETSC_COMM_SELF, PETSC_ERR_PLIB, "element is inverted");
  if (o->lump) ElementLump(n, me);
  PetscCall(MatSetValues(o->A[OPERATOR_K], n, rows, n, rows, ke, ADD_VALUES));
  PetscCall(MatSetValues(o->A[OPERATOR_M], n, rows, n, rows, me, ADD_VALUES));
  if (!o->A[OPERATOR_C]) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n * n; i++) me[i] = part->alpha * me[i] + part->beta * ke[i];
  PetscCall(MatSetValues(o->A[OPERATOR_C], n, rows, n, rows, me, ADD_VALUES));
  PetscFunctionReturn(0);
}

/* Adds all local cells */
static PetscErrorCode CellsAdd(Operators o, DM dm)
{
  const Element  *element;
  const Part     *parts;
  const PetscInt *cell_part, *unknowns;
  PetscInt        cStart, cEnd, vStart, n_parts;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  PetscCall(ModelGetElement(o->model, &element));
  PetscCall(ModelGetParts(o->model, &n_parts, &parts));
  PetscCall(ModelGetCellParts(o->model, &cell_part));
  PetscCall(ModelGetUnknowns(o->model, &unknowns));
  for (PetscInt c = 0; c < cEnd - cStart; c++) {
    PetscInt  vertices[ELEMENT_MAX_NODES], rows[ELEMENT_MAX_DOFS];
    PetscReal x[ELEMENT_MAX_DOFS];

    PetscCall(ModelGetCell(o->model, c, vertices, x));
    for (PetscInt i = 0; i < 3 * element->n_nodes; i++) rows[i] = unknowns[3 * (vertices[i / 3] - vStart) + i % 3];
    PetscCall(CellAdd(o, element, &parts[cell_part[c]], x, rows));
  }
  PetscFunctionReturn(0);
}

/* Adds grounded springs or dashpots to the diagonal of A */
static PetscErrorCode GroundedAdd(Model model, DM dm, PetscInt n, const Grounded grounded[], Mat A)
{
  const PetscInt *unknowns, *vertices;
  PetscInt        vStart, n_vertices;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  PetscCall(ModelGetUnknowns(model, &unknowns));
  for (PetscInt i = 0; i < n; i++) {
    IS is;

    PetscCall(ModelGetOwnedVertices(model, grounded[i].set, &is));
    PetscCall(ISGetLocalSize(is, &n_vertices));
    PetscCall(ISGetIndices(is, &vertices));
    for (PetscInt j = 0; j < 3 * n_vertices; j++) {
      const PetscInt row = unknowns[3 * (vertices[j / 3] - vStart) + j % 3];

      PetscCall(MatSetValues(A, 1, &row, 1, &row, &grounded[i].value[j % 3], ADD_VALUES));
    }
    PetscCall(ISRestoreIndices(is, &vertices));
    PetscCall(ISDestroy(&is));
  }
  PetscFunctionReturn(0);
}

/* Ends the assembly of all matrices */
static PetscErrorCode AssemblyEnd(Operators o)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_OPERATORS; i++)
    if (o->A[i]) PetscCall(MatAssemblyBegin(o->A[i], MAT_FINAL_ASSEMBLY));
  for (int i = 0; i < N_OPERATORS; i++)
    if (o->A[i]) PetscCall(MatAssemblyEnd(o->A[i], MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAssemble(Operators o)
{
  const Grounded *springs, *dashpots;
  PetscInt        n_springs, n_dashpots, n_unknowns;
  PetscBool       damped;
  DM              dm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetDM(o->model, &dm));
  PetscCall(ModelGetSprings(o->model, &n_springs, &springs));
  PetscCall(ModelGetDashpots(o->model, &n_dashpots, &dashpots));
  PetscCall(ModelIsDamped(o->model, &damped));
  PetscCall(PatternCreate(o->model, &o->A[OPERATOR_K]));
  PetscCall(MatGetSize(o->A[OPERATOR_K], &n_unknowns, NULL));
  PetscCheck(n_unknowns, o->comm, PETSC_ERR_USER_INPUT, "the -supports hold every node: nothing can vibrate");
  PetscCall(MatDuplicate(o->A[OPERATOR_K], MAT_DO_NOT_COPY_VALUES, &o->A[OPERATOR_M]));
  if (damped) PetscCall(MatDuplicate(o->A[OPERATOR_K], MAT_DO_NOT_COPY_VALUES, &o->A[OPERATOR_C]));
  PetscCall(CellsAdd(o, dm));
  PetscCall(GroundedAdd(o->model, dm, n_springs, springs, o->A[OPERATOR_K]));
  if (damped) PetscCall(GroundedAdd(o->model, dm, n_dashpots, dashpots, o->A[OPERATOR_C]));
  PetscCall(AssemblyEnd(o));
  PetscFunctionReturn(0);
}
