/*
   Turning of the master's normal. The normal of a pair is n = a / |a|, a = sum_i w_i a_i (m^2), where a_i sums, over
   the facets around the master's vertex i, their shares int N_i x_,xi x x_,eta of the area vector. With displacements u
   of the surface

      delta a_i = sum_j u_j x c_ij,   delta n = (I - n n') sum_i w_i delta a_i / |a|,

   the derivative of the very normal that pairing makes: a rigid rotation w gives w x n to rounding, on any surface. The
   tilt operators are its components along t and b; displacements within a flat surface do not tilt it.
*/
#include "contactimpl.h"
#include "kernels/facet.h"

/* The 96 entries of a facet that are not zero by nature: component d of u x c takes the others of u */
static void FacetEntries(const ContactFacet *facet, PetscInt row[96], PetscInt column[96], PetscScalar value[96])
{
  double c[4][4][3];
  int    n = 0;

  FacetTurning((const double(*)[3])facet->x, c);
  for (int ij = 0; ij < 16; ij++) {
    const int i = ij / 4, j = ij % 4;

    for (int d = 0; d < 3; d++) {
      for (int k = 1; k < 3; k++, n++) { /* (u x c)_d = u_(d+1) c_(d+2) - u_(d+2) c_(d+1) */
        row[n]    = 3 * facet->node[i] + d;
        column[n] = facet->unknowns[j][(d + k) % 3];
        value[n]  = k == 1 ? c[i][j][(d + 2) % 3] : -c[i][j][(d + 1) % 3];
      }
    }
  }
}

/* Derivatives of the area vectors of a surface at its vertices, shape [3 vertices][unknowns]: row 3 v + d belongs to
   component d of vertex v (global number) */
static PetscErrorCode TurningCreate(Contact contact, const char set[], Mat *turning)
{
  const Mesh   *mesh;
  PetscInt      n_rows = 0, n, *row, *column;
  PetscScalar  *value;
  ContactFacet *facets;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) n_rows += mesh->owned[v] ? 3 : 0;
  PetscCall(ContactFacetsLocal(contact->model, set, &n, &facets));
  PetscCall(PetscMalloc3(96 * n, &row, 96 * n, &column, 96 * n, &value));
  for (PetscInt f = 0; f < n; f++) FacetEntries(&facets[f], &row[96 * f], &column[96 * f], &value[96 * f]);
  PetscCall(MatCreate(contact->comm, turning));
  PetscCall(MatSetSizes(*turning, n_rows, mesh->n_own, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*turning, MATAIJ));
  PetscCall(MatSetPreallocationCOO(*turning, 96 * n, row, column));
  PetscCall(MatSetValuesCOO(*turning, value, INSERT_VALUES));
  PetscCall(PetscFree3(row, column, value));
  PetscCall(PetscFree(facets));
  PetscFunctionReturn(0);
}

/* sum_i w_i d . a_i / |a| for the pairs of an interface, d = t or b by its offset in ContactPair; other rows are empty */
static PetscErrorCode InterpolationCreate(Contact contact, PetscInt interface, size_t offset, PetscInt n_columns,
                                          Mat *P)
{
  PetscInt row;

  PetscFunctionBeginUser;
  PetscCall(
    MatCreateAIJ(contact->comm, contact->n_pairs, n_columns, PETSC_DETERMINE, PETSC_DETERMINE, 12, NULL, 12, NULL, P));
  PetscCall(MatGetOwnershipRange(*P, &row, NULL));
  for (PetscInt p = 0; p < contact->n_pairs; p++, row++) {
    const ContactPair *pair = &contact->pairs[p];
    const PetscReal   *d    = (const PetscReal *)((const char *)pair + offset);

    if (pair->interface != interface) continue;
    for (PetscInt i = 0; i < 3 * pair->n_master; i++)
      PetscCall(MatSetValue(*P, row, 3 * pair->corner[i / 3] + i % 3,
                            pair->weight[i / 3] * d[i % 3] / pair->area_master, ADD_VALUES));
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
