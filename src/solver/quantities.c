/* Options of PETSc and SLEPc, by what their names begin with, and which runs read them */
#include "solver/factor/shiftinvert.h"
#include <squeal/quantity.h>

static const char *SolverIdleSteps(const void *owner, const QuantityRun *run)
{
  (void)owner;
  (void)run;
  return "not used, runs in time take explicit steps of one length";
}

/* Which of SLEPc's solvers modes have: EPS without damping, or where modes without it tell the shape or the reach of
   those with it */
static const char *SolverIdleEps(const void *owner, const QuantityRun *run)
{
  (void)owner;
  if (!(run->does & RUN_LINEAR) || run->does & RUN_EPS) return NULL;
  return "not used by -modes_damping pep in a band, which -pep_* solves";
}

static const char *SolverIdlePep(const void *owner, const QuantityRun *run)
{
  (void)owner;
  if (!(run->does & RUN_LINEAR) || run->does & RUN_PEP) return NULL;
  return run->does & RUN_DAMPED ? "not used by -modes_damping project, which -eps_* solves"
                                : "not used by modes without damping, which -eps_* solves";
}

/* What runs in time leave out is of integrators that are implicit or choose their steps */
#define OPTIONS(prefix, bits)                                                                                          \
  {                                                                                                                    \
    prefix, NULL, NULL, QUANTITY_PREFIX, .in = (bits)                                                                  \
  }
#define EIGENVALUES(prefix, why)                                                                                       \
  {                                                                                                                    \
    prefix, NULL, NULL, QUANTITY_PREFIX, .in = RUN_LINEAR | RUN_REDUCED | RUN_SUPERELEMENT, .idle = (why)              \
  }
#define UNUSED(prefix)                                                                                                 \
  {                                                                                                                    \
    prefix, NULL, NULL, QUANTITY_PREFIX, .in = RUN_IN_TIME, .idle = SolverIdleSteps                                    \
  }

static const Quantity rows[] = {
  OPTIONS("-ts_", RUN_IN_TIME),
  OPTIONS("-ts_max_time", RUN_HISTORY | RUN_MAP),
  OPTIONS("-ts_exact_final_time", RUN_HISTORY | RUN_MAP),
  OPTIONS("-ts_init_time", RUN_HISTORY | RUN_MAP),
  OPTIONS("-ts_max_steps", RUN_HISTORY),
  OPTIONS("-ts_monitor", RUN_MESH),
  OPTIONS("-ts_view", RUN_MESH),
  OPTIONS("-ts_trajectory_", RUN_MESH),
  OPTIONS("-ts_event_", RUN_MESH),
  UNUSED("-ts_rtol"),
  UNUSED("-ts_atol"),
  UNUSED("-ts_adapt_"),
  UNUSED("-ts_max_reject"),
  UNUSED("-ts_max_snes_"),
  UNUSED("-ts_error_if_"),
  UNUSED("-ts_fd_color"),
  UNUSED("-ts_use_splitrhs"),
  UNUSED("-ts_time_span"),
  UNUSED("-ts_rhs_jacobian_"),
  EIGENVALUES("-eps_", SolverIdleEps),
  EIGENVALUES("-pep_", SolverIdlePep),
  EIGENVALUES("-bv_", NULL),
  EIGENVALUES("-ds_", NULL),
  EIGENVALUES("-rg_", NULL),
  OPTIONS("-st_", RUN_FACTORS),
  OPTIONS("-mat_mumps_", RUN_FACTORS),
};
const QuantityTable solver_quantities = {"PETSc and SLEPc", "petscsys.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                         .in = 0};
