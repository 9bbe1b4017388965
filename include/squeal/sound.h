/*
   Sound - what vibrating surfaces radiate into the air: power of the parts, and pressure at microphones.

   Surface: all faces of the mesh with a cell on one side, without those of the surfaces of contacts and ties; n is the
   normal out of the body, v_n = v . n the velocity along it, rho and c those of the air.

      equivalent radiated power   P = rho c / 2  int |v_n|^2 dA                          W, v_n the amplitude

   is that of a large plate far above its coincidence frequency: small parts and low frequencies radiate less. Pressure
   is Rayleigh's integral, over the points y of the surface that face the microphone, n . R > 0, R = x - y,

      p(x) = i omega rho / (2 pi)  int v_n e^{-i k R} / R dA,   k = omega / c            Pa, of v e^{i omega t}
      p(x, t) = d/dt  rho / (2 pi)  int v_n(y, t - R / c) / R dA.

   It is exact for a flat surface in a rigid wall. A disc without a wall radiates less at low frequencies, where sound
   goes round its rim; what other bodies hide and reflect is left out. The surface stays where it is meshed. Integrals
   are by the quadrature of the faces.

   In time the surface is known at times t_n, h apart. A point adds what it does at t_n to the four nearest times of
   t_n + R / c, by Lagrange's polynomials of third order; the derivative is a central difference of fourth order. Both
   err by (omega h)^4 3 / 128 and (omega h)^4 / 30: 0.4 % and 0.5 % of a tone at 10 kHz with h = 10 us, 1/16 of that
   with 5 us. A microphone is at least 3 c h away from the surface.

   Air is in kg/m^3 and m/s, results in W and Pa, in scenes in mm, t, s, N, MPa, too. Microphones are in the scene's
   unit of length. Source: Kinsler, Frey, Coppens, Sanders, Fundamentals of Acoustics, chapter 7.
*/
#pragma once

#include <squeal/contact.h>
#include <squeal/model.h>
#include <squeal/quantity.h>

typedef struct _p_Sound *Sound;

/* A place at which pressure is asked for */
typedef struct {
  char     *name;
  PetscReal at[3]; /* in the scene's unit of length */
  PetscBool has_at;
} Microphone;

/*@ SoundCreate - no microphones; model and contact NULL for matrices without a mesh (referenced until SoundDestroy()).
    Collective. @*/
PetscErrorCode SoundCreate(MPI_Comm comm, Model model, Contact contact, Sound *sound);

/*@ SoundSetFromOptions - reads microphones and air. Collective. Options are the rows of src/sound/quantities.c. Errors:
    PETSC_ERR_USER_INPUT for microphones of matrices without a mesh. @*/
PetscErrorCode SoundSetFromOptions(Sound sound);

/*@ SoundVisit - shows the rows of its options. Collective. @*/
PetscErrorCode SoundVisit(Sound sound, const QuantityVisitor *visitor);

/*@ SoundGetMicrophones - those of -sound_microphones, 0 where no sound is asked for (borrowed). Not collective; NULL
    has none. @*/
PetscErrorCode SoundGetMicrophones(Sound sound, PetscInt *n, const Microphone **microphones);

/*@ SoundGetEnergy - of the vibration, J, that modes are told for. Not collective. @*/
PetscErrorCode SoundGetEnergy(Sound sound, PetscReal *energy);

/*@ SoundGetScale - how many J a unit of energy of the scene is: 1, or 1e-3 of N mm. Not collective; after
    SoundSetUp(). @*/
PetscErrorCode SoundGetScale(Sound sound, PetscReal *joule);

/*@
   SoundSetUp - finds the surface. Collective; after ModelSetUp().

   Errors: PETSC_ERR_USER_INPUT where the units of the scene are in doubt, where a microphone lies on the surface, and
   where no point of the surface faces it.
@*/
PetscErrorCode SoundSetUp(Sound sound);

