/*
   PairRows of the contact problem: contact displacements w = G u of every pair, closing positive. Where the interface
   slides the direction of friction is known, lambda_t = mu lambda_n along t, so that a pair has its normal row only,
   and S holds t beside it; so has a pair without friction, without S.
*/
#include "statics/staticsimpl.h"
#include <math.h>

/* Rows per pair of each interface, and their sums */
static PetscErrorCode PairRowsCount(PetscBool pressing, PairRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n_pairs + 1, &rows->first));
  PetscCall(PetscCalloc1(rows->n_pairs, &rows->law));
  PetscCall(PetscCalloc1(rows->n_pairs, &rows->slide));
  PetscCall(PetscCalloc1(rows->n_pairs, &rows->closing));
  PetscCall(PetscCalloc1(rows->n_interfaces, &rows->pressure));
  rows->first[0] = 0;
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const ContactInterface *c = &rows->interface[rows->pair[p].interface];

    rows->law[p].d     = pressing || rows->slides[rows->pair[p].interface] || !FrictionExists(&c->friction) ? 1 : 3;
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
    if (rows->slides[q->interface]) PetscCall(PetscArraycpy(along[rows->first[p]], q->t, 3));
  }
  for (PetscInt i = 0; i < rows->n_interfaces; i++) any = (PetscBool)(any || rows->slides[i]);
  PetscCall(ContactCreateRows(contact, rows->n, pair, (const PetscReal(*)[3])across, &rows->G));
  if (any) PetscCall(ContactCreateRows(contact, rows->n, pair, (const PetscReal(*)[3])along, &rows->S));
  PetscCall(MatGetOwnershipRange(rows->G, &rows->begin, NULL));
  PetscCall(PetscFree2(across, along));
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(0);
}

PetscErrorCode PairRowsCreate(Operators operators, PetscBool pressing, const Stage *stage, PairRows *rows)
{
  Contact contact;
  Model   model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, &contact));
  PetscCall(ModelGetComm(model, &rows->comm));
  PetscCall(ContactGetInterfaces(contact, &rows->n_interfaces, &rows->interface));
  PetscCall(ContactGetPairs(contact, &rows->n_pairs, &rows->n_pairs_all, &rows->pair));
  PetscCall(PetscMalloc1(rows->n_interfaces, &rows->slides));
  for (PetscInt i = 0; i < rows->n_interfaces; i++)
    rows->slides[i] = stage ? stage->slides[i] : rows->interface[i].slides;
  PetscCall(PairRowsCount(pressing, rows));
  PetscCall(PairRowsCreateMatrices(contact, rows));
  PetscFunctionReturn(0);
}

/* k and shift of the tangent l = k (w - g0 - shift) to a law at the closing c, forces l = lambda_n / kappa:
   k = A P'(c) / kappa, shift = c - P(c) / P'(c), with the wear of a step (wear/law.c). At the onset, where P' may
   vanish, the pair is rigid: what it carries then tells how far it closes. */
void PairRowsSetClosing(PairRows *rows, PetscInt p, PetscReal kappa, PetscReal c)
{
  const PetscBool curved = PairIsCurved(rows, p);
  const PetscReal force  = curved ? PairForce(rows, p, c) : 0;

  rows->closing[p]   = c;
  rows->law[p].shift = force > 0 ? c - force / PairSlope(rows, p, c, force) : curved ? c : 0;
  rows->law[p].k     = force > 0 || !curved ? PairSlope(rows, p, c, force) / kappa : INFINITY;
}

PetscErrorCode PairRowsSetFriction(Operators operators, const PetscReal p[], PetscInt k, PetscReal force,
                                   PairRows *rows)
{
  const PetscInt i = rows->pair[k].interface;
  PetscReal      mu;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetPairMu(operators, p, &rows->pair[k], (PetscBool)(rows->interface[i].slides && !rows->slides[i]),
                               force, &mu));
  rows->law[k].mu = rows->law[k].d == 3 ? PetscAbsReal(mu) : 0;
  rows->slide[k]  = rows->slides[i] ? mu : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PairRowsSetLaws(Operators operators, const PetscReal p[], PetscReal kappa, PairRows *rows)
{
  PetscReal unused;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < rows->n_interfaces; i++)
    PetscCall(OperatorsGetInterface(operators, p, i, &unused, &rows->pressure[i]));
  for (PetscInt k = 0; k < rows->n_pairs; k++) {
    PairRowsSetClosing(rows, k, kappa, PressureOnset(&rows->pressure[rows->pair[k].interface]));
    PetscCall(PairRowsSetFriction(operators, p, k, 0, rows));
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
  PetscCall(PetscFree(rows->closing));
  PetscCall(PetscFree(rows->pressure));
  PetscCall(PetscFree(rows->slides));
  PetscCall(PetscFree(rows->moved));
  PetscCall(PetscFree(rows->moved0));
  PetscFunctionReturn(0);
}
