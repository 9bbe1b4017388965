/*
   What a restart needs so that the next steps are bitwise those of a run that goes on: base, frames, columns kept.
   The matrices themselves follow from these and W by the same operations. As numbers: m; index[m]; frame of each pair
   (4 reals: e[2], mu, c); indices whose columns are kept, in the order they were made. 0 numbers: no base. Where a
   law in series is not linear, the closings at which its lines were laid come first [n]; then, where iterations count
   from a whole product, its forces and what they move [3 n] each, and 1, or else 0. Where W is a map, the
   directions that have springs [3 n], the iterations that tell when these are set anew, and the statuses [n]. */
#include "complianceimpl.h"

/* A whole number of least to below - 1 */
static PetscErrorCode MemoryWhole(const char what[], PetscReal value, PetscInt least, PetscInt below, PetscInt *whole)
{
  PetscFunctionBeginUser;
  PetscCheck(value >= (PetscReal)least && value < (PetscReal)below && value == PetscFloorReal(value), PETSC_COMM_SELF,
             PETSC_ERR_FILE_UNEXPECTED,
             "Memory of contact on a compliance: %s %g is not a whole number of %" PetscInt_FMT " to %" PetscInt_FMT,
             what, (double)value, least, below - 1);
  *whole = (PetscInt)value;
  PetscFunctionReturn(0);
}

/* n numbers, as they came */
static PetscErrorCode MemoryCheckLength(const ContactCompliance c, PetscInt n, PetscBool good)
{
  PetscFunctionBeginUser;
  PetscCheck(good, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "Memory of contact on a compliance: %" PetscInt_FMT " numbers are not those of %" PetscInt_FMT " pairs", n,
             c->n);
  PetscFunctionReturn(0);
}

static PetscErrorCode MapGetMemory(const ContactCompliance c, PetscInt *n, PetscReal **values)
{
  PetscReal *to;

  PetscFunctionBeginUser;
  *n = c->krylov.stands ? 4 * c->n + 2 : 0;
  PetscCall(PetscMalloc1(*n, values));
  to = *values;
  if (!*n) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < 3 * c->n; i++) *to++ = (PetscReal)c->krylov.held[i];
  *to++ = (PetscReal)c->krylov.n_more;
  *to++ = (PetscReal)c->krylov.n_first;
  for (PetscInt p = 0; p < c->n; p++) *to++ = (PetscReal)c->status[p];
  PetscFunctionReturn(0);
}

