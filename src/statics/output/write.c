/*
   Tables and fields. static.csv and gap.csv have one row a pair, ordered by interface and position, so that they do not
   depend on the ranks.
*/
#include "statics/staticsimpl.h"
#include "base/gather.h"
#include "base/algebra/vec3.h"
#include <stdlib.h>

/* One row of the tables: topography is the gap of the unloaded surfaces, worn what slave and master have lost, m */
typedef struct {
  PetscInt     interface;
  PetscReal    x[3], t[3], n[3], area, pressure, stiffness, topography, worn[2];
  ContactState state;
} StaticsRecord;

/* By interface, then by z, y, x of the slave */
static int StaticsCompareRecords(const void *one, const void *other)
{
  const StaticsRecord *a = one, *b = other;

  if (a->interface != b->interface) return a->interface < b->interface ? -1 : 1;
  return Vec3ComparePlaces(a->x, b->x);
}

/* Pressures of the pairs of one interface on this rank, Pa: lambda_n over the pair's area, or on faces of second
   order, where that is no mean of the pressure, what all nodes of the slave surface have (pressure.c). Collective, also
   on ranks without pairs. */
static PetscErrorCode StaticsSetPressure(Statics s, PetscInt interface, StaticsRecord local[])
{
  const PairRows *rows = &s->rows;
  PetscBool       recovered;
  Vec             forces;

  PetscFunctionBeginUser;
  PetscCall(PressureCreateForces(s->model, &forces));
  for (PetscInt p = 0; p < rows->n_pairs; p++)
    if (rows->pair[p].interface == interface)
      PetscCall(VecSetValue(forces, rows->pair[p].vertex, s->state[p].lambda_n, INSERT_VALUES));
  PetscCall(VecAssemblyBegin(forces));
  PetscCall(VecAssemblyEnd(forces));
  PetscCall(PressureRecover(s->model, rows->interface[interface].slave, forces, &recovered));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    if (rows->pair[p].interface != interface) continue;
    local[p].pressure = s->state[p].lambda_n / rows->pair[p].area;
    if (recovered && !rows->pair[p].mean) PetscCall(VecGetValues(forces, 1, &rows->pair[p].vertex, &local[p].pressure));
  }
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(0);
}

static PetscErrorCode StaticsSetTopography(Statics s, PetscInt p, StaticsRecord *r)
{
  const PetscReal worn = s->worn[p];
  OperatorsWear   wear;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetPairWear(s->operators, s->p, &s->rows.pair[p], &wear));
  r->topography = s->rows.pair[p].gap + worn;
  r->worn[0]    = wear.share * worn;
  r->worn[1]    = worn - r->worn[0];
  PetscFunctionReturn(0);
}

/* Records of all ranks, in order, on every rank */
static PetscErrorCode StaticsGatherRecords(Statics s, PetscInt *n, StaticsRecord **all)
{
  const PairRows *rows = &s->rows;
  StaticsRecord  *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n_pairs, &local));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    local[p] = (StaticsRecord){.interface = rows->pair[p].interface, .area = rows->pair[p].area, .state = s->state[p]};
    local[p].stiffness = StaticsPairStiffness(s, p);
    PetscCall(PetscArraycpy(local[p].x, rows->pair[p].x, 3));
    PetscCall(PetscArraycpy(local[p].t, rows->pair[p].t, 3));
    PetscCall(PetscArraycpy(local[p].n, rows->pair[p].n, 3));
    PetscCall(StaticsSetTopography(s, p, &local[p]));
  }
  for (PetscInt i = 0; i < rows->n_interfaces; i++) PetscCall(StaticsSetPressure(s, i, local));
  PetscCall(GatherRecords(s->comm, rows->n_pairs, sizeof(StaticsRecord), local, n, all));
  if (*n) qsort(*all, (size_t)*n, sizeof(StaticsRecord), StaticsCompareRecords);
  PetscCall(PetscFree(local));
  PetscFunctionReturn(0);
}

/* static.csv */
static PetscErrorCode StaticsWritePairs(Statics s, PetscInt n, const StaticsRecord record[], Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "static",
                             "pair,x_m,y_m,z_m,gap_m,lambda_n_n,lambda_t_n,status,interface,lambda_b_n,area_m2,"
                             "pressure_pa,slip_t_m,slip_b_m,t_x,t_y,t_z,n_x,n_y,n_z,stiffness_n_m",
                             &table));
  for (PetscInt i = 0; i < n; i++) {
    const StaticsRecord *r = &record[i];
    const ContactState  *q = &r->state;

    PetscCall(ResultsTableRow(
      table,
      "%" PetscInt_FMT ",%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%s,%s,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,"
      "%.15g,%.15g,%.15g,%.15g",
      i + 1, (double)r->x[0], (double)r->x[1], (double)r->x[2], (double)q->gap, (double)q->lambda_n,
      (double)q->lambda_t[0], ContactStatusNames[q->status], s->rows.interface[r->interface].name,
      (double)q->lambda_t[1], (double)r->area, (double)r->pressure, (double)q->slip[0], (double)q->slip[1],
      (double)r->t[0], (double)r->t[1], (double)r->t[2], (double)r->n[0], (double)r->n[1], (double)r->n[2],
      (double)r->stiffness));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* gap.csv, the topography as -contact_gap reads it; of 17 digits, so that what reads it has the same numbers */
static PetscErrorCode StaticsWriteGaps(Statics s, PetscInt n, const StaticsRecord record[], Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "gap", "pair,x_m,y_m,z_m,gap_m,interface,worn_slave_m,worn_master_m", &table));
  for (PetscInt i = 0; i < n; i++) {
    const StaticsRecord *r = &record[i];

    PetscCall(ResultsTableRow(table, "%" PetscInt_FMT ",%.17g,%.17g,%.17g,%.17g,%s,%.15g,%.15g", i + 1, (double)r->x[0],
                              (double)r->x[1], (double)r->x[2], (double)r->topography,
                              s->rows.interface[r->interface].name, (double)r->worn[0], (double)r->worn[1]));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Residuals, for scene.yaml */
static PetscErrorCode StaticsNote(Statics s, Results results)
{
  ContactKKT kkt;
  PetscReal  equilibrium;
  char       text[256];

  PetscFunctionBeginUser;
  PetscCall(StaticsGetKKT(s, &kkt, &equilibrium));
  PetscCall(ContactPrintKKT(&kkt, sizeof(text), text));
  PetscCall(ResultsNote(results, "kkt", "%s", text));
  PetscCall(ResultsNote(results, "equilibrium", "%.1e", (double)equilibrium));
  PetscCall(ResultsNote(results, "iterations", "%" PetscInt_FMT, s->n_it));
  PetscCall(ResultsNote(results, "factorisations", "%" PetscInt_FMT, s->n_factored));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsWrite(Statics s, Results results)
{
  PetscInt       n;
  StaticsRecord *record;

  PetscFunctionBeginUser;
  PetscCall(StaticsNote(s, results));
  PetscCall(StaticsGatherRecords(s, &n, &record));
  PetscCall(StaticsWritePairs(s, n, record, results));
  PetscCall(StaticsWriteGaps(s, n, record, results));
  PetscCall(PetscFree(record));
  PetscCall(StaticsWriteReactions(s, results));
  PetscCall(StagesWrite(s, results));
  PetscCall(StaticsWriteWear(s, results));
  PetscCall(StaticsWriteFields(s, results));
  PetscFunctionReturn(0);
}
