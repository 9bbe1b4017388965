/*
   Linear equations between displacements, -model_equations FILE: constraints of other programs that no point and no tie
   says. A table

      equation,x_m,y_m,z_m,direction,coefficient[,part]

   whose lines with the same number, one after the other, are an equation sum_i a_i u_i = 0 between displacements u_i
   of nodes, which are known by their places and, where nodes of two parts stand in one place, by their part; direction
   is 1 to 3 along x, y, z. The displacement of the first line follows the others,

      u_1 = -(1 / a_1) sum_{i > 1} a_i u_i,

   as those of ties do (dependents.c). It may follow in one equation only, and not be held; what follows may be followed
   in turn, but not in a circle. Others that are held are 0.
*/
#include "dependents.h"
#include "nodesbyx.h"
#include "base/csv.h"
#include <stdlib.h>
#include <string.h>

#define EQUATION_NEAR  1e-6 /* of the size of the mesh: how near a line must be to its node */
#define EQUATION_CHUNK 1000000
#define EQUATION_WEAK  1e-9 /* of another coefficient: what follows would be rounding */
#define NOT_FOUND      PETSC_MIN_INT

enum { EQUATION_NUMBER, EQUATION_X, EQUATION_DIRECTION = 4, EQUATION_COEFFICIENT, EQUATION_PART, N_EQUATION_COLUMNS };

static const char *const equation_columns[N_EQUATION_COLUMNS] = {"equation",  "x_m",         "y_m", "z_m",
                                                                 "direction", "coefficient", "part"};

/* A line, on all ranks */
typedef struct {
  PetscInt  equation, direction, part; /* part: index, -1 for any */
  PetscReal x[3], coefficient;
} EquationLine;

/* Index of the part that a line names, -1 for none; a fault where there is no such part */
static PetscInt EquationPart(Csv *csv, const Mesh *mesh)
{
  const char *word = CsvWord(csv, EQUATION_PART);

  if (!word || !word[0]) return -1;
  for (PetscInt i = 0; i < mesh->n_parts; i++)
    if (!strcmp(mesh->part[i], word)) return i;
  if (!csv->fault[0])
    (void)snprintf(csv->fault, sizeof(csv->fault), "line %d: '%.100s' is none of -parts", (int)csv->line, word);
  return -1;
}

static void EquationRead(Csv *csv, const Mesh *mesh, EquationLine *line)
{
  line->equation  = (PetscInt)CsvReal(csv, EQUATION_NUMBER, PETSC_TRUE);
  line->direction = (PetscInt)CsvReal(csv, EQUATION_DIRECTION, PETSC_TRUE) - 1;
  for (int d = 0; d < 3; d++) line->x[d] = CsvReal(csv, EQUATION_X + d, PETSC_FALSE);
  line->coefficient = CsvReal(csv, EQUATION_COEFFICIENT, PETSC_FALSE);
  line->part        = EquationPart(csv, mesh);
  if (!csv->fault[0] && (line->direction < 0 || line->direction > 2))
    (void)snprintf(csv->fault, sizeof(csv->fault), "line %d: direction %d must be 1, 2 or 3 (x, y, z)", (int)csv->line,
                   (int)line->direction + 1);
}

/* A fault where an equation begins with next to nothing or stands in two places. A single line holds it: u_1 = 0 */
static void EquationsCheckLines(Csv *csv, PetscInt n, const EquationLine line[])
{
  PetscReal lead = 0;

  for (PetscInt i = 0; i < n && !csv->fault[0]; i++) {
    const PetscBool first = i == 0 || line[i].equation != line[i - 1].equation ? PETSC_TRUE : PETSC_FALSE;

    if (first) lead = PetscAbsReal(line[i].coefficient);
    if (lead < EQUATION_WEAK * PetscAbsReal(line[i].coefficient))
      (void)snprintf(csv->fault, sizeof(csv->fault),
                     "equation %d: the coefficient of its first line, which follows, is %.3g beside %.3g: begin with "
                     "the largest",
                     (int)line[i].equation, (double)lead, (double)line[i].coefficient);
    if (first && line[i].coefficient == 0)
      (void)snprintf(csv->fault, sizeof(csv->fault),
                     "equation %d: the coefficient of its first line, which follows, is 0", (int)line[i].equation);
    if (first && i > 0 && line[i].equation < line[i - 1].equation)
      (void)snprintf(csv->fault, sizeof(csv->fault), "equation %d after %d: their numbers must rise",
                     (int)line[i].equation, (int)line[i - 1].equation);
  }
  if (!n && !csv->fault[0]) (void)snprintf(csv->fault, sizeof(csv->fault), "it has no equation");
}

