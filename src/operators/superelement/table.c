/*
   Where the unknowns of a superelement are, a table

      unknown,node,direction,x,y,z

   with a line for each: its number in the matrices, from 1; a number of its node, the same for all of one place;
   direction x, y, z (or 1, 2, 3), about these rx, ry, rz (4, 5, 6), or `internal` (0) for what is no displacement of
   the mesh, such as a modal coordinate or a node that is kept; the place (m), not read of these. Lines in any order.
*/
#include "superelement.h"
#include "base/csv.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { TABLE_UNKNOWN, TABLE_NODE, TABLE_DIRECTION, TABLE_X, N_TABLE = TABLE_X + 3 };

static const char *const columns[N_TABLE] = {"unknown", "node", "direction", "x", "y", "z"};

/* A line, as it is read on one rank */
typedef struct {
  PetscInt        unknown, line;
  SuperelementRow row;
} TableLine;

/* The direction of a line */
static PetscInt TableLineDirection(Csv *csv)
{
  static const char *const word[]   = {"x", "y", "z", "rx", "ry", "rz", "internal"};
  static const char *const number[] = {"1", "2", "3", "4", "5", "6", "0"};
  const char              *given    = CsvWord(csv, TABLE_DIRECTION);

  for (PetscInt d = 0; d < 7; d++)
    if (!strcasecmp(given, word[d]) || !strcmp(given, number[d])) return d < 6 ? d : SUPERELEMENT_APART;
  if (!csv->fault[0])
    (void)snprintf(csv->fault, sizeof(csv->fault),
                   "line %d: direction '%.40s' must be x, y, z, rx, ry, rz or internal (or 1 to 6, 0)", (int)csv->line,
                   given);
  return SUPERELEMENT_APART;
}

static void TableLineRead(Csv *csv, TableLine *line)
{
  SuperelementRow *row = &line->row;

  *line          = (TableLine){.unknown = (PetscInt)CsvReal(csv, TABLE_UNKNOWN, PETSC_TRUE) - 1, .line = csv->line};
  row->direction = TableLineDirection(csv);
  if (row->direction == SUPERELEMENT_APART) return;
  row->node = (PetscInt)CsvReal(csv, TABLE_NODE, PETSC_TRUE);
  for (int d = 0; d < 3; d++) row->x[d] = CsvReal(csv, TABLE_X + d, PETSC_FALSE);
}

static int TableUnknownCompare(const void *a, const void *b)
{
  const TableLine *l = a, *r = b;

  return (l->unknown > r->unknown) - (l->unknown < r->unknown);
}

/* By node, then direction; internal ones first */
static int TableNodeCompare(const void *a, const void *b)
{
  const SuperelementRow *l = &((const TableLine *)a)->row, *r = &((const TableLine *)b)->row;
  const PetscInt         x = l->direction == SUPERELEMENT_APART, y = r->direction == SUPERELEMENT_APART;

  if (x != y) return x ? -1 : 1;
  if (l->node != r->node) return l->node < r->node ? -1 : 1;
  return (l->direction > r->direction) - (l->direction < r->direction);
}

/* A fault where a node has two places, or a direction twice */
static void LinesCheckNodes(Csv *csv, PetscInt n, TableLine line[])
{
  qsort(line, (size_t)n, sizeof(*line), TableNodeCompare);
  for (PetscInt i = 1; i < n && !csv->fault[0]; i++) {
    const SuperelementRow *a = &line[i - 1].row, *b = &line[i].row;

    if (a->direction == SUPERELEMENT_APART || a->node != b->node) continue;
    if (a->direction == b->direction)
      (void)snprintf(csv->fault, sizeof(csv->fault), "lines %d and %d: node %d has the same direction twice",
                     (int)line[i - 1].line, (int)line[i].line, (int)a->node);
    else if (a->x[0] != b->x[0] || a->x[1] != b->x[1] || a->x[2] != b->x[2])
      (void)snprintf(csv->fault, sizeof(csv->fault), "lines %d and %d: node %d has two places", (int)line[i - 1].line,
                     (int)line[i].line, (int)a->node);
  }
}

/* Sorts by unknown; a fault where these are not 1 to n, each once */
static void LinesCheckUnknowns(Csv *csv, PetscInt n, TableLine line[])
{
  if (!n && !csv->fault[0]) (void)snprintf(csv->fault, sizeof(csv->fault), "it has no unknown");
  if (n) qsort(line, (size_t)n, sizeof(*line), TableUnknownCompare);
  for (PetscInt i = 0; i < n && !csv->fault[0]; i++) {
    if (line[i].unknown == i) continue;
    if (line[i].unknown < 0)
      (void)snprintf(csv->fault, sizeof(csv->fault), "line %d: unknown %d: they count from 1", (int)line[i].line,
                     (int)line[i].unknown + 1);
    else if (i && line[i].unknown == line[i - 1].unknown)
      (void)snprintf(csv->fault, sizeof(csv->fault), "lines %d and %d: unknown %d stands twice", (int)line[i - 1].line,
                     (int)line[i].line, (int)line[i].unknown + 1);
    else
      (void)snprintf(csv->fault, sizeof(csv->fault),
                     "unknown %d has no line, so that it has no place; unknown %d stands in line %d", (int)i + 1,
                     (int)line[i].unknown + 1, (int)line[i].line);
  }
}

/* All of it, on the rank that calls */
static PetscErrorCode SuperelementReadFile(Csv *csv, Superelement *s)
{
  PetscInt   room = 0;
  TableLine *line = NULL;

  PetscFunctionBeginUser;
  CsvOpen(csv, s->table, N_TABLE, columns, N_TABLE);
  while (CsvNext(csv)) {
    if (s->n == room) {
      room = PetscMax(1024, 2 * room);
      PetscCall(PetscRealloc((size_t)room * sizeof(*line), &line));
    }
    TableLineRead(csv, &line[s->n++]);
  }
  CsvClose(csv);
  if (!csv->fault[0]) LinesCheckNodes(csv, s->n, line);
  LinesCheckUnknowns(csv, s->n, line);
  PetscCall(PetscMalloc1(s->n, &s->row));
  for (PetscInt i = 0; i < s->n; i++) s->row[i] = line[i].row;
  PetscCall(PetscFree(line));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementReadTable(MPI_Comm comm, Superelement *s)
{
  Csv         csv = {.stream = NULL};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  s->n = 0;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(SuperelementReadFile(&csv, s));
  PetscCallMPI(MPI_Bcast(csv.fault, sizeof(csv.fault), MPI_CHAR, 0, comm));
  PetscCheck(!csv.fault[0], comm, PETSC_ERR_FILE_UNEXPECTED, "cannot read '%s' of -%s_table: %s", s->table, s->name,
             csv.fault);
  PetscCallMPI(MPI_Bcast(&s->n, 1, MPIU_INT, 0, comm));
  if (rank) PetscCall(PetscMalloc1(s->n, &s->row));
  for (PetscInt i = 0; i < s->n; i += 1000000) /* the count of bytes is an int */
    PetscCallMPI(
      MPI_Bcast(&s->row[i], (PetscMPIInt)(sizeof(*s->row) * (size_t)PetscMin(1000000, s->n - i)), MPI_BYTE, 0, comm));
  s->n_apart = 0;
  for (PetscInt i = 0; i < s->n; i++) s->n_apart += s->row[i].direction == SUPERELEMENT_APART;
  PetscFunctionReturn(0);
}
