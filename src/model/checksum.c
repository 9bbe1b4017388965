/*
   What a model adds to the checksum of a scene. The mesh counts by the places of its nodes, which no renumbering
   changes: a cell by its part and corners in the element's order, a set by its nodes, a surface by its faces as well.
*/
#include "modelimpl.h"

/* Checksum of n nodes, in any order */
static uint64_t ModelSumVertices(const Mesh *mesh, PetscInt n, const PetscInt vertex[])
{
  uint64_t sum = 0;

  for (PetscInt i = 0; i < n; i++) sum += ChecksumBytes(CHECKSUM_BEGIN, &mesh->x[3 * vertex[i]], 3 * sizeof(PetscReal));
  return ChecksumBytes(CHECKSUM_BEGIN, &sum, sizeof(sum));
}

PetscErrorCode ModelAddSetChecksum(Model model, const char set[], PetscBool is_surface, Checksum c)
{
  const Mesh *mesh;
  PetscInt    n, *vertex;
  ModelFaces  faces = {0, NULL, NULL};
  uint64_t   *piece;

  PetscFunctionBeginUser;
  PetscCall(ChecksumAddString(c, set));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetOwnedNodes(model, set, &n, &vertex));
  if (is_surface) PetscCall(ModelGetSetFaces(model, set, &faces));
  PetscCall(PetscMalloc1(n + faces.n, &piece));
  for (PetscInt i = 0; i < n; i++) piece[i] = ModelSumVertices(mesh, 1, &vertex[i]);
  for (PetscInt i = 0; i < faces.n; i++)
    piece[n + i] = ModelSumVertices(mesh, faces.first[i + 1] - faces.first[i], &faces.node[faces.first[i]]);
  PetscCall(PetscFree(vertex));
  PetscCall(ChecksumAddPieces(c, n + faces.n, piece));
  PetscCall(ModelFacesDestroy(&faces));
  PetscCall(PetscFree(piece));
  PetscFunctionReturn(0);
}

/* Cells, and as a part of its own which rank has which, where a run goes on with arrays of each rank */
static PetscErrorCode ModelAddMeshChecksum(Model model, PetscBool with_partition, Checksum c)
{
  const Mesh *mesh;
  PetscInt    nodes[ELEMENT_MAX_NODES];
  PetscMPIInt rank;
  PetscReal   x[ELEMENT_MAX_DOFS];
  uint64_t   *piece, local = CHECKSUM_BEGIN;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(model->comm, &rank));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PetscMalloc1(mesh->n_cells, &piece));
  for (PetscInt i = 0; i < mesh->n_cells; i++) {
    const Element *element;

    PetscCall(ModelGetCell(model, i, &element, nodes, x));
    piece[i] = ChecksumBytes(CHECKSUM_BEGIN, x, 3 * (size_t)element->n_nodes * sizeof(PetscReal));
    piece[i] = ChecksumBytes(piece[i], &element->shape, sizeof(element->shape));
    piece[i] = ChecksumBytes(piece[i], &mesh->cell_part[i], sizeof(PetscInt));
    local    = ChecksumBytes(local, &piece[i], sizeof(local));
  }
  PetscCall(ChecksumSetPart(c, "the mesh"));
  PetscCall(ChecksumAddString(c, model->formulation));
  PetscCall(ChecksumAddPieces(c, mesh->n_cells, piece));
  PetscCall(PetscFree(piece));
  local = ChecksumBytes(local, &rank, sizeof(rank));
  PetscCall(ChecksumSetPart(c, "its partition"));
  if (with_partition) PetscCall(ChecksumAddPieces(c, 1, &local));
  PetscFunctionReturn(0);
}

static PetscErrorCode PartAddChecksum(const Part *p, Checksum c)
{
  const PetscReal all[] = {p->young, p->poisson, p->density, p->alpha, p->beta};

  PetscFunctionBeginUser;
  PetscCall(ChecksumAddString(c, p->name));
  if (strcmp(p->name, p->volume)) PetscCall(ChecksumAddString(c, p->volume));
  PetscCall(ChecksumAddReals(c, PETSC_STATIC_ARRAY_LENGTH(all), all));
  if (p->spin.given) {
    PetscCall(ChecksumAddReals(c, 1, &p->spin.rate));
    PetscCall(ChecksumAddReals(c, 3, p->spin.axis));
    PetscCall(ChecksumAddReals(c, 3, p->spin.centre));
  }
  if (p->layer.given) PetscCall(ChecksumAddReals(c, 1, &p->layer.thickness));
  PetscCall(ViscoelasticAddChecksum(&p->law, c));
  if (!p->anisotropy.n) PetscFunctionReturn(0);
  PetscCall(ChecksumAddReals(c, ELASTICITY_VOIGT * ELASTICITY_VOIGT, p->anisotropy.C[0]));
  PetscCall(ChecksumAddReals(c, 9, p->anisotropy.axis[0]));
  PetscCall(ChecksumAddInts(c, 1, (const PetscInt[]){p->anisotropy.cylinder}));
  PetscCall(ChecksumAddReals(c, 3, p->anisotropy.centre));
  PetscFunctionReturn(0);
}