/* All lines, on the rank that calls */
static PetscErrorCode EquationsReadFile(Csv *csv, const char file[], const Mesh *mesh, PetscInt *n, EquationLine **line)
{
  PetscInt room = 0;

  PetscFunctionBeginUser;
  CsvOpen(csv, file, N_EQUATION_COLUMNS, equation_columns, EQUATION_PART);
  while (CsvNext(csv)) {
    if (*n == room) {
      room = PetscMax(1024, 2 * room);
      PetscCall(PetscRealloc((size_t)room * sizeof(EquationLine), line));
    }
    EquationRead(csv, mesh, &(*line)[(*n)++]);
  }
  CsvClose(csv);
  if (!csv->fault[0]) EquationsCheckLines(csv, *n, *line);
  PetscFunctionReturn(0);
}

static PetscErrorCode EquationsRead(MPI_Comm comm, const char file[], const Mesh *mesh, PetscInt *n,
                                    EquationLine **line)
{
  Csv         csv = {.stream = NULL};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *n    = 0;
  *line = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(EquationsReadFile(&csv, file, mesh, n, line));
  PetscCallMPI(MPI_Bcast(csv.fault, sizeof(csv.fault), MPI_CHAR, 0, comm));
  PetscCheck(!csv.fault[0], comm, PETSC_ERR_FILE_UNEXPECTED, "cannot read '%s' of -model_equations: %s", file,
             csv.fault);
  PetscCallMPI(MPI_Bcast(n, 1, MPIU_INT, 0, comm));
  if (rank) PetscCall(PetscMalloc1(*n, line));
  for (PetscInt i = 0; i < *n; i += EQUATION_CHUNK)
    PetscCallMPI(MPI_Bcast(&(*line)[i], (PetscMPIInt)(sizeof(EquationLine) * (size_t)PetscMin(EQUATION_CHUNK, *n - i)),
                           MPI_BYTE, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshSize(MPI_Comm comm, const Mesh *mesh, PetscReal *size)
{
  PetscReal most[6] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL,
                       -PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    most[i % 3]     = PetscMax(most[i % 3], mesh->x[i]);
    most[3 + i % 3] = PetscMax(most[3 + i % 3], -mesh->x[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 6, MPIU_REAL, MPI_MAX, comm));
  *size = PetscMax(most[0] + most[3], PetscMax(most[1] + most[4], most[2] + most[5]));
  PetscFunctionReturn(0);
}

/* [n_parts][n_nodes] which nodes this rank's cells of each part have */
static PetscErrorCode NodesMarkParts(const Mesh *mesh, PetscBool **on)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_parts * mesh->n_nodes, on));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1]; i++)
      (*on)[mesh->cell_part[c] * mesh->n_nodes + mesh->cell_node[i]] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

typedef struct {
  NodesByX   nodes;
  PetscBool *on;   /* [n_parts][n_nodes] which nodes each part has */
  PetscReal  near; /* m */
} NodeSearch;

/* The node of a line among those of this rank, and others near it: the largest number, the largest of their negative,
   and its unknown, -1 where it is held */
static void EquationFindNode(const NodeSearch *s, const EquationLine *line, PetscInt found[4])
{
  const Mesh *mesh = s->nodes.mesh;

  for (PetscInt i = NodesByXBegin(&s->nodes, line->x[0] - s->near);
       i < mesh->n_nodes && s->nodes.x[i] <= line->x[0] + s->near; i++) {
    const PetscInt   v    = s->nodes.order[i];
    const PetscReal *at   = &mesh->x[3 * v];
    const PetscReal  away = PetscMax(PetscAbsReal(at[1] - line->x[1]), PetscAbsReal(at[2] - line->x[2]));

    if (away > s->near || (line->part >= 0 && !s->on[line->part * mesh->n_nodes + v])) continue;
    found[0] = PetscMax(found[0], mesh->number[v]);
    found[1] = PetscMax(found[1], -mesh->number[v]);
    found[2] = mesh->unknown[3 * v + line->direction];
    if (mesh->prescribed && mesh->prescribed[3 * v + line->direction] != 0) found[3] = 1;
  }
}

/* Raises the error for a line at no node, at several or at one that a motion moves, and for the first one where it is
   held */
static PetscErrorCode EquationCheckNode(MPI_Comm comm, const char file[], const EquationLine *line, PetscBool first,
                                        const PetscInt found[4])
{
  const PetscReal *x = line->x;

  PetscFunctionBeginUser;
  PetscCheck(found[0] >= 0, comm, PETSC_ERR_USER_INPUT,
             "-model_equations %s: equation %" PetscInt_FMT " has a line at %.9g, %.9g, %.9g m, where no node%s is",
             file, line->equation, (double)x[0], (double)x[1], (double)x[2], line->part >= 0 ? " of its part" : "");
  PetscCheck(found[0] == -found[1], comm, PETSC_ERR_USER_INPUT,
             "-model_equations %s: equation %" PetscInt_FMT
             " has a line at %.9g, %.9g, %.9g m, where several nodes are: name its part, or give more digits",
             file, line->equation, (double)x[0], (double)x[1], (double)x[2]);
  PetscCheck(found[3] != 1, comm, PETSC_ERR_SUP,
             "-model_equations %s: equation %" PetscInt_FMT
             " has the node at %.9g, %.9g, %.9g m, which a motion moves: that is not supported",
             file, line->equation, (double)x[0], (double)x[1], (double)x[2]);
  PetscCheck(!first || found[2] >= 0, comm, PETSC_ERR_USER_INPUT,
             "-model_equations %s: equation %" PetscInt_FMT
             " begins at %.9g, %.9g, %.9g m, which a support holds in this direction: begin with one that is free",
             file, line->equation, (double)x[0], (double)x[1], (double)x[2]);
  PetscFunctionReturn(0);
}

