/*
   sound_frf.csv: what a force of 1 N radiates (squeal/sound.h), of the velocity v = i omega u of all nodes.

   Superposition has u = V c on the vectors of its space with one step more. error_relative is the largest relative
   difference of power and pressures from those of the answer without that step: an estimate. With -frf_method direct u
   is exact but for rounding, and it is 0.
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

PetscErrorCode FrfFieldCreate(const ModesSpace *space, PetscReal shift, Vec force, FrfSchur *field)
{
  const PetscInt n    = space->space.n;
  FrfEnds        ends = {.n_outputs = n};

  PetscFunctionBeginUser;
  PetscCall(ModesSpaceProducts(space, 1, &force, &ends.b));
  PetscCall(PetscCalloc1(n * n, &ends.l));
  for (PetscInt i = 0; i < n; i++) ends.l[i * (n + 1)] = 1;
  PetscCall(FrfSchurCreate(space, PETSC_FALSE, shift, &ends, field));
  PetscCall(PetscFree(ends.b));
  PetscCall(PetscFree(ends.l));
  PetscFunctionReturn(0);
}

/* Coordinates of the answers at m frequencies from `first` on, c[re, im][m][length], the last of which may be zeros */
static PetscErrorCode FieldAnswer(Frf frf, const FrfSchur *field, PetscInt first, PetscInt m, PetscInt length,
                                  PetscReal c[])
{
  const PetscInt n = field->n;
  PetscReal      omega[FRF_BATCH], *x;
  PetscInt       pole;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m; k++) omega[k] = 2 * PETSC_PI * frf->freq[first + k];
  PetscCall(PetscCalloc1(2 * m * n, &x));
  PetscCall(FrfSchurRespond(field, m, omega, x, &x[m * n], &pole));
  PetscCheck(pole < 0, frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_frequencies: %.15g Hz is a pole, where the sound is infinite",
             (double)frf->freq[first + PetscMax(pole, 0)]);
  PetscCall(PetscArrayzero(c, 2 * m * length));
  for (PetscInt k = 0; k < 2 * m; k++) PetscCall(PetscArraycpy(&c[k * length], &x[k * n], n));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

/* The largest relative difference of power and pressures of two rows */
static PetscReal RowsDiffer(PetscInt n, PetscInt n_microphones, const PetscReal a[], const PetscReal b[])
{
  PetscReal most = a[0] > 0 ? PetscAbsReal(b[0] / a[0] - 1) : 0;

  for (PetscInt k = n - 4 * n_microphones; k < n; k += 4) {
    const PetscReal size = hypot(a[k], a[k + 1]);

    if (size > 0) most = PetscMax(most, hypot(a[k] - b[k], a[k + 1] - b[k + 1]) / size);
  }
  return most;
}

/* m frequencies from `first` on, by the answers before the last step and after it */
static PetscErrorCode FieldsHear(Frf frf, const ModesSpace *space, const FrfSchur field[2], PetscInt first, PetscInt m)
{
  const PetscInt n = space->space.n;
  PetscReal     *c, *before;
  PetscInt       n_microphones;
  Vec            u[2];

  PetscFunctionBeginUser;
  PetscCall(SoundGetMicrophones(frf->sound, &n_microphones, NULL));
  PetscCall(MatCreateVecs(space->pencil.K, &u[0], NULL));
  PetscCall(VecDuplicate(u[0], &u[1]));
  PetscCall(PetscMalloc2(4 * m * n, &c, frf->n_heard, &before));
  for (int k = 0; k < 2; k++) PetscCall(FieldAnswer(frf, &field[k], first, m, n, &c[2 * k * m * n]));
  for (PetscInt i = 0; i < m; i++) {
    PetscReal *row = &frf->heard[(first + i) * frf->n_heard];

    for (int k = 0; k < 2; k++) {
      for (int part = 0; part < 2; part++)
        PetscCall(BVMultVec(space->space.V, 1, 0, u[part], &c[((2 * k + part) * m + i) * n]));
      PetscCall(FrfHear(frf, first + i, 0, u[0], u[1]));
      if (!k) PetscCall(PetscArraycpy(before, row, frf->n_heard));
    }
    row[0] = RowsDiffer(frf->n_heard - 1, n_microphones, &row[1], &before[1]);
  }
  PetscCall(PetscFree2(c, before));
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&u[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfHearFields(Frf frf, const ModesSpace *space, const FrfSchur field[2])
{
  PetscFunctionBeginUser;
  for (PetscInt first = 0; first < frf->n; first += FRF_BATCH)
    PetscCall(FieldsHear(frf, space, field, first, PetscMin(FRF_BATCH, frf->n - first)));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfWriteSound(Frf frf, Results results)
{
  char        *header;
  PetscReal   *row;
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(SoundCreateHeader(frf->sound, "freq_hz,error_relative", &header));
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
