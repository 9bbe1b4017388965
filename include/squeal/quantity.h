/*
   Quantity - what an option sets, in one row: its name, help, unit, limits, where it lies in the struct of its owner,
   which runs read it, and whether a restart depends on it. A table of rows is read, checked and summed by one call
   each. Rows stand in quantities.c of their room, options that need more in its SetFromOptions(). A room shows all its
   tables to a visitor, XVisit(): one of them refuses, on the command line, what a run does not read.
*/
#pragma once

#include <squeal/checksum.h>
#include <squeal/options.h>
#include <stddef.h>

/* What a run computes, -analysis, and its words */
typedef enum {
  ANALYSIS_MODES,
  ANALYSIS_SWEEP,
  ANALYSIS_STATIC,
  ANALYSIS_TRANSIENT,
  ANALYSIS_FRF,
  ANALYSIS_MAP,
  ANALYSIS_CYCLE,
  ANALYSIS_SAMPLE,
  ANALYSIS_SUPERELEMENT,
  ANALYSIS_QUIET,
  ANALYSIS_DESIGN,
  ANALYSIS_CHECK,
  N_ANALYSES
} Analysis;
static const char *const AnalysisNames[N_ANALYSES + 1] = {
  [ANALYSIS_MODES] = "modes",         [ANALYSIS_SWEEP] = "sweep",   [ANALYSIS_STATIC] = "static",
  [ANALYSIS_TRANSIENT] = "transient", [ANALYSIS_FRF] = "frf",       [ANALYSIS_MAP] = "map",
  [ANALYSIS_CYCLE] = "cycle",         [ANALYSIS_SAMPLE] = "sample", [ANALYSIS_SUPERELEMENT] = "superelement",
  [ANALYSIS_QUIET] = "quiet",         [ANALYSIS_DESIGN] = "design", [ANALYSIS_CHECK] = "check",
}; /* NULL at the end */

/* What a run does, as bits: who reads a row. The first N_ANALYSES are the analyses */
typedef enum {
  RUN_MODES        = 1 << ANALYSIS_MODES,
  RUN_SWEEP        = 1 << ANALYSIS_SWEEP,
  RUN_STATIC       = 1 << ANALYSIS_STATIC,
  RUN_TRANSIENT    = 1 << ANALYSIS_TRANSIENT,
  RUN_FRF          = 1 << ANALYSIS_FRF,
  RUN_MAP          = 1 << ANALYSIS_MAP,
  RUN_CYCLE        = 1 << ANALYSIS_CYCLE,
  RUN_SAMPLE       = 1 << ANALYSIS_SAMPLE,
  RUN_SUPERELEMENT = 1 << ANALYSIS_SUPERELEMENT,
  RUN_QUIET        = 1 << ANALYSIS_QUIET,
  RUN_DESIGN       = 1 << ANALYSIS_DESIGN,
  RUN_CHECK        = 1 << ANALYSIS_CHECK,
  RUN_LINEAR       = RUN_MODES | RUN_SWEEP | RUN_FRF | RUN_SAMPLE | RUN_QUIET | RUN_DESIGN,
  RUN_IN_TIME      = RUN_TRANSIENT | RUN_MAP | RUN_CYCLE,
  RUN_MOVES        = RUN_LINEAR | RUN_IN_TIME,
  /* and what it does within them */
  RUN_EQUILIBRIUM = 1 << N_ANALYSES,       /* it finds an equilibrium */
  RUN_SLIDING     = RUN_EQUILIBRIUM << 1,  /* modes and their like about the sliding state */
  RUN_IDENTIFY    = RUN_EQUILIBRIUM << 2,  /* it presses contacts to find their stiffness */
  RUN_HOLDS       = RUN_EQUILIBRIUM << 3,  /* an equilibrium with pairs that can stick */
  RUN_WEIGHT      = RUN_EQUILIBRIUM << 4,  /* gravity acts */
  RUN_FACTORS     = RUN_EQUILIBRIUM << 5,  /* it factorises matrices */
  RUN_HISTORY     = RUN_EQUILIBRIUM << 6,  /* a transient from its beginning to its end */
  RUN_MESH        = RUN_EQUILIBRIUM << 7,  /* of the mesh */
  RUN_REDUCED     = RUN_EQUILIBRIUM << 8,  /* or of a reduced model */
  RUN_BODIES      = RUN_EQUILIBRIUM << 9,  /* of a scene with a mesh, not of matrices */
  RUN_CONTACTS    = RUN_EQUILIBRIUM << 10, /* which has contacts */
  RUN_FIELDS      = RUN_EQUILIBRIUM << 11, /* it may write fields */
  RUN_DAMPED      = RUN_EQUILIBRIUM << 12, /* its eigenvalue problems may have damping, as far as options tell */
  RUN_UNDAMPED    = RUN_EQUILIBRIUM << 13, /* they may have none */
  RUN_EPS         = RUN_EQUILIBRIUM << 14, /* SLEPc's EPS solves them, or tells how far to look */
  RUN_PEP         = RUN_EQUILIBRIUM << 15, /* its PEP does */
  RUN_NAMED       = RUN_EQUILIBRIUM << 16, /* its unknowns are those of nodes of parts, of a mesh or -operators_nodes */
  RUN_WEARS       = RUN_EQUILIBRIUM << 17, /* a sweep over the time that contacts wear */
  RUN_SPRINGS     = RUN_EQUILIBRIUM << 18, /* in time with penalty and pressure laws of the contacts */
} RunBit;

