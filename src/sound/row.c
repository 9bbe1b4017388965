/*
   What tables of sound have in a row: equivalent radiated power of all parts and of each, and of each microphone the
   pressure and its levels.

   Levels are those of a tone: L = 10 log10(P / 1 pW), and L = 20 log10(|p| / (sqrt(2) 20 uPa)) with |p| the amplitude;
   A-weighting of IEC 61672-1, equation (E.6):

      R(f) = 12194^2 f^4 / ((f^2 + 20.6^2) sqrt((f^2 + 107.7^2) (f^2 + 737.9^2)) (f^2 + 12194^2)),
      A(f) = 20 log10 R(f) - 20 log10 R(1000 Hz)     dB.

   Tones of different frequency add up by their powers: P, |p|^2 and |p|^2 10^(A / 10).
*/
#include "soundimpl.h"
#include "base/text.h"

#define PICOWATT     1e-12
#define QUIETEST     20e-6 /* Pa */
#define SOUND_COLUMN 256
#define REFERENCE    1000.   /* Hz */
#define SILENCE      (-999.) /* dB; -inf has no place in a table */

static PetscReal WeightSize(PetscReal f)
{
  const PetscReal f2 = f * f, low = 20.598997 * 20.598997, high = 12194.217 * 12194.217;

  return high * f2 * f2 /
         ((f2 + low) * PetscSqrtReal((f2 + 107.65265 * 107.65265) * (f2 + 737.86223 * 737.86223)) * (f2 + high));
}

/* Decibels of a ratio of powers */
static PetscReal Decibel(PetscReal ratio)
{
  return ratio > 0 ? 10 * PetscLog10Real(ratio) : SILENCE;
}

static PetscReal PowerOf(PetscReal decibel)
{
  return decibel > SILENCE ? PetscPowReal(10, decibel / 10) : 0;
}

PetscErrorCode SoundCreateHeader(Sound sound, const char lead[], char **header)
{
  const Mesh *mesh;
  size_t      room;
  char        column[SOUND_COLUMN];

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(sound->model, &mesh));
  room = (size_t)(mesh->n_parts + sound->n + 1) * SOUND_COLUMN;
  PetscCall(PetscMalloc1(room, header));
  PetscCall(PetscSNPrintf(*header, room, "%s,power_w,power_db", lead));
  for (PetscInt part = 0; part < mesh->n_parts; part++) {
    PetscCall(PetscSNPrintf(column, sizeof(column), ",power_%s_w", mesh->part[part]));
    PetscCall(TextAdd(*header, column, room));
  }
  for (PetscInt i = 0; i < sound->n; i++) {
    const char *name = sound->microphone[i].name;

    PetscCall(PetscSNPrintf(column, sizeof(column), ",%s_re_pa,%s_im_pa,%s_db,%s_dba", name, name, name, name));
    PetscCall(TextAdd(*header, column, room));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SoundGetRowSize(Sound sound, PetscInt *n)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(sound->model, &mesh));
  *n = 2 + mesh->n_parts + 4 * sound->n;
  PetscFunctionReturn(0);
}

PetscErrorCode SoundMeasureRow(Sound sound, PetscReal omega, const PetscReal vr[], const PetscReal vi[],
                               PetscReal row[])
{
  const PetscReal freq   = omega / (2 * PETSC_PI);
  const PetscReal weight = 20 * PetscLog10Real(WeightSize(freq) / WeightSize(REFERENCE));
  const Mesh     *mesh;
  PetscReal      *pressure;
  PetscInt        n_row;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(sound->model, &mesh));
  PetscCall(SoundGetRowSize(sound, &n_row));
  PetscCall(PetscArrayzero(row, n_row));
  PetscCall(PetscMalloc1(2 * sound->n, &pressure));
  PetscCall(SoundMeasurePower(sound, vr, vi, &row[2]));
  PetscCall(SoundMeasurePressure(sound, omega, vr, vi, pressure, &pressure[sound->n]));
  for (PetscInt part = 0; part < mesh->n_parts; part++) row[0] += row[2 + part];
  row[1] = Decibel(row[0] / PICOWATT);
  for (PetscInt k = 0; k < sound->n; k++) {
    const PetscReal re = pressure[k], im = pressure[sound->n + k];
    PetscReal      *cell = &row[2 + mesh->n_parts + 4 * k];

    cell[0] = re;
    cell[1] = im;
    cell[2] = Decibel((re * re + im * im) / (2 * QUIETEST * QUIETEST));
    cell[3] = cell[2] > SILENCE ? cell[2] + weight : SILENCE;
  }
  PetscCall(PetscFree(pressure));
  for (PetscInt k = 0; k < n_row; k++)
    PetscCheck(
      !PetscIsInfOrNanReal(row[k]), sound->comm, PETSC_ERR_USER_INPUT,
      "the sound at %g Hz is not finite: see to -sound_density, -sound_speed, the places of -sound_microphones, and "
      "for modes -sound_energy",
      (double)freq);
  PetscFunctionReturn(0);
}

PetscErrorCode SoundAddRows(Sound sound, PetscInt n, const PetscReal rows[], PetscReal all[])
{
  PetscInt    n_row;
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(sound->model, &mesh));
  PetscCall(SoundGetRowSize(sound, &n_row));
  PetscCall(PetscArrayzero(all, n_row));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal *row = &rows[i * n_row];

    for (PetscInt k = 0; k < 2 + mesh->n_parts; k++) all[k] += k == 1 ? 0 : row[k];
    for (PetscInt k = 2 + mesh->n_parts; k < n_row; k += 4) {
      all[k] += PetscSqr(row[k]) + PetscSqr(row[k + 1]);
      for (int level = 2; level < 4; level++) all[k + level] += PowerOf(row[k + level]);
    }
  }
  all[1] = Decibel(all[0] / PICOWATT);
  for (PetscInt k = 2 + mesh->n_parts; k < n_row; k += 4) {
    all[k] = PetscSqrtReal(all[k]);
    for (int level = 2; level < 4; level++) all[k + level] = Decibel(all[k + level]);
  }
  PetscFunctionReturn(0);
}
