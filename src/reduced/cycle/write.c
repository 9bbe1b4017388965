/* Tables of cycles, written anew with each one, so that a run that ends early leaves all that it has found */
#include "cycleimpl.h"

/* A number of second order in the step is off by 4/3 of its difference to twice the steps, one of first order by twice
   that; and by what it owes to the place of the steps */
#define ERROR_SECOND_ORDER (4.0 / 3)
#define ERROR_FIRST_ORDER  2

#define CYCLE_COLUMNS                                                                                                  \
  "point,parameter,value,value_error,kind,freq_hz,freq_error_hz,force_mean_n,force_rms_n,force_rms_error_n,"           \
  "force_peak_n,force_peak_error_n,open_share,multiplier_abs,multiplier_error,multiplier_re,multiplier_im,"            \
  "phase_multiplier_re,phase_multiplier_im,class,steps,residual,iterations,freq_cutoff_error_hz,"                      \
  "force_rms_cutoff_error_n,force_peak_cutoff_error_n,multiplier_cutoff_error,period_slope,derivative_check"
#define PROBE_COLUMNS                                                                                                  \
  "point,parameter,value,probe,direction,displacement_rms_m,displacement_rms_error_m,displacement_peak_m,"             \
  "displacement_peak_error_m,velocity_rms_m_s,velocity_rms_error_m_s,velocity_peak_m_s,velocity_peak_error_m_s"

PetscReal CycleMultiplier(const ShootingStability *stability)
{
  return hypot(stability->largest[0], stability->largest[1]);
}

PetscReal CycleError(PetscReal found, PetscReal finer, PetscReal spread)
{
  return ERROR_SECOND_ORDER * PetscAbsReal(found - finer) + spread;
}

/* Of the modulus of the largest multiplier: pairs that open and close between two steps leave multipliers of first
   order, which both differences tell */
PetscReal CycleMultiplierError(const CyclePoint *p)
{
  const PetscReal finer = PetscAbsReal(CycleMultiplier(&p->stability) - CycleMultiplier(&p->finer_stability));

  return PetscMax(ERROR_FIRST_ORDER * finer, p->multiplier_spread);
}

/* Of the same, what a higher cut-off makes */
static PetscReal MultiplierCutoffError(const CyclePoint *p)
{
  return p->has_higher ? PetscAbsReal(CycleMultiplier(&p->stability) - CycleMultiplier(&p->higher_stability)) : 0;
}

/* 1 outside the unit circle, -1 inside, 0 where the margin leaves that open */
static int MultiplierSide(PetscReal size, PetscReal margin)
{
  return PetscAbsReal(size - 1) <= margin ? 0 : size > 1 ? 1 : -1;
}

/* A residual r moves the cycle by r / |1 - m| along the vector of a multiplier m, and m by as much: it is told where
   |1 - m|^2 > r */
const char *CycleClass(const CyclePoint *p, PetscReal rtol, const char **why)
{
  const PetscReal size   = CycleMultiplier(&p->stability);
  const PetscReal margin = PetscMax(CycleMultiplierError(p) + MultiplierCutoffError(p), PetscSqrtReal(rtol));
  const int       side   = MultiplierSide(size, margin);

  *why = NULL;
  if (!p->has_finer)
    *why = "no cycle of other steps tells the error of the multiplier";
  else if (p->wants_higher && !p->has_higher)
    *why = "no cycle with a higher cut-off tells the error of the multiplier";
  if (*why) return "unverified";
  if (!side)
    *why = "the multiplier is nearer to 1 than its error";
  else if (side != MultiplierSide(p->stability.worst, margin))
    *why = "another multiplier may be that of the phase";
  else if (p->found.made)
    *why = "normal contact, which does no work, gives more than a tenth of what friction does: take more steps";
  if (*why) return "numerical";
  return side > 0 ? "unstable" : "stable";
}

typedef char Cell[32];

/* A number; nothing where it is not known */
static PetscErrorCode CellPrintKnown(PetscBool known, PetscReal number, Cell cell)
{
  PetscFunctionBeginUser;
  cell[0] = 0;
  if (known) PetscCall(PetscSNPrintf(cell, sizeof(Cell), "%.15g", (double)number));
  PetscFunctionReturn(0);
}

/* Multiplier of the phase, how the period changes with the place of the steps, and the check of the derivative */
static PetscErrorCode CellPrintPhase(const ShootingStability *s, Cell cell[4])
{
  const PetscReal number[] = {s->phase[0], s->phase[1], s->slope, s->check};

  PetscFunctionBeginUser;
  for (int i = 0; i < 4; i++) PetscCall(CellPrintKnown(!PetscIsNanReal(number[i]), number[i], cell[i]));
  PetscFunctionReturn(0);
}

/* Parameter, and its error where it is one of the results */
static PetscErrorCode CellPrintValue(LimitCycle c, const CyclePoint *p, Cell cell[2])
{
  PetscFunctionBeginUser;
  cell[0][0] = cell[1][0] = 0;
  if (c->parameter[0]) PetscCall(PetscSNPrintf(cell[0], sizeof(Cell), "%.15g", (double)p->value));
  if (p->value_error >= 0) PetscCall(PetscSNPrintf(cell[1], sizeof(Cell), "%.15g", (double)p->value_error));
  PetscFunctionReturn(0);
}

