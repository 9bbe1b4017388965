/*
   Help: the short one of -h, the list of all options of -help, the versions.

   The options are those that PETSc's help printer is told of while all rooms read theirs: its lines are taken apart
   into name, value in force, default and text. PETSc prints lists of types past the help printer, hence both are
   replaced for that time.
*/
#include "help.h"
#include "base/algebra/blas.h"
#include <squeal/sys.h>
#include <slepcsys.h>
#include <stdarg.h>
#include <stdlib.h>
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
  "The same in words, with an example of each: options/README.md. A first hour: options/tutorial.md.\n";

/* A scene with one name in every list, for -help where there is none */
static const char names_of_all[] =
  "-model_source rig -parts part -part_young 1 -part_density 1 -supports support -support_set S "
  "-springs spring -spring_set S -spring_stiffness 1,1,1 -dashpots dashpot -dashpot_set S -dashpot_viscosity 1,1,1 "
  "-joints bushing -bushing_a S -bushing_stiffness 1,1,1 -points point -point_set S -point_mass 1 "
  "-loads load -load_set S -load_force 0,0,1 -contacts contact -contact_surfaces S,M -contact_kn 1 -contact_slip 1,0,0 "
  "-probes probe -probe_at 0,0,0 -motions motion -motion_set S -motion_directions z "
  "-circles circle -circle_radius 1 -circle_count 8 -impulses impulse -impulse_at 0,0,0 "
  "-impulse_impulse 0,0,1 -modes_changes change -change_at 0,0,0 -change_mass 1 -terms term -ties tie -tie_surfaces "
  "S,M";

/* Where the printers below put what they are told. PETSc's printers are bare function pointers without context: hence
   the one static record, alive only inside HelpCollect(). */
static struct {
  HelpList *list;
  char      line[4096], group[96];
} collecting;

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

/* Copies what stands between two places, without blanks at its ends */
static void Cut(const char *begin, const char *end, char text[], size_t size)
{
  while (begin < end && *begin == ' ') begin++;
  while (begin < end && end[-1] == ' ') end--;
  (void)snprintf(text, size, "%.*s", (int)(end - begin), begin);
}

/* Writes 0 for PETSc's "0." */
static void CutPoint(char text[])
{
  const size_t length = strlen(text);

  if (length > 1 && text[length - 1] == '.' && strspn(text, "-0123456789") == length - 1) text[length - 1] = '\0';
}

/* Takes "<now 3 : formerly 2>" or "<3 : 2>" or "<3>" apart */
static void ParseValues(const char *begin, const char *end, HelpOption *option)
{
  const char *middle = strstr(begin, " : ");
  PetscBool   two; /* a default, which may be empty */

  if (!strncmp(begin, "now ", 4)) begin += 4;
  if (!middle || middle > end) middle = end;
  two = middle < end ? PETSC_TRUE : PETSC_FALSE;
  Cut(begin, strncmp(begin, "string1", 7) ? middle : begin, option->value, sizeof(option->value));
  if (middle < end) middle += 3;
  if (!strncmp(middle, "formerly ", 9)) middle += 9;
  if (two)
    Cut(middle, end, option->initial, sizeof(option->initial));
  else
    memcpy(option->initial, option->value, sizeof(option->initial));
  CutPoint(option->value);
  CutPoint(option->initial);
}

