/*
   Probes: places of bodies that histories record. Each is the nearest node of a part, or of any.

   Of several nodes at the same distance the one with the least x, then y, then z is taken, of coincident nodes that of
   the first part, then the least global number: the same place on any ranks. Of the ranks that share the node
   the first records it. A place may lie off its node by half the diagonal of the part's bounding box, of the largest
   part where none is named: what is farther is of other units or axes.
*/
#include "model/modelimpl.h"
#include "base/gather.h"
#include <squeal/options.h>
#include <stdlib.h>

#define PROBE_FAR 0.5 /* of the diagonal */

/* A node that may be the nearest, by what decides */
typedef struct {
  PetscReal distance, x[3]; /* m */
  PetscInt  part, number, rank, vertex;
} Candidate;

PetscErrorCode ProbeCheck(MPI_Comm comm, void *owner, void *record)
{
  Probe   *probe = record;
  PetscInt index;

  PetscFunctionBeginUser;
  (void)comm;
  probe->vertex = -1;
  PetscCall(ModelFindPart(owner, probe->name, probe->part, &index));
  PetscFunctionReturn(0);
}

static int CandidateCompare(const void *a, const void *b)
{
  const Candidate *x = a, *y = b;
  const PetscReal  real[][2] = {{x->distance, y->distance}, {x->x[0], y->x[0]}, {x->x[1], y->x[1]}, {x->x[2], y->x[2]}};
  const PetscInt   integer[][2] = {{x->part, y->part}, {x->number, y->number}, {x->rank, y->rank}};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(real); i++)
    if (real[i][0] != real[i][1]) return real[i][0] < real[i][1] ? -1 : 1;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(integer); i++)
    if (integer[i][0] != integer[i][1]) return integer[i][0] < integer[i][1] ? -1 : 1;
  return 0;
}

/* Vertex v of the local mesh as a candidate of a probe */
static PetscErrorCode CandidateSet(Model model, const Probe *probe, PetscInt part, PetscInt v, Candidate *candidate)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->comm, &rank));
  *candidate = (Candidate){.part = part, .number = model->mesh.number[v], .rank = rank, .vertex = v};
  PetscCall(PetscArraycpy(candidate->x, &model->mesh.x[3 * v], 3));
  for (int d = 0; d < 3; d++) candidate->distance += PetscSqr(candidate->x[d] - probe->at[d]);
  candidate->distance = PetscSqrtReal(candidate->distance);
  PetscFunctionReturn(0);
}

/* The best local candidate; n = 0 when this rank has no cell of the part */
static PetscErrorCode ProbeFindLocal(Model model, const Probe *probe, PetscInt *n, Candidate *best)
{
  const Mesh *mesh = &model->mesh;
  PetscInt    part;
  Candidate   candidate;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(ModelFindPart(model, probe->name, probe->part, &part));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (part >= 0 && mesh->cell_part[c] != part) continue;
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1]; i++) {
      PetscCall(CandidateSet(model, probe, mesh->cell_part[c], mesh->cell_node[i], &candidate));
      if (!*n || CandidateCompare(&candidate, best) < 0) *best = candidate;
      *n = 1;
    }
  }
  PetscFunctionReturn(0);
}

/* The node of one probe: its place on every rank, its node on the rank that records it */
PetscErrorCode ProbeLocate(Model model, Probe *probe)
{
  PetscMPIInt rank;
  PetscInt    n, n_all;
  Candidate   best, *all;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->comm, &rank));
  PetscCall(ProbeFindLocal(model, probe, &n, &best));
  PetscCall(GatherRecords(model->comm, n, sizeof(best), &best, &n_all, &all));
  if (n_all) qsort(all, (size_t)n_all, sizeof(*all), CandidateCompare);
  probe->vertex = all[0].rank == rank ? all[0].vertex : -1;
  PetscCall(PetscArraycpy(probe->x, all[0].x, 3));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* The same; raises the error for a place that is far off its node */
static PetscErrorCode ProbeLocateNear(Model model, Probe *probe)
{
  const PetscReal *at = probe->at, *x = probe->x;
  PetscReal        distance = 0, size = 0;
  PetscInt         part;

  PetscFunctionBeginUser;
  PetscCall(ProbeLocate(model, probe));
  PetscCall(ModelFindPart(model, probe->name, probe->part, &part));
  for (PetscInt i = 0; i < model->scene.n_parts; i++) {
    const PetscReal *side = model->extent[i].size;

    if (part < 0 || part == i)
      size = PetscMax(size, PetscSqrtReal(PetscSqr(side[0]) + PetscSqr(side[1]) + PetscSqr(side[2])));
  }
  for (int d = 0; d < 3; d++) distance += PetscSqr(x[d] - at[d]);
  distance = PetscSqrtReal(distance);
  PetscCheck(
    distance <= PROBE_FAR * size, model->comm, PETSC_ERR_USER_INPUT,
    "-%s_at %.6g,%.6g,%.6g is %.4g m off the nearest node%s%s, at %.6g,%.6g,%.6g; half the size of %s, %.4g m, is "
    "the most",
    probe->name, (double)at[0], (double)at[1], (double)at[2], (double)distance, part < 0 ? "" : " of ", probe->part,
    (double)x[0], (double)x[1], (double)x[2], part < 0 ? "the largest part" : "that part", (double)(PROBE_FAR * size));
  PetscFunctionReturn(0);
}

PetscErrorCode ProbesLocate(Model model)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_probes; i++) PetscCall(ProbeLocateNear(model, &model->scene.probes[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelFindNode(Model model, const char name[], const char part[], const PetscReal at[3], PetscInt *vertex)
{
  char  own_name[256], part_name[256];
  Probe probe = {.name = own_name, .part = part_name, .at = {at[0], at[1], at[2]}};

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(own_name, name, sizeof(own_name)));
  PetscCall(PetscStrncpy(part_name, part, sizeof(part_name)));
  PetscCall(ProbeLocateNear(model, &probe));
  *vertex = probe.vertex;
  PetscFunctionReturn(0);
}

PetscErrorCode ProbesView(Model model, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->scene.n_probes; i++) {
    const Probe *p = &model->scene.probes[i];

    PetscCall(
      PetscViewerASCIIPrintf(viewer, "  probe %s: node at %.6g, %.6g, %.6g m%s%s, asked for %.6g, %.6g, %.6g m\n",
                             p->name, (double)p->x[0], (double)p->x[1], (double)p->x[2], p->part[0] ? " of " : "",
                             p->part, (double)p->at[0], (double)p->at[1], (double)p->at[2]));
  }
  PetscFunctionReturn(0);
}
