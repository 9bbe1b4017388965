/*
   Unit test of squeal/quantity.h: rows of every kind, read into a struct.

   References: the definitions of the rows below.
*/
#include "check.h"
#include <squeal/options.h>
#include <squeal/quantity.h>
#include <string.h>

enum { FAST, SLOW };

typedef struct {
  PetscInt  count, mode[4], n_modes, n_shares;
  PetscReal speed, box[3], share[2], edge[2], bounds[2];
  PetscBool loud, has_box, has_count;
  int       way;
  char      name[16], title[8], file[PETSC_MAX_PATH_LEN];
  char     *part, *side[2], **parts;
  PetscInt  n_parts, n_entries;
  PetscReal *entries;
  PetscBool has_entries;
  int       kind;
} Owner;

static const char *Idle(const void *owner, const QuantityRun *run)
{
  (void)run;
  return ((const Owner *)owner)->way == SLOW ? "not used without -way fast" : NULL;
}

#define ROW(member) QUANTITY_AT(Owner, member)
static const char *const words[] = {"fast", "slow", NULL};
static const Quantity    rows[]  = {
  {"-count", "how many", NULL, QUANTITY_INT, ROW(count), .initial = 3, .given = offsetof(Owner, has_count), QUANTITY_LEAST(2),
   .restart = PETSC_TRUE},
  {"-speed", "how fast", "m/s", QUANTITY_REAL, ROW(speed), .initial = 0.5, QUANTITY_WITHIN(0, 1), .open = PETSC_TRUE,
   .why = "a share", .idle = Idle, .restart = PETSC_TRUE},
  {"-box", "edges", "m", QUANTITY_REALS, ROW(box), .given = offsetof(Owner, has_box), .restart = PETSC_TRUE},
  {"-loud", "prints", NULL, QUANTITY_BOOL, ROW(loud), .initial = PETSC_TRUE},
  {"-way", "which way", NULL, QUANTITY_WORD, ROW(way), .words = words, .initial = FAST, .restart = PETSC_TRUE},
  {"-name", "a name", NULL, QUANTITY_TEXT, ROW(name), .restart = PETSC_TRUE},
  {"-file", "a file", NULL, QUANTITY_PATH, ROW(file)},
  {"-modes", "their numbers", NULL, QUANTITY_INTS, ROW(mode), .count = offsetof(Owner, n_modes), QUANTITY_NOT_NEGATIVE,
   .restart = PETSC_TRUE},
  {"-shares", "up to two", "%", QUANTITY_LIST, ROW(share), .count = offsetof(Owner, n_shares), QUANTITY_WITHIN(0, 100),
   .restart = PETSC_TRUE},
  {"-edges", "frequencies", "Hz", QUANTITY_REALS, ROW(edge), QUANTITY_WITHIN(0, 1e30)},
  {"-title", "a word", NULL, QUANTITY_TEXT, ROW(title), .text = "disc"},
  {"-part", "one name", NULL, QUANTITY_NAME, ROW(part), .restart = PETSC_TRUE},
  {"-sides", "two names", NULL, QUANTITY_NAMES, ROW(side), .restart = PETSC_TRUE, .why = "slave,master"},
  {"-parts", "names", NULL, QUANTITY_NAMES, ROW(parts), .count = offsetof(Owner, n_parts), .restart = PETSC_TRUE},
  {"-entries", "numbers", "N", QUANTITY_MANY, ROW(entries), .count = offsetof(Owner, n_entries), .room = 5, .restart = PETSC_TRUE,
   .given = offsetof(Owner, has_entries), QUANTITY_WITHIN(-9, 9)},
  {"-bounds", "two numbers", "m", QUANTITY_REALS, ROW(bounds), .text = "0.5,-2e3"},
};
static const Quantity kind[] = {
  {"-kind", "what it is", NULL, QUANTITY_WORD, ROW(kind), .initial = 2, .words = words, .required = PETSC_TRUE, .why = "fast or slow"}};
static const QuantityTable wanted = {"Test", "test.h", 1, kind, .in = 0};
static const QuantityTable table = {"Test", "test.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = 0};

static PetscErrorCode Read(const char options[], Owner *owner)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(owner, sizeof(*owner)));
  PetscCall(QuantitiesInit(&table, owner));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, options));
  PetscCall(QuantitiesRead(PETSC_COMM_WORLD, &table, owner));
  PetscFunctionReturn(0);
}

static PetscErrorCode Free(Owner *owner)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < owner->n_parts; i++) PetscCall(PetscFree(owner->parts[i]));
  for (int i = 0; i < 2; i++) PetscCall(PetscFree(owner->side[i]));
  PetscCall(PetscFree(owner->parts));
  PetscCall(PetscFree(owner->part));
  PetscCall(PetscFree(owner->entries));
  PetscFunctionReturn(0);
}