/* Takes "  -disc_young <2.1e+11 : 0.>: Young's modulus, Pa (model.h)" apart; false for other lines */
static PetscBool ParseOption(const char line[], HelpOption *option)
{
  const char *begin = line + strspn(line, " "), *man = strrchr(line, '('), *end;
  size_t      length;

  if (*begin++ != '-') return PETSC_FALSE;
  length = strspn(begin, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_");
  if (!length || length >= HELP_MAX_NAME) return PETSC_FALSE;
  Cut(begin, begin + length, option->name, sizeof(option->name));
  begin += length;
  begin += strspn(begin, ": ");
  end = *begin == '<' ? strchr(begin, '>') : NULL;
  if (end) ParseValues(begin + 1, end, option);
  begin       = end ? end + 1 : begin;
  option->own = man && !strcmp(man + strcspn(man, ".)"), ".h)") ? PETSC_TRUE : PETSC_FALSE;
  if (!man) man = line + strlen(line);
  Cut(begin + strspn(begin, ": "), man, option->text, sizeof(option->text));
  return PETSC_TRUE;
}

/* Keeps the option of a whole line, or the title of those that follow */
static PetscErrorCode CollectLine(const char line[])
{
  HelpList *const list   = collecting.list;
  HelpOption      option = {0};
  const size_t    length = strlen(line);

  PetscFunctionBeginUser;
  if (!ParseOption(line, &option)) {
    if (length && line[0] != ' ' && line[length - 1] == ':' && strncmp(line, "Viewer (", 8))
      Cut(line, line + length - 1, collecting.group, sizeof(collecting.group));
    PetscFunctionReturn(0);
  }
  if (list->n == list->max) {
    HelpOption *more = realloc(list->option, (size_t)(2 * list->max + 64) * sizeof(*more));

    PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the list of options");
    list->option = more;
    list->max    = 2 * list->max + 64;
  }
  memcpy(option.group, collecting.group, sizeof(option.group));
  list->option[list->n++] = option;
  PetscFunctionReturn(0);
}

/* Stands in for PetscHelpPrintf, which may be told a line in pieces */
static PetscErrorCode CollectHelp(MPI_Comm comm, const char format[], ...)
{
  const size_t used = strlen(collecting.line);
  size_t       length;
  char        *end;
  va_list      args;

  PetscFunctionBeginUser;
  (void)comm;
  va_start(args, format);
  PetscCall(PetscVSNPrintf(collecting.line + used, sizeof(collecting.line) - used, format, &length, args));
  va_end(args);
  while ((end = strchr(collecting.line, '\n'))) {
    *end = '\0';
    PetscCall(CollectLine(collecting.line));
    (void)memmove(collecting.line, end + 1, strlen(end + 1) + 1);
  }
  PetscFunctionReturn(0);
}

/* Stand in for the printers of help and of all else, and print nothing */
static PetscErrorCode HushHelp(MPI_Comm comm, const char format[], ...)
{
  (void)comm;
  (void)format;
  return 0;
}

static PetscErrorCode HushAll(FILE *file, const char format[], va_list args)
{
  (void)file;
  (void)format;
  (void)args;
  return 0;
}

void HelpHush(int argc, char *const argv[])
{
  for (int i = 1; i < argc; i++)
    if (!strcmp(argv[i], "-help")) PetscHelpPrintf = HushHelp;
}

/* Whether whoever reads an option from now on tells the help printer of it, also of those read before */
static PetscErrorCode HelpForce(PetscBool on)
{
  PetscFunctionBeginUser;
  if (on)
    PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
  else
    PetscCall(PetscOptionsClearValue(NULL, "-help"));
  PetscCall(PetscOptionsHelpPrintedDestroy(&PetscOptionsHelpPrintedSingleton));
  PetscFunctionReturn(0);
}

PetscErrorCode HelpCollect(MPI_Comm comm, PetscErrorCode (*read_again)(MPI_Comm, void *), void *ctx, HelpList *list)
{
  PetscErrorCode (*const printer)(MPI_Comm, const char[], ...)       = PetscHelpPrintf;
  PetscErrorCode (*const all_printer)(FILE *, const char[], va_list) = PetscVFPrintf;
  PetscErrorCode error;
  PetscBool      asked;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasHelp(NULL, &asked));
  PetscCall(HelpForce(PETSC_TRUE));
  collecting.list    = list;
  collecting.line[0] = '\0';
  PetscHelpPrintf    = CollectHelp;
  PetscVFPrintf      = HushAll;
  error              = (*read_again)(comm, ctx);
  PetscHelpPrintf    = printer;
  PetscVFPrintf      = all_printer;
  collecting.list    = NULL;
  if (!asked) PetscCall(HelpForce(PETSC_FALSE));
  PetscCall(error);
  PetscFunctionReturn(0);
}