typedef struct {
  MPI_Comm comm;
  Analysis analysis;
  unsigned does; /* its RunBits */
} QuantityRun;

typedef enum {
  QUANTITY_INT,    /* PetscInt */
  QUANTITY_REAL,   /* PetscReal */
  QUANTITY_REALS,  /* PetscReal [n], all of them */
  QUANTITY_LIST,   /* PetscReal [n], one at least and n at most */
  QUANTITY_INTS,   /* PetscInt [n], likewise; all of them where there is no .count */
  QUANTITY_MANY,   /* PetscReal *, which the owner frees, of one to .room */
  QUANTITY_BOOL,   /* PetscBool */
  QUANTITY_WORD,   /* one of .words, as int: an enumeration or PetscBool */
  QUANTITY_TEXT,   /* char [n] */
  QUANTITY_NAME,   /* char *, which the owner frees */
  QUANTITY_NAMES,  /* char *[n], likewise; all of them or none. With .count char **, of any number */
  QUANTITY_PATH,   /* char [PETSC_MAX_PATH_LEN], relative to its options file */
  QUANTITY_VIEWER, /* PetscViewer, which the owner destroys; NULL where it is not given */
  QUANTITY_PREFIX, /* nothing: options of PETSc and SLEPc that begin so, which read themselves */
} QuantityKind;

/* Who may vary a row over its values, as bits; what it does then */
typedef enum {
  VARIES_LINEAR  = 1, /* sweeps and their links, sensitivities, samples */
  VARIES_IN_TIME = 2, /* maps, branches of cycles */
  VARIES_ALL     = VARIES_LINEAR | VARIES_IN_TIME,
  VARIES_DAMPING = 4, /* with it the eigenproblem has damping, or gyroscopic terms */
} QuantityVaries;

typedef struct {
  const char        *name; /* with its dash, e.g. "-sweep_rtol" */
  const char        *help; /* one sentence, without the unit */
  const char        *unit; /* e.g. "Hz"; NULL for what has none */
  QuantityKind       kind;
  PetscReal          initial;     /* default of a number, a logical, a word */
  const char        *text;        /* default of a text, of a list "0.02,0.08"; NULL: empty, zeros */
  const char        *path;        /* of a text: it names a "file" or a "folder"; NULL: neither */
  size_t             at;          /* offset in the owner's struct */
  size_t             size;        /* in bytes */
  size_t             given;       /* offset of a PetscBool: whether it is given; 0 for none */
  size_t             count;       /* offset of a PetscInt: how many values are given; of a list */
  const char *const *words;       /* of QUANTITY_WORD, NULL at the end */
  PetscInt           room;        /* most values of QUANTITY_MANY */
  PetscReal          least, most; /* of a number; most 0 where there is no upper limit */
  PetscBool          bounded;     /* least and most are limits */
  PetscBool          open;        /* the limits themselves are refused */
  PetscBool          none;     /* 0, which open limits refuse, is read and stands for none: what varies it obeys them */
  const char        *why;      /* of the limits, or what is to be given, for messages; or NULL */
  PetscBool          required; /* help says so; an error where it is not given, as far as its owner keeps that:
                                     a name, a word that begins as none, .given */
  unsigned           in;       /* RunBits, one of which a run that reads it does; 0: those of its table */
  const char        *unread;   /* why other runs do not read it, e.g. ", where nothing moves"; or NULL */
  PetscBool          always;   /* each scene says it: others refuse it only beside a file that does, too */
  /* NULL where a run that does one of `in` reads it, else why not, the owner's name for @; NULL: always read */
  const char *(*idle)(const void *owner, const QuantityRun *run);
  PetscBool restart; /* another value is another run: a restart must not go on */
  unsigned  varies;  /* QuantityVaries; 0: nobody */
} Quantity;

