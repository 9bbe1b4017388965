/*
   The topography of an interface, -contact_gap: the gap g0 (m, positive open) of each pair before anything is loaded,
   in the place of n . (x_s - x_m) of the mesh, as a measured surface has it, or a worn one. A table

      x_m,y_m,z_m,gap_m[,interface]

   with a line for each slave node that has a pair, in any order; lines of other interfaces are left out. The table
   gap.csv of statics is one. Nodes are known by their places, to GAPS_NEAR of the size of the contact, so that neither
   numbers nor ranks matter.
*/
#include "topography.h"
#include "base/csv.h"
#include <stdlib.h>
#include <string.h>

#define GAPS_NEAR  1e-4
#define GAPS_LEAST 1e-4    /* mm: gaps that are all smaller, 0.1 um, are in m */
#define GAPS_CHUNK 1000000 /* rows that are sent at once: the count of bytes is an int */

enum { GAPS_X, GAPS_GAP = 3, GAPS_INTERFACE, N_GAPS };

static const char *const columns[N_GAPS] = {"x_m", "y_m", "z_m", "gap_m", "interface"};

/* All lines of the interface, on the rank that calls */
static PetscErrorCode GapsReadFile(Csv *csv, ContactInterface *c)
{
  PetscInt room = 0;

  PetscFunctionBeginUser;
  CsvOpen(csv, c->gap_file, N_GAPS, columns, GAPS_INTERFACE);
  while (CsvNext(csv)) {
    const char     *name = CsvWord(csv, GAPS_INTERFACE);
    ContactGapLine *row;

    if (name && strcmp(name, c->name)) continue;
    if (c->n_gaps == room) {
      room = PetscMax(1024, 2 * room);
      PetscCall(PetscRealloc((size_t)room * sizeof(ContactGapLine), &c->gaps));
    }
    row = &c->gaps[c->n_gaps++];
    for (int d = 0; d < 3; d++) row->x[d] = CsvReal(csv, GAPS_X + d, PETSC_FALSE);
    row->gap = CsvReal(csv, GAPS_GAP, PETSC_FALSE);
  }
  CsvClose(csv);
  if (!c->n_gaps && !csv->fault[0])
    (void)snprintf(csv->fault, sizeof(csv->fault), "it has no line of contact %.100s", c->name);
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGapsRead(MPI_Comm comm, ContactInterface *c)
{
  Csv         csv = {.stream = NULL};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!c->gap_file[0]) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(GapsReadFile(&csv, c));
  PetscCallMPI(MPI_Bcast(csv.fault, sizeof(csv.fault), MPI_CHAR, 0, comm));
  PetscCheck(!csv.fault[0], comm, PETSC_ERR_FILE_UNEXPECTED, "cannot read '%s' of -%s_gap: %s", c->gap_file, c->name,
             csv.fault);
  PetscCallMPI(MPI_Bcast(&c->n_gaps, 1, MPIU_INT, 0, comm));
  if (rank) PetscCall(PetscMalloc1(c->n_gaps, &c->gaps));
  for (PetscInt i = 0; i < c->n_gaps; i += GAPS_CHUNK)
    PetscCallMPI(MPI_Bcast(&c->gaps[i],
                           (PetscMPIInt)(sizeof(ContactGapLine) * (size_t)PetscMin(GAPS_CHUNK, c->n_gaps - i)),
                           MPI_BYTE, 0, comm));
  PetscFunctionReturn(0);
}

/* By x, y and z, so that the order tells nothing of the file's */
static int GapsCompare(const void *left, const void *right)
{
  const ContactGapLine *a = left, *b = right;

  for (int d = 0; d < 3; d++)
    if (a->x[d] != b->x[d]) return a->x[d] < b->x[d] ? -1 : 1;
  return (a->gap > b->gap) - (a->gap < b->gap);
}

/* How near a line must be to its node: by the longest side of the box of all lines */
static PetscReal GapsNear(const ContactInterface *c)
{
  PetscReal longest = 0;

  for (int d = 0; d < 3; d++) {
    PetscReal least = c->gaps[0].x[d], most = least;

    for (PetscInt i = 1; i < c->n_gaps; i++) {
      least = PetscMin(least, c->gaps[i].x[d]);
      most  = PetscMax(most, c->gaps[i].x[d]);
    }
    longest = PetscMax(longest, most - least);
  }
  return GAPS_NEAR * longest;
}

