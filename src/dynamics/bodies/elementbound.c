/*
   Bound of the largest omega^2 from single elements (B. M. Irons and G. Treharne, 1971): with K and M sums over cells,
   max x'Kx / x'Mx <= max over cells of the same quotient; with C_e = alpha M_e + beta K_e the quotient of K_e + s C_e
   is (1 + s beta) lambda_e + s alpha, and with Maxwell branches as springs beside it (1 + sum_j E_j / E + s beta)
   lambda_e + s alpha. Springs and dashpots add at most (k + s c) / m of a node,
   bushings and points the trace of diag(k + s c) B M^-1 B', superelements likewise one (points/superelement.c).
*/
#include "bodiesimpl.h"
#include <petscblaslapack.h>

/* A = M_e^-1/2 K_e M_e^-1/2, 1/s^2, with the cell's own lumped masses: those of its nodes in the mesh are larger */
static void BoundScale(const BodiesCell *cell, PetscReal a[])
{
  const PetscInt n = 3 * cell->n_nodes;
  PetscReal      scale[ELEMENT_MAX_DOFS];

  for (PetscInt i = 0; i < n; i++) scale[i] = 1 / PetscSqrtReal(cell->mass[i / 3]);
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) a[n * i + j] = scale[i] * cell->stiffness[n * i + j] * scale[j];
}

/* Whether no eigenvalue of A is above a limit: then limit - A has a Cholesky factor, at a tenth of the eigenvalues'
   cost */
static PetscErrorCode BoundIsBelow(const BodiesCell *cell, PetscReal limit, PetscBool *below)
{
  const PetscInt n = 3 * cell->n_nodes;
  PetscReal      a[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];
  PetscBLASInt   size, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  BoundScale(cell, a);
  for (PetscInt i = 0; i < n * n; i++) a[i] = (i % (n + 1) ? 0 : limit) - a[i];
  LAPACKpotrf_("U", &size, a, &size, &info);
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's potrf failed with info %d", (int)info);
  *below = info ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Largest eigenvalue of A */
static PetscErrorCode BoundOfCell(const BodiesCell *cell, PetscReal *largest)
{
  const PetscInt n = 3 * cell->n_nodes;
  PetscReal      a[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS], w[ELEMENT_MAX_DOFS], work[8 * ELEMENT_MAX_DOFS];
  PetscBLASInt   size, n_work = 8 * ELEMENT_MAX_DOFS, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  BoundScale(cell, a);
  LAPACKsyev_("N", "U", &size, a, &size, w, work, &n_work, &info);
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's syev failed with info %d", (int)info);
  *largest = w[n - 1];
  PetscFunctionReturn(0);
}

/* Whether another cell of the same column stands for this one: swept bodies are looked at at node 0 alone. first
   [n_vertices] flags the nodes 0 of lines, swept the nodes of swept bodies */
static PetscBool BoundIsRepeated(PetscInt n_nodes, const PetscInt vertex[], const PetscBool first[],
                                 const PetscBool swept[])
{
  if (!swept[vertex[0]]) return PETSC_FALSE;
  for (PetscInt a = 0; a < n_nodes; a++)
    if (first[vertex[a]]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether nothing of a cell may move */
static PetscBool BoundIsHeld(Bodies b, PetscInt n_nodes, const PetscInt vertex[])
{
  for (PetscInt a = 0; a < n_nodes; a++)
    for (int j = 0; j < 3; j++)
      if (b->layout.minv[b->layout.at[vertex[a]] + j * b->layout.step[vertex[a]]] > 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

static void BoundFlagSwept(Bodies b, PetscBool first[], PetscBool swept[])
{
  for (PetscInt i = 0; i < b->n_swept; i++) {
    const ModelLines *lines = b->swept[i].lines;

    for (PetscInt j = 0; j < lines->n_lines * lines->n_nodes; j++) swept[lines->vertex[j]] = PETSC_TRUE;
    for (PetscInt l = 0; l < lines->n_lines; l++) first[lines->vertex[lines->n_nodes * l]] = PETSC_TRUE;
  }
}

static PetscErrorCode BoundOfCells(Bodies b, PetscReal s, PetscReal *largest)
{
  PetscBool *first, *swept;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(b->layout.n_vertices, &first, b->layout.n_vertices, &swept));
  BoundFlagSwept(b, first, swept);
  *largest = 0;
  for (PetscInt c = 0; c < b->mesh->n_cells; c++) {
    const PetscInt  n_nodes = b->mesh->element[c]->n_nodes;
    const PetscInt *vertex  = &b->mesh->cell_node[b->mesh->cell_first[c]];
    PetscReal       lambda;
    PetscBool       below;
    BodiesCell      cell;

    if (BoundIsRepeated(n_nodes, vertex, first, swept) || BoundIsHeld(b, n_nodes, vertex)) continue;
    PetscCall(BodiesGetCell(b, c, &cell));
    /* most cells are below the largest so far, and need no eigenvalues */
    PetscCall(BoundIsBelow(&cell, (*largest - s * cell.alpha) / (1 + cell.branches + s * cell.beta), &below));
    if (below) continue;
    PetscCall(BoundOfCell(&cell, &lambda));
    *largest = PetscMax(*largest, (1 + cell.branches + s * cell.beta) * lambda + s * cell.alpha);
  }
  PetscCall(PetscFree2(first, swept));
  PetscFunctionReturn(0);
}

/* Largest (k + s c) / m of the nodes; the trace bounds the largest direction */
static void BoundOfPoints(Bodies b, PetscReal s, PetscReal *largest)
{
  *largest = 0;
  for (PetscInt i = 0; i < b->n_points; i++) {
    const Point    *point = &b->point[i];
    const PetscReal m     = b->layout.total[b->layout.at[point->vertex]];
    PetscReal       trace = 0;

    for (int j = 0; j < 9; j += 4) trace += point->stiffness[j] + s * point->damping[j];
    *largest = PetscMax(*largest, trace / m);
  }
}

PetscErrorCode BodiesGetElementBound(Bodies b, PetscReal s, PetscReal *bound)
{
  PetscReal largest[2];

  PetscFunctionBeginUser;
  PetscCall(BoundOfCells(b, s, &largest[0]));
  BoundOfPoints(b, s, &largest[1]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPIU_REAL, MPI_MAX, b->comm));
  *bound = largest[0] + largest[1];
  PetscCall(JointsAddBound(b, s, bound));
  *bound += b->super.bound[0] + s * b->super.bound[1];
  PetscFunctionReturn(0);
}
