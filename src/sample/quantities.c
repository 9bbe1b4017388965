/* Options of samples */
#include "sampleimpl.h"

#define SAMPLE_AT(member)    QUANTITY_AT(struct _p_Sample, member)
#define VARIABLE_AT(member)  QUANTITY_AT(SampleVariable, member)
#define SAMPLE_GIVEN(member) .given = offsetof(struct _p_Sample, member)
#define GIVEN(member)        .given = offsetof(SampleVariable, member)

static const char *const kinds[] = {
  [DISTRIBUTION_NORMAL] = "normal",         [DISTRIBUTION_LOGNORMAL] = "lognormal", [DISTRIBUTION_UNIFORM] = "uniform",
  [DISTRIBUTION_TRIANGULAR] = "triangular", [DISTRIBUTION_TABLE] = "table",         NULL};
static const char *const sequences[] = {
  [SEQUENCE_SOBOL] = "sobol", [SEQUENCE_LATIN] = "latin", [SEQUENCE_RANDOM] = "random", NULL};

static const Quantity variable_rows[] = {
  {"-parameters", "options of the scene that take its value, e.g. pad_young; default the name itself", NULL,
   QUANTITY_NAMES, VARIABLE_AT(names), .count = offsetof(SampleVariable, n_names)},
  {"-distribution", "how it is distributed", NULL, QUANTITY_WORD, VARIABLE_AT(distribution.kind),
   .initial = DISTRIBUTION_NORMAL, .words = kinds},
  {"-mean", "of a normal or lognormal one; default the value of the scene", NULL, QUANTITY_REAL,
   VARIABLE_AT(distribution.mean), GIVEN(mean_given)},
  {"-deviation", "its standard deviation", NULL, QUANTITY_REAL, VARIABLE_AT(distribution.deviation), QUANTITY_POSITIVE,
   GIVEN(deviation_given)},
  {"-lower", "no value is below; of a uniform or triangular one its end", NULL, QUANTITY_REAL,
   VARIABLE_AT(distribution.lower), GIVEN(lower_given)},
  {"-upper", "no value is above, likewise", NULL, QUANTITY_REAL, VARIABLE_AT(distribution.upper), GIVEN(upper_given)},
  {"-peak", "likeliest value of a triangular one; default the value of the scene", NULL, QUANTITY_REAL,
   VARIABLE_AT(distribution.peak), GIVEN(peak_given)},
  {"-table", "CSV file with columns value, probability: of lower values, from 0 to 1, straight between", NULL,
   QUANTITY_PATH, VARIABLE_AT(table), .path = "file"},
  {"-relative", "all these are factors of the scene's own value of each parameter", NULL, QUANTITY_BOOL,
   VARIABLE_AT(relative)},
};
static const QuantityTable variables = {"Variable of samples", "sample.h", PETSC_STATIC_ARRAY_LENGTH(variable_rows),
                                        variable_rows, .in = RUN_SAMPLE};

const QuantityList sample_list = {
  "-sample_variables",    "what samples draw, each the prefix of its parameters and distribution",
  sizeof(SampleVariable), &variables,
  SampleVariableCheck,    .in = RUN_SAMPLE};

static const Quantity column_rows[] = {
  {"-parameters", "options of the scene that take its value, e.g. piston_pressure; these, or it names one itself", NULL,
   QUANTITY_NAMES, VARIABLE_AT(names), .count = offsetof(SampleVariable, n_names)},
  {"-column", "column of the file; default the name itself", NULL, QUANTITY_TEXT, VARIABLE_AT(source)},
  {"-scale", "what its numbers are multiplied by, besides the unit in brackets", NULL, QUANTITY_REAL,
   VARIABLE_AT(scale), .initial = 1},
  {"-relative", "its numbers are factors of the scene's own value of each parameter", NULL, QUANTITY_BOOL,
   VARIABLE_AT(relative)},
  {"-table", "CSV file with columns value, factor: of the scene's own value, straight between, as of a temperature",
   NULL, QUANTITY_PATH, VARIABLE_AT(table), .path = "file"},
};
static const QuantityTable columns = {"Column of conditions", "sample.h", PETSC_STATIC_ARRAY_LENGTH(column_rows),
                                      column_rows, .in = RUN_SAMPLE};

const QuantityList sample_columns = {
  "-sample_columns",
  "columns of -sample_conditions that are no parameter of their name, each the prefix of what it is",
  sizeof(SampleVariable),
  &columns,
  SampleColumnCheck,
  .in = RUN_SAMPLE};

static const Quantity rows[] = {
  {"-sample_count", "samples", NULL, QUANTITY_INT, SAMPLE_AT(n), .initial = 1000, QUANTITY_WITHIN(1, 10000000),
   SAMPLE_GIVEN(n_given)},
  {"-sample_sequence", "scrambled sequence of Sobol, Latin hypercube, or random numbers", NULL, QUANTITY_WORD,
   SAMPLE_AT(kind), .initial = SEQUENCE_SOBOL, .words = sequences, SAMPLE_GIVEN(kind_given)},
  {"-sample_seed", "another one draws other samples; the same on any number of ranks", NULL, QUANTITY_INT,
   SAMPLE_AT(seed), .initial = 1, QUANTITY_NOT_NEGATIVE, SAMPLE_GIVEN(seed_given)},
  {"-sample_correlations", "of the normal scores of two variables, e.g. a:b:0.5,a:c:-0.2", NULL, QUANTITY_TEXT,
   SAMPLE_AT(correlations)},
  {"-sample_indices", "rows of the design for indices of Sobol, each one solution more than there are variables", NULL,
   QUANTITY_INT, SAMPLE_AT(n_rows), QUANTITY_NOT_NEGATIVE},
  {"-sample_rtol", "largest estimated relative error of an eigenvalue (an estimate, no bound)", NULL, QUANTITY_REAL,
   SAMPLE_AT(box.rtol), .initial = 1e-6, QUANTITY_WITHIN(0, 1), .open = PETSC_TRUE},
  {"-sample_max_solutions", "most full solutions", NULL, QUANTITY_INT, SAMPLE_AT(box.max_solutions), .initial = 100,
   QUANTITY_POSITIVE},
  {"-sample_verify", "compare with full solutions at this many of the samples", NULL, QUANTITY_INT, SAMPLE_AT(n_verify),
   QUANTITY_NOT_NEGATIVE},
  {"-sample_groups", "ranks that share the samples (0: all; the full solutions use all ranks)", NULL, QUANTITY_INT,
   SAMPLE_AT(box.n_groups), QUANTITY_NOT_NEGATIVE},
  {"-sample_restart", "go on where a run of the same scene in -output_dir was stopped", NULL, QUANTITY_BOOL,
   SAMPLE_AT(restart), .initial = PETSC_TRUE},
  {"-sample_conditions",
   "CSV file of conditions in place of samples: condition, direction (forward, reverse), columns named like options, "
   "as piston_pressure [bar]",
   NULL, QUANTITY_PATH, SAMPLE_AT(file), .path = "file"},
  {"-sample_ignore", "columns of that file that are left out", NULL, QUANTITY_NAMES, SAMPLE_AT(ignored),
   .count = offsetof(struct _p_Sample, n_ignored)},
  {"-sample_bands",
   "edges of the frequency bands in which conditions are counted; default some ten between those of "
   "-modes_band",
   "Hz", QUANTITY_LIST, SAMPLE_AT(edge), QUANTITY_NOT_NEGATIVE, .count = offsetof(struct _p_Sample, n_edges)},
};
const QuantityTable sample_quantities = {"Samples", "sample.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows,
                                         .in = RUN_SAMPLE};
