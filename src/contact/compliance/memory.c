/*
   What a restart needs so that the next steps are bitwise those of a run that goes on: base, frames, columns kept.
   The matrices themselves follow from these and W by the same operations. As numbers: m; index[m]; frame of each pair
   (4 reals: e[2], mu, c); indices whose columns are kept, in the order they were made. 0 numbers: no base. Where a
   law in series is not linear, the closings at which its lines were laid come first [n]; then, where iterations count
   from a whole product, its forces and what they move [3 n] each, and 1, or else 0. Where W is a map, the
   directions that have springs [3 n], the iterations that tell when these are set anew, and the statuses [n]. */
#include "complianceimpl.h"

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
  PetscCheck(n == 4 * c->n + 2, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "Memory of contact on a compliance: %" PetscInt_FMT " numbers are not those of %" PetscInt_FMT " pairs", n,
             c->n);
  PetscCall(PetscMalloc1(3 * c->n, &held));
  for (PetscInt i = 0; i < 3 * c->n; i++) held[i] = values[i] != 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ComplianceKrylovHold(c, held));
  c->krylov.n_more  = (PetscInt)values[3 * c->n];
  c->krylov.n_first = (PetscInt)values[3 * c->n + 1];
  for (PetscInt p = 0; p < c->n; p++) c->status[p] = (ContactStatus)values[3 * c->n + 2 + p];
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

/* Indices are whole numbers below 4 n, which a PetscReal holds exactly */
PetscErrorCode ContactComplianceSetMemory(ContactCompliance c, PetscInt n, const PetscReal values[])
{
  ComplianceChord *h = &c->chord;
  PetscInt         n_columns;
  PetscBool        room;

  PetscFunctionBeginUser;
  if (ComplianceIsMap(c)) {
    PetscCall(MapSetMemory(c, n, values));
    PetscFunctionReturn(0);
  }
  h->exists       = PETSC_FALSE;
  c->springs.laid = c->near.stands = PETSC_FALSE;
  if (n && c->springs.curved) {
    PetscCheck(n >= c->n, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "Memory of contact on a compliance: %" PetscInt_FMT " numbers are not those of %" PetscInt_FMT " pairs",
               n, c->n);
    PetscCall(ComplianceLayAt(c, values));
    values += c->n;
    n -= c->n;
  }
  if (n && ComplianceNearServes(c)) {
    PetscCheck(n > 6 * c->n, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "Memory of contact on a compliance: %" PetscInt_FMT " numbers are not those of %" PetscInt_FMT " pairs",
               n, c->n);
    if (values[6 * c->n] != 0) PetscCall(ComplianceNearTake(c, values, &values[3 * c->n]));
    values += 6 * c->n + 1;
    n -= 6 * c->n + 1;
  }
  if (!n) PetscFunctionReturn(0);
  h->m      = (PetscInt)values[0];
  n_columns = n - 1 - h->m - 4 * c->n;
  PetscCheck(h->m >= 0 && h->m <= 3 * c->n && n_columns >= 0 && n_columns <= 4 * c->n, PETSC_COMM_SELF,
             PETSC_ERR_FILE_UNEXPECTED,
             "Memory of contact on a compliance: %" PetscInt_FMT " numbers are not those of %" PetscInt_FMT " pairs", n,
             c->n);
  values++;
  for (PetscInt i = 0; i < h->m; i++) h->index[i] = (PetscInt)*values++;
  PetscCall(PetscArraycpy((PetscReal *)h->frame, values, 4 * c->n));
  values += 4 * c->n;
  PetscCall(ComplianceChordSetBase(c));
  for (PetscInt k = 0; k < n_columns; k++) h->next[k] = (PetscInt)values[k];
  if (h->exists) PetscCall(ComplianceChordColumns(c, n_columns, h->next, &room));
  PetscFunctionReturn(0);
}
