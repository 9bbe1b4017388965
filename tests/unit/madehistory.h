/*
   A history of made-up motions on two boxes, for tests: displacement, velocity and acceleration of a node at x are
      u_d = (d + 1 + x_d) s,   v_d = 10 u_d + x_0,   a_d = -100 u_d,   s = sin(2 pi t / 1 ms)
   The layout has a turned basis at each node, strides, a gap of padding, and masses that differ from node to node.
   Files are written into a scratch folder.
*/
#pragma once

#include "dynamics/history/historyimpl.h"
#include "boxes.h"
#include "check.h"
#include "scratch.h"
#include <string.h>

#define MADE_DT 1e-6
#define MADE_B  0.7
#define MADE_SCENE                                                                                                     \
  "-model_source file -parts low,high -low_young 1e9 -low_density 1000 -high_young 1e9 -high_density 1000 "            \
  "-probes tip,foot -tip_at 1.1,0.9,2 -tip_part high -foot_at 0,0,0 "

static const PetscReal made_x[] = {0, 0.5, 1}, made_y[] = {0, 1}, made_low[] = {0, 1}, made_high[] = {1.5, 2};
static const Box       made_boxes[] = {{"low", {3, 2, 2}, {made_x, made_y, made_low}, 0, 0, 0},
                                       {"high", {3, 2, 2}, {made_x, made_y, made_high}, 0, 0, 0}};

typedef struct {
  Model            model;
  const PetscReal *x; /* places of the local vertices */
  Results          results;
  Layout           layout;
  PetscReal       *u, *before, *f, *f_old, *minv; /* state vectors */
  char             dir[PETSC_MAX_PATH_LEN];
  PetscMPIInt      rank;
} Made;

/* Sets displacement, velocity and acceleration at x, t */
static inline void MadeMotion(const PetscReal x[3], PetscReal t, PetscReal u[3], PetscReal v[3], PetscReal a[3])
{
  for (int d = 0; d < 3; d++) {
    u[d] = (d + 1 + x[d]) * PetscSinReal(2e3 * PETSC_PI * t);
    v[d] = 10 * u[d] + x[0];
    a[d] = -100 * u[d];
  }
}

/* Basis turned about z by an angle that depends on the place, and strides of n_vertices + 1 */
static inline PetscErrorCode MadeLayOut(Made *m)
{
  Layout     *l = &m->layout;
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(m->model, &mesh));
  l->n_vertices = mesh->n_nodes;
  l->n          = 3 * (l->n_vertices + 1);
  PetscCall(PetscMalloc3(l->n_vertices, &l->at, l->n_vertices, &l->step, 9 * l->n_vertices, &l->basis));
  PetscCall(PetscCalloc5(l->n, &m->u, l->n, &m->before, l->n, &m->f, l->n, &m->f_old, l->n, &m->minv));
  for (PetscInt i = 0; i < l->n_vertices; i++) {
    const PetscReal *x = &m->x[3 * i], angle = 1 + x[0] + 2 * x[1] + 4 * x[2];
    const PetscReal  q[9] = {
       PetscCosReal(angle), PetscSinReal(angle), 0, -PetscSinReal(angle), PetscCosReal(angle), 0, 0, 0, 1};

    l->at[i]   = i;
    l->step[i] = l->n_vertices + 1;
    PetscCall(PetscArraycpy(&l->basis[9 * i], q, 9));
    for (int j = 0; j < 3; j++) m->minv[i + j * l->step[i]] = 1 / (1 + x[0] + x[1]);
  }
  PetscFunctionReturn(0);
}

/* State vectors at step n: `before` such that v_n follows with b = MADE_B, and b = 0 in step 0 */
static inline void MadeState(Made *m, PetscInt n, const Ledger *ledger, HistoryState *state)
{
  const PetscReal t = n * MADE_DT, b = n ? MADE_B : 0;

  for (PetscInt i = 0; i < m->layout.n_vertices; i++) {
    const PetscReal mass = 1 / m->minv[i];
    PetscReal       u[3], v[3], a[3], f[3], f_old[3], before[3];

    MadeMotion(&m->x[3 * i], t, u, v, a);
    for (int d = 0; d < 3; d++) {
      f[d]      = mass * a[d];
      f_old[d]  = 1e6 * (d - m->x[3 * i + d]);
      before[d] = v[d] - MADE_DT / mass * (b * f[d] + (n ? (0.5 - b) * f_old[d] : 0));
    }
    LayoutSet(&m->layout, i, u, m->u);
    LayoutSet(&m->layout, i, before, m->before);
    LayoutSet(&m->layout, i, f, m->f);
    LayoutSet(&m->layout, i, f_old, m->f_old);
  }
  *state = (HistoryState){.step   = n,
                          .time   = t,
                          .dt     = MADE_DT,
                          .b      = b,
                          .u      = m->u,
                          .before = m->before,
                          .f      = m->f,
                          .minv   = m->minv,
                          .f_old  = n ? m->f_old : NULL,
                          .ledger = ledger};
}

