/*
   Unit test of results/journal/: what is read is what was written, bit by bit, or nothing at all and one line that
   says why. Bad files are made from a good one: cut at places all over the file, one bit turned in every 8 bytes, head
   changed by hand (with the checksum made anew). A full disk is played by the limit of the size of a file.
*/
#include "results/journal/journal.h"
#include "check.h"
#include "scratch.h"
#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/stat.h>

#define N_ITEMS   3
#define MAX_N     40
#define MAX_BYTES 8192
#define NAME      "checkpoint.bin"
#define JOURNAL(t) ((Journal){PETSC_COMM_WORLD, (t)->results, (t)->scene, "-dynamics_restart", NULL})

/* Words of the head: order of bytes, its own length, its checksum, version, size of a real, ranks */
enum { ORDER = 1, SIZE, CHECKSUM, VERSION, REAL, RANKS, TOTAL = 9 };

typedef struct {
  Scratch        scratch;
  Results        results;
  Checksum       scene;
  PetscMPIInt    size;
  PetscReal      value[N_ITEMS][MAX_N];
  JournalItem item[N_ITEMS];
  long           length; /* of the good file, bytes */
  unsigned char  good[MAX_BYTES];
} Test;

/* Arrays whose lengths differ between ranks, one of them empty on rank 0, with numbers that only bits tell apart */
static void ItemsMake(Test *t, PetscReal salt)
{
  const char *const names[N_ITEMS] = {"displacements", "none on rank 0", "a name that is longer than the file keeps"};
  const PetscInt    n[N_ITEMS]     = {30 + t->scratch.rank, 5 * t->scratch.rank, 7};

  for (int i = 0; i < N_ITEMS; i++) {
    t->item[i] = (JournalItem){names[i], n[i], n[i] ? t->value[i] : NULL};
    for (int k = 0; k < n[i]; k++) t->value[i][k] = sin(1 + salt + 100 * t->scratch.rank + 10 * i + k);
  }
  t->value[0][0] = -0.0;
  t->value[0][1] = NAN;
  t->value[0][2] = 5e-324;
}

/* Reads into other arrays; `any` leaves the lengths open. Whether all are the values of the test */
static PetscErrorCode ReadBack(Test *t, PetscBool any, PetscBool *same)
{
  JournalItem item[N_ITEMS];
  PetscReal      value[N_ITEMS][MAX_N];
  PetscErrorCode error;
  Fault          fault;

  *same = PETSC_TRUE;
  memset(value, 1, sizeof(value));
  for (int i = 0; i < N_ITEMS; i++)
    item[i] = (JournalItem){t->item[i].name, any ? -1 : t->item[i].n, any ? NULL : value[i]};
  error = JournalRead(&JOURNAL(t), NAME, N_ITEMS, item, &fault);
  if (!error) error = FaultsRaise(PETSC_COMM_WORLD, &fault);
  for (int i = 0; i < N_ITEMS && !error; i++) {
    const size_t bytes = sizeof(PetscReal) * (size_t)t->item[i].n;

    if (item[i].n != t->item[i].n || (bytes && memcmp(item[i].values, t->item[i].values, bytes))) *same = PETSC_FALSE;
    if (any) (void)PetscFree(item[i].values);
  }
  for (int i = 0; i < N_ITEMS && error; i++) { /* nothing of a bad file may come through */
    if (any && item[i].values) *same = PETSC_FALSE;
    for (int k = 0; k < MAX_N; k++)
      if (memcmp(&value[i][k], "\1\1\1\1\1\1\1\1", sizeof(PetscReal))) *same = PETSC_FALSE;
  }
  (void)MPI_Allreduce(MPI_IN_PLACE, same, 1, MPIU_BOOL, MPI_LAND, PETSC_COMM_WORLD);
  return error;
}

/* Puts bytes in the place of the file */
static void FilePut(Test *t, const unsigned char bytes[], long length)
{
  char  path[PETSC_MAX_PATH_LEN + 32];
  FILE *file;

  MPI_Barrier(PETSC_COMM_WORLD);
  if (t->scratch.rank == 0) {
    file = fopen(ScratchPath(&t->scratch, NAME, path), "wb");
    if (!file || fwrite(bytes, 1, (size_t)length, file) != (size_t)length || fclose(file)) MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Barrier(PETSC_COMM_WORLD);
}

/* Whether a file of these bytes is refused on all ranks, with this error (0: either of two), a line that has `words`,
   and nothing read */
static int Refused(Test *t, const unsigned char bytes[], long length, PetscErrorCode code, const char words[])
{
  PetscBool      untouched;
  PetscErrorCode error;
  int            good;

  FilePut(t, bytes, length);
  t->scratch.message[0] = '\0';
  error                 = ReadBack(t, PETSC_FALSE, &untouched);
  good = error && (error == code || (!code && (error == PETSC_ERR_FILE_READ || error == PETSC_ERR_FILE_UNEXPECTED)));
  good = good && untouched && !strchr(t->scratch.message, '\n') && strstr(t->scratch.message, NAME) &&
         strstr(t->scratch.message, words);
  if (!good) printf("error %d, message: %s\n", (int)error, t->scratch.message);
  MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_LAND, PETSC_COMM_WORLD);
  return good;
}

