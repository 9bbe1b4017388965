/*
   sound_cycle.csv: what cycles radiate (squeal/sound.h), harmonic by harmonic. The rates a of the modes Phi after the N
   steps of a period T have the amplitudes

      A_h = 2 / N sum_k a(t_k) e^{-2 pi i h k / N},   h = 1 .. H,   v = Re sum_h Phi A_h e^{2 pi i h t / T}      m/s,

   H the last harmonic below the cut-off of the modes and 20 kHz, where hearing ends, (N - 1) / 2 at most. The
   residual of the modes left out has no part in it, as in a transient. Harmonic 0 is all of them together.

   Errors of a row are the largest differences of its levels (power and microphones, dB) from the cycle with twice the
   steps, times 4/3, and from that with 2.25 times the cut-off.
*/
#include "cycleimpl.h"
#include "base/text.h"

#define SOUND_CELL   32
#define HEARING_ENDS 20e3 /* Hz */
#define SOUND_LEAD   "point,harmonic,freq_hz,error_db,cutoff_error_db"

PetscErrorCode CycleSetSound(LimitCycle c, Sound sound)
{
  PetscFunctionBeginUser;
  c->sound = sound;
  PetscFunctionReturn(0);
}

PetscErrorCode CycleListen(LimitCycle c)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(SoundGetMicrophones(c->sound, &n, NULL));
  if (n) PetscCall(PetscMalloc1(c->flow.n_steps * c->flow.model->m, &c->flow.rates));
  PetscFunctionReturn(0);
}

/* Re and Im of A_h, [modes] each */
static void HarmonicFind(const CycleFlow *f, PetscInt harmonic, PetscReal re[], PetscReal im[])
{
  const PetscInt m = f->model->m, n = f->n_steps;

  for (PetscInt j = 0; j < m; j++) re[j] = im[j] = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal angle = 2 * PETSC_PI * (PetscReal)((harmonic * k) % n) / (PetscReal)n;

    for (PetscInt j = 0; j < m; j++) {
      re[j] += 2 * f->rates[k * m + j] * PetscCosReal(angle) / (PetscReal)n;
      im[j] -= 2 * f->rates[k * m + j] * PetscSinReal(angle) / (PetscReal)n;
    }
  }
}

/* Velocities Phi A of the nodes */
static PetscErrorCode HarmonicMove(ReducedRun r, const PetscReal amplitude[], PetscReal v[])
{
  Vec x;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(r->reduction.Phi, NULL, &x));
  PetscCall(VecSet(x, 0));
  PetscCall(ReducedAddCombination(r->reduction.Phi, amplitude, x));
  PetscCall(ModelGetNodal(r->run.model, x, v));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(0);
}

/* Harmonics of a cycle that are told */
static PetscInt HarmonicsCount(const CycleFlow *f, PetscReal freq, PetscReal cutoff)
{
  const PetscReal most = PetscMin((f->n_steps - 1) / 2, PetscMin(cutoff, HEARING_ENDS) / freq);

  return PetscMax(1, (PetscInt)most);
}

PetscErrorCode CycleHear(LimitCycle c, PetscReal period, PetscReal cutoff, CycleSound *heard)
{
  const PetscInt m = c->flow.model->m;
  PetscReal     *re, *im, *vr, *vi;
  const Mesh    *mesh;

  PetscFunctionBeginUser;
  if (!c->flow.rates) PetscFunctionReturn(0);
  PetscCall(ModelGetMesh(c->reduced->run.model, &mesh));
  PetscCall(SoundGetRowSize(c->sound, &heard->n_row));
  heard->n = HarmonicsCount(&c->flow, 1 / period, cutoff);
  PetscCall(PetscMalloc1((heard->n + 1) * heard->n_row, &heard->row));
  PetscCall(PetscMalloc4(m, &re, m, &im, 3 * mesh->n_nodes, &vr, 3 * mesh->n_nodes, &vi));
  for (PetscInt h = 1; h <= heard->n; h++) {
    HarmonicFind(&c->flow, h, re, im);
    PetscCall(HarmonicMove(c->reduced, re, vr));
    PetscCall(HarmonicMove(c->reduced, im, vi));
    PetscCall(SoundMeasureRow(c->sound, 2 * PETSC_PI * (PetscReal)h / period, vr, vi, &heard->row[h * heard->n_row]));
  }
  PetscCall(SoundAddRows(c->sound, heard->n, &heard->row[heard->n_row], heard->row));
  PetscCall(PetscFree4(re, im, vr, vi));
  PetscCall(PetscFree(c->flow.rates));
  PetscFunctionReturn(0);
}

