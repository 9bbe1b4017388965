/*
   Import: a Gmsh file as a DMPlex of its volume elements. A physical group becomes a label of its name with value
   1: on cells for volumes, on faces for surfaces, on vertices for points, and on vertices and edges for curves.

   Nodes that belong to no volume element (centres of arcs, say) are left out; a named group that needs one is an
   error, and so is a named surface or curve element that is no face or edge of a cell. Elements of lower dimension
   without a named group do nothing.
*/
#include "volumes.h"
#include "model/modelimpl.h"

/* Raises on all ranks what rank 0 found wrong */
static PetscErrorCode RaiseError(MPI_Comm comm, const char file[], ReaderError *error)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(error, (PetscMPIInt)sizeof(*error), MPI_BYTE, 0, comm));
  PetscCheck(!error->code, comm, error->code, "Option -model_mesh %s: %s", file, error->text);
  PetscFunctionReturn(0);
}

/* Counts the volume elements, some of which must be in a named group */
static PetscInt CountCells(const GmshMesh *mesh, ReaderError *error)
{
  PetscBool volume  = PETSC_FALSE;
  PetscInt  n_cells = 0;

  for (PetscInt e = 0; e < mesh->n_elements && !error->code; e++) n_cells += mesh->elements[e].shape->dim == 3;
  for (PetscInt g = 0; g < mesh->n_groups; g++) volume = mesh->groups[g].dim == 3 ? PETSC_TRUE : volume;
  if (!n_cells)
    ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                   "there is no volume element; mesh the volumes and put them into physical volumes");
  if (!volume) {
    ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                   "no physical volume has a name; name every body, as in Physical Volume(\"disc\") = {1};");
  }
  return n_cells;
}

/* Checks that no node stands twice in an element */
static void CheckTwice(const GmshMesh *mesh, const GmshElement *element, ReaderError *error)
{
  for (PetscInt i = 0; i < element->shape->n_nodes && !error->code; i++)
    for (PetscInt k = 0; k < i; k++)
      if (element->node[i] == element->node[k])
        ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                       "element %" PetscInt_FMT " has node %" PetscInt_FMT " twice; give %" PetscInt_FMT
                       " different ones",
                       element->number, mesh->node_tags[element->node[i]], element->shape->n_nodes);
}

/* Replaces the tags of the elements' nodes by their places in the file */
static PetscErrorCode FindNodes(GmshMesh *mesh, ReaderError *error)
{
  PetscInt *tags, *index;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_nodes, &tags, mesh->n_nodes, &index));
  PetscCall(PetscArraycpy(tags, mesh->node_tags, mesh->n_nodes));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) index[n] = n;
  PetscCall(PetscSortIntWithArray(mesh->n_nodes, tags, index));
  for (PetscInt n = 1; n < mesh->n_nodes; n++)
    if (tags[n] == tags[n - 1])
      ReaderErrorSet(error, PETSC_ERR_FILE_READ, "node %" PetscInt_FMT " stands twice in $Nodes", tags[n]);
  for (PetscInt e = 0; e < mesh->n_elements; e++) {
    GmshElement *element = &mesh->elements[e];

    for (PetscInt v = 0; v < element->shape->n_nodes && !error->code; v++) {
      PetscInt at;

      PetscCall(PetscFindInt(element->node[v], mesh->n_nodes, tags, &at));
      if (at < 0) {
        ReaderErrorSet(error, PETSC_ERR_FILE_READ,
                       "element %" PetscInt_FMT " has node %" PetscInt_FMT ", which $Nodes does not hold",
                       element->number, element->node[v]);
      } else
        element->node[v] = index[at];
    }
    CheckTwice(mesh, element, error);
  }
  PetscCall(PetscFree2(tags, index));
  PetscFunctionReturn(0);
}