/* Prints one of squeal's options: name, value in force, text, and the default where it is another one. In an example
   scene the value is the default */
static PetscErrorCode HelpPrintOption(MPI_Comm comm, const HelpOption *option, PetscBool example)
{
  static const char choose[] = "(choose one of)";
  const char       *choice   = strstr(option->text, choose);
  const PetscBool   required = strstr(option->text, "(required)") ? PETSC_TRUE : PETSC_FALSE;
  const char       *value    = example ? (required ? "" : option->initial) : option->value;
  const PetscBool   changed  = strcmp(value, option->initial) && !required ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, "  -%-28s %-14s %.*s", option->name, value,
                        (int)(choice ? choice - option->text : (ptrdiff_t)strlen(option->text)), option->text));
  if (choice) PetscCall(PetscPrintf(comm, "(one of%s)", choice + strlen(choose)));
  if (changed) PetscCall(PetscPrintf(comm, " [default %s]", option->initial[0] ? option->initial : "none"));
  PetscCall(PetscPrintf(comm, "\n"));
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

/* Prints the options of squeal among those of the list */
static PetscErrorCode HelpPrint(MPI_Comm comm, const HelpList *list, PetscBool example)
{
  const char *group = "";

  PetscFunctionBeginUser;
  for (int i = 0; i < list->n; i++) {
    if (!list->option[i].own) continue;
    if (strcmp(group, list->option[i].group)) PetscCall(PetscPrintf(comm, "%s\n", list->option[i].group));
    group = list->option[i].group;
    PetscCall(HelpPrintOption(comm, &list->option[i], example));
  }
  PetscCall(PetscPrintf(comm,
                        "PETSc's and SLEPc's own, such as -ts_max_time, -ts_dt, -eps_*, -pep_*, -st_*, -log_view, "
                        "-options_file: squeal -help_all\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode HelpIsAsked(HelpKind *kind)
{
  PetscBool list, all, json;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasHelp(NULL, &list));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-help_all", &all));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-help_json", &json));
  *kind = json ? HELP_JSON : all ? HELP_ALL : list ? HELP_LIST : HELP_NONE;
  PetscFunctionReturn(0);
}

PetscErrorCode SquealViewOptions(MPI_Comm comm, PetscErrorCode (*read_again)(MPI_Comm, void *),
                                 PetscErrorCode (*write)(MPI_Comm, void *), void *ctx, PetscBool *asked)
{
  HelpList  list = {0};
  HelpKind  kind;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(HelpIsAsked(&kind));
  *asked = kind == HELP_NONE ? PETSC_FALSE : PETSC_TRUE;
  if (!*asked) PetscFunctionReturn(0);
  PetscCall(SceneIsGiven(&given));
  if (!given) PetscCall(PetscOptionsInsertString(NULL, names_of_all));
  if (kind == HELP_ALL) PetscCall(HelpForce(PETSC_TRUE));
  if (kind == HELP_ALL) PetscCall((*read_again)(comm, ctx));
  if (kind == HELP_JSON) PetscCall((*write)(comm, ctx));
  if (kind != HELP_LIST) PetscFunctionReturn(0);
  PetscCall(HelpCollect(comm, read_again, ctx, &list));
  PetscCall(PetscPrintf(comm, "squeal %s: friction-induced vibration of bodies in sliding contact\n", SQUEAL_VERSION));
  PetscCall(HelpPrint(comm, &list, given ? PETSC_FALSE : PETSC_TRUE));
  free(list.option);
  PetscFunctionReturn(0);
}
