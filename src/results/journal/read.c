/*
   Journal: reads it back (write.c). Nothing of a file is used before all ranks have found all of it good.
*/
#include "base/process/fault.h"
#include "base/file.h"
#include "journalimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A file that is being read, and what is wrong with it */
typedef struct {
  const Journal *journal;
  char           name[PETSC_MAX_PATH_LEN];
  int            fd;
  JournalHead   *head; /* with parts, names and table behind it; NULL until read */
  Fault          fault;
} JournalReader;

/* Keep what is wrong with the file, printf-like: it is damaged, or of another program, run or model */
#define NoteDamage(reader, ...) FaultNote(&(reader)->fault, PETSC_ERR_FILE_READ, __VA_ARGS__)
#define NoteOther(reader, ...)  FaultNote(&(reader)->fault, PETSC_ERR_FILE_UNEXPECTED, __VA_ARGS__)

/* Reads bytes [offset, offset + size) */
static PetscErrorCode ReaderRead(JournalReader *reader, void *bytes, uint64_t size, uint64_t offset)
{
  char *at = bytes;

  PetscFunctionBeginUser;
  while (size > 0 && !reader->fault.code) {
    const ssize_t n = pread(reader->fd, at, (size_t)size, (off_t)offset);

    if (n < 0 && errno == EINTR) continue;
    if (n < 0) PetscCall(NoteDamage(reader, "cannot read %s: %s", reader->name, strerror(errno)));
    if (n == 0) PetscCall(NoteDamage(reader, "%s is truncated: it ends while it is read", reader->name));
    if (n <= 0) break;
    at += n, offset += (uint64_t)n, size -= (uint64_t)n;
  }
  PetscFunctionReturn(0);
}

/* Opens the file on this rank */
static PetscErrorCode ReaderOpen(JournalReader *reader, const char name[])
{
  const char *dir;

  PetscFunctionBeginUser;
  PetscCall(ResultsGetDirectory(reader->journal->results, &dir));
  PetscCall(PetscSNPrintf(reader->name, sizeof(reader->name), "%s/%s", dir, name));
  reader->fd = FileOpen(reader->name, O_RDONLY);
  if (reader->fd < 0 && errno == ENOENT)
    PetscCall(FaultNote(&reader->fault, PETSC_ERR_FILE_OPEN,
                        "there is no %s in the folder -output_dir %s, from which %s goes on", name, dir,
                        reader->journal->reader));
  if (reader->fd < 0)
    PetscCall(FaultNote(&reader->fault, PETSC_ERR_FILE_OPEN, "cannot read %s for %s: %s", reader->name,
                        reader->journal->reader, FileReason(errno)));
  PetscFunctionReturn(0);
}

/* Checks what is the same in all versions and the length of the file; head is the first part of one */
static PetscErrorCode ReaderCheckKind(JournalReader *reader, const JournalHead *head, uint64_t length)
{
  uint64_t other = 0;

  PetscFunctionBeginUser;
  for (unsigned i = 0; i < 64; i += 8) other |= (JOURNAL_ORDER >> i & 0xff) << (56 - i);
  if (length < sizeof(*head))
    PetscCall(NoteDamage(reader, "%s is truncated: %llu bytes are less than its head", reader->name,
                         (unsigned long long)length));
  else if (memcmp(head->magic, JOURNAL_MAGIC, sizeof(head->magic)))
    PetscCall(NoteOther(reader, "%s is no checkpoint of squeal, or damaged", reader->name));
  else if (head->order == other)
    PetscCall(NoteOther(reader, "%s was written by a machine with the other order of bytes", reader->name));
  else if (head->order != JOURNAL_ORDER || head->size < offsetof(JournalHead, real_size))
    PetscCall(NoteDamage(reader, "%s is damaged: its head is wrong", reader->name));
  else if (head->size > length)
    PetscCall(NoteDamage(reader, "%s is truncated or damaged: %llu bytes, its head says more", reader->name,
                         (unsigned long long)length));
  PetscFunctionReturn(0);
}

