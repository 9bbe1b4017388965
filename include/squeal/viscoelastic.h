/*
   Viscoelastic - the stiffness of a material as a function of the eigenvalue: K(lambda) = f(lambda) K, u = x
   e^(lambda t), where K is the static one of Young's modulus E, and all moduli go with E. With G = E (f - 1), Pa:

      hysteretic  G = i eta E                                           the loss factor is eta at every frequency
      Prony       G = sum_j E_j lambda / (lambda + 1 / tau_j)           Maxwell branches: E_j stiff, E_j tau_j viscous
      Zener       G = E_1 (lambda tau)^a / (1 + (lambda tau)^a)         0 < a <= 1, a = 1: one Maxwell branch
      table       G = E(w) (1 + i eta(w)) - E                           as measured at frequencies w, rad/s

   for Im lambda > 0; f(conj lambda) = conj f(lambda), so that displacements are real. On the imaginary axis E f(i w) is
   the modulus that a test at the frequency w measures: Re its stiffness, Im > 0 what it dissipates. Off it, at lambda =
   sigma + i w of a mode that grows or decays, Prony and Zener are what their equations in time say. Hysteretic damping
   has no equation in time: it is what tests measure on the axis. In the upper half plane the constant i eta E is the
   one analytic function that has these values there, and is taken, K (1 + i eta sign(Im lambda)). At a real lambda it
   is zero: what does not oscillate has no such damping.

   A table is interpolated in log w, storage E and loss E eta each by a monotone cubic with continuous slopes (F. N.
   Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5, 1984). Off the axis it is continued to first order: with
   lambda = |lambda| e^(i pi / 2 + i d) its value at |lambda| plus i d times the slope in log w there, as of an analytic
   function; what is left out is of second order in d, about -sigma / w. Beyond its ends it is constant; callers refuse
   what lies there. Between tables of two temperatures log(E (1 + i eta)) is linear in the temperature T, so that
   log |E| and the loss angle are; beyond the first and the last T nothing is known, and it is refused.

   All laws but tables are zero at lambda = 0: E is the static modulus, of slow motions, with a table too.
*/
#pragma once

#include <squeal/checksum.h>
#include <squeal/quantity.h>
#include <complex.h>

#define VISCOELASTIC_BRANCHES   8
#define VISCOELASTIC_PARAMETERS (2 * VISCOELASTIC_BRANCHES)
#define VISCOELASTIC_LISTED     64 /* rows of a table that is given by lists */
#define VISCOELASTIC_LOSS_MOST                                                                                         \
  100 /* largest loss factor: beyond, modes would end with errors (operators/terms/law.c) */

typedef enum {
  VISCOELASTIC_NONE,
  VISCOELASTIC_HYSTERETIC,
  VISCOELASTIC_PRONY,
  VISCOELASTIC_ZENER,
  VISCOELASTIC_TABLE
} ViscoelasticKind;

/* A row of a table: log of w in rad/s, E (1 + i eta) and its slope by that log, Pa */
typedef struct {
  PetscReal    x;
  PetscComplex modulus, slope;
} ViscoelasticRow;

/* Rows of one temperature */
typedef struct {
  PetscReal        temperature;
  PetscInt         n_rows;
  ViscoelasticRow *row; /* [n_rows] */
} ViscoelasticTable;

/* A law with its values: eta; E_1 .. E_n, tau_1 .. tau_n (Pa, s); E_1, tau, a; of a table T where it has any */
typedef struct {
  ViscoelasticKind         kind;
  PetscInt                 n;     /* values */
  PetscReal                young; /* E, Pa */
  PetscReal                value[VISCOELASTIC_PARAMETERS];
  PetscInt                 n_tables;
  const ViscoelasticTable *table; /* [n_tables] T ascends; borrowed from who has read them */
} Viscoelastic;

/* G at an eigenvalue and its derivatives */
typedef struct {
  PetscComplex modulus;                        /* G, Pa */
  PetscComplex slope;                          /* dG / d lambda, Pa s */
  PetscComplex young;                          /* dG / dE */
  PetscComplex value[VISCOELASTIC_PARAMETERS]; /* dG / d value */
} ViscoelasticAt;