/* Breaks when: a default is lost, a kind is read into another place or as another type, or what is given is not said */
static PetscErrorCode TestRead(int *failed)
{
  Owner o;

  PetscFunctionBeginUser;
  PetscCall(Read("", &o));
  *failed += CheckTrue("defaults", o.count == 3 && o.speed == 0.5 && o.loud && o.way == FAST && !o.name[0], o.speed);
  *failed += CheckTrue("default of a text, empty lists", !strcmp(o.title, "disc") && !o.n_modes && !o.n_shares, o.n_modes);
  *failed += CheckTrue("nothing is given", !o.has_count && !o.has_box && !o.has_entries, 0);
  *failed += CheckTrue("defaults of a list", o.bounds[0] == 0.5 && o.bounds[1] == -2e3, o.bounds[1]);
  PetscCall(Free(&o));
  PetscCall(Read("-part disc -sides a,b -parts x,y,z -entries 1,2,-3", &o));
  *failed += CheckTrue("names", !strcmp(o.part, "disc") && !strcmp(o.side[1], "b") && o.n_parts == 3 && !strcmp(o.parts[2], "z"), 0);
  *failed += CheckTrue("many", o.n_entries == 3 && o.entries[2] == -3 && o.has_entries, o.n_entries);
  PetscCall(Free(&o));
  PetscCall(Read("-count 2 -speed 0.25 -box 1,2,-3 -loud 0 -way slow -name pad -file /dev/null", &o));
  *failed += CheckTrue("integer and word", o.count == 2 && o.way == SLOW, o.count);
  *failed += CheckTrue("numbers", o.speed == 0.25 && o.box[0] == 1 && o.box[1] == 2 && o.box[2] == -3, o.box[2]);
  *failed += CheckTrue("texts", !strcmp(o.name, "pad") && !strcmp(o.file, "/dev/null"), 0);
  PetscCall(Read("-modes 3,0,7 -shares 5 -edges 1,2", &o));
  *failed += CheckTrue("integers of a list", o.n_modes == 3 && o.mode[0] == 3 && o.mode[2] == 7 && !o.mode[3], o.n_modes);
  *failed += CheckTrue("a list of one, an array", o.n_shares == 1 && o.share[0] == 5 && o.edge[1] == 2, o.share[0]);
  PetscCall(Read("-loud 0 -count 2 -box 1,2,3", &o));
  *failed += CheckTrue("logical, and what is given", !o.loud && o.has_count && o.has_box, 0);
  PetscFunctionReturn(0);
}

static char last[512]; /* message of the last error */

static PetscErrorCode Keep(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                           PetscErrorType type, const char *message, void *ctx)
{
  (void)comm, (void)line, (void)function, (void)file, (void)ctx;
  if (type == PETSC_ERROR_INITIAL) snprintf(last, sizeof(last), "%s", message);
  return code;
}

/* Breaks when: a limit lets a value pass, its ends count otherwise, or the message says something else */
static PetscErrorCode TestLimits(int *failed)
{
  static const char *const bad[][2] = {
    {"-count 1", "-count 1 must be at least 2"},
    {"-speed 1", "-speed 1 must lie between 0 and 1 (m/s): a share"},
    {"-speed -2", "-speed -2 must lie between 0 and 1 (m/s): a share"},
    {"-box 1,2", "-box has 2 values; give 3"},
    {"-shares 1,2,3", "-shares has more than 2 values"},
    {"-shares 1,101", "-shares 101 must lie between 0 and 100 (%)"},
    {"-modes 1,-2", "-modes -2 must not be negative"},
    {"-edges 1,-2", "-edges -2 must not be negative (Hz)"},
    {"-entries 1,10", "-entries 10 must lie between -9 and 9 (N)"},
    {"-entries 1,2,3,4,5,6", "-entries has more than 5 values"},
    {"-edges 1,2e30", "-edges 2e+30 must lie between 0 and 1e+30 (Hz)"},
  };
  Owner o;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(bad); i++) {
    PetscErrorCode code;

    PetscCall(PetscPushErrorHandler(Keep, NULL));
    code = Read(bad[i][0], &o);
    PetscCall(PetscPopErrorHandler());
    *failed += CheckTrue(bad[i][1], code == PETSC_ERR_USER_INPUT && !strcmp(last, bad[i][1]), code);
  }
  PetscCall(PetscPushErrorHandler(Keep, NULL));
  PetscCall(QuantitiesInit(&wanted, &o));
  *failed += CheckTrue("a word that is required", QuantitiesRead(PETSC_COMM_WORLD, &wanted, &o) == PETSC_ERR_USER_INPUT &&
                       !strcmp(last, "-kind must be given: fast or slow"), 0);
  PetscCall(PetscPopErrorHandler());
  PetscCall(Read("-count 2 -speed 0.999", &o));
  *failed += CheckTrue("values at and inside the limits", o.count == 2 && o.speed == 0.999, o.speed);
  PetscFunctionReturn(0);
}

