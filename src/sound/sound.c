/* Sound: life cycle, options, and the surface where it is asked for */
#include "soundimpl.h"
#include <string.h>

PetscErrorCode SoundCreate(MPI_Comm comm, Model model, Contact contact, Sound *sound)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(sound));
  **sound = (struct _p_Sound){.comm = comm, .model = model, .contact = contact};
  PetscCall(QuantitiesInit(&sound_quantities, *sound));
  PetscFunctionReturn(0);
}

PetscErrorCode SoundSetFromOptions(Sound sound)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesReadList(sound->comm, &microphones_list, sound, &sound->n, &sound->microphone));
  PetscCall(QuantitiesRead(sound->comm, &sound_quantities, sound));
  PetscCheck(!sound->n || sound->model, sound->comm, PETSC_ERR_USER_INPUT,
             "-sound_microphones: matrices without a mesh have no surface that radiates");
  for (PetscInt i = 0; i < sound->n; i++)
    PetscCheck(strcmp(sound->microphone[i].name, "power"), sound->comm, PETSC_ERR_USER_INPUT,
               "-sound_microphones power: sound.csv has columns of that name; choose another one");
  PetscFunctionReturn(0);
}

PetscErrorCode SoundVisit(Sound sound, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisitList(visitor, &microphones_list, sound->n, sound->microphone));
  PetscCall(QuantitiesVisit(visitor, &sound_quantities, NULL, sound, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode SoundGetMicrophones(Sound sound, PetscInt *n, const Microphone **microphones)
{
  PetscFunctionBeginUser;
  *n = sound ? sound->n : 0;
  if (microphones) *microphones = sound ? sound->microphone : NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode SoundGetEnergy(Sound sound, PetscReal *energy)
{
  PetscFunctionBeginUser;
  *energy = sound->energy;
  PetscFunctionReturn(0);
}

PetscErrorCode SoundGetScale(Sound sound, PetscReal *joule)
{
  PetscFunctionBeginUser;
  *joule = sound->metre;
  PetscFunctionReturn(0);
}

/* m in the scene's unit of length */
static PetscErrorCode SoundFindUnits(Sound sound)
{
  const char *units, *length;

  PetscFunctionBeginUser;
  PetscCall(ModelUnits(sound->model, &units));
  PetscCheck(units, sound->comm, PETSC_ERR_USER_INPUT,
             "-sound_microphones: the units of the scene are in doubt: give all in m, kg, s, N, Pa or in mm, t, s, N, "
             "MPa");
  PetscCall(ModelGetUnit(sound->model, "m", &length));
  sound->metre = strcmp(length, "m") ? 1e-3 : 1;
  PetscFunctionReturn(0);
}

/* Raises an error for a microphone that no point of the surface faces */
static PetscErrorCode SoundCheckMicrophones(Sound sound)
{
  const SoundSurface *s = &sound->surface;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < sound->n; i++) {
    const Microphone *m = &sound->microphone[i];
    PetscReal         x[3];
    PetscBool         is_faced = PETSC_FALSE;

    SoundPlace(sound, i, x);
    for (PetscInt q = 0; q < s->n && !is_faced; q++)
      if (SoundSurfaceDistance(s, q, x) > 0) is_faced = PETSC_TRUE;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &is_faced, 1, MPIU_BOOL, MPI_LOR, sound->comm));
    PetscCheck(is_faced, sound->comm, PETSC_ERR_USER_INPUT,
               "-%s_at %.6g,%.6g,%.6g: no free face of the mesh faces this microphone: place it outside of the bodies",
               m->name, (double)m->at[0], (double)m->at[1], (double)m->at[2]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SoundSetUp(Sound sound)
{
  PetscFunctionBeginUser;
  if (!sound->n || sound->is_ready) PetscFunctionReturn(0);
  PetscCall(SoundFindUnits(sound));
  PetscCall(SoundSurfaceCreate(sound, &sound->surface));
  sound->is_ready = PETSC_TRUE;
  PetscCall(SoundCheckMicrophones(sound));
  PetscFunctionReturn(0);
}

PetscErrorCode SoundAddChecksum(Sound sound, Checksum checksum)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(checksum, "-sound_microphones"));
  for (PetscInt i = 0; sound && i < sound->n; i++) {
    PetscCall(ChecksumAddString(checksum, sound->microphone[i].name));
    PetscCall(ChecksumAddReals(checksum, 3, sound->microphone[i].at));
  }
  if (sound && sound->n) PetscCall(ChecksumAddReals(checksum, 2, (const PetscReal[]){sound->density, sound->speed}));
  PetscFunctionReturn(0);
}

PetscErrorCode SoundDestroy(Sound *sound)
{
  PetscFunctionBeginUser;
  if (!*sound) PetscFunctionReturn(0);
  if ((*sound)->is_ready) PetscCall(SoundSurfaceDestroy(&(*sound)->surface));
  for (PetscInt i = 0; i < (*sound)->n; i++) PetscCall(PetscFree((*sound)->microphone[i].name));
  PetscCall(PetscFree((*sound)->microphone));
  PetscCall(PetscFree(*sound));
  PetscFunctionReturn(0);
}