/* Reads the head with names and table on this rank, and checks it in itself */
static PetscErrorCode ReaderReadHead(JournalReader *reader)
{
  struct stat status;
  uint64_t    length;
  JournalHead head = {.size = 0};

  PetscFunctionBeginUser;
  if (reader->fault.code) PetscFunctionReturn(0);
  if (fstat(reader->fd, &status)) PetscCall(NoteDamage(reader, "cannot read %s: %s", reader->name, strerror(errno)));
  length = (uint64_t)status.st_size;
  PetscCall(ReaderRead(reader, &head, PetscMin(length, sizeof(head)), 0));
  PetscCall(ReaderCheckKind(reader, &head, length));
  if (reader->fault.code) PetscFunctionReturn(0);
  PetscCall(PetscCalloc(PetscMax((size_t)head.size, sizeof(head)), &reader->head));
  PetscCall(ReaderRead(reader, reader->head, head.size, 0));
  if (reader->head->size != head.size || JournalHeadSum(reader->head) != head.checksum)
    PetscCall(NoteDamage(reader, "%s is damaged: the checksum of its head differs", reader->name));
  else if (head.version != JOURNAL_VERSION)
    PetscCall(NoteOther(reader, "%s has version %llu of the format, this program reads version %d", reader->name,
                        (unsigned long long)head.version, JOURNAL_VERSION));
  else if (length != head.total)
    PetscCall(NoteDamage(reader, "%s is %s: %llu bytes instead of %llu", reader->name,
                         length < head.total ? "truncated" : "too long", (unsigned long long)length,
                         (unsigned long long)head.total));
  PetscFunctionReturn(0);
}

/* Checks that the file is one of this program on these ranks */
static PetscErrorCode ReaderCheckRun(JournalReader *reader, PetscMPIInt size)
{
  const JournalHead *h = reader->head;

  PetscFunctionBeginUser;
  if (reader->fault.code) PetscFunctionReturn(0);
  if (h->real_size != sizeof(PetscReal))
    PetscCall(NoteOther(reader, "%s has real numbers of %llu bytes, those of this program have %d", reader->name,
                        (unsigned long long)h->real_size, (int)sizeof(PetscReal)));
  else if (h->n_ranks != (uint64_t)size)
    PetscCall(NoteOther(reader, "%s was written by %llu rank%s, this run has %d", reader->name,
                        (unsigned long long)h->n_ranks, h->n_ranks == 1 ? "" : "s", size));
  else if (h->size != JournalHeadSize(h))
    PetscCall(NoteDamage(reader, "%s is damaged: its head has a wrong length", reader->name));
  PetscFunctionReturn(0);
}

/* Checks that it is a run of this scene */
static PetscErrorCode ReaderCheckScene(JournalReader *reader, Checksum scene)
{
  const JournalHead *h = reader->head;
  char               names[256];

  PetscFunctionBeginUser;
  if (reader->fault.code) PetscFunctionReturn(0);
  PetscCall(ChecksumCompare(scene, (PetscInt)h->n_parts, JournalHeadParts(h), sizeof(names), names));
  if (names[0]) PetscCall(NoteOther(reader, "%s is of another scene, which differs in: %s", reader->name, names));
  PetscFunctionReturn(0);
}

/* Checks names of the items, and their lengths on this rank */
static PetscErrorCode ReaderCheckItems(JournalReader *reader, PetscMPIInt rank, PetscInt n, const JournalItem item[])
{
  const JournalHead *h = reader->head;
  const uint64_t    *row;
  char               name[JOURNAL_NAME];

  PetscFunctionBeginUser;
  if (reader->fault.code) PetscFunctionReturn(0);
  if (h->n_items != (uint64_t)n)
    PetscCall(NoteOther(reader, "%s has %llu arrays, this run has %" PetscInt_FMT ": it is of another scene",
                        reader->name, (unsigned long long)h->n_items, n));
  row = JournalHeadRow(h, rank);
  for (PetscInt i = 0; i < n && !reader->fault.code; i++) {
    PetscCall(PetscStrncpy(name, item[i].name, sizeof(name)));
    if (strncmp(JournalHeadName(h, i), name, JOURNAL_NAME))
      PetscCall(NoteOther(reader, "%s has '%.32s' where this run has '%s': it is of another scene", reader->name,
                          JournalHeadName(h, i), name));
    else if (item[i].n >= 0 && row[i] != (uint64_t)item[i].n)
      PetscCall(NoteOther(
        reader, "%s has %llu numbers of '%s' on rank %d, this run has %" PetscInt_FMT ": it is of another scene",
        reader->name, (unsigned long long)row[i], name, rank, item[i].n));
  }
  PetscFunctionReturn(0);
}

/* Where the values of a rank begin, and how many bytes they have */
static PetscErrorCode ReaderFindValues(JournalReader *reader, PetscMPIInt rank, uint64_t *begin, uint64_t *size)
{
  const JournalHead *h = reader->head;
  uint64_t           at, end = 0;

  PetscFunctionBeginUser;
  *begin = *size = 0;
  if (reader->fault.code) PetscFunctionReturn(0);
  end = h->size;
  for (uint64_t r = 0; r < h->n_ranks; r++) {
    at = end;
    for (uint64_t i = 0; i < h->n_items; i++) end += sizeof(PetscReal) * JournalHeadRow(h, (PetscInt)r)[i];
    if (r == (uint64_t)rank) *begin = at, *size = end - at;
  }
  if (end != h->total || *begin + *size > h->total)
    PetscCall(NoteDamage(reader, "%s is damaged: its lengths contradict each other", reader->name));
  PetscFunctionReturn(0);
}

