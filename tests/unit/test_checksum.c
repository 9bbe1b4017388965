/*
   Unit test of base/checksum.c: one change, however small, changes the sum of its part and of no other; the sums do not
   depend on the ranks, on the order of pieces, or on how they are shared; a difference is named.
*/
#include <squeal/checksum.h>
#include "check.h"
#include <math.h>
#include <string.h>

#define N_PIECES 12

/* What a scene says; one of them differs in each test */
typedef struct {
  PetscReal   x[3];
  PetscInt    n[2];
  const char *text[2];
  uint64_t    piece[N_PIECES];
} Scene;

/* Parts "reals", "ints", "strings", "pieces"; the pieces are dealt out to the ranks, from `first` on */
static PetscErrorCode SceneSum(const Scene *s, PetscMPIInt first, Checksum *c)
{
  PetscMPIInt rank, size;
  uint64_t    mine[N_PIECES];
  PetscInt    n = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (int i = 0; i < N_PIECES; i++)
    if ((i * i + first) % size == rank) mine[n++] = s->piece[(i + first) % N_PIECES];
  PetscCall(ChecksumCreate(PETSC_COMM_WORLD, c));
  PetscCall(ChecksumSetPart(*c, "reals"));
  PetscCall(ChecksumAddReals(*c, 1, s->x));
  PetscCall(ChecksumSetPart(*c, "%ss", "int"));
  PetscCall(ChecksumAddInts(*c, 2, s->n));
  PetscCall(ChecksumSetPart(*c, "strings"));
  for (int i = 0; i < 2; i++) PetscCall(ChecksumAddString(*c, s->text[i]));
  PetscCall(ChecksumSetPart(*c, "pieces"));
  PetscCall(ChecksumAddPieces(*c, n, mine));
  PetscCall(ChecksumSetPart(*c, "reals")); /* goes on with the first one */
  PetscCall(ChecksumAddReals(*c, 2, &s->x[1]));
  PetscFunctionReturn(0);
}

static Scene SceneMake(void)
{
  Scene s = {
    .x = {0.1, 0,  3},
      .n = {7,   -7    },
      .text = {"pad",   "disc"}
  };

  for (int i = 0; i < N_PIECES; i++) s.piece[i] = ChecksumBytes(CHECKSUM_BEGIN, &i, sizeof(i));
  return s;
}

/* Names of what differs between two scenes */
static PetscErrorCode SceneCompare(const Scene *one, const Scene *other, PetscMPIInt first, char names[256])
{
  Checksum            c[2];
  const ChecksumPart *parts;
  PetscInt            n;

  PetscFunctionBeginUser;
  PetscCall(SceneSum(one, 0, &c[0]));
  PetscCall(SceneSum(other, first, &c[1]));
  PetscCall(ChecksumGetParts(c[1], &n, &parts));
  PetscCall(ChecksumCompare(c[0], n, parts, 256, names));
  for (int i = 0; i < 2; i++) PetscCall(ChecksumDestroy(&c[i]));
  PetscFunctionReturn(0);
}

/* Breaks when: a change passes, or is laid to another part, or order and ranks of pieces matter */
static PetscErrorCode TestChanges(int *failed)
{
  const Scene scene = SceneMake();
  char        names[256];

  PetscFunctionBeginUser;
  PetscCall(SceneCompare(&scene, &scene, 0, names));
  *failed += CheckTrue("the same scene", !names[0], 0);
  PetscCall(SceneCompare(&scene, &scene, 1, names));
  *failed += CheckTrue("pieces on other ranks in another order", !names[0], 1);
  for (int change = 0; change < 9; change++) {
    const char *const expected[] = {"reals",   "reals",  "reals",       "ints", "strings",
                                    "strings", "pieces", "reals, ints", ""};
    Scene             s          = scene;

    if (change == 0) s.x[0] = nextafter(s.x[0], 1);
    if (change == 1) s.x[1] = -1e-300;
    if (change == 2) s.x[2] = -3;
    if (change == 3) s.n[0] = -7, s.n[1] = 7;
    if (change == 4) s.text[0] = "padd", s.text[1] = "isc";
    if (change == 5) s.text[1] = NULL;
    if (change == 6) s.piece[N_PIECES - 1] ^= 1;
    if (change == 7) s.x[2] = NAN, s.n[1]++;
    if (change == 8) s.x[1] = -0.0; /* the same number */
    PetscCall(SceneCompare(&scene, &s, change % 3, names));
    *failed += CheckTrue(expected[change], !strcmp(names, expected[change]), change);
  }
  PetscFunctionReturn(0);
}

/* Breaks when: sums change with the number of ranks; the values are those of one rank */
static PetscErrorCode TestRanks(int *failed)
{
  const Scene         scene = SceneMake();
  const ChecksumPart *parts;
  uint64_t            all[2] = {0, N_PIECES}, sum;
  Checksum            c;
  PetscInt            n;

  PetscFunctionBeginUser;
  PetscCall(SceneSum(&scene, 2, &c));
  PetscCall(ChecksumGetParts(c, &n, &parts));
  for (int i = 0; i < N_PIECES; i++) all[0] += scene.piece[i];
  sum = ChecksumBytes(CHECKSUM_BEGIN, all, sizeof(all));
  *failed += CheckTrue("four parts", n == 4 && !strcmp(parts[3].name, "pieces"), (double)n);
  *failed += CheckTrue("sum of the pieces", n == 4 && parts[3].sum == sum, 0);
  sum = ChecksumBytes(CHECKSUM_BEGIN, scene.x, sizeof(*scene.x));
  *failed += CheckTrue("a part that is taken up goes on", parts[0].sum == ChecksumBytes(sum, &scene.x[1], 16), 0);
  PetscCall(ChecksumDestroy(&c));
  PetscFunctionReturn(0);
}

/* Breaks when: a part that one of the two lacks passes, or a long name spoils the others */
static PetscErrorCode TestLacking(int *failed)
{
  const ChecksumPart kept[] = {
    {"loads",  CHECKSUM_BEGIN},
    {"motion", 1             }
  };
  char     name[100], names[256];
  Checksum c;

  PetscFunctionBeginUser;
  memset(name, 'x', sizeof(name));
  name[99] = '\0';
  PetscCall(ChecksumCreate(PETSC_COMM_WORLD, &c));
  PetscCall(ChecksumSetPart(c, "%s", name));
  PetscCall(ChecksumSetPart(c, "loads"));
  PetscCall(ChecksumCompare(c, 2, kept, sizeof(names), names));
  name[55] = '\0';
  *failed += CheckTrue("new part and missing part",
                       !strncmp(names, name, 55) && !strcmp(names + 55, ", motion") && strlen(names) == 63, 0);
  PetscCall(ChecksumDestroy(&c));
  PetscFunctionReturn(0);
}

/* Breaks when: the sum of a zero-filled tail or an empty array is that of another length */
static int TestBytes(void)
{
  const char bytes[16] = {1, 2, 3};
  uint64_t   sum[17];
  int        equal = 0;

  for (size_t n = 0; n <= 16; n++) {
    sum[n] = ChecksumBytes(CHECKSUM_BEGIN, bytes, n);
    for (size_t i = 0; i < n; i++) equal += sum[i] == sum[n];
  }
  return CheckTrue("lengths have their own checksums", equal == 0, equal);
}

int main(int argc, char **argv)
{
  int failed = 0;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestChanges(&failed));
  PetscCall(TestRanks(&failed));
  PetscCall(TestLacking(&failed));
  failed += TestBytes();
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
