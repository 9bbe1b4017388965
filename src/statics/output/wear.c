/*
   What wore: wear.csv with a row for each step and interface that wears. The topography that is left is gap.csv
   (write.c).
*/
#include "statics/staticsimpl.h"

PetscErrorCode StaticsWriteWear(Statics s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  if (!s->n_wear) PetscFunctionReturn(0);
  PetscCall(ResultsTableOpen(results, "wear",
                             "step,time_s,interface,depth_m,depth_error_m,volume_m3,friction_work_j,normal_force_n,"
                             "pressure_pa,pressure_change,n_closed",
                             &table));
  for (PetscInt i = 0; i < s->n_wear; i++) {
    const WearRow *r = &s->wear_row[i];

    PetscCall(ResultsTableRow(
      table, "%" PetscInt_FMT ",%.15g,%s,%.15g,%.2g,%.15g,%.15g,%.15g,%.15g,%.15g,%" PetscInt_FMT, r->step,
      (double)r->time, s->rows.interface[r->interface].name, (double)r->depth, (double)r->error, (double)r->volume,
      (double)r->work, (double)r->force, (double)r->pressure, (double)r->change, r->n_closed));
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
                                     " steps: at most %.6g %s (error of the steps %.2g %s), %.6g %s by "
                                     "%.6g J of friction; in the last step a pressure changed by %.2g of the largest\n",
                                     s->rows.interface[r->interface].name, (double)r->time, r->step, (double)r->depth,
                                     metre, (double)r->error, metre, (double)r->volume, volume, (double)r->work,
                                     (double)r->change));
  }
  PetscFunctionReturn(0);
}