/* Breaks when: a bit is lost, ranks mix, an empty array or a long name is not kept, or a temporary file stays */
static int TestSame(Test *t)
{
  PetscBool same;
  char      path[PETSC_MAX_PATH_LEN + 32];
  FILE     *file;
  int       failed = 0;

  for (int salt = 0; salt < 2; salt++) { /* the second one replaces the first */
    ItemsMake(t, salt);
    failed += CheckTrue("written", !JournalWrite(&JOURNAL(t), NAME, N_ITEMS, t->item), t->size);
    failed += CheckTrue("read", !ReadBack(t, PETSC_FALSE, &same) && same, salt);
    failed += CheckTrue("read with open lengths", !ReadBack(t, PETSC_TRUE, &same) && same, salt);
  }
  failed += CheckTrue("no temporary file", !ScratchRemove(&t->scratch, NAME ".part"), 0);
  file = fopen(ScratchPath(&t->scratch, NAME, path), "rb");
  if (file) t->length = (long)fread(t->good, 1, MAX_BYTES, file);
  if (file) fclose(file);
  return failed + CheckTrue("length of the file", t->length > 0 && t->length < MAX_BYTES, (double)t->length);
}

/* Breaks when: a file that is cut anywhere is believed on some rank */
static int TestTruncated(Test *t)
{
  int n = 0, refused = 0;

  for (long length = 0; length < t->length; length = length < 16 ? length + 1 : length + 13, n++)
    refused += Refused(t, t->good, length, PETSC_ERR_FILE_READ, "truncated");
  refused += Refused(t, t->good, t->length - 1, PETSC_ERR_FILE_READ, "truncated");
  memset(t->good + t->length, 0, 8);
  refused += Refused(t, t->good, t->length + 8, PETSC_ERR_FILE_READ, "too long");
  return CheckTrue("cut files are refused", refused == n + 2, n + 2);
}

/* Breaks when: any bit of the file is not covered by a checksum; another bit in each word, so that all places come */
static int TestFlipped(Test *t)
{
  unsigned char bytes[MAX_BYTES];
  int           n = 0, refused = 0;

  for (long at = 0; at < t->length; at += 8, n++) {
    memcpy(bytes, t->good, (size_t)t->length);
    bytes[at + (n / 8) % 8] ^= (unsigned char)(1 << n % 8);
    refused += Refused(t, bytes, t->length, 0, "");
  }
  memcpy(bytes, t->good, (size_t)t->length);
  bytes[t->length - 1] ^= 0x80, bytes[t->length - 9] ^= 0x80;
  refused += Refused(t, bytes, t->length, PETSC_ERR_FILE_READ, "is damaged: the checksum of the values of rank ");
  return CheckTrue("files with one bit turned, or two signs, are refused", refused == n + 1, n + 1);
}

/* Whether a file with another word of the head, and the right checksum, is refused with these words */
static int RefusedWord(Test *t, int word, uint64_t value, PetscErrorCode code, const char words[])
{
  unsigned char bytes[MAX_BYTES];
  uint64_t      head[TOTAL + 1], sum = 0;

  memcpy(bytes, t->good, (size_t)t->length);
  memcpy(head, bytes, sizeof(head));
  head[word]     = value;
  head[CHECKSUM] = 0;
  memcpy(bytes, head, sizeof(head));
  if (head[SIZE] <= (uint64_t)t->length) sum = ChecksumBytes(CHECKSUM_BEGIN, bytes, head[SIZE]);
  memcpy(bytes + 8 * CHECKSUM, &sum, 8);
  return Refused(t, bytes, t->length, code, words);
}

/* Breaks when: a file of other ranks, version, real numbers or machine is taken for a damaged one, or for a good one */
static int TestForeign(Test *t)
{
  char ranks[80], version[80], before[80];
  int  failed = 0;

  snprintf(ranks, sizeof(ranks), "was written by 7 ranks, this run has %d", t->size);
  snprintf(version, sizeof(version), "has version 9 of the format, this program reads version 7");
  snprintf(before, sizeof(before), "has version 6 of the format, this program reads version 7");
  failed += CheckTrue("other ranks", RefusedWord(t, RANKS, 7, PETSC_ERR_FILE_UNEXPECTED, ranks), 7);
  failed += CheckTrue("other version", RefusedWord(t, VERSION, 9, PETSC_ERR_FILE_UNEXPECTED, version), 9);
  failed += CheckTrue("version before", RefusedWord(t, VERSION, 6, PETSC_ERR_FILE_UNEXPECTED, before), 6);
  failed +=
    CheckTrue("other real numbers", RefusedWord(t, REAL, 4, PETSC_ERR_FILE_UNEXPECTED, "real numbers of 4 bytes"), 4);
  failed +=
    CheckTrue("other order of bytes",
              RefusedWord(t, ORDER, UINT64_C(0x0807060504030201), PETSC_ERR_FILE_UNEXPECTED, "order of bytes"), 0);
  failed += CheckTrue("head longer than the file",
                      RefusedWord(t, SIZE, (uint64_t)t->length + 8, PETSC_ERR_FILE_READ, "truncated or damaged"), 0);
  failed += CheckTrue("no checkpoint at all",
                      Refused(t,
                              (const unsigned char *)"# a text that somebody has put into this place by mistake\n"
                                                     "# a text that somebody has put into this place by mistake\n"
                                                     "# a text that somebody has put into this place by mistake\n"
                                                     "# a text that somebody has put into this place by mistake\n",
                              4 * 58, PETSC_ERR_FILE_UNEXPECTED, "no checkpoint"),
                      0);
  return failed;
}

