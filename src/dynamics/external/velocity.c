/*
   Initial velocities of parts: uniform in a part, the mean of the parts' where they share a node, nothing in directions
   that are held or prescribed.
*/
#include "externalimpl.h"

PetscErrorCode VelocitySetFromOptions(External external)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  external->n_parts = scene->n_parts;
  PetscCall(PetscCalloc1(3 * external->n_parts, &external->velocity));
  for (PetscInt i = 0; i < external->n_parts; i++)
    PetscCall(QuantitiesReadOf(external->comm, scene->parts[i].name, &start_velocity, &external->velocity[3 * i]));
  PetscFunctionReturn(0);
}

static PetscBool VelocityIsZero(const PetscReal v[3])
{
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* Adds a part's velocity to sum[node][3] and 1 to count[node] */
static PetscErrorCode VelocityAddPart(External external, const char part[], const PetscReal velocity[3],
                                      PetscReal sum[], PetscInt count[])
{
  PetscInt n, n_owned, *vertex;

  PetscFunctionBeginUser;
  PetscCall(ExternalFindVertices(external, part, &n, &n_owned, &vertex));
  for (PetscInt k = 0; k < n; k++) {
    for (int d = 0; d < 3; d++) sum[3 * vertex[k] + d] += velocity[d];
    count[vertex[k]]++;
  }
  PetscCall(PetscFree(vertex));
  PetscFunctionReturn(0);
}

/* Adds the means to v where nothing is held */
static void VelocityAddMeans(External external, PetscReal sum[], const PetscInt count[], PetscReal v[])
{
  const Layout *layout = external->layout;

  for (PetscInt i = 0; i < layout->n_vertices; i++) {
    if (!count[i]) continue;
    for (int d = 0; d < 3; d++) sum[3 * i + d] /= (PetscReal)count[i];
    LayoutAdd(layout, i, &sum[3 * i], v);
    for (int j = 0; j < 3; j++) {
      const PetscInt index = layout->at[i] + j * layout->step[i];

      if (external->layout->minv[index] == 0) v[index] = 0;
    }
  }
}

PetscErrorCode ExternalSetVelocity(External external, PetscReal v[])
{
  const ModelScene *scene;
  PetscInt         *count;
  PetscReal        *sum;
  PetscBool         moves = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  for (PetscInt i = 0; i < external->n_parts; i++)
    if (!VelocityIsZero(&external->velocity[3 * i])) moves = PETSC_TRUE;
  if (!moves) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(3 * external->layout->n_vertices, &sum, external->layout->n_vertices, &count));
  for (PetscInt i = 0; i < external->n_parts; i++)
    PetscCall(VelocityAddPart(external, scene->parts[i].name, &external->velocity[3 * i], sum, count));
  VelocityAddMeans(external, sum, count, v);
  PetscCall(PetscFree2(sum, count));
  PetscFunctionReturn(0);
}

const PetscReal *ExternalGetVelocity(External external)
{
  return external->velocity;
}

PetscErrorCode VelocityView(External external, PetscViewer viewer)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(external->model, &scene));
  for (PetscInt i = 0; i < external->n_parts; i++) {
    const PetscReal *v = &external->velocity[3 * i];

    if (!VelocityIsZero(v))
      PetscCall(PetscViewerASCIIPrintf(viewer, "  part %s starts with %.6g, %.6g, %.6g m/s\n", scene->parts[i].name,
                                       (double)v[0], (double)v[1], (double)v[2]));
  }
  PetscFunctionReturn(0);
}
