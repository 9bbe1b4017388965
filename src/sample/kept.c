/*
   What a killed run of samples or conditions goes on from, in files of the output folder until it is complete:

      sample_restart_statuses    which pairs are closed at each point (sweep/box/status.c)
      sample_restart_<k>         full solutions behind the basis (sweep/basis/kept.c)
      sample_restart_points_<k>  the beginning of a pass over points, or the modes of some of them, each from its rank

   On one rank the tables are bit by bit those of a run that nobody disturbed.
*/
#include "sampleimpl.h"
#include "base/path.h"
#include "base/process/interrupt.h"

/* What stands in front of the indices of points in each file, and of the modes of those of this rank */
typedef struct {
  PetscInt round, n_before, n_large, n_divided, first, n;
} PassHeader;

/* What a run must share with the one that it goes on with: the scene, and all points */
static PetscErrorCode SampleAddChecksum(Sample s, Checksum c)
{
  PetscMPIInt size;
  PetscReal  *p;

  PetscFunctionBeginUser;
  PetscCall(OperatorsAddSceneChecksum(s->operators, PETSC_TRUE, c));
  if (s->box.statics) PetscCall(StaticsAddChecksum(s->box.statics, c));
  PetscCall(ModesAddChecksum(s->box.modes, c));
  PetscCallMPI(MPI_Comm_size(s->comm, &size));
  PetscCall(ChecksumSetPart(c, "the points"));
  PetscCall(ChecksumAddInts(c, 3, (const PetscInt[]){size, s->box.n_groups, s->n_points}));
  PetscCall(ChecksumAddReals(c, 1, &s->box.rtol));
  PetscCall(PetscMalloc1(s->box.n_base, &p));
  for (PetscInt i = 0; i < s->n_points; i++) {
    PetscCall(SampleGet(s, i, p));
    PetscCall(ChecksumAddReals(c, s->box.n_base, p));
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleJournalOpen(Sample s, Results results)
{
  PetscFunctionBeginUser;
  s->results = results;
  if (!s->restart) PetscFunctionReturn(0);
  PetscCall(ChecksumCreate(s->comm, &s->journal.scene));
  PetscCall(SampleAddChecksum(s, s->journal.scene));
  s->journal     = (Journal){s->comm, results, s->journal.scene, "a run of samples", "run"};
  s->box.journal = &s->journal;
  s->box.begin   = "sample";
  PetscFunctionReturn(0);
}

static PetscErrorCode PassFileName(Sample s, char name[64])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, 64, "sample_restart_points_%05d", (int)s->pass.n_files));
  PetscFunctionReturn(0);
}

/* The points k = first .. first + n - 1 of a pass, those of this rank */
static PetscErrorCode PassPointsMove(Sample s, PetscInt first, PetscInt n, const PetscInt list[], JournalPack *pack)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(s->comm, &rank));
  for (PetscInt k = 0; k < n && (pack->write || pack->good); k++) {
    SamplePoint *point = &s->point[list[k]];

    if (PointGroupsOwner(&s->box.groups, first + k) != rank) continue;
    PetscCall(JournalPackMove(pack, &point->n, sizeof(point->n)));
    PetscCall(JournalPackMove(pack, &point->worst, sizeof(point->worst)));
    if (!pack->write) PetscCall(PetscFree(point->mode));
    if (!pack->write) PetscCall(PetscMalloc1(point->n, &point->mode));
    PetscCall(JournalPackMove(pack, point->mode, (size_t)point->n * sizeof(SampleMode)));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SampleKeep(Sample s, PetscBool begins, PetscInt first, PetscInt n, PetscInt list[])
{
  PassHeader  h    = {s->pass.round, s->pass.n_before, s->n_large, s->n_divided, begins ? -1 : first, n};
  JournalPack pack = {.write = PETSC_TRUE};
  JournalItem item;
  char        name[64];

  PetscFunctionBeginUser;
  if (!s->restart) PetscFunctionReturn(0);
  PetscCall(PassFileName(s, name));
  PetscCall(JournalPackMove(&pack, &h, sizeof(h)));
  PetscCall(JournalPackMove(&pack, list, (size_t)n * sizeof(*list)));
  if (!begins) PetscCall(PassPointsMove(s, first, n, list, &pack));
  item = (JournalItem){"points", pack.n, pack.word};
  PetscCall(JournalKeep(&s->journal, name, 1, &item, &s->restart));
  PetscCall(JournalPackDestroy(&pack));
  s->pass.n_files++;
  if (s->restart && !begins && !s->pass.round)
    InterruptSays("%d of %d points are kept, with which the same command goes on", (int)(first + n), (int)s->n_points);
  PetscFunctionReturn(0);
}

PetscErrorCode SampleShare(Sample s, PetscInt first, PetscInt n, const PetscInt list[])
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(s->comm, &rank));
  for (PetscInt k = 0; k < n; k++) {
    const PetscMPIInt owner   = PointGroupsOwner(&s->box.groups, first + k);
    SamplePoint      *point   = &s->point[list[k]];
    PetscReal         head[2] = {(PetscReal)point->n, point->worst};

    PetscCallMPI(MPI_Bcast(head, 2, MPIU_REAL, owner, s->comm));
    point->n     = (PetscInt)head[0];
    point->worst = head[1];
    if (rank != owner) PetscCall(PetscFree(point->mode));
    if (rank != owner) PetscCall(PetscMalloc1(point->n, &point->mode));
    PetscCallMPI(
      MPI_Bcast(point->mode, (PetscMPIInt)(point->n * (PetscInt)sizeof(SampleMode)), MPI_BYTE, owner, s->comm));
  }
  PetscFunctionReturn(0);
}