/* The line nearest to a place, -1 where none is near: from the first one that may be, by bisection in x */
static PetscInt GapsFind(const ContactInterface *c, PetscReal near, const PetscReal x[3])
{
  PetscInt  begin = 0, end = c->n_gaps, found = -1;
  PetscReal least = PetscSqr(near);

  while (begin < end) {
    const PetscInt middle = begin + (end - begin) / 2;

    if (c->gaps[middle].x[0] < x[0] - near)
      begin = middle + 1;
    else
      end = middle;
  }
  for (PetscInt i = begin; i < c->n_gaps && c->gaps[i].x[0] <= x[0] + near; i++) {
    const PetscReal *at     = c->gaps[i].x;
    const PetscReal  square = PetscSqr(at[0] - x[0]) + PetscSqr(at[1] - x[1]) + PetscSqr(at[2] - x[2]);

    if (square > least) continue;
    least = square;
    found = i;
  }
  return found;
}

/* Raises the error for nodes without a line, `without` over all ranks, x of one of them */
static PetscErrorCode GapsCheckNodes(Contact contact, const ContactInterface *c, PetscInt without, PetscReal x[3])
{
  PetscReal any = without ? 1 : 0;

  PetscFunctionBeginUser;
  PetscCall(ContactShareWorst(contact->comm, &any, x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &without, 1, MPIU_INT, MPI_SUM, contact->comm));
  PetscCheck(!without, contact->comm, PETSC_ERR_USER_INPUT,
             "-%s_gap %s has no line for %" PetscInt_FMT
             " slave nodes that have a pair, such as that at %.9g, %.9g, %.9g m; gap.csv of -analysis static has all",
             c->name, c->gap_file, without, (double)x[0], (double)x[1], (double)x[2]);
  PetscFunctionReturn(0);
}

/* Raises the error for a line that no node has, or more than one; used is over all ranks */
static PetscErrorCode GapsCheckLines(Contact contact, const ContactInterface *c, const PetscInt used[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n_gaps; i++) {
    const PetscReal *x = c->gaps[i].x;

    PetscCheck(used[i], contact->comm, PETSC_ERR_USER_INPUT,
               "-%s_gap %s: the line at %.9g, %.9g, %.9g m is at no slave node that has a pair, or stands twice",
               c->name, c->gap_file, (double)x[0], (double)x[1], (double)x[2]);
    PetscCheck(used[i] == 1, contact->comm, PETSC_ERR_USER_INPUT,
               "-%s_gap %s: the line at %.9g, %.9g, %.9g m is near %" PetscInt_FMT
               " slave nodes; give places with more digits",
               c->name, c->gap_file, (double)x[0], (double)x[1], (double)x[2], used[i]);
  }
  PetscFunctionReturn(0);
}

/* Warns of a length that is in m where the scene is in mm */
static PetscErrorCode LengthWarn(Contact contact, const char option[], PetscReal length)
{
  const char *unit;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(contact->model, "m", &unit));
  if (strcmp(unit, "mm") || length == 0 || length >= GAPS_LEAST) PetscFunctionReturn(0);
  PetscCall(PetscFPrintf(contact->comm, stderr,
                         "squeal: warning: -%s: %.3g mm at most, of a scene in mm: is it in m?\n", option,
                         (double)length));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactLengthsWarn(Contact contact)
{
  PetscBool wears = PETSC_FALSE;
  char      option[256];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const ContactInterface *c    = &contact->interfaces[i];
    PetscReal               most = 0;

    for (PetscInt k = 0; k < c->n_gaps; k++) most = PetscMax(most, PetscAbsReal(c->gaps[k].gap));
    PetscCall(PetscSNPrintf(option, sizeof(option), "%s_gap", c->name));
    PetscCall(LengthWarn(contact, option, most));
    if (ContactWears(c)) wears = PETSC_TRUE;
  }
  if (wears) PetscCall(LengthWarn(contact, "wear_depth", contact->wear.depth));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGapsSet(Contact contact, PetscInt interface)
{
  ContactInterface *c       = &contact->interfaces[interface];
  PetscInt          without = 0, *used;
  PetscReal         near, x[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  if (!c->n_gaps) PetscFunctionReturn(0);
  qsort(c->gaps, (size_t)c->n_gaps, sizeof(ContactGapLine), GapsCompare);
  near = GapsNear(c);
  PetscCall(PetscCalloc1(c->n_gaps, &used));
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    ContactPair   *pair = &contact->pairs[p];
    const PetscInt i    = pair->interface == interface ? GapsFind(c, near, pair->x) : -1;

    if (pair->interface != interface) continue;
    if (i < 0 && !without++) PetscCall(PetscArraycpy(x, pair->x, 3));
    if (i < 0) continue;
    used[i]++;
    pair->gap = c->gaps[i].gap;
  }
  PetscCall(GapsCheckNodes(contact, c, without, x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, used, (PetscMPIInt)c->n_gaps, MPIU_INT, MPI_SUM, contact->comm));
  PetscCall(GapsCheckLines(contact, c, used));
  PetscCall(PetscFree(used));
  PetscFunctionReturn(0);
}
