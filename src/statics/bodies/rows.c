/*
   PairRows of the contact problem: contact displacements w = G u of every pair, closing positive. Where the interface
   slides the direction of friction is known, lambda_t = mu lambda_n along t, so that a pair has its normal row only,
   and S holds t beside it; so has a pair without friction, without S.
*/
#include "statics/staticsimpl.h"

/* Rows per pair of each interface, and their sums */
static PetscErrorCode PairRowsCount(PetscBool pressing, PairRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n_pairs + 1, &rows->first));
  PetscCall(PetscCalloc1(rows->n_pairs, &rows->law));
  PetscCall(PetscCalloc1(rows->n_pairs, &rows->slide));
  rows->first[0] = 0;
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const ContactInterface *c = &rows->interface[rows->pair[p].interface];

    rows->law[p].d     = pressing || c->slides || !FrictionExists(&c->friction) ? 1 : 3;
    rows->law[p].g0    = rows->pair[p].gap;
    rows->first[p + 1] = rows->first[p] + rows->law[p].d;
  }
  rows->n = rows->first[rows->n_pairs];
  PetscCallMPI(MPI_Allreduce(&rows->n, &rows->n_all, 1, MPIU_INT, MPI_SUM, rows->comm));
  PetscFunctionReturn(0);
}

/* G, and S where some interface slides */
static PetscErrorCode PairRowsCreateMatrices(Contact contact, PairRows *rows)
{
  PetscInt *pair;
  PetscReal(*across)[3], (*along)[3];
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n, &pair));
  PetscCall(PetscCalloc2(rows->n, &across, rows->n, &along));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const ContactPair *q    = &rows->pair[p];
    const PetscReal   *d[3] = {q->n, q->t, q->b};

    for (PetscInt i = 0; i < rows->law[p].d; i++) {
      pair[rows->first[p] + i] = p;
      PetscCall(PetscArraycpy(across[rows->first[p] + i], d[i], 3));
    }
    if (rows->interface[q->interface].slides) PetscCall(PetscArraycpy(along[rows->first[p]], q->t, 3));
  }
  for (PetscInt i = 0; i < rows->n_interfaces; i++) any = (PetscBool)(any || rows->interface[i].slides);
  PetscCall(ContactCreateRows(contact, rows->n, pair, (const PetscReal(*)[3])across, &rows->G));
  if (any) PetscCall(ContactCreateRows(contact, rows->n, pair, (const PetscReal(*)[3])along, &rows->S));
  PetscCall(MatGetOwnershipRange(rows->G, &rows->begin, NULL));
  PetscCall(PetscFree2(across, along));
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(0);
}

PetscErrorCode PairRowsCreate(Operators operators, PetscBool pressing, PairRows *rows)
{
  Contact contact;
  Model   model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, &contact));
  PetscCall(ModelGetComm(model, &rows->comm));
  PetscCall(ContactGetInterfaces(contact, &rows->n_interfaces, &rows->interface));
  PetscCall(ContactGetPairs(contact, &rows->n_pairs, &rows->n_pairs_all, &rows->pair));
  PetscCall(PairRowsCount(pressing, rows));
  PetscCall(PairRowsCreateMatrices(contact, rows));
  PetscCall(PairRowsSetMoved(model, rows));
  PetscFunctionReturn(0);
}

PetscErrorCode PairRowsSetLaws(Operators operators, const PetscReal p[], PetscReal kappa, PairRows *rows)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < rows->n_pairs; k++) {
    const PetscInt i = rows->pair[k].interface;
    PetscReal      mu, kn;

    PetscCall(OperatorsGetInterface(operators, p, i, &mu, &kn));
    PetscCall(OperatorsGetPairMu(operators, p, &rows->pair[k], &mu));
    rows->law[k].k  = ContactPairStiffness(&rows->interface[i], &rows->pair[k], kn) / kappa;
    rows->law[k].mu = rows->law[k].d == 3 ? PetscAbsReal(mu) : 0;
    rows->slide[k]  = rows->interface[i].slides ? mu : 0;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PairRowsDestroy(PairRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&rows->G));
  PetscCall(MatDestroy(&rows->S));
  PetscCall(PetscFree(rows->first));
  PetscCall(PetscFree(rows->law));
  PetscCall(PetscFree(rows->slide));
  PetscCall(PetscFree(rows->moved));
  PetscFunctionReturn(0);
}
