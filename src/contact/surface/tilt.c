/*
   Turning of the master's normal. The normal of a pair is n = a / |a|, a = sum_i w_i a_i, where a_i (m^2) sums the area
   vectors of the facets around the master's node i (kernels/contact/facet.h) or, on facets of second order, is the unit
   vector along that sum A_i. With displacements u of the surface

      delta A_i = sum_j u_j x c_ij,   delta a_i = delta A_i or (I - a_i a_i') delta A_i / |A_i|,
      delta n = (I - n n') sum_i w_i delta a_i / |a|,

   the derivative of the very normal that pairing makes: a rigid rotation w gives w x n to rounding, on any surface. The
   tilt operators are its components along t and b; displacements within a flat surface do not tilt it.
*/
#include "contact/contactimpl.h"

/* Entries of a list of facets, those that are not zero by nature: component d of u x c takes the others of u */
typedef struct {
  PetscInt     n, *row, *column;
  PetscScalar *value;
} TurningEntries;

static void FacetEntries(const ContactFacet *facet, TurningEntries *e)
{
  double    c[FACET_NODES][FACET_NODES][3] = {0};
  const int n                              = facet->n;

  FacetTurning(n, (const double(*)[3])facet->x, c);
  for (int ij = 0; ij < n * n; ij++) {
    const int i = ij / n, j = ij % n;

    for (int d = 0; d < 3; d++) {
      for (int k = 1; k < 3; k++, e->n++) { /* (u x c)_d = u_(d+1) c_(d+2) - u_(d+2) c_(d+1) */
        e->row[e->n]    = 3 * facet->node[i] + d;
        e->column[e->n] = facet->unknowns[j][(d + k) % 3];
        e->value[e->n]  = k == 1 ? c[i][j][(d + 2) % 3] : -c[i][j][(d + 1) % 3];
      }
    }
  }
}

/* Area vectors A_i (m^2) of facets of second order at their nodes, summed in the places of their rows; 0 at nodes of
   other facets alone. They are summed anew, since facet->across has unit vectors there. */
static PetscErrorCode AreasCreate(Mat turning, PetscInt n, const ContactFacet facet[], Vec *areas)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(turning, NULL, areas));
  PetscCall(VecSetBlockSize(*areas, 3));
  for (PetscInt f = 0; f < n; f++) {
    PetscReal share[FACET_NODES][3];

    if (ContactFacetCorners(&facet[f]) == facet[f].n) continue;
    FacetNodeNormals(facet[f].n, (const double(*)[3])facet[f].x, share);
    PetscCall(VecSetValuesBlocked(*areas, facet[f].n, facet[f].node, &share[0][0], ADD_VALUES));
  }
  PetscCall(VecAssemblyBegin(*areas));
  PetscCall(VecAssemblyEnd(*areas));
  PetscFunctionReturn(0);
}

/* The derivatives of A_i of facets of second order become those of the unit vectors along them: rows of node i are
   multiplied by P_i = (I - a_i a_i') / |A_i| (1/m^2), a_i = A_i / |A_i|, a block of 3 by 3; P_i = I where A_i = 0, on
   facets of first order */
