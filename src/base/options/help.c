/*
   Help: the short one of -h, the versions, and which help is asked for. The lists of options are made of the rows
   (quantity/help.c).
*/
#include "help.h"
#include "base/algebra/blas.h"
#include "base/text.h"
#include <squeal/sys.h>
#include <slepcsys.h>
#include <stdio.h>
#include <string.h>
#if __has_include(<dmumps_c.h>)
#include <dmumps_c.h>
#endif

static const char usage[] =
  "It builds one finite-element model of a scene, which a YAML file describes, and answers three questions:\n"
  "where the surfaces touch while they slide, which vibrations grow, and what they grow into.\n"
  "  squeal -options_file options/massi2005.yaml          modes: frequency and growth of each\n"
  "  mpirun -n 2 squeal -options_file FILE [any option]   the same on two ranks\n";

static const char most_used[] =
  "Units are m, kg, s, N, Pa, Hz, or another consistent set. The ten options most used, as one gives them:\n"
  "  -options_file FILE         the scene; a later file overrides an earlier one, the command line overrides both\n"
  "  -analysis static           or modes (default), sweep, transient, frf, map, cycle\n"
  "  -output_dir results        folder of tables and shapes\n"
  "  -modes_band 1000,10000     all modes between these frequencies, Hz\n"
  "  -modes_contact all         modes with all pairs closed, not about those that touch under the loads\n"
  "  -contact_mu 0.3            friction of the contact 'contact'; each name in a scene is the prefix of its options\n"
  "  -pad_young 16e9            modulus of the part 'pad', Pa\n"
  "  -sweep_parameter contact_mu -sweep_values 0:1:11\n"
  "  -ts_max_time 10e-3         end of a transient, s\n"
  "  -squeal_view               says what was built and chosen, and the time of each stage\n"
  "All options with unit and default: squeal -help. Those of a scene's own names: squeal -options_file FILE -help.\n"
  "The same in words, with an example of each: options/reference.md. A first hour: options/tutorial.md.\n";

/* A scene with one name in every list, for -help where there is none */
static const char names_of_all[] =
  "-model_source rig -parts part -part_young 1 -part_density 1 -supports support -support_set S "
  "-springs spring -spring_set S -spring_stiffness 1,1,1 -dashpots dashpot -dashpot_set S -dashpot_viscosity 1,1,1 "
  "-joints bushing -bushing_a S -bushing_stiffness 1,1,1 -points point -point_set S -point_mass 1 "
  "-loads load -load_set S -load_force 0,0,1 -contacts contact -contact_surfaces S,M -contact_kn 1 -contact_slip 1,0,0 "
  "-probes probe -probe_at 0,0,0 -sound_microphones microphone -microphone_at 0,0,1 "
  "-motions motion -motion_set S -motion_directions z "
  "-circles circle -circle_radius 1 -circle_count 8 -impulses impulse -impulse_at 0,0,0 "
  "-impulse_impulse 0,0,1 -modes_changes change -change_at 0,0,0 -change_mass 1 -terms term -superelements body "
  "-ties tie -tie_surfaces S,M -stages stage -stage_loads load -sample_variables variable -variable_deviation 1 "
  "-sample_columns column";

void SquealGetVersions(SquealVersions *versions)
{
  int length = 0;

  (void)memset(versions, 0, sizeof(*versions));
  (void)snprintf(versions->squeal, sizeof(versions->squeal), "%s", SQUEAL_VERSION);
  (void)snprintf(versions->petsc, sizeof(versions->petsc), "%d.%d.%d", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR,
                 PETSC_VERSION_SUBMINOR);
  (void)snprintf(versions->slepc, sizeof(versions->slepc), "%d.%d.%d", SLEPC_VERSION_MAJOR, SLEPC_VERSION_MINOR,
                 SLEPC_VERSION_SUBMINOR);
#if defined(MUMPS_VERSION)
  (void)snprintf(versions->mumps, sizeof(versions->mumps), "%s", MUMPS_VERSION);
#else
  (void)snprintf(versions->mumps, sizeof(versions->mumps), "of PETSc");
#endif
  BlasGetName(sizeof(versions->blas), versions->blas);
  (void)MPI_Get_library_version(versions->mpi, &length);
  versions->mpi[strcspn(versions->mpi, ",\n")] = '\0';
}

PetscBool HelpAnswer(int argc, char *const argv[])
{
  SquealVersions versions;
  PetscBool      brief = PETSC_FALSE, version = PETSC_FALSE;
  int            rank;

  for (int i = 1; i < argc; i++) {
    brief   = brief || !strcmp(argv[i], "-h") || !strcmp(argv[i], "--help") ? PETSC_TRUE : PETSC_FALSE;
    version = version || !strcmp(argv[i], "-version") || !strcmp(argv[i], "--version") ? PETSC_TRUE : PETSC_FALSE;
  }
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank || !(brief || version)) return brief || version;
  SquealGetVersions(&versions);
  printf("squeal %s: friction-induced vibration of bodies in sliding contact, brake squeal first\n", versions.squeal);
  if (brief)
    printf("%s%s", usage, most_used);
  else
    printf("PETSc %s, SLEPc %s, MUMPS %s, %s, %s\n", versions.petsc, versions.slepc, versions.mumps, versions.blas,
           versions.mpi);
  return PETSC_TRUE;
}