/* Reads the values of this rank, which the caller frees */
static PetscErrorCode ReaderReadValues(JournalReader *reader, PetscMPIInt rank, PetscReal **values)
{
  uint64_t         begin, size, sum = CHECKSUM_BEGIN;
  const uint64_t  *row;
  const PetscReal *at;

  PetscFunctionBeginUser;
  *values = NULL;
  PetscCall(ReaderFindValues(reader, rank, &begin, &size));
  if (reader->fault.code) PetscFunctionReturn(0);
  PetscCall(PetscMalloc((size_t)size, values));
  PetscCall(ReaderRead(reader, *values, size, begin));
  if (reader->fault.code) PetscFunctionReturn(0);
  row = JournalHeadRow(reader->head, rank);
  at  = *values;
  for (uint64_t i = 0; i < reader->head->n_items; at += row[i++])
    sum = ChecksumBytes(sum, at, sizeof(PetscReal) * row[i]);
  if (sum != row[reader->head->n_items])
    PetscCall(NoteDamage(reader, "%s is damaged: the checksum of the values of rank %d differs", reader->name, rank));
  PetscFunctionReturn(0);
}

/* Hands the values to the items */
static PetscErrorCode JournalFillItems(const uint64_t row[], const PetscReal values[], PetscInt n, JournalItem item[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; values += row[i++]) {
    if (item[i].n < 0) PetscCall(PetscMalloc1((size_t)row[i], &item[i].values));
    item[i].n = (PetscInt)row[i];
    PetscCall(PetscArraycpy(item[i].values, values, item[i].n));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode JournalRead(const Journal *journal, const char name[], PetscInt n, JournalItem item[], Fault *fault)
{
  JournalReader reader = {.journal = journal, .fd = -1};
  PetscReal    *values;
  PetscMPIInt   size, rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(journal->comm, &size));
  PetscCallMPI(MPI_Comm_rank(journal->comm, &rank));
  PetscCall(ReaderOpen(&reader, name));
  PetscCall(ReaderReadHead(&reader));
  PetscCall(ReaderCheckRun(&reader, size));
  PetscCall(ReaderCheckScene(&reader, journal->scene));
  PetscCall(ReaderCheckItems(&reader, rank, n, item));
  PetscCall(ReaderReadValues(&reader, rank, &values));
  PetscCall(FaultsAgree(journal->comm, &reader.fault));
  if (!reader.fault.code) PetscCall(JournalFillItems(JournalHeadRow(reader.head, rank), values, n, item));
  PetscCall(PetscFree(values));
  PetscCall(PetscFree(reader.head));
  if (reader.fd >= 0) (void)close(reader.fd);
  *fault = reader.fault;
  PetscFunctionReturn(0);
}

PetscErrorCode JournalFind(MPI_Comm comm, Results results, const char name[], JournalKind *kind)
{
  char        path[PETSC_MAX_PATH_LEN], magic[sizeof(JOURNAL_MAGIC)] = "";
  const char *dir;
  FILE       *file;
  PetscMPIInt rank;
  int         found = JOURNAL_NONE;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(ResultsGetDirectory(results, &dir));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", dir, name));
  if (rank == 0 && !access(path, F_OK)) {
    found = JOURNAL_FOREIGN;
    file  = FileStream(path, "rb");
    if (file && fread(magic, 1, sizeof(magic) - 1, file) == sizeof(magic) - 1 && !strcmp(magic, JOURNAL_MAGIC))
      found = JOURNAL_OURS;
    if (file) (void)fclose(file);
  }
  PetscCallMPI(MPI_Bcast(&found, 1, MPI_INT, 0, comm));
  *kind = (JournalKind)found;
  PetscFunctionReturn(0);
}

PetscErrorCode JournalWarn(const Journal *journal, MPI_Comm comm, const char name[], const char then[], Fault *fault,
                           PetscBool *taken)
{
  JournalKind kind;

  PetscFunctionBeginUser;
  PetscCall(FaultsAgree(comm, fault));
  *taken = fault->code ? PETSC_FALSE : PETSC_TRUE;
  if (*taken) PetscFunctionReturn(0);
  PetscCall(JournalFind(comm, journal->results, name, &kind));
  if (kind != JOURNAL_NONE) PetscCall(PetscFPrintf(comm, stderr, "squeal: warning: %s; %s\n", fault->text, then));
  PetscFunctionReturn(0);
}

PetscErrorCode JournalTake(const Journal *journal, const char name[], const char then[], PetscInt n, JournalItem item[],
                           PetscBool *taken)
{
  Fault fault;

  PetscFunctionBeginUser;
  PetscCall(JournalRead(journal, name, n, item, &fault));
  PetscCall(JournalWarn(journal, journal->comm, name, then, &fault, taken));
  PetscFunctionReturn(0);
}