/* The scene of a run: a number that is 0 or differs by its last bit alone, and a part more */
static PetscErrorCode SceneMake(PetscReal x, PetscBool more, Checksum *scene)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumDestroy(scene));
  PetscCall(ChecksumCreate(PETSC_COMM_WORLD, scene));
  PetscCall(ChecksumSetPart(*scene, "materials"));
  PetscCall(ChecksumAddReals(*scene, 1, &x));
  PetscCall(ChecksumSetPart(*scene, "supports"));
  if (more) PetscCall(ChecksumSetPart(*scene, "contact pad"));
  PetscFunctionReturn(0);
}

/* Breaks when: another scene (by one bit, by a part more), or other arrays on one rank alone, pass */
static int TestOtherModel(Test *t)
{
  const PetscMPIInt last   = t->size - 1;
  int               failed = 0;

  PetscCall(SceneMake(4.9e-324, PETSC_TRUE, &t->scene));
  failed += CheckTrue("one bit, one part",
                      Refused(t, t->good, t->length, PETSC_ERR_FILE_UNEXPECTED,
                              "is of another scene, which differs in: materials, contact pad"),
                      1);
  PetscCall(SceneMake(0, PETSC_FALSE, &t->scene));
  if (t->scratch.rank == last) t->item[2].n--;
  failed += CheckTrue("length that differs on one rank",
                      Refused(t, t->good, t->length, PETSC_ERR_FILE_UNEXPECTED, "has 7 numbers of 'a name"), 4);
  if (t->scratch.rank == last) t->item[2].n++;
  t->item[0].name = "velocities";
  failed +=
    CheckTrue("other array", Refused(t, t->good, t->length, PETSC_ERR_FILE_UNEXPECTED, "has 'displacements' where"), 5);
  t->item[0].name = "displacements";
  return failed;
}

/* Breaks when: a missing file is not named, or with the folder only */
static int TestMissing(Test *t)
{
  PetscBool      same;
  PetscErrorCode error;
  int            failed;

  failed = CheckTrue("the file is removed", ScratchRemove(&t->scratch, NAME), 0);
  error  = ReadBack(t, PETSC_FALSE, &same);
  failed += CheckTrue("missing file", error == PETSC_ERR_FILE_OPEN && same, error);
  return failed +
         CheckTrue("folder and option are named",
                   strstr(t->scratch.message, t->scratch.dir) && strstr(t->scratch.message, "-dynamics_restart"), 0);
}

/* Breaks when: a write that fails, on whichever rank, replaces or removes the last good file, leaves its temporary one,
   or passes unnoticed. Limits from nothing to one byte less than the file */
static int TestFull(Test *t)
{
  PetscBool same;
  int       n = 0, good = 0;

  FilePut(t, t->good, t->length);
  for (long limit = 0; limit < t->length; limit += limit < t->length - 100 ? 97 : 1, n++) {
    PetscErrorCode error;

    ItemsMake(t, 2);
    LimitFiles(limit);
    error = JournalWrite(&JOURNAL(t), NAME, N_ITEMS, t->item);
    LimitFiles(-1);
    ItemsMake(t, 1);
    good += error == PETSC_ERR_FILE_WRITE && strstr(t->scratch.message, NAME ": File too large; free some space") &&
            !ReadBack(t, PETSC_FALSE, &same) && same && !ScratchRemove(&t->scratch, NAME ".part");
  }
  return CheckTrue("the last good file stays when the disk is full", good == n, n);
}

int main(int argc, char **argv)
{
  static Test t;
  int         failed;

  signal(SIGXFSZ, SIG_IGN);
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &t.size));
  PetscCall(ScratchCreate(&t.scratch));
  PetscCall(PetscOptionsSetValue(NULL, "-output_dir", t.scratch.dir));
  PetscCall(ResultsCreate(PETSC_COMM_WORLD, &t.results));
  PetscCall(ResultsSetFromOptions(t.results));
  PetscCall(SceneMake(0, PETSC_FALSE, &t.scene));
  failed = TestSame(&t);
  failed += TestTruncated(&t);
  failed += TestFlipped(&t);
  failed += TestForeign(&t);
  failed += TestOtherModel(&t);
  failed += TestMissing(&t);
  failed += TestFull(&t);
  (void)ScratchRemove(&t.scratch, NAME);
  PetscCall(ChecksumDestroy(&t.scene));
  PetscCall(ResultsDestroy(&t.results));
  failed += CheckTrue("no other file is left", ScratchDestroy(&t.scratch), 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
