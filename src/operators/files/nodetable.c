/*
   The table of -operators_nodes: which displacement each unknown of matrices without a mesh is, a line an unknown,

      unknown,node,direction,x,y,z[,part]

   unknown from 1, direction 1 to 3 along x, y, z (others, such as rotations, have no shape), place of the node in m.
   Unknowns may be left out. Columns stand in any order; further ones are left unread.
*/
#include "nodetable.h"
#include "base/file.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NODES_MAX_LINE    4096
#define NODES_MAX_COLUMNS 32
/* m: places beyond are none, and their squares overflow no sum */
#define NODES_LARGEST 1e30

enum { COLUMN_UNKNOWN, COLUMN_NODE, COLUMN_DIRECTION, COLUMN_X, COLUMN_Y, COLUMN_Z, COLUMN_PART, N_COLUMNS };

static const char *const columns[N_COLUMNS] = {"unknown", "node", "direction", "x", "y", "z", "part"};

/* The file that is read on one rank, and what is wrong with it */
typedef struct {
  FILE      *stream;
  PetscInt   line, n_columns, n_unknowns;
  int        at[N_COLUMNS]; /* place of each column, -1 for none */
  PetscBool *seen;          /* [n_unknowns] */
  char       fault[256];
} NodeFile;

/* The words of the next line, cut in place; their number, 0 at the end of the file */
static PetscInt NodeFileWords(NodeFile *f, char line[NODES_MAX_LINE], char *word[NODES_MAX_COLUMNS])
{
  PetscInt n = 0;

  if (!fgets(line, NODES_MAX_LINE, f->stream)) return 0;
  f->line++;
  line[strcspn(line, "\r\n")] = '\0';
  for (char *rest = line; rest && n < NODES_MAX_COLUMNS; n++) {
    word[n] = rest;
    rest    = strchr(rest, ',');
    if (rest) *rest++ = '\0';
    while (*word[n] == ' ') word[n]++;
    for (size_t k = strlen(word[n]); k && word[n][k - 1] == ' '; k--) word[n][k - 1] = '\0';
  }
  return n;
}

/* Where the columns are */
static void NodeFileHead(NodeFile *f)
{
  char line[NODES_MAX_LINE], *word[NODES_MAX_COLUMNS];

  f->n_columns = NodeFileWords(f, line, word);
  for (int c = 0; c < N_COLUMNS; c++) {
    f->at[c] = -1;
    for (PetscInt i = 0; i < f->n_columns; i++)
      if (!strcmp(word[i], columns[c])) f->at[c] = (int)i;
    if (f->at[c] < 0 && c != COLUMN_PART && !f->fault[0])
      (void)snprintf(f->fault, sizeof(f->fault),
                     "its first line has no column %s: it must have unknown,node,direction,x,y,z", columns[c]);
  }
}

/* A number of the present line */
static double NodeFileNumber(NodeFile *f, char *const word[], int column, PetscBool whole)
{
  const char  *text = word[f->at[column]];
  char        *end;
  const double value = strtod(text, &end);

  if (!f->fault[0] && (end == text || *end || !(fabs(value) <= NODES_LARGEST) || (whole && value != rint(value))))
    (void)snprintf(f->fault, sizeof(f->fault), "line %d: %s '%.40s' is no %snumber", (int)f->line, columns[column],
                   text, whole ? "whole " : "");
  return value;
}

/* Index of the part that the line names, a new one where there is none of that name */
static PetscInt NodeFilePart(NodeFile *f, char *const word[], NodeTable *table)
{
  const char *name = f->at[COLUMN_PART] < 0 ? "nodes" : word[f->at[COLUMN_PART]];

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
static void NodeFileRow(NodeFile *f, char *const word[], NodeTable *table)
{
  const double unknown   = NodeFileNumber(f, word, COLUMN_UNKNOWN, PETSC_TRUE),
               node      = NodeFileNumber(f, word, COLUMN_NODE, PETSC_TRUE);
  const double direction = NodeFileNumber(f, word, COLUMN_DIRECTION, PETSC_TRUE);
  NodeRow     *row       = &table->row[table->n];

  for (int d = 0; d < 3; d++) row->x[d] = NodeFileNumber(f, word, COLUMN_X + d, PETSC_FALSE);
  row->part = NodeFilePart(f, word, table);
  if (f->fault[0]) return;
  if (unknown < 1 || unknown > (double)f->n_unknowns || fabs(node) > 2e9)
    (void)snprintf(f->fault, sizeof(f->fault), "line %d: unknown %.0f of node %.0f: the matrices have unknowns 1 to %d",
                   (int)f->line, unknown, node, (int)f->n_unknowns);
  else if (f->seen[(PetscInt)unknown - 1])
    (void)snprintf(f->fault, sizeof(f->fault), "line %d: unknown %.0f stands twice", (int)f->line, unknown);
  if (f->fault[0]) return;
  row->unknown          = (PetscInt)unknown - 1;
  row->node             = (PetscInt)node;
  row->direction        = direction >= 1 && direction <= 3 ? (PetscInt)direction : 0;
  f->seen[row->unknown] = PETSC_TRUE;
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
static void NodeFileSort(NodeFile *f, NodeTable *table)
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
  char     line[NODES_MAX_LINE], *word[NODES_MAX_COLUMNS];
  PetscInt n;

  PetscFunctionBeginUser;
  f->stream = FileStream(file, "r");
  if (!f->stream) (void)snprintf(f->fault, sizeof(f->fault), "%s", FileReason(errno));
  if (!f->stream) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(f->n_unknowns, &f->seen));
  NodeFileHead(f);
  for (n = f->fault[0] ? 0 : NodeFileWords(f, line, word); n && !f->fault[0]; n = NodeFileWords(f, line, word)) {
    if (n == 1 && !word[0][0]) continue;
    if (n == f->n_columns)
      NodeFileRow(f, word, table);
    else
      (void)snprintf(f->fault, sizeof(f->fault), "line %d has %d columns, its first line %d", (int)f->line, (int)n,
                     (int)f->n_columns);
  }
  NodeFileSort(f, table);
  PetscCall(PetscFree(f->seen));
  (void)fclose(f->stream);
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
  PetscCallMPI(MPI_Bcast(f.fault, sizeof(f.fault), MPI_CHAR, 0, comm));
  PetscCheck(!f.fault[0], comm, PETSC_ERR_FILE_UNEXPECTED, "cannot read '%s' of -operators_nodes: %s", file, f.fault);
  PetscCallMPI(MPI_Bcast(&table->n, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(&table->n_parts, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(table->part, sizeof(table->part), MPI_CHAR, 0, comm));
  for (PetscInt i = 0; i < table->n; i += 1000000) /* the count of bytes is an int */
    PetscCallMPI(MPI_Bcast(&table->row[i], (PetscMPIInt)(sizeof(NodeRow) * (size_t)PetscMin(1000000, table->n - i)),
                           MPI_BYTE, 0, comm));
  PetscFunctionReturn(0);
}