/*@
   SoundMeasurePower - equivalent radiated power of each part. Collective; after SoundSetUp().

   Input Parameters:
.  vr, vi - velocity of the nodes, amplitude [nodes][3], in the scene's units
   Output Parameter:
.  power - [parts] W
@*/
PetscErrorCode SoundMeasurePower(Sound sound, const PetscReal vr[], const PetscReal vi[], PetscReal power[]);

/*@
   SoundMeasurePressure - pressure at the microphones. Collective; after SoundSetUp().

   Input Parameters:
+  omega - rad/s
-  vr, vi - velocity of the nodes, amplitude [nodes][3], in the scene's units
   Output Parameter:
.  pr, pi - [microphones] Pa, amplitude
@*/
PetscErrorCode SoundMeasurePressure(Sound sound, PetscReal omega, const PetscReal vr[], const PetscReal vi[],
                                    PetscReal pr[], PetscReal pi[]);

/*@ SoundCreateHeader - columns of a table of sound: `lead`, power_w, power_db, power_<part>_w of each part, and of each
    microphone _re_pa, _im_pa, _db, _dba; the caller frees it. Not collective. @*/
PetscErrorCode SoundCreateHeader(Sound sound, const char lead[], char **header);

/*@ SoundGetRowSize - numbers of a row behind `lead`. Not collective. @*/
PetscErrorCode SoundGetRowSize(Sound sound, PetscInt *n);

/*@
   SoundMeasureRow - one tone: W, dB, W, Pa, dB, dB(A) as the header has them. Collective; after SoundSetUp().

   Input Parameters:
+  omega - rad/s
-  vr, vi - velocity of the nodes, amplitude [nodes][3], in the scene's units
   Output Parameter:
.  row - [n] of SoundGetRowSize()

   Errors: PETSC_ERR_USER_INPUT for sound that is not finite.
@*/
PetscErrorCode SoundMeasureRow(Sound sound, PetscReal omega, const PetscReal vr[], const PetscReal vi[],
                               PetscReal row[]);

/*@ SoundAddRows - tones of different frequency together: their powers added up; the pressure is the root of the sum of
    squared amplitudes, without a phase. Not collective. @*/
PetscErrorCode SoundAddRows(Sound sound, PetscInt n, const PetscReal rows[], PetscReal all[]);

/* What a run in time has heard until now */
typedef struct _p_SoundListener *SoundListener;

/*@ SoundListen - begins to listen, at times h (s) apart. Collective; after SoundSetUp(). Errors: PETSC_ERR_USER_INPUT
    for a microphone nearer than 3 c h. @*/
PetscErrorCode SoundListen(Sound sound, PetscReal h, SoundListener *listener);

/* Shapes of which a motion is made: v = sum_k rate_k shape_k. get() gives that of one at the nodes [nodes][3];
   collective */
typedef struct {
  PetscInt n;
  PetscErrorCode (*get)(void *ctx, PetscInt k, PetscReal v[]);
  void *ctx;
} SoundShapes;

/*@ SoundListenerTakeShapes - what each shape does to the pressure, once: SoundListenerHear() then takes rates.
    Collective; before the first time. @*/
PetscErrorCode SoundListenerTakeShapes(SoundListener listener, const SoundShapes *shapes);

/*@ SoundListenerHear - adds the velocities v of the next time, [nodes][3], or the rates [shapes], the same on
    every rank; pressure [microphones] (Pa) of that time. Collective. @*/
PetscErrorCode SoundListenerHear(SoundListener listener, const PetscReal v[], PetscReal pressure[]);

/*@ SoundListenerGetMemory, SoundListenerSetMemory - what a restart needs, n numbers, the same on every rank; the caller
    frees values. Collective. @*/
PetscErrorCode SoundListenerGetMemory(SoundListener listener, PetscInt *n, PetscReal **values);
PetscErrorCode SoundListenerSetMemory(SoundListener listener, PetscInt n, const PetscReal values[]);

/*@ SoundAddChecksum - adds microphones and air to the present part. Not collective. @*/
PetscErrorCode SoundAddChecksum(Sound sound, Checksum checksum);

PetscErrorCode SoundListenerDestroy(SoundListener *listener);
PetscErrorCode SoundDestroy(Sound *sound);
