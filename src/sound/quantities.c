/* Options of sound */
#include "soundimpl.h"

#define SOUND_AT(member) QUANTITY_AT(struct _p_Sound, member)
#define HEARD            (RUN_MODES | RUN_FRF | RUN_CYCLE | RUN_HISTORY)

static const char *SoundIdle(const void *sound, const QuantityRun *run)
{
  (void)run;
  return ((const struct _p_Sound *)sound)->n ? NULL : "not used without -sound_microphones";
}

static const Quantity rows[] = {
  {"-sound_density", "density of the air, in any set of units", "kg/m^3", QUANTITY_REAL, SOUND_AT(density),
   .initial = 1.204, QUANTITY_POSITIVE, .idle = SoundIdle, .restart = PETSC_TRUE},
  {"-sound_speed", "speed of sound in it, in any set of units", "m/s", QUANTITY_REAL, SOUND_AT(speed), .initial = 343.2,
   QUANTITY_POSITIVE, .idle = SoundIdle, .restart = PETSC_TRUE},
  {"-sound_energy", "energy of vibration at which the sound of each mode is stated", "J", QUANTITY_REAL,
   SOUND_AT(energy), .initial = 1e-3, QUANTITY_POSITIVE, .idle = SoundIdle, .in = RUN_MODES | RUN_FRF},
};
const QuantityTable sound_quantities = {"Sound", "sound.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = HEARD};

static const Quantity microphone[] = {
  {"-at", "place x,y,z", "m", QUANTITY_REALS, QUANTITY_AT(Microphone, at), .given = offsetof(Microphone, has_at),
   .required = PETSC_TRUE, .why = "the place x,y,z (m)", .restart = PETSC_TRUE},
};
static const QuantityTable microphones = {"Microphone", "sound.h", PETSC_STATIC_ARRAY_LENGTH(microphone), microphone,
                                          .in = HEARD};

const QuantityList microphones_list = {"-sound_microphones",
                                       "where the pressure of sound is told, each the prefix of its -at",
                                       sizeof(Microphone),
                                       &microphones,
                                       NULL,
                                       .in = HEARD};
