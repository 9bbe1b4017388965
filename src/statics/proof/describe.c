/*
   A rigid motion in words: which body goes farthest, and where to. On each body a motion is t + w x (x - c), fitted to
   its unknowns by least squares, c the middle of its nodes: a turn about the axis w through c + w x t / |w|^2, or a
   way along t where the turn is none.
*/
#include "statics/staticsimpl.h"
#include "base/algebra/dense.h"
#include "base/text.h"
#include <math.h>

#define NO_TURN   1e-3  /* way of the turn beside that of the middle */
#define FIT_RCOND 1e-10 /* of motions that a body's unknowns do not tell apart */

/* A body: its middle, half its size, and its motion */
typedef struct {
  PetscReal c[3], size; /* m */
  PetscReal t[3], w[3];
} BodyMotion;

/* The body of the largest displacement, over all ranks */
static PetscErrorCode BodyFarthest(const Mesh *mesh, MPI_Comm comm, const PetscInt body[], Vec r, PetscInt *farthest)
{
  const PetscScalar *value;
  struct {
    double way;
    int    body;
  } most = {-1, 0};

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(r, &value));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    const PetscInt at = mesh->unknown[i] - mesh->first_own;

    if (mesh->unknown[i] < 0 || at < 0 || at >= mesh->n_own || PetscAbsScalar(value[at]) <= most.way) continue;
    most.way  = PetscAbsScalar(value[at]);
    most.body = (int)body[i / 3];
  }
  PetscCall(VecRestoreArrayRead(r, &value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  *farthest = most.body;
  PetscFunctionReturn(0);
}

/* Middle and half the size of a body, from its box */
static PetscErrorCode BodyMeasure(Model model, const PetscInt body[], PetscInt b, BodyMotion *m)
{
  PetscReal box[6];

  PetscFunctionBeginUser;
  PetscCall(ModelMeasureBodies(model, body, b, 1, box));
  m->size = 0;
  for (int d = 0; d < 3; d++) {
    m->c[d] = (box[d] - box[3 + d]) / 2;
    m->size = PetscMax(m->size, (box[d] + box[3 + d]) / 2);
  }
  PetscFunctionReturn(0);
}

/* t and w of a body, turns counted in ways at half its size: normal equations of at most 6 numbers, [6][6] and [6],
   summed over the ranks. They square the condition, which is of order 1 here; three figures are printed. */
static PetscErrorCode BodyFit(const Mesh *mesh, MPI_Comm comm, const PetscInt body[], PetscInt b, Vec r, BodyMotion *m)
{
  const PetscScalar *value;
  PetscReal          sum[42] = {0};

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(r, &value));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    const PetscInt at = mesh->unknown[i] - mesh->first_own, d = i % 3;
    PetscReal      row[6] = {0}, x[3];

    if (body[i / 3] != b || mesh->unknown[i] < 0 || at < 0 || at >= mesh->n_own) continue;
    for (int k = 0; k < 3; k++) x[k] = (mesh->x[i - d + k] - m->c[k]) / m->size;
    row[d]               = 1;
    row[3 + (d + 1) % 3] = x[(d + 2) % 3];
    row[3 + (d + 2) % 3] = -x[(d + 1) % 3];
    for (int j = 0; j < 6; j++) {
      for (int k = 0; k < 6; k++) sum[6 * j + k] += row[j] * row[k];
      sum[36 + j] += row[j] * PetscRealPart(value[at]);
    }
  }
  PetscCall(VecRestoreArrayRead(r, &value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 42, MPIU_REAL, MPI_SUM, comm));
  PetscCall(DenseLeast(6, 6, sum, &sum[36], FIT_RCOND, NULL));
  for (int d = 0; d < 3; d++) {
    m->t[d] = sum[36 + d];
    m->w[d] = sum[39 + d] / m->size;
  }
  PetscFunctionReturn(0);
}

/* x to four digits beside `size`, for reading: the same text from all ranks and libraries, no -0 and no rounding */
static double Readable(PetscReal x, PetscReal size)
{
  const PetscReal digits = 1e4 * x / size;

  return PetscAbsReal(digits) < 0.5 ? 0 : (double)(round(digits) * size / 1e4);
}

/* "push part pad along 0, 0, 1", "turn part pad about the axis ..." */
static PetscErrorCode BodyPrint(const char name[], const BodyMotion *m, size_t size, char text[])
{
  const PetscReal way   = PetscSqrtReal(PetscSqr(m->t[0]) + PetscSqr(m->t[1]) + PetscSqr(m->t[2]));
  const PetscReal turn  = PetscSqrtReal(PetscSqr(m->w[0]) + PetscSqr(m->w[1]) + PetscSqr(m->w[2]));
  const PetscBool turns = turn * m->size > NO_TURN * way ? PETSC_TRUE : PETSC_FALSE;
  PetscReal       d[3], x[3];

  PetscFunctionBeginUser;
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;

    d[k] = turns ? m->w[k] / turn : m->t[k] / way;
    x[k] = turns ? m->c[k] + (m->w[i] * m->t[j] - m->w[j] * m->t[i]) / PetscSqr(turn) : 0;
  }
  PetscCall(PetscSNPrintf(text, size, "%s %s %s %.4g, %.4g, %.4g", turns ? "turn" : "push", name,
                          turns ? "about the axis" : "along", Readable(d[0], 1), Readable(d[1], 1), Readable(d[2], 1)));
  if (turns) {
    char place[128];

    PetscCall(PetscSNPrintf(place, sizeof(place), " through %.4g, %.4g, %.4g m", Readable(x[0], m->size),
                            Readable(x[1], m->size), Readable(x[2], m->size)));
    PetscCall(WordsAdd(text, place, size));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode RigidDescribe(Operators operators, Vec r, size_t size, char text[])
{
  const Mesh *mesh;
  BodyMotion  m = {.size = 0};
  PetscInt    n_bodies, *body, b;
  MPI_Comm    comm;
  Model       model;
  char        name[256];

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetBodies(model, &n_bodies, &body));
  PetscCall(BodyFarthest(mesh, comm, body, r, &b));
  PetscCall(BodyMeasure(model, body, b, &m));
  PetscCall(BodyFit(mesh, comm, body, b, r, &m));
  PetscCall(ModelNameBody(model, body, b, sizeof(name), name));
  PetscCall(BodyPrint(name, &m, size, text));
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
}
