/* Private to sound/: the record, and the surface as points of its quadrature */
#pragma once

#include <squeal/sound.h>

/* Points of the quadrature of the free faces of this rank. A velocity along the normal is sum_k row[k] . v of the nodes
   first[q] .. first[q + 1] */
typedef struct {
  PetscInt   n;
  PetscInt  *first, *node; /* [n + 1]; local nodes */
  PetscReal *row;          /* [first[n]][3] shape function times normal, -, times what makes m/s of the scene's speed */
  PetscReal *x;            /* [n][3] m */
  PetscReal *normal;       /* [n][3] out of the body, of length 1 */
  PetscReal *area;         /* [n] m^2 */
  PetscInt  *part;         /* [n] */
} SoundSurface;

struct _p_Sound {
  MPI_Comm     comm;
  Model        model;
  Contact      contact;
  PetscInt     n; /* microphones */
  Microphone  *microphone;
  PetscReal    density, speed; /* of the air, kg/m^3 and m/s */
  PetscReal    energy;         /* of a mode, J */
  PetscReal    metre;          /* m in a unit of length of the scene */
  SoundSurface surface;
  PetscBool    is_ready;
};

/* quantities.c */
extern const QuantityList  microphones_list;
extern const QuantityTable sound_quantities;

/* surface.c - all points. Collective */
PETSC_INTERN PetscErrorCode SoundSurfaceCreate(Sound sound, SoundSurface *surface);
PETSC_INTERN PetscErrorCode SoundSurfaceDestroy(SoundSurface *surface);
/* Velocity along the normal at point q, m/s */
PETSC_INTERN PetscReal SoundSurfaceNormal(const SoundSurface *surface, PetscInt q, const PetscReal v[]);
/* Distance from point q to a place (m), negative where the point does not face it */
PETSC_INTERN PetscReal SoundSurfaceDistance(const SoundSurface *surface, PetscInt q, const PetscReal x[3]);

/* The place of a microphone, m */
static inline void SoundPlace(Sound sound, PetscInt i, PetscReal x[3])
{
  for (int d = 0; d < 3; d++) x[d] = sound->metre * sound->microphone[i].at[d];
}
