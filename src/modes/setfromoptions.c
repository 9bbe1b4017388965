/*
   Options of the modes: what is looked for, and by which route.
*/
#include "modesimpl.h"
#include <squeal/options.h>

#define MODES_LARGEST 1e30 /* Hz, 1/s: squares stay finite */

static PetscErrorCode ModesCheckValues(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCheck(modes->left || !modes->filters, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_filters needs left vectors: leave out -modes_left false");
  PetscCheck(!modes->has_band || (modes->band[0] >= 0 && modes->band[1] > modes->band[0]), modes->comm,
             PETSC_ERR_USER_INPUT, "-modes_band %.6g,%.6g must satisfy 0 <= f1 < f2 (Hz)", (double)modes->band[0],
             (double)modes->band[1]);
  PetscCheck(modes->band[1] <= MODES_LARGEST && modes->target <= MODES_LARGEST && modes->growth <= MODES_LARGEST,
             modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_band, -modes_target (Hz) and -modes_growth (1/s) must be of at most %g", MODES_LARGEST);
  PetscCheck(modes->count > 0, modes->comm, PETSC_ERR_USER_INPUT, "-modes_count %" PetscInt_FMT " must be positive",
             modes->count);
  PetscCheck(modes->most >= 0, modes->comm, PETSC_ERR_USER_INPUT, "-modes_most %" PetscInt_FMT " must not be negative", modes->most);
  PetscCheck(modes->growth >= 0, modes->comm, PETSC_ERR_USER_INPUT, "-modes_growth %.6g must not be negative (1/s)",
             (double)modes->growth);
  PetscCheck(modes->max_time >= 0, modes->comm, PETSC_ERR_USER_INPUT, "-modes_max_time %.6g must not be negative (s)",
             (double)modes->max_time);
  PetscCheck(modes->target >= 0, modes->comm, PETSC_ERR_USER_INPUT, "-modes_target %.6g must not be negative (Hz)",
             (double)modes->target);
  PetscFunctionReturn(0);
}

/* A band or a number of modes nearest to a frequency: what the command line says before what files say, of files the number.
   What is then not used is said, and taken out. */
static PetscErrorCode ModesChooseRange(Modes modes, PetscBool has_target, PetscBool has_count)
{
  PetscBool band, target, count;

  PetscFunctionBeginUser;
  modes->has_nearest = has_target || has_count ? PETSC_TRUE : PETSC_FALSE;
  if (!modes->has_band || !modes->has_nearest) PetscFunctionReturn(0);
  PetscCall(OptionsCommandGives("modes_band", &band));
  PetscCall(OptionsCommandGives("modes_target", &target));
  PetscCall(OptionsCommandGives("modes_count", &count));
  if (band && (target || count))
    PetscCall(OptionsRefuse(modes->comm, "-modes_band", "not used beside -modes_target or -modes_count; give one"));
  if (band)
    PetscCall(OptionsDrop(modes->comm, "-modes_target -modes_count", "the command line gives -modes_band"));
  else
    PetscCall(OptionsDrop(modes->comm, "-modes_band",
                          has_count ? "-modes_count asks for the modes nearest to -modes_target"
                                    : "-modes_target asks for the modes nearest to it"));
  modes->has_band    = band;
  modes->has_nearest = band ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSetFromOptions(Modes modes)
{
  static const char *const contacts[] = {"all", "static"};
  static const char *const routes[]   = {"auto", "project", "pep"};
  PetscBool                has_target, has_count;
  PetscInt                 contact = 0;

  PetscFunctionBeginUser;
  PetscOptionsBegin(modes->comm, NULL, "Modes", NULL);
  PetscCall(OptionsGetReals(PetscOptionsObject, "-modes_band", "all modes with frequency in f1,f2, Hz", 2, modes->band,
                            &modes->has_band));
  PetscCall(OptionsGetReal(PetscOptionsObject, "-modes_target",
                           "instead of a band: the modes nearest to this frequency, Hz", modes->target, &modes->target,
                           &has_target));
  PetscCall(
    OptionsGetInt(PetscOptionsObject, "-modes_count", "how many of them", modes->count, &modes->count, &has_count));
  PetscCall(OptionsGetReal(
    PetscOptionsObject, "-modes_growth",
    "modes of a band with growth and decay up to this must be found, 1/s (0: a tenth of the angular frequency f2)",
    modes->growth, &modes->growth, NULL));
  PetscCall(ShiftsSetFromOptions(modes, PetscOptionsObject));
  PetscCall(
    OptionsGetInt(PetscOptionsObject, "-modes_most",
                  "modes that a band may hold, counted before they are computed; more are an error (0: any number)",
                  modes->most, &modes->most, &modes->has_most));
  PetscCall(OptionsGetReal(PetscOptionsObject, "-modes_max_time",
                           "time that a solution may take, s (0: any); asked after every solve",
                           modes->max_time, &modes->max_time, NULL));
  PetscCall(OptionsGetBool(PetscOptionsObject, "-modes_left", "left vectors: condition and error of each eigenvalue",
                           &modes->left));
  PetscCall(OptionsGetBool(PetscOptionsObject, "-modes_filters",
                           "write modal filters, which find the modes' amplitudes in a transient", &modes->filters));
  PetscCall(PetscOptionsString("-modes_disc", "part whose shapes are named by nodal circles and diameters", "modes.h",
                               modes->disc, modes->disc, sizeof(modes->disc), &modes->has_disc));
  PetscCall(PetscOptionsEList("-modes_contact", "pairs that are closed: every one, or those of the sliding state",
                              "modes.h", contacts, 2, contacts[0], &contact, NULL));
  PetscCall(PetscOptionsEList(
    "-modes_damping",
    "route of a damped solution: projection on undamped modes where damping is weak (auto), always (project), or PEP",
    "modes.h", routes, 3, routes[modes->damping], &modes->damping, &modes->has_route));
  PetscOptionsEnd();
  modes->is_static = contact ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ModesCheckValues(modes));
  PetscCall(ModesChooseRange(modes, has_target, has_count));
  PetscFunctionReturn(0);
}