typedef char LevelText[SOUND_CELL];

/* Largest difference of the levels of harmonic h at n microphones, dB; nothing where the other cycle has none */
static PetscErrorCode LevelsDiffer(PetscInt n, PetscInt h, const CycleSound *heard, const CycleSound *other,
                                   PetscReal factor, LevelText cell)
{
  const PetscReal *a = &heard->row[h * heard->n_row], *b = other->row ? &other->row[h * heard->n_row] : NULL;
  PetscReal        most;

  PetscFunctionBeginUser;
  cell[0] = 0;
  if (!b || h > other->n) PetscFunctionReturn(0);
  most = PetscAbsReal(a[1] - b[1]);
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt level = heard->n_row - 4 * (n - k) + 2;

    most = PetscMax(most, PetscAbsReal(a[level] - b[level]));
  }
  PetscCall(PetscSNPrintf(cell, sizeof(LevelText), "%.15g", (double)(factor * most)));
  PetscFunctionReturn(0);
}

/* One row: harmonic h of cycle i; text [SOUND_CELL times the columns] */
static PetscErrorCode CycleWriteTone(LimitCycle c, PetscInt i, PetscInt h, char text[], size_t room, ResultsTable table)
{
  const CyclePoint *p   = &c->point[i];
  const CycleSound *s   = &p->sound;
  const PetscReal  *row = &s->row[h * s->n_row];
  LevelText         error[2], cell;
  PetscInt          n;

  PetscFunctionBeginUser;
  PetscCall(SoundGetMicrophones(c->sound, &n, NULL));
  PetscCall(LevelsDiffer(n, h, s, &p->finer_sound, 4. / 3, error[0]));
  PetscCall(LevelsDiffer(n, h, s, &p->higher_sound, 1, error[1]));
  PetscCall(PetscSNPrintf(text, room, "%" PetscInt_FMT ",%" PetscInt_FMT ",%.15g,%s,%s", i + 1, h,
                          (double)((PetscReal)PetscMax(h, 1) * p->found.freq), error[0], error[1]));
  for (PetscInt k = 0; k < s->n_row; k++) {
    PetscCall(PetscSNPrintf(cell, sizeof(cell), ",%.15g", (double)row[k]));
    PetscCall(TextAdd(text, cell, room));
  }
  PetscCall(ResultsTableRow(table, "%s", text));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleWriteSound(LimitCycle c)
{
  char        *header, *text;
  size_t       room;
  ResultsTable table;
  PetscInt     n, n_row;

  PetscFunctionBeginUser;
  PetscCall(SoundGetMicrophones(c->sound, &n, NULL));
  if (!n) PetscFunctionReturn(0);
  PetscCall(SoundGetRowSize(c->sound, &n_row));
  PetscCall(SoundCreateHeader(c->sound, SOUND_LEAD, &header));
  PetscCall(ResultsTableOpen(c->results, "sound_cycle", header, &table));
  room = (size_t)(n_row + 5) * SOUND_CELL;
  PetscCall(PetscMalloc1(room, &text));
  for (PetscInt i = 0; i < c->n_points; i++)
    for (PetscInt h = 0; h <= c->point[i].sound.n; h++) PetscCall(CycleWriteTone(c, i, h, text, room, table));
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree(text));
  PetscCall(PetscFree(header));
  PetscFunctionReturn(0);
}