/* Vertex of each node in the order of the file, -1 where it is the corner of no volume element; vertex [n_nodes] */
static PetscInt NumberVertices(const GmshMesh *mesh, PetscInt vertex[])
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < mesh->n_nodes; i++) vertex[i] = -1;
  for (PetscInt e = 0; e < mesh->n_elements; e++) {
    const GmshElement *element = &mesh->elements[e];

    for (PetscInt v = 0; element->shape->dim == 3 && v < element->shape->n_corners; v++) vertex[element->node[v]] = 0;
  }
  for (PetscInt i = 0; i < mesh->n_nodes; i++) vertex[i] = vertex[i] < 0 ? -1 : n++;
  return n;
}

/* Two cells in one place give a face more than two cells */
static PetscErrorCode CheckOverlap(DM dm, ReaderError *error)
{
  PetscInt fStart, fEnd, n;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(dm, 1, &fStart, &fEnd));
  for (PetscInt f = fStart; f < fEnd; f++) {
    PetscCall(DMPlexGetSupportSize(dm, f, &n));
    if (n > 2) {
      ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                     "%" PetscInt_FMT " volume elements share one face; is a volume in two physical volumes?", n);
    }
  }
  PetscFunctionReturn(0);
}

/* Labels of all groups, on every rank */
static PetscErrorCode CreateLabels(DM dm, const char file[], const GmshMesh *mesh)
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)dm);
  PetscInt       n    = mesh->n_groups;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&n, 1, MPIU_INT, 0, comm));
  for (PetscInt g = 0; g < n; g++) {
    char      name[sizeof(mesh->groups->name)] = "";
    PetscBool taken;

    if (g < mesh->n_groups) PetscCall(PetscStrncpy(name, mesh->groups[g].name, sizeof(name)));
    PetscCallMPI(MPI_Bcast(name, (PetscMPIInt)sizeof(name), MPI_CHAR, 0, comm));
    PetscCall(DMHasLabel(dm, name, &taken));
    PetscCheck(!taken, comm, PETSC_ERR_USER_INPUT,
               "Option -model_mesh %s: the physical name \"%s\" stands for two groups or is reserved; choose another",
               file, name);
    PetscCall(DMCreateLabel(dm, name));
  }
  PetscFunctionReturn(0);
}

/* The edge or face between vertices, if there is one, is appended to points */
static PetscErrorCode AppendJoin(DM dm, PetscInt n_vertices, const PetscInt vertices[], PetscInt *n, PetscInt points[])
{
  const PetscInt *join;
  PetscInt        n_join;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetFullJoin(dm, n_vertices, vertices, &n_join, &join));
  if (n_join) points[(*n)++] = join[0];
  PetscCall(DMPlexRestoreJoin(dm, n_vertices, vertices, &n_join, &join));
  PetscFunctionReturn(0);
}

/* The points of the mesh that stand for an element: its cell, its face, or its vertices with the edge between them; n
   is 0 without any */
