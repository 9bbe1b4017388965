/*
   sound.csv: what each mode radiates (squeal/sound.h) while its vibration has the energy E = -sound_energy, kinetic and
   potential: v = lambda x is scaled to v^H M v / 2 = E. Growth within a period is left out, so that rigid and
   overdamped modes have no row.
*/
#include "modes/modesimpl.h"
#include <squeal/sound.h>

PetscErrorCode ModesSetSound(Modes modes, Sound sound)
{
  PetscFunctionBeginUser;
  modes->sound = sound;
  PetscFunctionReturn(0);
}

/* Velocity lambda x at the nodes, scaled to the energy */
static PetscErrorCode ModesMoveNodes(Modes modes, PetscInt i, PetscReal vr[], PetscReal vi[])
{
  const Mode *m       = &modes->mode[i];
  const Vec   part[2] = {modes->right.xr[i], modes->right.xi[i]};
  Operators   operators;
  Mat         M;
  Vec         y;
  PetscReal   energy, joule, mass = 0, scale, product;
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetMesh(operators, &mesh));
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(VecDuplicate(part[0], &y));
  for (int k = 0; k < 2; k++) {
    if (part[k]) PetscCall(MatMult(M, part[k], y));
    if (part[k]) PetscCall(VecDot(part[k], y, &product));
    if (part[k]) mass += product;
  }
  PetscCall(VecDestroy(&y));
  PetscCall(SoundGetEnergy(modes->sound, &energy));
  PetscCall(SoundGetScale(modes->sound, &joule));
  scale = PetscSqrtReal(2 * energy / (joule * mass * (m->sigma * m->sigma + m->omega * m->omega)));
  PetscCall(OperatorsGetNodal(operators, part[0], vr));
  PetscCall(PetscArrayzero(vi, 3 * mesh->n_nodes));
  if (part[1]) PetscCall(OperatorsGetNodal(operators, part[1], vi));
  for (PetscInt k = 0; k < 3 * mesh->n_nodes; k++) {
    const PetscReal re = vr[k], im = vi[k];

    vr[k] = scale * (m->sigma * re - m->omega * im);
    vi[k] = scale * (m->omega * re + m->sigma * im);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWriteSound(Modes modes, const Mesh *mesh, Results results)
{
  PetscInt     n, n_row;
  PetscReal   *vr, *vi, *row;
  char        *header;
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(SoundGetMicrophones(modes->sound, &n, NULL));
  if (!n) PetscFunctionReturn(0);
  PetscCall(SoundCreateHeader(modes->sound, "mode,freq_hz,energy_j", &header));
  PetscCall(SoundGetRowSize(modes->sound, &n_row));
  PetscCall(ResultsTableOpen(results, "sound", header, &table));
  PetscCall(PetscMalloc3(3 * mesh->n_nodes, &vr, 3 * mesh->n_nodes, &vi, 3 + n_row, &row));
  PetscCall(SoundGetEnergy(modes->sound, &row[2]));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscReal omega = modes->mode[i].omega;

    if (!(omega > 0)) continue;
    row[0] = (PetscReal)(i + 1);
    row[1] = omega / (2 * PETSC_PI);
    PetscCall(ModesMoveNodes(modes, i, vr, vi));
    PetscCall(SoundMeasureRow(modes->sound, omega, vr, vi, &row[3]));
    PetscCall(ResultsTableNumbers(table, 3 + n_row, row));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree3(vr, vi, row));
  PetscCall(PetscFree(header));
  PetscFunctionReturn(0);
}
