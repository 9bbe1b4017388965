/*
   sound_time.csv: pressure at the microphones, Pa, by the velocities at the times of the rows (sound.h). It begins with
   silence: what moves at the first time begins to then.
*/
#include "dynamics/history/historyimpl.h"
#include "base/text.h"

#define SOUND_ROOM 64 /* characters of a column, without its name */

PetscBool HistoryHears(History h)
{
  PetscInt n = 0;

  (void)SoundGetMicrophones(h->sound, &n, NULL);
  return n ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode HistoryCreateSoundHeader(History h, char **header)
{
  const Microphone *microphone;
  PetscInt          n;
  size_t            room = SOUND_ROOM, length;

  PetscFunctionBeginUser;
  PetscCall(SoundGetMicrophones(h->sound, &n, &microphone));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscStrlen(microphone[i].name, &length));
    room += length + SOUND_ROOM;
  }
  PetscCall(PetscMalloc1(room, header));
  PetscCall(PetscStrncpy(*header, "time_s", room));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(TextAdd(*header, ",", room));
    PetscCall(TextAdd(*header, microphone[i].name, room));
    PetscCall(TextAdd(*header, "_pa", room));
  }
  PetscFunctionReturn(0);
}

/* Before the first row, or the first one of a run that goes on */
static PetscErrorCode HistoryListen(History h, const HistoryMotions *motions)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  if (h->listener) PetscFunctionReturn(0);
  PetscCall(ModelGetScene(h->source.model, &scene));
  PetscCheck(
    !motions || !scene->n_motions, h->comm, PETSC_ERR_SUP,
    "-sound_microphones hear the modes of a reduced model, not what motion %s moves: take -dynamics_model full, "
    "or leave one of them out",
    scene->motions[0].name);
  PetscCall(SoundListen(h->sound, h->rows.interval, &h->listener));
  if (motions) PetscCall(SoundListenerTakeShapes(h->listener, motions->shapes));
  if (h->n_heard) PetscCall(SoundListenerSetMemory(h->listener, h->n_heard, h->heard));
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryWriteSound(History h, const HistoryState *state)
{
  const Mesh *mesh;
  PetscInt    n;
  PetscReal  *row, *v, u[3], a[3];

  PetscFunctionBeginUser;
  PetscCall(HistoryListen(h, state->motions));
  PetscCall(SoundGetMicrophones(h->sound, &n, NULL));
  PetscCall(ModelGetMesh(h->source.model, &mesh));
  PetscCall(PetscMalloc2(n + 1, &row, 3 * mesh->n_nodes, &v));
  for (PetscInt i = 0; i < mesh->n_nodes && !state->motions; i++)
    HistoryMotion(h->source.layout, state, i, u, &v[3 * i], a);
  row[0] = state->time;
  PetscCall(SoundListenerHear(h->listener, state->motions ? state->motions->rate : v, &row[1]));
  PetscCall(ResultsTableNumbers(h->sound_table, n + 1, row));
  PetscCall(ResultsTableCheck(h->sound_table));
  PetscCall(PetscFree2(row, v));
  PetscFunctionReturn(0);
}
