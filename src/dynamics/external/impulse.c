/*
   Impulses J (N s) at nodes: a force J / dt in one step, so that the node's momentum grows by J. The step is the one
   with t_n <= T < t_n + dt, except the first, v_{1/2} = v_0 + dt/2 a_0, which would give half of it: there the second
   takes over.
*/
#include "externalimpl.h"

PetscErrorCode ImpulseCheck(MPI_Comm comm, void *external, void *impulse)
{
  const Impulse *hit = impulse;
  PetscInt       part;

  PetscFunctionBeginUser;
  (void)comm;
  PetscCall(ModelFindPart(((External)external)->model, hit->name, hit->part, &part));
  PetscFunctionReturn(0);
}

static PetscErrorCode ImpulseDestroy(Impulse *hit)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(hit->name));
  PetscCall(PetscFree(hit->part));
  PetscCall(ForcePatternDestroy(&hit->pattern));
  PetscFunctionReturn(0);
}

/* Those of zeros, by which a command line does without one of its files, come last and do not act. Their options stay
   known to the run, so that one that it does not read is refused as any other. */
static PetscErrorCode ImpulsesSetAsideZero(External external)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_impulses; i++) {
    const Impulse hit = external->impulses[i];

    if (hit.impulse[0] == 0 && hit.impulse[1] == 0 && hit.impulse[2] == 0) continue;
    external->impulses[i]   = external->impulses[n];
    external->impulses[n++] = hit;
  }
  external->n_acting = n;
  PetscFunctionReturn(0);
}

PetscErrorCode ImpulsesSetFromOptions(External external)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesReadList(external->comm, &impulses_list, external, &external->n_impulses, &external->impulses));
  PetscCall(ImpulsesSetAsideZero(external));
  PetscFunctionReturn(0);
}

/* This rank's copy of the node that one rank names by a number >= 0, else -1 */
static PetscErrorCode ImpulseFindCopy(Model model, PetscInt *vertex)
{
  const Mesh *mesh;
  PetscInt    global = -1;
  MPI_Comm    comm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetMesh(model, &mesh));
  if (*vertex >= 0) global = mesh->number[*vertex];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &global, 1, MPIU_INT, MPI_MAX, comm));
  *vertex = -1;
  for (PetscInt i = 0; i < mesh->n_nodes && *vertex < 0; i++)
    if (mesh->number[i] == global) *vertex = i;
  PetscFunctionReturn(0);
}

/* The place of the node that is hit on every rank, and whether it moves in a direction of J: sum |minv J_j| > 0
   over all copies */
static PetscErrorCode ImpulsePlace(External external, PetscInt vertex, Impulse *hit, PetscBool *moves)
{
  const ForcePattern *p = &hit->pattern;
  const Mesh         *mesh;
  PetscReal           here[4] = {0, 0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(external->model, &mesh));
  if (vertex >= 0 && external->layout->owned[vertex]) PetscCall(PetscArraycpy(here, &mesh->x[3 * vertex], 3));
  for (PetscInt i = 0; i < p->n; i++) here[3] += PetscAbsReal(external->layout->minv[p->index[i]] * p->value[i]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, here, 4, MPIU_REAL, MPI_SUM, external->comm));
  PetscCall(PetscArraycpy(hit->x, here, 3));
  *moves = here[3] > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Raises the error for an impulse that does nothing */
static PetscErrorCode ImpulseCheckMoves(External external, const Impulse *hit, PetscBool moves)
{
  PetscFunctionBeginUser;
  PetscCheck(moves, external->comm, PETSC_ERR_USER_INPUT,
             "-%s_impulse does nothing: the node at %.6g, %.6g, %.6g m is held in its direction", hit->name,
             (double)hit->x[0], (double)hit->x[1], (double)hit->x[2]);
  PetscFunctionReturn(0);
}