static PetscErrorCode MapSetMemory(ContactCompliance c, PetscInt n, const PetscReal values[])
{
  PetscBool *held;

  PetscFunctionBeginUser;
  c->krylov.stands = PETSC_FALSE;
  if (!n) PetscFunctionReturn(0);
  PetscCall(MemoryCheckLength(c, n, n == 4 * c->n + 2 ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(PetscMalloc1(3 * c->n, &held));
  for (PetscInt i = 0; i < 3 * c->n; i++) held[i] = values[i] != 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ComplianceKrylovHold(c, held));
  c->krylov.n_more  = (PetscInt)values[3 * c->n];
  c->krylov.n_first = (PetscInt)values[3 * c->n + 1];
  for (PetscInt p = 0; p < c->n; p++) {
    PetscInt status;

    PetscCall(MemoryWhole("status", values[3 * c->n + 2 + p], 0, CONTACT_N_STATUS, &status));
    c->status[p] = (ContactStatus)status;
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(0);
}

/* 6 n + 1 numbers, zeros where there is no whole product */
static PetscErrorCode NearGetMemory(const ContactCompliance c, PetscReal to[])
{
  const ComplianceNear *s = &c->near;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(to, 6 * c->n + 1));
  to[6 * c->n] = (PetscReal)s->stands;
  if (!s->stands) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(to, s->from, 3 * c->n));
  PetscCall(PetscArraycpy(&to[3 * c->n], s->moved, 3 * c->n));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceGetMemory(ContactCompliance c, PetscInt *n, PetscReal **values)
{
  const ComplianceChord *h       = &c->chord;
  const PetscInt         n_lines = c->springs.laid ? c->n : 0, n_near = ComplianceNearServes(c) ? 6 * c->n + 1 : 0;
  PetscReal             *to;

  PetscFunctionBeginUser;
  if (ComplianceIsMap(c)) {
    PetscCall(MapGetMemory(c, n, values));
    PetscFunctionReturn(0);
  }
  *n = n_lines + n_near + (h->exists ? 1 + h->m + 4 * c->n + h->n_columns : 0);
  PetscCall(PetscMalloc1(*n, values));
  to = *values;
  PetscCall(PetscArraycpy(to, c->springs.at, n_lines));
  to += n_lines;
  if (n_near) PetscCall(NearGetMemory(c, to));
  to += n_near;
  if (*n == n_lines + n_near) PetscFunctionReturn(0);
  *to++ = (PetscReal)h->m;
  for (PetscInt i = 0; i < h->m; i++) *to++ = (PetscReal)h->index[i];
  PetscCall(PetscArraycpy(to, (const PetscReal *)h->frame, 4 * c->n));
  to += 4 * c->n;
  for (PetscInt i = 0; i < 4 * c->n; i++)
    if (h->column[i] >= 0) to[h->column[i]] = (PetscReal)i;
  PetscFunctionReturn(0);
}

/* Base, frames and columns, n numbers of the n_all that came. Indices are whole numbers below 4 n, which a PetscReal
   holds exactly, and ascend in the base */
static PetscErrorCode ChordSetMemory(ContactCompliance c, PetscInt n_all, PetscInt n, const PetscReal values[])
{
  ComplianceChord *h = &c->chord;
  PetscInt         m, n_columns;
  PetscBool        room;

  PetscFunctionBeginUser;
  PetscCall(MemoryWhole("size of a base", *values++, 0, 3 * c->n + 1, &m));
  n_columns = n - 1 - m - 4 * c->n;
  PetscCall(MemoryCheckLength(c, n_all, n_columns >= 0 && n_columns <= 4 * c->n ? PETSC_TRUE : PETSC_FALSE));
  for (PetscInt i = 0; i < m; i++)
    PetscCall(MemoryWhole("index", *values++, i ? h->index[i - 1] + 1 : 0, 4 * c->n, &h->index[i]));
  h->m = m;
  PetscCall(PetscArraycpy((PetscReal *)h->frame, values, 4 * c->n));
  values += 4 * c->n;
  for (PetscInt k = 0; k < n_columns; k++) PetscCall(MemoryWhole("column", values[k], 0, 4 * c->n, &h->next[k]));
  PetscCall(ComplianceChordSetBase(c));
  if (h->exists) PetscCall(ComplianceChordColumns(c, n_columns, h->next, &room));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceSetMemory(ContactCompliance c, PetscInt n, const PetscReal values[])
{
  PetscInt left = n;

  PetscFunctionBeginUser;
  if (ComplianceIsMap(c)) {
    PetscCall(MapSetMemory(c, n, values));
    PetscFunctionReturn(0);
  }
  c->chord.exists = c->springs.laid = c->near.stands = PETSC_FALSE;
  if (left && c->springs.curved) {
    PetscCall(MemoryCheckLength(c, n, left >= c->n ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(ComplianceLayAt(c, values));
    values += c->n;
    left -= c->n;
  }
  if (left && ComplianceNearServes(c)) {
    PetscCall(MemoryCheckLength(c, n, left > 6 * c->n ? PETSC_TRUE : PETSC_FALSE));
    if (values[6 * c->n] != 0) PetscCall(ComplianceNearTake(c, values, &values[3 * c->n]));
    values += 6 * c->n + 1;
    left -= 6 * c->n + 1;
  }
  if (left) PetscCall(ChordSetMemory(c, n, left, values));
  PetscFunctionReturn(0);
}
