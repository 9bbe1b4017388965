/*
   Unit test of dynamics/start/shape.c: a mode of a run of modes, laid on the mesh of another run.

   The first part writes shapes that are functions of place and body, u_d = (1 + body) (1 + d + x + 2 y + 4 z), so that
   what must come back is known at every node, whatever ranks wrote and read it. Pad and disc of the coarse brake match,
   so that 25 nodes of either stand at the same places with other values. The second part takes the brake's own modes.
*/
#include "dynamics/start/shape.h"
#include <squeal/modes.h>
#include <hdf5.h>
#include <slepcsys.h>
#include <string.h>
#include "brake.h"
#include "check.h"
#include "scratch.h"

#define N_MATCHING 25 /* nodes of the pad, (4 + 1) x (4 + 1) */
#define FREQUENCY  1234.5678901234567
#define GROWTH     -12.3

/* A model of the scene on some ranks, and the local vertices */
typedef struct {
  Model       model;
  const Mesh *mesh;
  PetscInt    n, *body;
  PetscReal  *re, *im;
} ModelOnRanks;

static PetscErrorCode ModelOnRanksCreate(MPI_Comm comm, ModelOnRanks *m)
{
  PetscInt n_bodies;

  PetscFunctionBeginUser;
  PetscCall(ModelCreate(comm, &m->model));
  PetscCall(ModelSetFromOptions(m->model));
  PetscCall(ModelSetUp(m->model));
  PetscCall(ModelGetMesh(m->model, &m->mesh));
  m->n = m->mesh->n_nodes;
  PetscCall(ModelGetBodies(m->model, &n_bodies, &m->body));
  PetscCall(PetscMalloc2(3 * m->n, &m->re, 3 * m->n, &m->im));
  PetscFunctionReturn(0);
}

static PetscErrorCode ModelOnRanksDestroy(ModelOnRanks *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->body));
  PetscCall(PetscFree2(m->re, m->im));
  PetscCall(ModelDestroy(&m->model));
  PetscFunctionReturn(0);
}

/* Displacement d of vertex v, 0 where it is held; the imaginary part is -3 times as large */
static PetscReal Known(const ModelOnRanks *m, PetscInt v, int d)
{
  const PetscReal *x = &m->mesh->x[3 * v];

  return m->mesh->unknown[3 * v + d] < 0 ? 0 : (1 + m->body[v]) * (1 + d + x[0] + 2 * x[1] + 4 * x[2]);
}

/* modes.csv with modes 1 to n, columns in any order */
static PetscErrorCode WriteTable(Results results, PetscInt n, PetscReal frequency)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  PetscCall(ResultsTableOpen(results, "modes", "label,growth_rad_s,mode,more,freq_hz", &table));
  for (PetscInt i = 1; i <= n; i++)
    PetscCall(ResultsTableRow(table, "\"(0,%d+)\",%.15g,%d,7,%.15g", (int)i, GROWTH * (double)i, (int)i,
                              (double)(frequency * (double)i)));
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* Files of a run of modes whose second mode has the known shape */
static PetscErrorCode WriteShape(Results results, const ModelOnRanks *m)
{
  ResultsField field;
  char         title[64];
  PetscReal   *re, *im;

  PetscFunctionBeginUser;
  PetscCall(WriteTable(results, 2, FREQUENCY));
  PetscCall(PetscMalloc2(3 * m->n, &re, 3 * m->n, &im));
  for (PetscInt i = 0; i < 3 * m->n; i++) {
    re[i] = Known(m, i / 3, (int)(i % 3));
    im[i] = -3 * re[i];
  }
  PetscCall(PetscSNPrintf(title, sizeof(title), "2: %.6g Hz, growth 1 1/s, (0,2+)", 2 * FREQUENCY));
  PetscCall(ResultsFieldOpen(results, "modes", m->mesh, &field));
  PetscCall(ResultsFieldWriteMode(field, "mode_001", title, im, im, NULL));
  PetscCall(ResultsFieldWriteMode(field, "mode_002", title, re, im, NULL));
  PetscCall(ResultsFieldClose(&field));
  PetscCall(PetscFree2(re, im));
  PetscFunctionReturn(0);
}