/* Lists of a table */
enum { TABLE_FREQUENCY, TABLE_MODULUS, TABLE_LOSS, N_TABLE_LISTS };

/* A law as options give it */
typedef struct {
  PetscInt  n_modulus, n_time;
  PetscReal modulus[VISCOELASTIC_BRANCHES], time[VISCOELASTIC_BRANCHES]; /* of Prony's series, Pa, s */
  PetscReal zener[3];                                                    /* modulus, time, order: Pa, s, - */
  PetscBool has_zener[3];
  PetscInt  n_listed[N_TABLE_LISTS];
  PetscReal listed[N_TABLE_LISTS][VISCOELASTIC_LISTED]; /* Hz, Pa, - */
  char      file[PETSC_MAX_PATH_LEN];                   /* or a table */
  PetscReal temperature;                                /* of its rows, in its unit */
  PetscBool has_file, has_temperature;
} ViscoelasticAsked;

/* Sweeps in full vary them */
#define VISCOELASTIC_VARIES .varies = VARIES_LINEAR | VARIES_DAMPING

/* Rows of the options of a ViscoelasticAsked, a member of a record that has a name; more may follow in each */
#define VISCOELASTIC_ROWS(type, asked, ...)                                                                            \
  {"-prony_modulus",                                                                                                   \
   "moduli E_j of Maxwell branches beside -young, which is that of slow motions",                                      \
   "Pa",                                                                                                               \
   QUANTITY_LIST,                                                                                                      \
   QUANTITY_AT(type, asked.modulus),                                                                                   \
   .count = offsetof(type, asked.n_modulus),                                                                           \
   QUANTITY_POSITIVE,                                                                                                  \
   VISCOELASTIC_VARIES,                                                                                                \
   __VA_ARGS__},                                                                                                       \
    {"-prony_time",     "their relaxation times",      "s",                                                            \
     QUANTITY_LIST,     QUANTITY_AT(type, asked.time), .count = offsetof(type, asked.n_time),                          \
     QUANTITY_POSITIVE, VISCOELASTIC_VARIES,           __VA_ARGS__},                                                   \
    {"-zener_modulus",                                                                                                 \
     "modulus E_1 of fast motions beside -young: E_1 (lambda tau)^a / (1 + (lambda tau)^a)",                           \
     "Pa",                                                                                                             \
     QUANTITY_REAL,                                                                                                    \
     QUANTITY_AT(type, asked.zener[0]),                                                                                \
     .given = offsetof(type, asked.has_zener[0]),                                                                      \
     QUANTITY_POSITIVE,                                                                                                \
     VISCOELASTIC_VARIES,                                                                                              \
     __VA_ARGS__},                                                                                                     \
    {"-zener_time",                                                                                                    \
     "its relaxation time tau",                                                                                        \
     "s",                                                                                                              \
     QUANTITY_REAL,                                                                                                    \
     QUANTITY_AT(type, asked.zener[1]),                                                                                \
     .given = offsetof(type, asked.has_zener[1]),                                                                      \
     QUANTITY_POSITIVE,                                                                                                \
     VISCOELASTIC_VARIES,                                                                                              \
     __VA_ARGS__},                                                                                                     \
    {"-zener_order",                                                                                                   \
     "its order a, a fractional derivative",                                                                           \
     NULL,                                                                                                             \
     QUANTITY_REAL,                                                                                                    \
     QUANTITY_AT(type, asked.zener[2]),                                                                                \
     .given = offsetof(type, asked.has_zener[2]),                                                                      \
     QUANTITY_WITHIN(0, 1),                                                                                            \
     VISCOELASTIC_VARIES,                                                                                              \
     __VA_ARGS__},                                                                                                     \
    {"-table",                                                                                                         \
     "file frequency_hz,modulus,loss_factor[,temperature] of the modulus over frequency, in the unit of -young",       \
     NULL,                                                                                                             \
     QUANTITY_PATH,                                                                                                    \
     QUANTITY_AT(type, asked.file),                                                                                    \
     .path  = "file",                                                                                                  \
     .given = offsetof(type, asked.has_file),                                                                          \
     __VA_ARGS__},                                                                                                     \
    {"-table_temperature",                                                                                             \
     "the temperature, in the unit of the table; between two of the table by logarithms of the modulus",               \
     NULL,                                                                                                             \
     QUANTITY_REAL,                                                                                                    \
     QUANTITY_AT(type, asked.temperature),                                                                             \
     .given = offsetof(type, asked.has_temperature),                                                                   \
     VISCOELASTIC_VARIES,                                                                                              \
     __VA_ARGS__},                                                                                                     \
    {"-table_frequency",                                                                                               \
     "or the table as three lists: rising frequencies",                                                                \
     "Hz",                                                                                                             \
     QUANTITY_LIST,                                                                                                    \
     QUANTITY_AT(type, asked.listed[TABLE_FREQUENCY]),                                                                 \
     .count = offsetof(type, asked.n_listed[TABLE_FREQUENCY]),                                                         \
     QUANTITY_POSITIVE,                                                                                                \
     __VA_ARGS__},                                                                                                     \
    {"-table_modulus",                                                                                                 \
     "Young's moduli at these",                                                                                        \
     "Pa",                                                                                                             \
     QUANTITY_LIST,                                                                                                    \
     QUANTITY_AT(type, asked.listed[TABLE_MODULUS]),                                                                   \
     .count = offsetof(type, asked.n_listed[TABLE_MODULUS]),                                                           \
     QUANTITY_POSITIVE,                                                                                                \
     __VA_ARGS__},                                                                                                     \
  {                                                                                                                    \
    "-table_loss_factor", "loss factors at these", NULL, QUANTITY_LIST, QUANTITY_AT(type, asked.listed[TABLE_LOSS]),   \
      .count = offsetof(type, asked.n_listed[TABLE_LOSS]), QUANTITY_NOT_NEGATIVE, __VA_ARGS__                          \
  }