/* Records step n with energies and contact sums that depend on n alone */
static inline PetscErrorCode MadeRecord(Made *m, History history, PetscInt n)
{
  const Ledger      ledger = {n + 0.25, 2, 3, 4, 5, 6, 7, 8, 0, 9, 10, 0};
  const ContactSums sums[] = {
    {.n = {1, 2, 3}, .normal = 100 + n, .friction = 20, .residual = 1e-11, .sweeps = 3 * n * n, .steps = n},
    {.n = {4, 5, 6}, .normal = 0.5, .friction = 7, .residual = 2e-11, .sweeps = 5 * n * n, .steps = n},
  };
  HistoryState state;

  PetscFunctionBeginUser;
  if (!HistoryIsDue(history, n * MADE_DT, MADE_DT)) PetscFunctionReturn(0);
  MadeState(m, n, &ledger, &state);
  state.n_interfaces = 2;
  state.sums         = sums;
  PetscCall(HistoryRecord(history, &state));
  PetscFunctionReturn(0);
}

/* A history with these options, for a run of 1 s */
static inline PetscErrorCode MadeHistory(Made *m, const char options[], History *history)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsInsertString(NULL, options));
  PetscCall(HistoryCreate(PETSC_COMM_WORLD, history));
  PetscCall(HistorySetFromOptions(*history));
  PetscCall(
    HistorySetUp(*history, &(HistorySource){.model = m->model, .layout = &m->layout, .results = m->results}, 1, 0));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode MadeCreate(Made *m)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &m->rank));
  PetscCall(BoxesCreateModel(PETSC_COMM_WORLD, BOX_LENGTH(made_boxes), made_boxes, MADE_SCENE, &m->model));
  PetscCall(ModelGetMesh(m->model, &mesh));
  m->x = mesh->x;
  PetscCall(MadeLayOut(m));
  PetscCall(ScratchMakeFolder(m->dir));
  PetscCall(PetscOptionsSetValue(NULL, "-output_dir", m->dir));
  PetscCall(ResultsCreate(PETSC_COMM_WORLD, &m->results));
  PetscCall(ResultsSetFromOptions(m->results));
  PetscFunctionReturn(0);
}

/* The scratch folder must be empty */
static inline PetscErrorCode MadeDestroy(Made *m, int *failed)
{
  PetscFunctionBeginUser;
  if (m->rank == 0) *failed += CheckTrue("no other file is left in the folder", !rmdir(m->dir), 0);
  PetscCall(ResultsDestroy(&m->results));
  PetscCall(ModelDestroy(&m->model));
  PetscCall(PetscFree3(m->layout.at, m->layout.step, m->layout.basis));
  PetscCall(PetscFree5(m->u, m->before, m->f, m->f_old, m->minv));
  PetscFunctionReturn(0);
}

/* Content of a file of the folder, or NULL where there is none, on rank 0 alone; the caller frees it with free() */
static inline char *MadeRead(const Made *m, const char name[])
{
  char  path[PETSC_MAX_PATH_LEN + 32], *text;
  long  size;
  FILE *file;

  snprintf(path, sizeof(path), "%s/%s", m->dir, name);
  file = m->rank ? NULL : fopen(path, "r");
  if (!file) return NULL;
  fseek(file, 0, SEEK_END);
  size = ftell(file);
  rewind(file);
  text = calloc((size_t)size + 1, 1);
  if (fread(text, 1, (size_t)size, file) != (size_t)size) text[0] = '\0';
  fclose(file);
  return text;
}

/* Removes a file of the folder on rank 0, returns on all ranks whether it was there */
static inline int MadeRemove(const Made *m, const char name[])
{
  char path[PETSC_MAX_PATH_LEN + 32];
  int  removed = 0;

  snprintf(path, sizeof(path), "%s/%s", m->dir, name);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (m->rank == 0) removed = !unlink(path);
  (void)MPI_Bcast(&removed, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  return removed;
}
