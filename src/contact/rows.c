/*
   Sparse rows d . (u_m - u_s) = d . (sum_i w_i u_i - sum_k v_k u_k) of pairs: N (d = n, closing of the gap), T (d = t)
   and B (d = b) of an interface, and rows along any direction d (unit vectors, no unit; the row times u is in m). Row i
   has 3 (n_slave + n_master) entries at most: w_i d at the unknowns of the master's nodes and -v_k d at those of the
   slave's. A direction that a support holds has the unknown -1, which MatSetValues() leaves out: u is 0 there. Values
   are added, since a node may be slave and master of one pair.

   The transpose takes forces of pairs to nodes: a compressive lambda_n is the internal force N' lambda_n, and acts on
   the nodes as -N' lambda_n. Rows live on the rank that owns the slave; columns may belong to any.
*/
#include "contactimpl.h"

/* Sets one row: d . (u_m - u_s) */
static PetscErrorCode PairRowSet(Mat rows, PetscInt row, const ContactPair *pair, const PetscReal d[3])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < pair->n_master + pair->n_slave; i++) {
    const PetscBool        master  = i < pair->n_master ? PETSC_TRUE : PETSC_FALSE;
    const ContactPairNode *node    = master ? &pair->master[i] : &pair->slave[i - pair->n_master];
    const PetscReal        w       = master ? node->weight : -node->weight;
    const PetscScalar      part[3] = {w * d[0], w * d[1], w * d[2]};

    PetscCall(MatSetValues(rows, 1, &row, 3, node->unknown, part, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactCreateRows(Contact contact, PetscInt n, const PetscInt pair[], const PetscReal direction[][3],
                                 Mat *rows)
{
  const Mesh *mesh;
  PetscInt    row, n_entries = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  for (PetscInt i = 0; i < n; i++)
    n_entries = PetscMax(n_entries, 3 * (contact->pairs[pair[i]].n_slave + contact->pairs[pair[i]].n_master));
  PetscCall(MatCreateAIJ(contact->comm, n, mesh->n_own, PETSC_DETERMINE, PETSC_DETERMINE, n_entries, NULL, n_entries,
                         NULL, rows));
  PetscCall(MatGetOwnershipRange(*rows, &row, NULL));
  for (PetscInt i = 0; i < n; i++) PetscCall(PairRowSet(*rows, row + i, &contact->pairs[pair[i]], direction[i]));
  PetscCall(MatAssemblyBegin(*rows, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*rows, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Rows of local pairs along n, t or b, chosen by its offset in ContactPair */
static PetscErrorCode RowsAlong(Contact contact, PetscInt n, const PetscInt pair[], size_t offset, Mat *rows)
{
  PetscReal(*direction)[3];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &direction));
  for (PetscInt i = 0; i < n; i++)
    PetscCall(PetscMemcpy(direction[i], (const char *)&contact->pairs[pair[i]] + offset, sizeof(*direction)));
  PetscCall(ContactCreateRows(contact, n, pair, (const PetscReal(*)[3])direction, rows));
  PetscCall(PetscFree(direction));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactCreatePairOperators(Contact contact, PetscInt n, const PetscInt pair[], Mat *N, Mat *T, Mat *B)
{
  PetscFunctionBeginUser;
  if (N) PetscCall(RowsAlong(contact, n, pair, offsetof(ContactPair, n), N));
  if (T) PetscCall(RowsAlong(contact, n, pair, offsetof(ContactPair, t), T));
  if (B) PetscCall(RowsAlong(contact, n, pair, offsetof(ContactPair, b), B));
  PetscFunctionReturn(0);
}