/* Mode `mode` of a run of modes in folder dir */
static ShapeSource ModeOf(const char dir[], PetscInt mode)
{
  return (ShapeSource){"-dynamics_shape", "-dynamics_shape_mode", "-output_fields", dir, "modes.h5", "", mode};
}

/* Breaks when: a node gets the value of another one, of the node of another body at its place, or none. Expected: the
   formula, to the last bit at the file's own coordinates, which are those of the model */
static int CheckKnown(const char dir[], ModelOnRanks *m, const char name[])
{
  const ShapeSource source = ModeOf(dir, 2);
  PetscReal         lambda[2];
  int               wrong = 0, failed;

  memset(m->re, 1, 3 * sizeof(PetscReal) * (size_t)m->n);
  memset(m->im, 1, 3 * sizeof(PetscReal) * (size_t)m->n);
  failed = CheckTrue(name, !ShapeRead(m->model, &source, m->re, m->im, lambda), m->n);
  for (PetscInt i = 0; i < 3 * m->n; i++) {
    const PetscReal known = Known(m, i / 3, (int)(i % 3));

    wrong += m->re[i] != known || m->im[i] != -3 * known;
  }
  failed += CheckTrue("values that are not those of their node", wrong == 0, wrong);
  failed += CheckClose("growth, 1/s", lambda[0], 2 * GROWTH, 1e-13);
  return failed + CheckClose("angular frequency, 1/s", lambda[1], 4 * PETSC_PI * FREQUENCY, 1e-10);
}

/* Places at which two bodies have nodes */
static int CountMatching(const ModelOnRanks *m)
{
  int n = 0;

  for (PetscInt v = 0; v < m->n; v++)
    for (PetscInt w = 0; w < v; w++)
      if (m->body[v] != m->body[w] && !memcmp(&m->mesh->x[3 * v], &m->mesh->x[3 * w], 3 * sizeof(PetscReal))) n++;
  return n;
}

/* Writer of files of one rank, or all */
static PetscErrorCode WriterCreate(MPI_Comm comm, Results *results)
{
  PetscFunctionBeginUser;
  PetscCall(ResultsCreate(comm, results));
  PetscCall(ResultsSetFromOptions(*results));
  PetscFunctionReturn(0);
}

/* All ranks write, all and one read; one writes, all read */
static int TestRanks(Scratch *s, ModelOnRanks *all, ModelOnRanks *own)
{
  Results results;
  int     failed = CheckTrue("nodes of two bodies at one place", CountMatching(own) == N_MATCHING, CountMatching(own));

  if (WriterCreate(PETSC_COMM_WORLD, &results) || WriteShape(results, all) || ResultsDestroy(&results)) return 1;
  failed += CheckKnown(s->dir, all, "written by all, read by all");
  failed += CheckKnown(s->dir, own, "written by all, read by one");
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (s->rank == 0)
    if (WriterCreate(PETSC_COMM_SELF, &results) || WriteShape(results, own) || ResultsDestroy(&results)) return 1;
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  return failed + CheckKnown(s->dir, all, "written by one, read by all");
}

/* Whether a mode is refused on all ranks with a line that has these words */
static int Refused(Scratch *s, const char dir[], ModelOnRanks *m, PetscInt mode, PetscErrorCode code,
                   const char words[])
{
  const ShapeSource source = ModeOf(dir, mode);
  PetscReal         lambda[2];
  PetscErrorCode    error;
  int               good;

  s->message[0] = '\0';
  error         = ShapeRead(m->model, &source, m->re, m->im, lambda);
  good          = error == code && strstr(s->message, words) && !strchr(s->message, '\n');
  if (!good) printf("error %d, message: %s\n", (int)error, s->message);
  return CheckTrue(words, good, mode);
}

