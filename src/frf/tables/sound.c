/*
   sound_frf.csv: what a force of 1 N radiates (squeal/sound.h), of the velocity v = i omega u of all nodes.

   Superposition has u = V c on the orthonormal vectors of its space with one step more. field_error is the relative
   difference |c - c'| / |c| from the answer c' without that step: an estimate. With -frf_method direct u is exact but
   for rounding, and field_error is 0.
*/
#include "frf/schur.h"
#include <squeal/sound.h>

PetscBool FrfHears(Frf frf)
{
  PetscInt n = 0;

  (void)SoundGetMicrophones(frf->sound, &n, NULL);
  return n ? PETSC_TRUE : PETSC_FALSE;
}

/* Velocity of the nodes, scale times a displacement in the unknowns of the pencil */
static PetscErrorCode SoundMoveNodes(Frf frf, PetscReal scale, Vec u, PetscReal v[])
{
  const Mesh *mesh;
  Vec         all;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMesh(frf->operators, &mesh));
  PetscCall(VecDuplicate(frf->f, &all));
  PetscCall(PencilExpand(frf->pencil, PETSC_FALSE, u, all));
  PetscCall(OperatorsGetNodal(frf->operators, all, v));
  for (PetscInt k = 0; k < 3 * mesh->n_nodes; k++) v[k] *= scale;
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfHear(Frf frf, PetscInt i, PetscReal error, Vec re, Vec im)
{
  const PetscReal omega = 2 * PETSC_PI * frf->freq[i];
  const Mesh     *mesh;
  PetscReal      *vr, *vi, *row = &frf->heard[i * frf->n_heard];

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMesh(frf->operators, &mesh));
  PetscCall(PetscCalloc2(3 * mesh->n_nodes, &vr, 3 * mesh->n_nodes, &vi));
  PetscCall(SoundMoveNodes(frf, omega, re, vi));
  if (im) PetscCall(SoundMoveNodes(frf, -omega, im, vr));
  row[0] = error;
  PetscCall(SoundMeasureRow(frf->sound, omega, vr, vi, &row[1]));
  PetscCall(PetscFree2(vr, vi));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfFieldCreate(Frf frf, const ModesSpace *space, PetscReal shift, Vec force, FrfField *field)
{
  const PetscInt n    = space->space.n;
  FrfEnds        ends = {.n_outputs = n};
  FrfSchur       schur;
  PetscInt       pole;

  PetscFunctionBeginUser;
  field->n = n;
  PetscCall(ModesSpaceProducts(space, 1, &force, &ends.b));
  PetscCall(PetscCalloc1(n * n, &ends.l));
  for (PetscInt i = 0; i < n; i++) ends.l[i * (n + 1)] = 1;
  PetscCall(FrfSchurCreate(space, PETSC_FALSE, shift, &ends, &schur));
  PetscCall(PetscFree(ends.b));
  PetscCall(PetscFree(ends.l));
  PetscCall(PetscCalloc2(frf->n * n, &field->re, frf->n * n, &field->im));
  for (PetscInt first = 0; first < frf->n; first += FRF_BATCH) {
    const PetscInt m = PetscMin(FRF_BATCH, frf->n - first);
    PetscReal      omega[FRF_BATCH];

    for (PetscInt k = 0; k < m; k++) omega[k] = 2 * PETSC_PI * frf->freq[first + k];
    PetscCall(FrfSchurRespond(&schur, m, omega, &field->re[first * n], &field->im[first * n], &pole));
    PetscCheck(pole < 0, frf->comm, PETSC_ERR_USER_INPUT,
               "-frf_frequencies: %.15g Hz is a pole, where the sound is infinite",
               (double)frf->freq[first + PetscMax(pole, 0)]);
  }
  PetscCall(FrfSchurDestroy(&schur));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfFieldDestroy(FrfField *field)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(field->re, field->im));
  PetscFunctionReturn(0);
}

/* |c - c'| / |c| at frequency i */
static PetscReal FieldError(const FrfField *field, const FrfField *before, PetscInt i)
{
  PetscReal size = 0, off = 0;

  for (PetscInt k = 0; k < field->n; k++) {
    const PetscInt  here = i * field->n + k, there = i * before->n + k;
    const PetscReal re = k < before->n ? before->re[there] : 0, im = k < before->n ? before->im[there] : 0;

    size += PetscSqr(field->re[here]) + PetscSqr(field->im[here]);
    off += PetscSqr(field->re[here] - re) + PetscSqr(field->im[here] - im);
  }
  return size > 0 ? PetscSqrtReal(off / size) : 0;
}

PetscErrorCode FrfHearFields(Frf frf, const ModesSpace *space, const FrfField *field, const FrfField *before)
{
  Vec u[2];

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(space->pencil.K, &u[0], NULL));
  PetscCall(VecDuplicate(u[0], &u[1]));
  for (PetscInt i = 0; i < frf->n; i++) {
    PetscCall(BVMultVec(space->space.V, 1, 0, u[0], &field->re[i * field->n]));
    PetscCall(BVMultVec(space->space.V, 1, 0, u[1], &field->im[i * field->n]));
    PetscCall(FrfHear(frf, i, FieldError(field, before, i), u[0], u[1]));
  }
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&u[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfWriteSound(Frf frf, Results results)
{
  char        *header;
  PetscReal   *row;
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(SoundCreateHeader(frf->sound, "freq_hz,field_error", &header));
  PetscCall(ResultsTableOpen(results, "sound_frf", header, &table));
  PetscCall(PetscMalloc1(1 + frf->n_heard, &row));
  for (PetscInt i = 0; i < frf->n; i++) {
    row[0] = frf->freq[i];
    PetscCall(PetscArraycpy(&row[1], &frf->heard[i * frf->n_heard], frf->n_heard));
    PetscCall(ResultsTableNumbers(table, 1 + frf->n_heard, row));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree(row));
  PetscCall(PetscFree(header));
  PetscFunctionReturn(0);
}