static PetscErrorCode CycleWriteRow(LimitCycle c, PetscInt i, ResultsTable table)
{
  const CyclePoint   *p = &c->point[i];
  const CycleMeasure *a = &p->found, *b = &p->finer, *spread = &p->spread;
  const PetscReal    *large = p->stability.largest, size = CycleMultiplier(&p->stability);
  const char         *why;
  Cell                error[4], cutoff[4], value[2], phase[4];

  PetscFunctionBeginUser;
  PetscCall(CellPrintValue(c, p, value));
  PetscCall(CellPrintKnown(p->has_finer, CycleError(a->freq, b->freq, spread->freq), error[0]));
  PetscCall(CellPrintKnown(p->has_finer, CycleError(a->rms, b->rms, spread->rms), error[1]));
  PetscCall(CellPrintKnown(p->has_finer, CycleError(a->peak, b->peak, spread->peak), error[2]));
  PetscCall(CellPrintKnown(p->has_finer, CycleMultiplierError(p), error[3]));
  PetscCall(CellPrintPhase(&p->stability, phase));
  PetscCall(CellPrintKnown(p->has_higher, PetscAbsReal(p->higher.freq - a->freq), cutoff[0]));
  PetscCall(CellPrintKnown(p->has_higher, PetscAbsReal(p->higher.rms - a->rms), cutoff[1]));
  PetscCall(CellPrintKnown(p->has_higher, PetscAbsReal(p->higher.peak - a->peak), cutoff[2]));
  PetscCall(CellPrintKnown(p->has_higher, MultiplierCutoffError(p), cutoff[3]));
  PetscCall(ResultsTableRow(table,
                            "%" PetscInt_FMT ",%s,%s,%s,%s,%.15g,%s,%.15g,%.15g,%s,%.15g,%s,%.15g,%.15g,%s,%.15g,%.15g,"
                            "%s,%s,%s,%" PetscInt_FMT ",%.15g,%" PetscInt_FMT ",%s,%s,%s,%s,%s,%s",
                            i + 1, c->parameter, value[0], value[1], p->fold ? "fold" : "cycle", (double)a->freq,
                            error[0], (double)a->mean, (double)a->rms, error[1], (double)a->peak, error[2],
                            (double)a->open, (double)size, error[3], (double)large[0], (double)large[1], phase[0],
                            phase[1], CycleClass(p, c->rtol, &why), p->n_steps, (double)p->residual, p->its, cutoff[0],
                            cutoff[1], cutoff[2], cutoff[3], phase[2], phase[3]));
  PetscFunctionReturn(0);
}

/* The three directions of one probe, the first of which is port k of those that are looked at */
static PetscErrorCode CycleWriteProbe(LimitCycle c, PetscInt i, PetscInt k, const char name[], ResultsTable table)
{
  const CyclePoint *p = &c->point[i];
  Cell              error[4], value[2];

  PetscFunctionBeginUser;
  PetscCall(CellPrintValue(c, p, value));
  for (int d = 0; d < 3; d++) {
    const CycleProbe *a = &p->probe[k + d], *b = &p->finer_probe[k + d], *spread = &p->spread_probe[k + d];

    PetscCall(CellPrintKnown(p->has_finer,
                             CycleError(a->displacement_rms, b->displacement_rms, spread->displacement_rms), error[0]));
    PetscCall(CellPrintKnown(
      p->has_finer, CycleError(a->displacement_peak, b->displacement_peak, spread->displacement_peak), error[1]));
    PetscCall(
      CellPrintKnown(p->has_finer, CycleError(a->velocity_rms, b->velocity_rms, spread->velocity_rms), error[2]));
    PetscCall(
      CellPrintKnown(p->has_finer, CycleError(a->velocity_peak, b->velocity_peak, spread->velocity_peak), error[3]));
    PetscCall(ResultsTableRow(table, "%" PetscInt_FMT ",%s,%s,%s,%c,%.15g,%s,%.15g,%s,%.15g,%s,%.15g,%s", i + 1,
                              c->parameter, value[0], name, 'x' + d, (double)a->displacement_rms, error[0],
                              (double)a->displacement_peak, error[1], (double)a->velocity_rms, error[2],
                              (double)a->velocity_peak, error[3]));
  }
  PetscFunctionReturn(0);
}

/* cycle_probes.csv, of probes and nodes of circles in the order of their ports */
static PetscErrorCode CycleWriteProbes(LimitCycle c)
{
  const ModelScene *scene;
  Model             model;
  ResultsTable      table;

  PetscFunctionBeginUser;
  if (!c->flow.n_looked) PetscFunctionReturn(0);
  PetscCall(OperatorsGetModel(c->operators, &model, NULL));
  PetscCall(ModelGetScene(model, &scene));
  PetscCall(ResultsTableOpen(c->results, "cycle_probes", PROBE_COLUMNS, &table));
  for (PetscInt i = 0; i < c->n_points; i++) {
    PetscInt port = 0;

    for (PetscInt k = 0; k < scene->n_probes; k++, port += 3)
      PetscCall(CycleWriteProbe(c, i, port, scene->probes[k].name, table));
    for (PetscInt j = 0; j < scene->n_circles; j++)
      for (PetscInt k = 0; k < scene->circles[j].n; k++, port += 3)
        PetscCall(CycleWriteProbe(c, i, port, scene->circles[j].probe[k].name, table));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode CycleWrite(LimitCycle c)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(c->results, "cycle", CYCLE_COLUMNS, &table));
  for (PetscInt i = 0; i < c->n_points; i++) PetscCall(CycleWriteRow(c, i, table));
  PetscCall(ResultsTableClose(&table));
  PetscCall(CycleWriteProbes(c));
  PetscCall(CycleWriteSound(c));
  PetscFunctionReturn(0);
}