static PetscErrorCode FindPoints(DM dm, const GmshElement *element, PetscInt cell, const PetscInt vertex[], PetscInt *n,
                                 PetscInt points[])
{
  const PetscInt n_corners = element->shape->n_corners;
  PetscInt       vStart, vertices[GMSH_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  *n = 0;
  for (PetscInt v = 0; v < n_corners; v++) {
    if (vertex[element->node[v]] < 0) PetscFunctionReturn(0);
    vertices[v] = vStart + vertex[element->node[v]];
  }
  if (element->shape->dim == 3)
    points[(*n)++] = cell;
  else if (element->shape->dim < 2) {
    *n = n_corners;
    PetscCall(PetscArraycpy(points, vertices, n_corners));
  }
  if (element->shape->dim == 1 || element->shape->dim == 2) {
    const PetscInt before = *n;

    PetscCall(AppendJoin(dm, n_corners, vertices, n, points));
    if (*n == before) *n = 0; /* no edge of a cell, though its ends are nodes */
  }
  PetscFunctionReturn(0);
}

/* Marks what stands for an element in each of its groups */
static PetscErrorCode LabelElement(DM dm, const GmshVolumes *volumes, const GmshElement *element, PetscInt cell,
                                   ReaderError *error)
{
  const GmshMesh   *mesh   = volumes->mesh;
  const GmshEntity *entity = &mesh->entities[element->entity];
  PetscInt          n = 0, value = SET_CLOSED, points[GMSH_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(FindPoints(dm, element, cell, volumes->vertex, &n, points));
  if (!n && element->shape->dim == 0 && volumes->point[element->node[0]] >= 0) {
    points[n++] = volumes->point[element->node[0]];
    value       = SET_ALONE;
  }
  for (PetscInt g = 0; g < mesh->n_groups; g++) {
    const GmshGroup *group = &mesh->groups[g];

    for (PetscInt p = 0; p < entity->n_physical; p++) {
      if (group->dim != entity->dim || group->tag != entity->physical[p]) continue;
      if (!n) {
        ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                       "element %" PetscInt_FMT " of physical group \"%s\" is no part of a volume element",
                       element->number, group->name);
      }
      for (PetscInt i = 0; i < n; i++) PetscCall(DMSetLabelValue(dm, group->name, points[i], value));
    }
  }
  PetscFunctionReturn(0);
}

/* Fills the labels; a group without elements is an error, since a support or contact on it would do nothing */
static PetscErrorCode FillLabels(DM dm, const GmshVolumes *volumes, ReaderError *error)
{
  const GmshMesh *mesh = volumes->mesh;
  PetscInt        cell = 0, n, n_alone;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < mesh->n_elements; e++) {
    const GmshElement *element = &mesh->elements[e];

    if (element->entity >= 0) PetscCall(LabelElement(dm, volumes, element, cell, error));
    if (element->shape->dim == 3) cell++;
  }
  for (PetscInt g = 0; g < mesh->n_groups; g++) {
    PetscCall(DMGetStratumSize(dm, mesh->groups[g].name, SET_CLOSED, &n));
    PetscCall(DMGetStratumSize(dm, mesh->groups[g].name, SET_ALONE, &n_alone));
    if (n || n_alone) continue;
    ReaderErrorSet(error, PETSC_ERR_USER_INPUT,
                   "physical group \"%s\" has no elements: what it was made of is not in the mesh (or format 2.2 lost "
                   "them by Mesh.SaveAll)",
                   mesh->groups[g].name);
  }
  PetscFunctionReturn(0);
}

/*
   ImportGmsh - a Gmsh file of format 2.2 or 4.1, text or binary, as an interpolated DMPlex, all of it on rank 0.
   Collective.

   Errors: PETSC_ERR_FILE_OPEN; PETSC_ERR_FILE_READ for a damaged file; PETSC_ERR_SUP for other formats and
   elements; PETSC_ERR_USER_INPUT without named physical volumes, for overlapping ones, for a named group off the
   volumes, for a name that stands twice, and for mid-side nodes off their edges.
*/
PetscErrorCode ImportGmsh(MPI_Comm comm, const char file[], DM *dm)
{
  GmshMesh    mesh    = {0};
  ReaderError error   = {0};
  GmshVolumes volumes = {.mesh = &mesh};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(GmshMeshRead(file, &mesh, &error));
  if (rank == 0 && !error.code) PetscCall(FindNodes(&mesh, &error));
  if (rank == 0) volumes.n_cells = CountCells(&mesh, &error);
  PetscCall(RaiseError(comm, file, &error));
  PetscCall(PetscMalloc2(mesh.n_nodes, &volumes.vertex, mesh.n_nodes, &volumes.point));
  if (rank == 0) volumes.n_vertices = NumberVertices(&mesh, volumes.vertex);
  PetscCall(VolumesCreateMesh(comm, file, &volumes, &error, dm));
  PetscCall(CheckOverlap(*dm, &error));
  PetscCall(RaiseError(comm, file, &error));
  PetscCall(CreateLabels(*dm, file, &mesh));
  PetscCall(FillLabels(*dm, &volumes, &error));
  PetscCall(RaiseError(comm, file, &error));
  PetscCall(PetscFree2(volumes.vertex, volumes.point));
  PetscCall(GmshMeshDestroy(&mesh));
  PetscFunctionReturn(0);
}