/*@ ViscoelasticSet - the law of a part or matrix of that name, from its options and its hysteretic loss factor, 0 for
    none; E in Pa, 1 of a matrix, whose moduli are beside it. Collective; ViscoelasticFree() frees it.
    Errors: PETSC_ERR_USER_INPUT for what does not go together, for a table that is none, and for loss factors above
    VISCOELASTIC_LOSS_MOST. @*/
PetscErrorCode ViscoelasticSet(MPI_Comm comm, const char name[], const ViscoelasticAsked *asked, PetscReal young,
                               PetscReal loss, Viscoelastic *law);

/*@ ViscoelasticFree - frees the rows that ViscoelasticSet() has read. Not collective. @*/
PetscErrorCode ViscoelasticFree(Viscoelastic *law);

/*@ ViscoelasticAddChecksum - adds its kind, values and rows; nothing of no law. Collective. @*/
PetscErrorCode ViscoelasticAddChecksum(const Viscoelastic *law, Checksum checksum);

/*@ ViscoelasticEvaluate - G and its derivatives at lambda, rad/s, Im lambda >= 0. Not collective. @*/
void ViscoelasticEvaluate(const Viscoelastic *law, PetscComplex lambda, ViscoelasticAt *at);

/*@ ViscoelasticBranches - how many Maxwell branches a law is, E_j = value[j] and tau_j = value[n + j]; 0 where it has
    no equation in time. Not collective. @*/
PetscInt ViscoelasticBranches(const Viscoelastic *law);

/*@ ViscoelasticRange - the frequencies, rad/s, for which a law tells something: all but of a table. Not collective. @*/
void ViscoelasticRange(const Viscoelastic *law, PetscReal range[2]);

/*@ ViscoelasticLimits - the least and the largest value of a law's first parameter, the temperature of a table or a
    hysteretic loss factor; infinite of other laws. Not collective. @*/
void ViscoelasticLimits(const Viscoelastic *law, PetscReal limit[2]);

/*@ ViscoelasticName - the option of value i of a law, or of the law itself, i < 0, without dash and name, and with
    the number of its branch, as prony_time_2, in name[32]. Not collective. @*/
PetscErrorCode ViscoelasticName(const Viscoelastic *law, PetscInt i, const char **option, char name[32]);

/*@ ViscoelasticDescribe - the law in words, as a view has it. Not collective. @*/
PetscErrorCode ViscoelasticDescribe(const Viscoelastic *law, size_t size, char text[]);