PetscErrorCode ImpulsesSetUp(External external)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_acting; i++) {
    Impulse  *hit = &external->impulses[i];
    PetscInt  vertex;
    PetscBool moves;

    PetscCall(ModelFindNode(external->model, hit->name, hit->part, hit->at, &vertex));
    PetscCall(ImpulseFindCopy(external->model, &vertex));
    PetscCall(ForcePatternCreate(external->layout, vertex >= 0, &vertex, hit->impulse, &hit->pattern));
    PetscCall(ImpulsePlace(external, vertex, hit, &moves));
    PetscCall(ImpulseCheckMoves(external, hit, moves));
  }
  PetscFunctionReturn(0);
}

/* last[0] = 1 / dt while it acts, 1/s, last[1] = when it acted, s; both in the memory of a restart. It acts once:
   in the step after which T < t_n + dt, not in the first one. */
PetscErrorCode ImpulsesAdvance(External external, const ExternalStep *step, ExternalPower *power)
{
  const PetscReal end = step->time + step->dt;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_acting; i++) {
    Impulse        *hit  = &external->impulses[i];
    const PetscBool acts = *external->begun != 0 && hit->last[1] == 0 && hit->time < end ? PETSC_TRUE : PETSC_FALSE;
    PetscReal       full;

    if (!acts && hit->last[0] == 0) continue;
    full = ForcePatternPower(&hit->pattern, step->v);
    power->old += hit->last[0] * full;
    hit->last[0] = acts ? 1 / step->dt : 0;
    power->now += hit->last[0] * full;
    ForcePatternAdd(&hit->pattern, hit->last[0], step->f);
    if (acts) hit->last[1] = step->time;
  }
  PetscFunctionReturn(0);
}

PetscBool ExternalIsHitting(External external)
{
  for (PetscInt i = 0; i < external->n_acting; i++)
    if (external->impulses[i].last[0] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode ExternalCountHits(External external, PetscInt *n)
{
  PetscFunctionBeginUser;
  *n = external->n_acting;
  PetscFunctionReturn(0);
}

PetscErrorCode ExternalGetHit(External external, PetscInt i, ExternalHit *hit)
{
  const Impulse *from = &external->impulses[i];

  PetscFunctionBeginUser;
  *hit = (ExternalHit){.name = from->name, .time = from->last ? from->last[1] : 0};
  PetscCall(PetscArraycpy(hit->x, from->x, 3));
  PetscCall(PetscArraycpy(hit->impulse, from->impulse, 3));
  PetscFunctionReturn(0);
}

/* The same for a reduced run, which has no layout: the node moves where it has an unknown in a direction of J. */
PetscErrorCode ExternalFindHit(External external, PetscInt i, ExternalHit *hit, PetscInt *vertex)
{
  Impulse    *from = &external->impulses[i];
  const Mesh *mesh;
  PetscReal   here[4] = {0, 0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(external->model, &mesh));
  PetscCall(ModelFindNode(external->model, from->name, from->part, from->at, vertex));
  for (int d = 0; d < 3 && *vertex >= 0; d++) {
    here[d] = mesh->x[3 * *vertex + d];
    if (mesh->unknown[3 * *vertex + d] >= 0) here[3] += PetscAbsReal(from->impulse[d]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, here, 4, MPIU_REAL, MPI_SUM, external->comm));
  PetscCall(PetscArraycpy(from->x, here, 3));
  PetscCall(ImpulseCheckMoves(external, from, here[3] > 0 ? PETSC_TRUE : PETSC_FALSE));
  *hit = (ExternalHit){.name = from->name, .time = from->time};
  PetscCall(PetscArraycpy(hit->x, from->x, 3));
  PetscCall(PetscArraycpy(hit->impulse, from->impulse, 3));
  PetscFunctionReturn(0);
}

PetscErrorCode ImpulsesView(External external, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_acting; i++) {
    const Impulse   *hit = &external->impulses[i];
    const PetscReal *J = hit->impulse, *x = hit->x;

    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  impulse %s: %.6g, %.6g, %.6g N s on the node at %.6g, %.6g, %.6g m at %.6g s\n", hit->name,
      (double)J[0], (double)J[1], (double)J[2], (double)x[0], (double)x[1], (double)x[2], (double)hit->time));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ImpulsesDestroy(External external)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_impulses; i++) PetscCall(ImpulseDestroy(&external->impulses[i]));
  PetscCall(PetscFree(external->impulses));
  PetscFunctionReturn(0);
}