typedef struct {
  const char     *title;  /* heads the rows in -help */
  const char     *header; /* with the manual page, e.g. "sweep.h" */
  PetscInt        n;
  const Quantity *row;
  unsigned        in; /* as of a row; 0: every run */
  const char     *unread;
} QuantityTable;

/* Where a member lies, as in {"-sweep_rtol", "...", .kind = QUANTITY_REAL, QUANTITY_AT(struct _p_Sweep, rtol)} */
#define QUANTITY_AT(type, member) .at = offsetof(type, member), .size = sizeof(((type *)0)->member)

/* Limits */
#define QUANTITY_POSITIVE     .bounded = PETSC_TRUE, .open = PETSC_TRUE
#define QUANTITY_OR_NONE      .bounded = PETSC_TRUE, .open = PETSC_TRUE, .none = PETSC_TRUE
#define QUANTITY_NOT_NEGATIVE .bounded = PETSC_TRUE
#define QUANTITY_LEAST(a)     .bounded = PETSC_TRUE, .least = (a)
#define QUANTITY_WITHIN(a, b) .bounded = PETSC_TRUE, .least = (a), .most = (b)

/*@ QuantitiesInit - sets the defaults of all rows. Not collective. @*/
PetscErrorCode QuantitiesInit(const QuantityTable *table, void *owner);

/*@ QuantityFind - the row of a table whose option is -`name`; NULL for none. Not collective. @*/
const Quantity *QuantityFind(const QuantityTable *table, const char name[]);

/*@
   QuantitiesRead - reads the options of a table into their owner and checks them. Collective.

   Input Parameters:
+  comm  - ranks that read, all alike
-  table - its rows
   Input/Output Parameter:
.  owner - the struct that the rows' offsets are of; unchanged where an option is not given

   Errors: PETSC_ERR_USER_INPUT for a value that is none, not finite, or beyond the row's limits, for one that is
   required and not given.
@*/
PetscErrorCode QuantitiesRead(MPI_Comm comm, const QuantityTable *table, void *owner);

/*@ QuantitiesReadOf - the same of a thing that has a name, which stands before that of each option: -pad_mu of `pad`.
   NULL for none. Collective. @*/
PetscErrorCode QuantitiesReadOf(MPI_Comm comm, const char name[], const QuantityTable *table, void *owner);

/* A list of the scene, each name of which is the prefix of the options of a record */
typedef struct {
  const char          *option, *help; /* of the list itself */
  size_t               size;          /* of a record, which begins with char *name */
  const QuantityTable *table;
  PetscErrorCode (*check)(MPI_Comm comm, void *owner, void *record); /* what no row says; NULL for nothing */
  unsigned in;                                                       /* RunBits that read the list itself; 0: all */
} QuantityList;

/*@ QuantitiesReadList - reads the names of a list into n new records, which begin as QuantitiesInit() says, and then
   the
    options of each. records is the address of the pointer to them; the caller frees it and the names. Collective.
    Errors: those of OptionsGetNames(), QuantitiesRead() and check(). @*/
PetscErrorCode QuantitiesReadList(MPI_Comm comm, const QuantityList *list, void *owner, PetscInt *n, void *records);

/*@ QuantitiesAddChecksum - adds the values of the rows that decide a restart, in their order, to the
    part of the checksum that is set. Not collective. @*/
PetscErrorCode QuantitiesAddChecksum(const QuantityTable *table, const void *owner, Checksum checksum);

/* Whoever goes over the tables of all rooms. Of each: its owner, the name before its options or NULL, and why this run
   reads none of them, or NULL */