static PetscErrorCode TurningNormalise(PetscInt n, const ContactFacet facet[], Mat *turning)
{
  const PetscScalar *area;
  PetscInt           first, last;
  Vec                areas;
  Mat                P, product;

  PetscFunctionBeginUser;
  PetscCall(AreasCreate(*turning, n, facet, &areas));
  PetscCall(MatGetOwnershipRange(*turning, &first, &last));
  PetscCall(MatCreateAIJ(PetscObjectComm((PetscObject)areas), last - first, last - first, PETSC_DETERMINE,
                         PETSC_DETERMINE, 3, NULL, 0, NULL, &P));
  PetscCall(VecGetArrayRead(areas, &area));
  for (PetscInt row = first; row < last; row += 3) {
    const PetscScalar *A      = &area[row - first];
    const PetscReal    length = Vec3Length(A);

    for (int k = 0; k < 9; k++) {
      const PetscReal one  = k % 4 == 0 ? 1 : 0;
      const PetscReal part = length > 0 ? (one - A[k / 3] / length * A[k % 3] / length) / length : one;

      PetscCall(MatSetValue(P, row + k / 3, row + k % 3, part, INSERT_VALUES));
    }
  }
  PetscCall(VecRestoreArrayRead(areas, &area));
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatMatMult(P, *turning, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
  PetscCall(MatProductClear(product));
  PetscCall(MatDestroy(&P));
  PetscCall(MatDestroy(turning));
  PetscCall(VecDestroy(&areas));
  *turning = product;
  PetscFunctionReturn(0);
}

/* Derivatives of the vectors a_i of a surface at its nodes, shape [3 nodes][unknowns]: row 3 v + d belongs to component
   d of node v (global number) */
static PetscErrorCode TurningCreate(Contact contact, const char set[], Mat *turning)
{
  const Mesh    *mesh;
  PetscInt       n_rows = 0, n, room = 0;
  PetscBool      second = PETSC_FALSE;
  TurningEntries e      = {.n = 0};
  ContactFacet  *facets;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) n_rows += mesh->owned[v] ? 3 : 0;
  PetscCall(ContactFacetsLocal(contact->model, set, &n, &facets));
  for (PetscInt f = 0; f < n; f++) {
    room += 6 * facets[f].n * facets[f].n;
    if (ContactFacetCorners(&facets[f]) < facets[f].n) second = PETSC_TRUE;
  }
  /* the product below is collective: a rank without faces of second order takes part */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &second, 1, MPIU_BOOL, MPI_LOR, contact->comm));
  PetscCall(PetscMalloc3(room, &e.row, room, &e.column, room, &e.value));
  for (PetscInt f = 0; f < n; f++) FacetEntries(&facets[f], &e);
  PetscCall(MatCreate(contact->comm, turning));
  PetscCall(MatSetSizes(*turning, n_rows, mesh->n_own, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*turning, MATAIJ));
  PetscCall(MatSetPreallocationCOO(*turning, e.n, e.row, e.column));
  PetscCall(MatSetValuesCOO(*turning, e.value, INSERT_VALUES));
  PetscCall(PetscFree3(e.row, e.column, e.value));
  if (second) PetscCall(TurningNormalise(n, facets, turning));
  PetscCall(PetscFree(facets));
  PetscFunctionReturn(0);
}

/* sum_i w_i d . a_i / |a| for the pairs of an interface, d = t or b by its offset in ContactPair; other rows are
   empty. d is across n, so that the projection (I - n n') of the header needs no factor of its own. */
static PetscErrorCode InterpolationCreate(Contact contact, PetscInt interface, size_t offset, PetscInt n_columns,
                                          Mat *P)
{
  const PetscInt        n_entries = 3 * CONTACT_MAX_MASTER;
  const ContactSurface *surface;
  PetscInt              row;

  PetscFunctionBeginUser;
  PetscCall(ContactGetSurface(contact, interface, &surface));
  PetscCall(MatCreateAIJ(contact->comm, contact->n_pairs, n_columns, PETSC_DETERMINE, PETSC_DETERMINE, n_entries, NULL,
                         n_entries, NULL, P));
  PetscCall(MatGetOwnershipRange(*P, &row, NULL));
  for (PetscInt p = 0; p < contact->n_pairs; p++, row++) {
    const ContactPair     *pair  = &contact->pairs[p];
    const ContactPairFoot *foot  = &contact->feet[p];
    const ContactFacet    *facet = pair->interface == interface ? &surface->facet[foot->facet] : NULL;
    const PetscReal       *d     = (const PetscReal *)((const char *)pair + offset);

    for (PetscInt i = 0; facet && i < 3 * facet->n; i++)
      if (foot->weight[i / 3] != 0)
        PetscCall(MatSetValue(*P, row, 3 * surface->vertex[facet->node[i / 3]] + i % 3,
                              foot->weight[i / 3] * d[i % 3] / foot->across, ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(*P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*P, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Adds the rows of an interface to one tilt operator, which is NULL before the first */
static PetscErrorCode TiltAdd(Contact contact, PetscInt interface, size_t offset, Mat turning, Mat *tilt)
{
  PetscInt n_rows;
  Mat      P, rows;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(turning, &n_rows, NULL));
  PetscCall(InterpolationCreate(contact, interface, offset, n_rows, &P));
  PetscCall(MatMatMult(P, turning, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &rows));
  PetscCall(MatProductClear(rows));
  PetscCall(MatDestroy(&P));
  if (*tilt) {
    PetscCall(MatAXPY(*tilt, 1, rows, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatDestroy(&rows));
  } else
    *tilt = rows;
  PetscFunctionReturn(0);
}

PetscErrorCode ContactCreateTilt(Contact contact, Mat *tilt_t, Mat *tilt_b)
{
  Mat turning;

  PetscFunctionBeginUser;
  *tilt_t = *tilt_b = NULL;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    PetscCall(TurningCreate(contact, contact->interfaces[i].master, &turning));
    PetscCall(TiltAdd(contact, i, offsetof(ContactPair, t), turning, tilt_t));
    PetscCall(TiltAdd(contact, i, offsetof(ContactPair, b), turning, tilt_b));
    PetscCall(MatDestroy(&turning));
  }
  PetscFunctionReturn(0);
}