/* One file; good is false where it is not what it should be */
static PetscErrorCode PassTake(Sample s, JournalPack *pack, PetscBool *good)
{
  PassHeader h = {0};
  PetscInt  *list;

  PetscFunctionBeginUser;
  PetscCall(JournalPackMove(pack, &h, sizeof(h)));
  *good =
    pack->good && h.n >= 0 && h.n <= s->n_points && h.first >= -1 && h.first <= s->n_points ? PETSC_TRUE : PETSC_FALSE;
  list  = NULL;
  if (*good) PetscCall(PetscCalloc1(h.n, &list));
  if (*good) PetscCall(JournalPackMove(pack, list, (size_t)h.n * sizeof(*list)));
  if (!pack->good) *good = PETSC_FALSE;
  for (PetscInt k = 0; k < h.n && *good; k++)
    if (list[k] < 0 || list[k] >= s->n_points) *good = PETSC_FALSE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, good, 1, MPIU_BOOL, MPI_LAND, s->comm));
  if (!*good) PetscCall(PetscFree(list));
  if (!*good) PetscFunctionReturn(0);
  s->pass.round    = h.round;
  s->pass.n_before = h.n_before;
  s->n_large       = h.n_large;
  s->n_divided     = h.n_divided;
  if (h.first < 0) {
    PetscCall(PetscArraycpy(s->pass.list, list, h.n));
    s->pass.n     = h.n;
    s->pass.first = 0;
    s->pass.begun = PETSC_TRUE;
  } else {
    PetscCall(PassPointsMove(s, h.first, h.n, list, pack));
    PetscCall(SampleShare(s, h.first, h.n, list));
    s->pass.first = h.first + h.n;
  }
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleResume(Sample s)
{
  const char *folder;
  PetscBool   taken = s->restart;

  PetscFunctionBeginUser;
  while (taken) {
    JournalItem item = {"points", -1, NULL};
    JournalPack pack = {.good = PETSC_TRUE};
    char        name[64];

    PetscCall(PassFileName(s, name));
    PetscCall(JournalTake(&s->journal, name, "the run goes on without it", 1, &item, &taken));
    if (!taken) break;
    pack.word = item.values;
    pack.n    = item.n;
    PetscCall(PassTake(s, &pack, &taken));
    PetscCall(JournalPackDestroy(&pack));
    if (taken) s->pass.n_files++;
  }
  if (!s->pass.n_files) PetscFunctionReturn(0);
  PetscCall(ResultsGetDirectory(s->results, &folder));
  PetscCall(PetscPrintf(
    s->comm, "going on behind %" PetscInt_FMT " of %" PetscInt_FMT " points of pass %" PetscInt_FMT " kept in %s\n",
    s->pass.first, s->pass.n, s->pass.round + 1, folder));
  PetscFunctionReturn(0);
}

PetscErrorCode SampleForget(Sample s)
{
  PetscMPIInt rank;
  const char *folder;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(s->comm, &rank));
  if (!s->results || !s->journal.scene) PetscFunctionReturn(0);
  PetscCall(ResultsGetDirectory(s->results, &folder));
  if (!rank) PathForget(folder, "sample_restart_");
  PetscFunctionReturn(0);
}