typedef struct {
  PetscErrorCode (*table)(const QuantityTable *table, const char name[], void *owner, const char why[], void *ctx);
  void *ctx;
} QuantityVisitor;

/*@ QuantitiesVisit - shows one table. Collective. @*/
PetscErrorCode QuantitiesVisit(const QuantityVisitor *visitor, const QuantityTable *table, const char name[],
                               void *owner, const char why[]);

/*@ QuantitiesVisitList - shows the option of a list, and the table of each of its n records. Collective. @*/
PetscErrorCode QuantitiesVisitList(const QuantityVisitor *visitor, const QuantityList *list, PetscInt n, void *records);

/*@ QuantitiesReadVisited - a visitor with an MPI_Comm for its context: as QuantitiesReadOf(). Collective. @*/
PetscErrorCode QuantitiesReadVisited(const QuantityTable *table, const char name[], void *owner, const char why[],
                                     void *comm);

/*@ QuantitiesRefuse - a visitor with a QuantityRun for its context: raises an error for an option of the command line
   that the run does not read. Files may give such options. Collective. @*/
PetscErrorCode QuantitiesRefuse(const QuantityTable *table, const char name[], void *owner, const char why[],
                                void *run);

/* What writes rows as JSON, a visitor's context */
typedef struct {
  MPI_Comm comm;
  PetscInt n; /* rows until now */
} QuantityJson;

/*@ QuantitiesBeginJson, QuantitiesWriteJson, QuantitiesEndJson - print the rows of all tables that a visitor is shown,
   with a QuantityJson for its context, as one JSON object on stdout (quantity/json.c says its members). Collective. @*/
PetscErrorCode QuantitiesBeginJson(QuantityJson *json);
PetscErrorCode QuantitiesWriteJson(const QuantityTable *table, const char name[], void *owner, const char why[],
                                   void *json);
PetscErrorCode QuantitiesEndJson(QuantityJson *json);

/* What shows the rows of a run to a visitor; ctx is its own */
typedef PetscErrorCode (*QuantityShow)(void *ctx, const QuantityVisitor *visitor);

/* The page of -help, a visitor's context */
typedef struct {
  MPI_Comm  comm;
  PetscBool example;    /* of an example scene: the defaults in place of values */
  char      title[128]; /* of the last table */
} QuantityPage;

/*@ QuantitiesPrint - a visitor with a QuantityPage for its context: prints the rows, each with value, help, unit, words
    and default. Collective. @*/
PetscErrorCode QuantitiesPrint(const QuantityTable *table, const char name[], void *owner, const char why[],
                               void *page);

#define QUANTITY_SHOWN 128 /* characters of a name or value that are shown */

/* Options with their values in force, a visitor's context; free `text` with PetscFree() */
typedef struct {
  char      name[QUANTITY_SHOWN]; /* without the dash */
  char      value[QUANTITY_SHOWN];
  PetscBool shows; /* it says where something is shown */
} QuantityText;
typedef struct {
  PetscInt      n;
  QuantityText *text;
} QuantityTexts;

/*@ QuantitiesAddTexts - a visitor with QuantityTexts for its context: adds the options of the tables. Not
    collective. @*/
PetscErrorCode QuantitiesAddTexts(const QuantityTable *table, const char name[], void *owner, const char why[],
                                  void *texts);

/*@
   QuantitiesCheckUnknown - raises an error for an option that nobody has read, naming the nearest valid one; of those
   of PETSc and SLEPc only where the command line gives it and nothing will read it. Collective; call when every room
   has read its options.
@*/
PetscErrorCode QuantitiesCheckUnknown(MPI_Comm comm, QuantityShow show, void *ctx);

/* A row that is looked for by its option, named without the dash, and whether a table has it */
typedef struct {
  const char *option;
  Quantity    row;
  PetscBool   found;
} QuantitySearch;

/*@ QuantitiesSearch - a visitor with a QuantitySearch for its context: finds its row. Collective. @*/
PetscErrorCode QuantitiesSearch(const QuantityTable *table, const char name[], void *owner, const char why[],
                                void *search);

/*@ SquealVisit - shows the rows of what concerns every room, which SquealSetFromOptions() reads. Collective. @*/
PetscErrorCode SquealVisit(MPI_Comm comm, const QuantityVisitor *visitor);