/* Raises the error for an equation whose first displacement stands in it again: others that do are added up */
static PetscErrorCode EquationsCheckFirst(MPI_Comm comm, const char file[], PetscInt n, const EquationLine line[],
                                          const PetscInt found[])
{
  PetscInt first = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 1; i < n; i++) {
    if (line[i].equation != line[i - 1].equation) first = i;
    PetscCheck(i == first || found[4 * i + 2] != found[4 * first + 2], comm, PETSC_ERR_USER_INPUT,
               "-model_equations %s: equation %" PetscInt_FMT
               " names the displacement of its first line twice, direction %" PetscInt_FMT
               " at %.9g, %.9g, %.9g m: give it once, with the sum of its coefficients",
               file, line[i].equation, line[i].direction + 1, (double)line[i].x[0], (double)line[i].x[1],
               (double)line[i].x[2]);
  }
  PetscFunctionReturn(0);
}

/* The unknown of each line, on all ranks: found[4 i + 2] */
static PetscErrorCode EquationsFind(MPI_Comm comm, const char file[], const Mesh *mesh, PetscInt n,
                                    const EquationLine line[], PetscInt found[])
{
  NodeSearch s;

  PetscFunctionBeginUser;
  PetscCall(MeshSize(comm, mesh, &s.near));
  s.near *= EQUATION_NEAR;
  PetscCall(NodesMarkParts(mesh, &s.on));
  PetscCall(NodesByXCreate(mesh, &s.nodes));
  for (PetscInt i = 0; i < 4 * n; i++) found[i] = NOT_FOUND;
  for (PetscInt i = 0; i < n; i++) EquationFindNode(&s, &line[i], &found[4 * i]);
  for (PetscInt i = 0; i < 4 * n; i += EQUATION_CHUNK)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found[i], (PetscMPIInt)PetscMin(EQUATION_CHUNK, 4 * n - i), MPIU_INT,
                               MPI_MAX, comm));
  for (PetscInt i = 0; i < n; i++)
    PetscCall(
      EquationCheckNode(comm, file, &line[i], i == 0 || line[i].equation != line[i - 1].equation, &found[4 * i]));
  PetscCall(EquationsCheckFirst(comm, file, n, line, found));
  PetscCall(NodesByXDestroy(&s.nodes));
  PetscCall(PetscFree(s.on));
  PetscFunctionReturn(0);
}

PetscErrorCode EquationsCreate(Operators o, Equations *e)
{
  const ModelScene *scene;
  const Mesh       *mesh;
  EquationLine     *line;
  PetscInt          n, *found;

  PetscFunctionBeginUser;
  *e = (Equations){0};
  PetscCall(ModelGetScene(o->model, &scene));
  if (!scene->equations[0]) PetscFunctionReturn(0);
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(EquationsRead(o->comm, scene->equations, mesh, &n, &line));
  PetscCall(PetscMalloc1(4 * n, &found));
  PetscCall(EquationsFind(o->comm, scene->equations, mesh, n, line, found));
  PetscCall(PetscMalloc3(n + 1, &e->first, n, &e->unknown, n, &e->share));
  for (PetscInt i = 0; i < n; i++) {
    if (i == 0 || line[i].equation != line[i - 1].equation) e->first[e->n++] = i;
    e->unknown[i] = found[4 * i + 2];
    e->share[i]   = -line[i].coefficient / line[e->first[e->n - 1]].coefficient;
  }
  e->first[e->n] = n;
  PetscCall(PetscFree(found));
  PetscCall(PetscFree(line));
  PetscFunctionReturn(0);
}

PetscErrorCode EquationsDestroy(Equations *e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(e->first, e->unknown, e->share));
  PetscFunctionReturn(0);
}

PetscErrorCode EquationsAddRows(const Equations *e, PetscInt by, Dependents *d)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < e->n; i++) {
    const PetscInt first = e->first[i];

    PetscCall(DependentsClaim(d, e->unknown[first], by));
    PetscCall(DependentsFollow(d, e->unknown[first], e->first[i + 1] - first - 1, &e->unknown[first + 1],
                               &e->share[first + 1]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCheckSpinningEquations(Operators o, PetscInt part)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCheck(!scene->equations[0], o->comm, PETSC_ERR_SUP,
             "-model_equations is not supported with a part that spins (%s): take -%s_spin away",
             scene->parts[part].name, scene->parts[part].name);
  PetscFunctionReturn(0);
}