PetscErrorCode SquealViewUsage(MPI_Comm comm)
{
  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm,
                        "squeal %s: friction-induced vibration of bodies in sliding contact\n%s"
                        "  squeal -h                                            the options most used\n",
                        SQUEAL_VERSION, usage));
  PetscFunctionReturn(0);
}

void HelpRename(int argc, char *argv[])
{
  static char list[] = "-help_list";

  for (int i = 1; i < argc; i++)
    if (!strcmp(argv[i], "-help")) argv[i] = list;
}

/* Names shown so far, and the title that waits for the first line under it, where each name is shown once */
static struct {
  PetscErrorCode (*print)(FILE *, const char[], va_list);
  PetscOptionsHelpPrinted shown;
  char                    title[512];
  PetscBool               inside, skip; /* a line has begun; its name was shown before */
} once;

static PetscErrorCode HelpPrint(FILE *file, const char format[], ...)
{
  va_list list;

  PetscFunctionBeginUser;
  va_start(list, format);
  PetscCall((*once.print)(file, format, list));
  va_end(list);
  PetscFunctionReturn(0);
}

/* In place of PetscVFPrintf: solvers of one kind print the same names again, and viewers a line for each of their
   types. A line begins with blanks and the dash of its name and may come in pieces. */
static PetscErrorCode HelpPrintOnce(FILE *file, const char format[], va_list list)
{
  char      text[8192], name[HELP_MAX_NAME];
  size_t    length = 0, blanks;
  PetscBool begins;

  PetscFunctionBeginUser;
  PetscCall(PetscVSNPrintf(text, sizeof(text), format, &length, list));
  PetscCall(PetscStrlen(text, &length));
  blanks = strspn(text, " ");
  begins = text[0] == ' ' && text[blanks] == '-' ? PETSC_TRUE : PETSC_FALSE;
  if (!once.inside && !begins) {
    if (text[0] == '-') once.title[0] = '\0';
    PetscCall(WordsAdd(once.title, text, sizeof(once.title)));
    PetscFunctionReturn(0);
  }
  if (begins) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%.*s", (int)strcspn(text + blanks, " :"), text + blanks));
    PetscCall(PetscOptionsHelpPrintedCheck(once.shown, "", name, &once.skip));
    if (!once.skip) PetscCall(HelpPrint(file, "%s", once.title));
    if (!once.skip) once.title[0] = '\0';
  }
  if (!once.skip) PetscCall(HelpPrint(file, "%s", text));
  once.inside = text[length - 1] != '\n' ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Until HelpShowLibraries() is off again */
static PetscErrorCode HelpBeginOnce(void)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHelpPrintedCreate(&once.shown));
  once.print    = PetscVFPrintf;
  PetscVFPrintf = HelpPrintOnce;
  PetscFunctionReturn(0);
}

PetscErrorCode HelpShowLibraries(PetscBool on)
{
  PetscFunctionBeginUser;
  if (on)
    PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
  else
    PetscCall(PetscOptionsClearValue(NULL, "-help"));
  PetscCall(PetscOptionsHelpPrintedDestroy(&PetscOptionsHelpPrintedSingleton));
  if (!on) PetscVFPrintf = once.print;
  if (!on) PetscCall(PetscOptionsHelpPrintedDestroy(&once.shown));
  PetscFunctionReturn(0);
}

PetscErrorCode HelpIsAsked(HelpKind *kind)
{
  PetscBool list, all, json;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-help_list", &list));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-help_all", &all));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-help_json", &json));
  *kind = json ? HELP_JSON : all ? HELP_ALL : list ? HELP_LIST : HELP_NONE;
  PetscFunctionReturn(0);
}

/* Whether options of names, or matrices, tell of a scene */
static PetscErrorCode SceneIsGiven(PetscBool *given)
{
  static const char *const first[] = {"-options_file", "-parts", "-operators_load_k", "-operators_dense_k", "-terms"};

  PetscFunctionBeginUser;
  *given = PETSC_FALSE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(first) && !*given; i++)
    PetscCall(PetscOptionsHasName(NULL, NULL, first[i], given));
  PetscFunctionReturn(0);
}

PetscErrorCode HelpBegin(HelpKind *kind, PetscBool *example)
{
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(HelpIsAsked(kind));
  if (*kind == HELP_NONE) PetscFunctionReturn(0); /* to look for an option would make it one that is read */
  PetscCall(SceneIsGiven(&given));
  *example = given ? PETSC_FALSE : PETSC_TRUE;
  if (*kind == HELP_ALL) PetscCall(HelpBeginOnce());
  if (*example) PetscCall(PetscOptionsInsertString(NULL, names_of_all));
  PetscFunctionReturn(0);
}
