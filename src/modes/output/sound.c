/*
   sound.csv: what each mode radiates (squeal/sound.h) while its vibration has the energy E = -sound_energy, kinetic and
   potential: v = lambda x is scaled to v^H M v / 2 = E. Growth within a period is left out, so that rigid and
   overdamped modes have no row.

   Levels are those of a tone: L = 10 log10(P / 1 pW), and L = 20 log10(|p| / (sqrt(2) 20 uPa)) with |p| the amplitude;
   A-weighting of IEC 61672-1, equation (E.6):

      R(f) = 12194^2 f^4 / ((f^2 + 20.6^2) sqrt((f^2 + 107.7^2) (f^2 + 737.9^2)) (f^2 + 12194^2)),
      A(f) = 20 log10 R(f) - 20 log10 R(1000 Hz)     dB.
*/
#include "modes/modesimpl.h"
#include "base/text.h"
#include <squeal/sound.h>

#define PICOWATT   1e-12
#define QUIETEST   20e-6 /* Pa */
#define SOUND_CELL 256
#define REFERENCE  1000. /* Hz */

#define SILENCE (-999.) /* dB */

PetscErrorCode ModesSetSound(Modes modes, Sound sound)
{
  PetscFunctionBeginUser;
  modes->sound = sound;
  PetscFunctionReturn(0);
}

static PetscReal WeightSize(PetscReal f)
{
  const PetscReal f2 = f * f, low = 20.598997 * 20.598997, high = 12194.217 * 12194.217;

  return high * f2 * f2 /
         ((f2 + low) * PetscSqrtReal((f2 + 107.65265 * 107.65265) * (f2 + 737.86223 * 737.86223)) * (f2 + high));
}

/* Decibels of a ratio of powers; -inf has no place in a table */
static PetscReal Decibel(PetscReal ratio)
{
  return ratio > 0 ? 10 * PetscLog10Real(ratio) : SILENCE;
}

/* Header of sound.csv, which the caller frees */
static PetscErrorCode SoundHeader(const Mesh *mesh, PetscInt n, const Microphone microphone[], char **header)
{
  const size_t room = (size_t)(mesh->n_parts + n + 1) * SOUND_CELL;
  char         column[SOUND_CELL];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(room, header));
  PetscCall(PetscStrncpy(*header, "mode,freq_hz,energy_j,power_w,power_db", room));
  for (PetscInt part = 0; part < mesh->n_parts; part++) {
    PetscCall(PetscSNPrintf(column, sizeof(column), ",power_%s_w", mesh->part[part]));
    PetscCall(TextAdd(*header, column, room));
  }
  for (PetscInt i = 0; i < n; i++) {
    const char *name = microphone[i].name;

    PetscCall(PetscSNPrintf(column, sizeof(column), ",%s_re_pa,%s_im_pa,%s_db,%s_dba", name, name, name, name));
    PetscCall(TextAdd(*header, column, room));
  }
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

/* One row; velocities [nodes][3] */
static PetscErrorCode SoundWriteRow(Modes modes, PetscInt i, const Mesh *mesh, const PetscReal vr[],
                                    const PetscReal vi[], ResultsTable table)
{
  const PetscReal freq    = modes->mode[i].omega / (2 * PETSC_PI);
  const PetscReal weight  = 20 * PetscLog10Real(WeightSize(freq) / WeightSize(REFERENCE));
  const PetscInt  n_parts = mesh->n_parts;
  PetscInt        n;
  PetscReal      *row, *power, *pressure;

  PetscFunctionBeginUser;
  PetscCall(SoundGetMicrophones(modes->sound, &n, NULL));
  PetscCall(PetscCalloc2(5 + n_parts + 4 * n, &row, 2 * n, &pressure));
  power  = &row[5];
  row[0] = (PetscReal)(i + 1);
  row[1] = freq;
  PetscCall(SoundGetEnergy(modes->sound, &row[2]));
  PetscCall(SoundMeasurePower(modes->sound, vr, vi, power));
  PetscCall(SoundMeasurePressure(modes->sound, modes->mode[i].omega, vr, vi, pressure, &pressure[n]));
  for (PetscInt k = 0; k < n_parts + 2 * n; k++)
    PetscCheck(
      !PetscIsInfOrNanReal(k < n_parts ? power[k] : pressure[k - n_parts]), modes->comm, PETSC_ERR_USER_INPUT,
      "the sound of the mode at %g Hz is not finite: see to -sound_energy, -sound_density, -sound_speed and the "
      "places of -sound_microphones",
      (double)freq);
  for (PetscInt part = 0; part < n_parts; part++) row[3] += power[part];
  row[4] = Decibel(row[3] / PICOWATT);
  for (PetscInt k = 0; k < n; k++) {
    PetscReal      *cell = &row[5 + n_parts + 4 * k];
    const PetscReal re = pressure[k], im = pressure[n + k];

    cell[0] = re;
    cell[1] = im;
    cell[2] = Decibel((re * re + im * im) / (2 * QUIETEST * QUIETEST));
    cell[3] = cell[2] > SILENCE ? cell[2] + weight : SILENCE;
  }
  PetscCall(ResultsTableNumbers(table, 5 + n_parts + 4 * n, row));
  PetscCall(PetscFree2(row, pressure));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWriteSound(Modes modes, const Mesh *mesh, Results results)
{
  const Microphone *microphone;
  PetscInt          n;
  PetscReal        *vr, *vi;
  char             *header;
  ResultsTable      table;

  PetscFunctionBeginUser;
  PetscCall(SoundGetMicrophones(modes->sound, &n, &microphone));
  if (!n) PetscFunctionReturn(0);
  PetscCall(SoundHeader(mesh, n, microphone, &header));
  PetscCall(ResultsTableOpen(results, "sound", header, &table));
  PetscCall(PetscMalloc2(3 * mesh->n_nodes, &vr, 3 * mesh->n_nodes, &vi));
  for (PetscInt i = 0; i < modes->n; i++) {
    if (!(modes->mode[i].omega > 0)) continue;
    PetscCall(ModesMoveNodes(modes, i, vr, vi));
    PetscCall(SoundWriteRow(modes, i, mesh, vr, vi, table));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree2(vr, vi));
  PetscCall(PetscFree(header));
  PetscFunctionReturn(0);
}