/* Breaks when: files that are not of this mesh or of one run are taken, or the message does not say what is wrong */
static PetscErrorCode TestRefused(Scratch *s, ModelOnRanks *all, int *failed)
{
  Results      results;
  char         nowhere[PETSC_MAX_PATH_LEN + 32], missing[PETSC_MAX_PATH_LEN + 32];
  ModelOnRanks other;

  PetscFunctionBeginUser;
  *failed += Refused(s, ScratchPath(s, "nowhere", nowhere), all, 2, PETSC_ERR_FILE_OPEN, "needs the folder of a run");
  *failed += Refused(s, s->dir, all, 3, PETSC_ERR_USER_INPUT, "-dynamics_shape_mode 3 is none of the modes 1 to 2 of");
  *failed += Refused(s, s->dir, all, 0, PETSC_ERR_USER_INPUT, "-dynamics_shape_mode 0 is none of the modes 1 to 2 of");
  PetscCall(PetscOptionsSetValue(NULL, "-rig_pad_elements", "4,4,3"));
  PetscCall(ModelOnRanksCreate(PETSC_COMM_WORLD, &other));
  *failed += Refused(s, s->dir, &other, 2, PETSC_ERR_USER_INPUT, "the mesh of -dynamics_shape has no node at ");
  PetscCall(ModelOnRanksDestroy(&other));
  PetscCall(PetscOptionsSetValue(NULL, "-rig_pad_elements", "4,4,2"));
  PetscCall(PetscOptionsSetValue(NULL, "-rig_pad", "false"));
  PetscCall(PetscOptionsSetValue(NULL, "-parts", "disc"));
  PetscCall(PetscOptionsClearValue(NULL, "-springs"));
  PetscCall(ModelOnRanksCreate(PETSC_COMM_WORLD, &other));
  *failed += Refused(s, s->dir, &other, 2, PETSC_ERR_USER_INPUT, " cells, that of this run ");
  PetscCall(ModelOnRanksDestroy(&other));
  PetscCall(WriterCreate(PETSC_COMM_WORLD, &results));
  PetscCall(WriteTable(results, 3, FREQUENCY));
  *failed += Refused(s, s->dir, all, 3, PETSC_ERR_USER_INPUT, "no fitting array /VTKHDF/PointData/mode_003_re");
  PetscCall(WriteTable(results, 3, 1.001 * FREQUENCY));
  *failed += Refused(s, s->dir, all, 2, PETSC_ERR_USER_INPUT, "they are of different runs");
  PetscCall(WriteTable(results, 0, FREQUENCY));
  *failed += Refused(s, s->dir, all, 2, PETSC_ERR_USER_INPUT, "modes.csv has no modes");
  PetscCall(ResultsDestroy(&results));
  (void)ScratchRemove(s, "modes.h5");
  PetscCall(WriterCreate(PETSC_COMM_WORLD, &results));
  PetscCall(WriteTable(results, 2, FREQUENCY));
  PetscCall(ResultsDestroy(&results));
  PetscCall(PetscSNPrintf(missing, sizeof(missing), "cannot read %s/modes.h5, which", s->dir));
  *failed += Refused(s, s->dir, all, 2, PETSC_ERR_FILE_OPEN, missing);
  PetscFunctionReturn(0);
}

