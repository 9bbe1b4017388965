/*
   The table of -operators_nodes: which displacement each unknown of matrices without a mesh is, a line an unknown,

      unknown,node,direction,x,y,z[,part]

   unknown from 1, direction 1 to 3 along x, y, z (others, such as rotations, have no shape), place of the node in m.
   Unknowns may be left out. Columns stand in any order; further ones are left unread.
*/
#include "nodetable.h"
#include "base/csv.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMN_UNKNOWN, COLUMN_NODE, COLUMN_DIRECTION, COLUMN_X, COLUMN_Y, COLUMN_Z, COLUMN_PART, N_COLUMNS };

static const char *const columns[N_COLUMNS] = {"unknown", "node", "direction", "x", "y", "z", "part"};

/* The file that is read on one rank */
typedef struct {
  Csv        csv;
  PetscInt   n_unknowns;
  PetscBool *seen; /* [n_unknowns] */
} NodeFile;

/* Index of the part that the line names, a new one where there is none of that name */
static PetscInt NodeFilePart(Csv *f, NodeTable *table)
{
  const char *word = CsvWord(f, COLUMN_PART), *name = word ? word : "nodes";

  for (PetscInt i = 0; i < table->n_parts; i++)
    if (!strcmp(table->part[i], name)) return i;
  if (table->n_parts == NODES_MAX_PARTS || strlen(name) >= NODES_MAX_NAME || !name[0]) {
    (void)snprintf(f->fault, sizeof(f->fault),
                   "line %d: part '%.40s' has no name, a long one, or is one of more than %d", (int)f->line, name,
                   NODES_MAX_PARTS);
    return 0;
  }
  (void)snprintf(table->part[table->n_parts], NODES_MAX_NAME, "%s", name);
  return table->n_parts++;
}

/* One line of the table */
static void NodeFileRow(NodeFile *file, NodeTable *table)
{
  Csv         *f       = &file->csv;
  const double unknown = CsvReal(f, COLUMN_UNKNOWN, PETSC_TRUE), node = CsvReal(f, COLUMN_NODE, PETSC_TRUE);
  const double direction = CsvReal(f, COLUMN_DIRECTION, PETSC_TRUE);
  NodeRow     *row       = &table->row[table->n];

  for (int d = 0; d < 3; d++) row->x[d] = CsvReal(f, COLUMN_X + d, PETSC_FALSE);
  row->part = NodeFilePart(f, table);
  if (f->fault[0]) return;
  if (unknown < 1 || unknown > (double)file->n_unknowns || fabs(node) > 2e9)
    (void)snprintf(f->fault, sizeof(f->fault), "line %d: unknown %.0f of node %.0f: the matrices have unknowns 1 to %d",
                   (int)f->line, unknown, node, (int)file->n_unknowns);
  else if (file->seen[(PetscInt)unknown - 1])
    (void)snprintf(f->fault, sizeof(f->fault), "line %d: unknown %.0f stands twice", (int)f->line, unknown);
  if (f->fault[0]) return;
  row->unknown             = (PetscInt)unknown - 1;
  row->node                = (PetscInt)node;
  row->direction           = direction >= 1 && direction <= 3 ? (PetscInt)direction : 0;
  file->seen[row->unknown] = PETSC_TRUE;
  table->n++;
}

/* By node, then direction */
static int RowCompare(const void *a, const void *b)
{
  const NodeRow *l = a, *r = b;

  if (l->node != r->node) return l->node < r->node ? -1 : 1;
  return (l->direction > r->direction) - (l->direction < r->direction);
}

/* Sorts, and looks for a node with two places and for a direction that stands twice */
static void NodeFileSort(Csv *f, NodeTable *table)
{
  if (table->n) qsort(table->row, (size_t)table->n, sizeof(*table->row), RowCompare);
  for (PetscInt i = 1; i < table->n && !f->fault[0]; i++) {
    const NodeRow *a = &table->row[i - 1], *b = &table->row[i];

    if (a->node != b->node) continue;
    if (a->direction == b->direction && a->direction)
      (void)snprintf(f->fault, sizeof(f->fault), "direction %d of node %d stands twice", (int)a->direction,
                     (int)a->node);
    else if (a->x[0] != b->x[0] || a->x[1] != b->x[1] || a->x[2] != b->x[2] || a->part != b->part)
      (void)snprintf(f->fault, sizeof(f->fault), "node %d has two places or parts", (int)a->node);
  }
  if (!table->n && !f->fault[0]) (void)snprintf(f->fault, sizeof(f->fault), "it has no nodes");
}

/* Reads all of it on the rank that calls */
static PetscErrorCode NodeFileRead(NodeFile *f, const char file[], NodeTable *table)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(f->n_unknowns, &f->seen));
  CsvOpen(&f->csv, file, N_COLUMNS, columns, COLUMN_PART);
  while (CsvNext(&f->csv)) NodeFileRow(f, table);
  if (f->csv.stream) NodeFileSort(&f->csv, table);
  CsvClose(&f->csv);
  PetscCall(PetscFree(f->seen));
  PetscFunctionReturn(0);
}

PetscErrorCode NodeTableRead(MPI_Comm comm, const char file[], PetscInt n_unknowns, NodeTable *table)
{
  NodeFile    f = {.n_unknowns = n_unknowns};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_unknowns + 1, &table->row));
  table->n = table->n_parts = 0;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(NodeFileRead(&f, file, table));
  PetscCallMPI(MPI_Bcast(f.csv.fault, sizeof(f.csv.fault), MPI_CHAR, 0, comm));
  PetscCheck(!f.csv.fault[0], comm, PETSC_ERR_FILE_UNEXPECTED, "cannot read '%s' of -operators_nodes: %s", file,
             f.csv.fault);
  PetscCallMPI(MPI_Bcast(&table->n, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(&table->n_parts, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(table->part, sizeof(table->part), MPI_CHAR, 0, comm));
  for (PetscInt i = 0; i < table->n; i += 1000000) /* the count of bytes is an int */
    PetscCallMPI(MPI_Bcast(&table->row[i], (PetscMPIInt)(sizeof(NodeRow) * (size_t)PetscMin(1000000, table->n - i)),
                           MPI_BYTE, 0, comm));
  PetscFunctionReturn(0);
}
