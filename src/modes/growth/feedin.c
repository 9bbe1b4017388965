/*
   Where friction feeds a mode: its mean power at each pair, modes_feed_in.csv for unstable modes, and per area as a
   field of every mode in modes.h5.

   At the amplitude of modes.h5, x^H M x = 1 kg m^2 of displacements x in m, which does not change in a period:
   u = Re(x e^(i omega t)). Positive power feeds the mode. Over the pairs of a contact it adds up to power_w of
   modes_causes.csv, 2 E s: E the mean energy, J, s the share in the growth, 1/s.

   Error of the power at a pair, an estimate of first order: 2 P e, P the largest of all pairs, e the relative error of
   the vector (causes.c).
*/
#include "modes/modesimpl.h"
#include "base/algebra/vec3.h"
#include "base/gather.h"
#include <stdlib.h>

/* A pair and its power, W */
typedef struct {
  PetscInt  interface;
  PetscReal x[3], area, power[PENCIL_N_POWERS];
} FeedRecord;

/* By interface and place, as static.csv has them */
static int FeedCompare(const void *one, const void *other)
{
  const FeedRecord *a = one, *b = other;

  if (a->interface != b->interface) return a->interface < b->interface ? -1 : 1;
  return Vec3ComparePlaces(a->x, b->x);
}

/* The pairs of a scene in which friction has a share, else a NULL contact. Collective */
static PetscErrorCode FeedFindContact(Modes modes, Contact *contact)
{
  const PencilCause *cause;
  PetscInt           n;
  PetscBool          found = PETSC_FALSE;
  Operators          operators;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, NULL, contact));
  PetscCall(PencilGetCauses(modes->pencil, &n, &cause));
  for (PetscInt i = 0; i < n; i++)
    for (int k = 0; k < PENCIL_N_POWERS; k++)
      if (!strcmp(cause[i].kind, PencilPowerNames[k])) found = PETSC_TRUE;
  if (!found) *contact = NULL;
  PetscFunctionReturn(0);
}

/* power [local pairs][PENCIL_N_POWERS] of mode i, zero without a frequency */
static PetscErrorCode FeedMeasure(Modes modes, PetscInt i, PetscInt n, PetscReal power[])
{
  const Mode *m = &modes->mode[i];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(power, n * PENCIL_N_POWERS));
  if (m->omega > 0 && !m->rigid)
    PetscCall(
      PencilMeasurePairPowers(modes->pencil, m->sigma, m->omega, modes->right.xr[i], modes->right.xi[i], power));
  PetscFunctionReturn(0);
}

static PetscReal FeedSum(const PetscReal power[])
{
  PetscReal sum = 0;

  for (int k = 0; k < PENCIL_N_POWERS; k++) sum += power[k];
  return sum;
}

/* Rows of one mode: all pairs of all ranks */
static PetscErrorCode FeedWriteRows(Modes modes, Contact contact, PetscInt i, ResultsTable table)
{
  const ContactPair      *pair;
  const ContactInterface *interface;
  PetscInt                n, n_all;
  PetscReal              *power, largest = 0, error;
  FeedRecord             *local, *all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(contact, &n, &interface));
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  PetscCall(PetscMalloc2(n, &local, n * PENCIL_N_POWERS, &power));
  PetscCall(FeedMeasure(modes, i, n, power));
  for (PetscInt p = 0; p < n; p++) {
    local[p] = (FeedRecord){.interface = pair[p].interface, .area = pair[p].area};
    PetscCall(PetscArraycpy(local[p].x, pair[p].x, 3));
    PetscCall(PetscArraycpy(local[p].power, &power[p * PENCIL_N_POWERS], PENCIL_N_POWERS));
  }
  PetscCall(GatherRecords(modes->comm, n, sizeof(FeedRecord), local, &n_all, &all));
  qsort(all, (size_t)n_all, sizeof(FeedRecord), FeedCompare);
  for (PetscInt p = 0; p < n_all; p++) largest = PetscMax(largest, PetscAbsReal(FeedSum(all[p].power)));
  error = 2 * largest * ModeVectorError(modes, i);
  for (PetscInt p = 0; p < n_all; p++) {
    const FeedRecord *r = &all[p];

    PetscCall(ResultsTableRow(
      table, "%d,%d,%s,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.3g", (int)i + 1, (int)p + 1,
      interface[r->interface].name, (double)r->x[0], (double)r->x[1], (double)r->x[2], (double)r->area,
      (double)(r->power[PENCIL_FRICTION] + 0), (double)(r->power[PENCIL_FRICTION_DAMPING] + 0),
      (double)(r->power[PENCIL_FALLING_FRICTION] + 0), (double)(FeedSum(r->power) / r->area), (double)error));
  }
  PetscCall(PetscFree(all));
  PetscCall(PetscFree2(local, power));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWriteFeedIn(Modes modes, Results results)
{
  Contact      contact;
  PetscBool    unstable = PETSC_FALSE;
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(FeedFindContact(modes, &contact));
  for (PetscInt i = 0; i < modes->n; i++) unstable = unstable || modes->mode[i].unstable ? PETSC_TRUE : PETSC_FALSE;
  if (!contact || !unstable) PetscFunctionReturn(0);
  PetscCall(ResultsTableOpen(results, "modes_feed_in",
                             "mode,pair,contact,x_m,y_m,z_m,area_m2,friction_w,friction_damping_w,"
                             "falling_friction_w,power_w_m2,error_w",
                             &table));
  for (PetscInt i = 0; i < modes->n; i++)
    if (modes->mode[i].unstable) PetscCall(FeedWriteRows(modes, contact, i, table));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesCreateFeedIn(Modes modes, PetscInt i, const Mesh *mesh, PetscReal **density)
{
  const ContactPair *pair;
  PetscInt           n, n_all, *owned, n_owned = 0, first = 0;
  PetscReal         *power;
  Contact            contact;

  PetscFunctionBeginUser;
  *density = NULL;
  PetscCall(FeedFindContact(modes, &contact));
  if (!contact) PetscFunctionReturn(0);
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  PetscCall(PetscCalloc1(mesh->n_nodes, density));
  PetscCall(PetscMalloc2(mesh->n_nodes, &owned, n * PENCIL_N_POWERS, &power));
  for (PetscInt v = 0; v < mesh->n_nodes; v++)
    if (mesh->owned[v]) owned[n_owned++] = v;
  if (n_owned) first = mesh->number[owned[0]]; /* those of a rank have consecutive numbers */
  PetscCall(FeedMeasure(modes, i, n, power));
  for (PetscInt p = 0; p < n; p++)
    (*density)[owned[pair[p].vertex - first]] += FeedSum(&power[p * PENCIL_N_POWERS]) / pair[p].area;
  PetscCall(PetscFree2(owned, power));
  PetscFunctionReturn(0);
}
