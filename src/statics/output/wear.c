/*
   What wore: wear.csv with a row for each step and interface that wears, and gap.csv, the topography of all pairs in
   the form that -contact_gap reads: gaps of the unloaded surfaces as they are at the end, and what both sides have
   lost.
*/
#include "statics/staticsimpl.h"
#include "base/gather.h"
#include "base/algebra/vec3.h"
#include <stdlib.h>

/* One row of gap.csv */
typedef struct {
  PetscInt  interface;
  PetscReal x[3], gap, worn[2]; /* m */
} GapRecord;

/* By interface, then by z, y, x of the slave, as static.csv */
static int GapCompareRecords(const void *one, const void *other)
{
  const GapRecord *a = one, *b = other;

  if (a->interface != b->interface) return a->interface < b->interface ? -1 : 1;
  return Vec3ComparePlaces(a->x, b->x);
}

/* Records of all ranks, in order, on every rank */
static PetscErrorCode GapGatherRecords(Statics s, PetscInt *n, GapRecord **all)
{
  const PairRows *rows = &s->rows;
  GapRecord      *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n_pairs, &local));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const ContactPair *pair = &rows->pair[p];
    const PetscReal    worn = s->worn[p];
    OperatorsWear      wear;

    PetscCall(OperatorsGetPairWear(s->operators, s->p, pair, &wear));
    local[p] = (GapRecord){
      .interface = pair->interface, .gap = pair->gap + worn, .worn = {wear.share * worn, worn - wear.share * worn}};
    PetscCall(PetscArraycpy(local[p].x, pair->x, 3));
  }
  PetscCall(GatherRecords(s->comm, rows->n_pairs, sizeof(GapRecord), local, n, all));
  if (*n) qsort(*all, (size_t)*n, sizeof(GapRecord), GapCompareRecords);
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* gap.csv; of 17 digits, so that what reads it has the same numbers */
static PetscErrorCode GapWrite(Statics s, Results results)
{
  ResultsTable table;
  PetscInt     n;
  GapRecord   *record;

  PetscFunctionBeginUser;
  PetscCall(GapGatherRecords(s, &n, &record));
  PetscCall(ResultsTableOpen(results, "gap", "pair,x_m,y_m,z_m,gap_m,interface,worn_slave_m,worn_master_m", &table));
  for (PetscInt i = 0; i < n; i++) {
    const GapRecord *r = &record[i];

    PetscCall(ResultsTableRow(table, "%" PetscInt_FMT ",%.17g,%.17g,%.17g,%.17g,%s,%.15g,%.15g", i + 1, (double)r->x[0],
                              (double)r->x[1], (double)r->x[2], (double)r->gap, s->rows.interface[r->interface].name,
                              (double)r->worn[0], (double)r->worn[1]));
  }
  PetscCall(ResultsTableClose(&table));
  PetscCall(PetscFree(record));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsWriteWear(Statics s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(GapWrite(s, results));
  if (!s->n_wear) PetscFunctionReturn(0);
  PetscCall(ResultsTableOpen(results, "wear",
                             "step,time_s,interface,depth_m,volume_m3,friction_work_j,normal_force_n,pressure_pa,"
                             "pressure_change,n_closed",
                             &table));
  for (PetscInt i = 0; i < s->n_wear; i++) {
    const WearRow *r = &s->wear_row[i];

    PetscCall(ResultsTableRow(table, "%" PetscInt_FMT ",%.15g,%s,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%" PetscInt_FMT,
                              r->step, (double)r->time, s->rows.interface[r->interface].name, (double)r->depth,
                              (double)r->volume, (double)r->work, (double)r->force, (double)r->pressure,
                              (double)r->change, r->n_closed));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* The last step of each interface that wears */
PetscErrorCode StaticsViewWear(Statics s, PetscViewer viewer)
{
  const char *metre, *volume;

  PetscFunctionBeginUser;
  if (!s->n_wear) PetscFunctionReturn(0);
  PetscCall(ModelGetUnit(s->model, "m", &metre));
  PetscCall(ModelGetUnit(s->model, "m^3", &volume));
  for (PetscInt i = 0; i < s->n_wear; i++) {
    const WearRow *r = &s->wear_row[i];

    if (r->step != s->wear_row[s->n_wear - 1].step) continue;
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "contact %s has worn for %.6g s in %" PetscInt_FMT
                                     " steps: at most %.6g %s, %.6g %s by %.6g J of friction; its "
                                     "pressure changed by %.2g of the largest in the last one\n",
                                     s->rows.interface[r->interface].name, (double)r->time, r->step, (double)r->depth,
                                     metre, (double)r->volume, volume, (double)r->work, (double)r->change));
  }
  PetscFunctionReturn(0);
}