static PetscErrorCode SupportAddChecksum(Model model, const Support *s, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ModelAddSetChecksum(model, s->set, PETSC_FALSE, c));
  PetscCall(ChecksumAddInts(c, 3, (const PetscInt[]){s->fix[0], s->fix[1], s->fix[2]}));
  PetscFunctionReturn(0);
}

static PetscErrorCode MotionAddChecksum(Model model, const PrescribedMotion *m, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "motion %s", m->name));
  PetscCall(ModelAddSetChecksum(model, m->set, PETSC_FALSE, c));
  PetscCall(ChecksumAddReals(c, 3, m->displacement));
  PetscCall(ChecksumAddInts(c, 3, (const PetscInt[]){m->direction[0], m->direction[1], m->direction[2]}));
  PetscFunctionReturn(0);
}

/* kind = "spring" or "dashpot" */
static PetscErrorCode GroundedAddChecksum(Model model, const char kind[], const Grounded *g, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "%s %s", kind, g->name));
  PetscCall(ModelAddSetChecksum(model, g->set, PETSC_FALSE, c));
  PetscCall(ChecksumAddReals(c, 3, g->value));
  if (g->spread != SPREAD_EACH) PetscCall(ChecksumAddString(c, g->quantity));
  PetscFunctionReturn(0);
}

static PetscErrorCode JointAddChecksum(Model model, const Joint *j, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "%s %s", j->is_point ? "point" : "bushing", j->name));
  for (int k = 0; k < 2; k++)
    if (j->set[k][0]) PetscCall(ModelAddSetChecksum(model, j->set[k], PETSC_FALSE, c));
  PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){j->has_at, j->rigid}));
  if (j->has_at) PetscCall(ChecksumAddReals(c, 3, j->at)); /* else a sum over ranks, whose rounding is no difference */
  if (j->has_at_b) PetscCall(ChecksumAddReals(c, 3, j->at_b));
  if (j->has_axis[0]) PetscCall(ChecksumAddReals(c, 9, j->frame));
  PetscCall(ChecksumAddReals(c, 6, j->stiffness));
  PetscCall(ChecksumAddReals(c, 6, j->viscosity));
  PetscCall(ChecksumAddReals(c, 1, &j->mass));
  PetscCall(ChecksumAddReals(c, 6, j->inertia));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelAddChecksum(Model model, PetscBool with_partition, Checksum c)
{
  const ModelScene *s = &model->scene;

  PetscFunctionBeginUser;
  PetscCall(ModelAddMeshChecksum(model, with_partition, c));
  PetscCall(ChecksumSetPart(c, "materials"));
  for (PetscInt i = 0; i < s->n_parts; i++) PetscCall(PartAddChecksum(&s->parts[i], c));
  PetscCall(ChecksumSetPart(c, "supports"));
  for (PetscInt i = 0; i < s->n_supports; i++) PetscCall(SupportAddChecksum(model, &s->supports[i], c));
  for (PetscInt i = 0; i < s->n_motions; i++) PetscCall(MotionAddChecksum(model, &s->motions[i], c));
  for (PetscInt i = 0; i < s->n_springs; i++) PetscCall(GroundedAddChecksum(model, "spring", &s->springs[i], c));
  for (PetscInt i = 0; i < s->n_dashpots; i++) PetscCall(GroundedAddChecksum(model, "dashpot", &s->dashpots[i], c));
  for (PetscInt i = 0; i < s->n_joints; i++) PetscCall(JointAddChecksum(model, &s->joints[i], c));
  for (PetscInt i = 0; i < s->n_points; i++) PetscCall(JointAddChecksum(model, &s->points[i], c));
  if (s->equations[0]) PetscCall(ChecksumSetPart(c, "-model_equations"));
  if (s->equations[0]) PetscCall(ChecksumAddString(c, s->equations));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelAddLoadsChecksum(Model model, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "-model_gravity"));
  PetscCall(ChecksumAddReals(c, 3, model->scene.gravity));
  for (PetscInt i = 0; i < model->scene.n_loads; i++) {
    const Load *load = &model->scene.loads[i];

    PetscCall(ChecksumSetPart(c, "load %s", load->name));
    PetscCall(ChecksumAddInts(c, 1, &i)); /* the order counts */
    if (load->on_point) {
      PetscCall(ChecksumAddString(c, model->scene.points[load->point].name));
      PetscCall(ChecksumAddReals(c, 3, load->moment));
    } else {
      PetscCall(ModelAddSetChecksum(model, load->set, PETSC_FALSE, c));
    }
    if (load->is_bolt) {
      const PetscReal bolt[] = {load->axis[0], load->axis[1], load->axis[2], load->tension, load->shortening};

      PetscCall(ChecksumAddInts(c, 1, &load->of_part));
      PetscCall(ChecksumAddReals(c, 5, bolt));
    }
    /* the resultant of a pressure is a sum over ranks, whose rounding is no difference */
    if (load->is_pressure)
      PetscCall(ChecksumAddReals(c, 1, &load->pressure));
    else
      PetscCall(ChecksumAddReals(c, 3, load->force));
  }
  PetscFunctionReturn(0);
}