/* Breaks when: a row that the run does not read is accepted, one that it reads is refused, or the message lacks the
   reason. The words of the bits are those of the manual page of quantity.h */
static PetscErrorCode TestRefuse(int *failed)
{
  static const struct {
    unsigned    does;
    const char *said; /* empty: accepted */
  } runs[] = {
    {RUN_MODES, ""},
    {RUN_STATIC | RUN_EQUILIBRIUM,
     "-speed 0.5: not used by -analysis static; it belongs to -analysis modes and frf, and -dynamics_model reduced"},
    {RUN_CYCLE | RUN_REDUCED, ""},
    {RUN_FRF | RUN_SLIDING, "-speed 0.5: not used without -way fast"},
  };
  Quantity            row   = rows[1];
  const QuantityTable other = {"Test", "test.h", 1, &row, .in = RUN_MODES | RUN_FRF | RUN_REDUCED};
  Owner               o;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(runs); i++) {
    QuantityRun    run = {PETSC_COMM_WORLD, ANALYSIS_STATIC, runs[i].does};
    PetscErrorCode code;

    PetscCall(Read(runs[i].does & RUN_FRF ? "-way slow" : "", &o));
    last[0] = '\0';
    PetscCall(PetscPushErrorHandler(Keep, NULL));
    code = QuantitiesRefuse(&other, NULL, &o, NULL, &run);
    PetscCall(PetscPopErrorHandler());
    *failed += CheckTrue(runs[i].said, !code == !runs[i].said[0] && !strcmp(last, runs[i].said), code);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Sum(const char options[], uint64_t *sum)
{
  const ChecksumPart *part;
  Checksum            c;
  PetscInt            n;
  Owner               o;

  PetscFunctionBeginUser;
  PetscCall(Read(options, &o));
  PetscCall(ChecksumCreate(PETSC_COMM_WORLD, &c));
  PetscCall(ChecksumSetPart(c, "options"));
  PetscCall(QuantitiesAddChecksum(&table, &o, c));
  PetscCall(ChecksumGetParts(c, &n, &part));
  *sum = part[0].sum;
  PetscCall(ChecksumDestroy(&c));
  PetscCall(Free(&o));
  PetscFunctionReturn(0);
}

/* Breaks when: a row that decides a restart is left out of the sum, or one that does not is in it */
static PetscErrorCode TestChecksum(int *failed)
{
  static const char *const decides[] = {"-count 4", "-speed 0.6", "-box 0,0,1", "-way slow", "-name pad", "-modes 0", "-shares 0",
                                        "-part disc", "-sides a,b", "-parts x", "-parts x,y", "-entries 1"};
  static const char *const free[]    = {"-loud 0", "-file /dev/null", "-count 3"};
  uint64_t                 none, other;

  PetscFunctionBeginUser;
  PetscCall(Sum("", &none));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(decides); i++) {
    PetscCall(Sum(decides[i], &other));
    *failed += CheckTrue(decides[i], other != none, 0);
  }
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(free); i++) {
    PetscCall(Sum(free[i], &other));
    *failed += CheckTrue(free[i], other == none, 0);
  }
  PetscFunctionReturn(0);
}

/* Breaks when: text is written behind the end of a list that is nearly full, as PetscStrlcat() does */
static PetscErrorCode TestAppend(int *failed)
{
  char list[16 + 8] = "";

  PetscFunctionBeginUser;
  memset(list + 16, '~', 8);
  for (int i = 0; i < 4; i++) PetscCall(OptionsTextAppend(list, "abcdefg", 16));
  *failed += CheckTrue("a list as long as there is room", !strcmp(list, "abcdefgabcdefga"), (double)strlen(list));
  *failed += CheckTrue("nothing behind it", !memcmp(list + 16, "~~~~~~~~", 8), 0);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char *words[] = {argv[0], "-speed", "0.5", NULL}, **command = words; /* what TestRefuse() judges */
  int   failed = 0;

  argc = 3;
  PetscCall(PetscInitialize(&argc, &command, NULL, NULL));
  PetscCall(TestRead(&failed));
  PetscCall(TestLimits(&failed));
  PetscCall(TestRefuse(&failed));
  PetscCall(TestChecksum(&failed));
  PetscCall(TestAppend(&failed));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