/* Largest difference between a shape and the local values of a vector (NULL: 0), relative to the largest value */
static PetscErrorCode Compare(Model model, Vec x, PetscInt n, const PetscReal shape[], PetscReal *difference)
{
  PetscReal largest[2] = {0, PETSC_SMALL}, *value;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &value));
  PetscCall(ModelGetNodal(model, x, value));
  for (PetscInt i = 0; i < n; i++) {
    largest[0] = PetscMax(largest[0], PetscAbsReal(value[i] - shape[i]));
    largest[1] = PetscMax(largest[1], PetscAbsReal(value[i]));
  }
  PetscCall(PetscFree(value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  *difference = largest[0] / largest[1];
  PetscFunctionReturn(0);
}

/* Breaks when: what the run of modes writes and what is read here part ways: numbers of modes, files, parts of the
   complex shape, eigenvalues. Reference: the modes in memory */
static PetscErrorCode TestModes(Scratch *s, int *failed)
{
  const Mode *mode;
  Chain       chain;
  Modes       modes;
  Results     results;
  const Mesh *mesh;
  PetscReal  *re, *im;
  PetscInt    n, n_values, n_complex = 0;

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(
    BRAKE SLIP BODIES_1 BEAM_1,
    "-contact_mu 0.5 -modes_band 1000,6000 -dashpots oil -oil_set beam_rows -oil_viscosity 300,300,0", &chain));
  PetscCall(PetscOptionsSetValue(NULL, "-output_dir", s->dir));
  PetscCall(ModesCreate(PETSC_COMM_WORLD, &modes));
  PetscCall(ModesSetFromOptions(modes));
  PetscCall(ChainLinearise(&chain, NULL));
  PetscCall(ModesSetPencil(modes, chain.pencil));
  PetscCall(ModesSolve(modes));
  PetscCall(WriterCreate(PETSC_COMM_WORLD, &results));
  PetscCall(ModesWrite(modes, results));
  PetscCall(ModelGetMesh(chain.model, &mesh));
  n_values = 3 * mesh->n_nodes;
  PetscCall(PetscMalloc2(n_values, &re, n_values, &im));
  PetscCall(ModesGet(modes, &n, &mode));
  for (PetscInt i = 0; i < n; i++) {
    const ShapeSource source = ModeOf(s->dir, i + 1);
    PetscReal         lambda[2], difference[2];
    Vec               xr, xi, yr, yi;

    PetscCall(ModesGetVectors(modes, i, &xr, &xi, &yr, &yi));
    PetscCall(ShapeRead(chain.model, &source, re, im, lambda));
    PetscCall(Compare(chain.model, xr, n_values, re, &difference[0]));
    PetscCall(Compare(chain.model, xi, n_values, im, &difference[1]));
    *failed += CheckClose("shape of a mode", difference[0] + difference[1], 0, 0);
    *failed += CheckClose("sigma, 1/s", lambda[0], mode[i].sigma, 1e-14 * PetscAbsReal(mode[i].sigma));
    *failed += CheckClose("omega, 1/s", lambda[1], mode[i].omega, 1e-14 * mode[i].omega);
    n_complex += xi ? 1 : 0;
  }
  *failed += CheckTrue("there are modes, complex ones among them", n > 4 && n_complex > 0, n_complex);
  PetscCall(PetscFree2(re, im));
  PetscCall(ResultsDestroy(&results));
  PetscCall(ModesDestroy(&modes));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  const char *const written[] = {"modes.csv",         "modes.h5",         "modes.xmf",         "modes_causes.csv",
                                 "modes_effects.csv", "modes_effects.h5", "modes_effects.xmf", "modes_feed_in.csv"};
  Scratch           scratch;
  ModelOnRanks      all, own;
  int               failed = 0;

  PetscCall(SlepcInitialize(&argc, &argv, NULL, NULL));
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  PetscCall(ScratchCreate(&scratch));
  PetscCall(PetscOptionsInsertString(NULL, BRAKE SLIP BODIES_1 BEAM_1));
  PetscCall(PetscOptionsSetValue(NULL, "-output_dir", scratch.dir));
  PetscCall(ModelOnRanksCreate(PETSC_COMM_WORLD, &all));
  PetscCall(ModelOnRanksCreate(PETSC_COMM_SELF, &own));
  failed += TestRanks(&scratch, &all, &own);
  PetscCall(TestRefused(&scratch, &all, &failed));
  PetscCall(ModelOnRanksDestroy(&own));
  PetscCall(ModelOnRanksDestroy(&all));
  PetscCall(TestModes(&scratch, &failed));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(written); k++)
    failed += CheckTrue(written[k], ScratchRemove(&scratch, written[k]), 0);
  failed += CheckTrue("no other file is left", ScratchDestroy(&scratch), 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(SlepcFinalize());
  return failed ? 1 : 0;
}
