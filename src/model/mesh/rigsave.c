/*
   The built-in rig as a Gmsh file, format 2.2 in text, with its parts and sets as physical names: for what needs a mesh
   file, such as a deck of another program. It is written before the mesh is cut, when the first rank has all of it;
   coordinates have 17 digits, so that the file gives the same matrices.
   Reference: Gmsh reference manual, MSH file format version 2.
*/
#include "base/file.h"
#include "model/modelimpl.h"
#include <errno.h>
#include <string.h>
#include <unistd.h>

#define GMSH_QUADRILATERAL 3
#define GMSH_HEXAHEDRON    5
#define GMSH_POINT         15
#define RIG_CELL_NODES     8

static const char *const rig_surfaces[] = {"disc_inner", "disc_face", "pad_face", "beam_top"};
static const char        rig_rows[]     = "beam_rows";

/* Elements of the sets: type of Gmsh, number of the physical name, nodes from 0 */
typedef struct {
  FILE    *stream;
  PetscInt n; /* elements so far */
} RigFile;

/* One element; a failure shows when the file is closed */
static void RigFileElement(RigFile *file, int type, PetscInt group, PetscInt n, const PetscInt node[])
{
  fprintf(file->stream, "%" PetscInt_FMT " %d 2 %" PetscInt_FMT " %" PetscInt_FMT, ++file->n, type, group, group);
  for (PetscInt i = 0; i < n; i++) fprintf(file->stream, " %" PetscInt_FMT, node[i] + 1);
  fprintf(file->stream, "\n");
}

/* Nodes and hexahedra */
static void RigFileBodies(RigFile *file, const Mesh *mesh, PetscInt n_elements)
{
  fprintf(file->stream, "$Nodes\n%" PetscInt_FMT "\n", mesh->n_nodes);
  for (PetscInt v = 0; v < mesh->n_nodes; v++)
    fprintf(file->stream, "%" PetscInt_FMT " %.17g %.17g %.17g\n", v + 1, (double)mesh->x[3 * v],
            (double)mesh->x[3 * v + 1], (double)mesh->x[3 * v + 2]);
  fprintf(file->stream, "$EndNodes\n$Elements\n%" PetscInt_FMT "\n", n_elements);
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    RigFileElement(file, GMSH_HEXAHEDRON, mesh->cell_part[c] + 1, RIG_CELL_NODES,
                   &mesh->cell_node[mesh->cell_first[c]]);
}

/* All of the file: parts have the physical numbers 1 .. n_parts, sets those behind; nodes are those of rows [n_rows] */
static void RigFileWrite(RigFile *file, const Mesh *mesh, PetscInt n_surfaces, const ModelFaces faces[],
                         PetscInt n_rows, const PetscInt rows[])
{
  PetscInt n_elements = mesh->n_cells + n_rows;

  for (PetscInt s = 0; s < n_surfaces; s++) n_elements += faces[s].n;
  fprintf(file->stream, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%" PetscInt_FMT "\n",
          mesh->n_parts + n_surfaces + (n_rows > 0));
  for (PetscInt i = 0; i < mesh->n_parts; i++)
    fprintf(file->stream, "3 %" PetscInt_FMT " \"%s\"\n", i + 1, mesh->part[i]);
  for (PetscInt s = 0; s < n_surfaces; s++)
    fprintf(file->stream, "2 %" PetscInt_FMT " \"%s\"\n", mesh->n_parts + s + 1, rig_surfaces[s]);
  if (n_rows) fprintf(file->stream, "0 %" PetscInt_FMT " \"%s\"\n", mesh->n_parts + n_surfaces + 1, rig_rows);
  fprintf(file->stream, "$EndPhysicalNames\n");
  RigFileBodies(file, mesh, n_elements);
  for (PetscInt s = 0; s < n_surfaces; s++)
    for (PetscInt f = 0; f < faces[s].n; f++)
      RigFileElement(file, GMSH_QUADRILATERAL, mesh->n_parts + s + 1, 4, &faces[s].node[faces[s].first[f]]);
  for (PetscInt i = 0; i < n_rows; i++) RigFileElement(file, GMSH_POINT, mesh->n_parts + n_surfaces + 1, 1, &rows[i]);
  fprintf(file->stream, "$EndElements\n");
}

/* The file under a temporary name, then under its own; the first error of the system, 0 where there is none */
static int RigFileMake(Model model, PetscInt n_surfaces, const ModelFaces faces[], PetscInt n_rows,
                       const PetscInt rows[])
{
  char    part[PETSC_MAX_PATH_LEN + 32]; /* of this process: another run may write the same file */
  RigFile file = {NULL, 0};
  int     failed;

  (void)snprintf(part, sizeof(part), "%s.%ld.part", model->rig.save, (long)getpid());
  errno       = 0;
  file.stream = FileCreateStream(part, "w");
  if (!file.stream) return errno;
  RigFileWrite(&file, &model->mesh, n_surfaces, faces, n_rows, rows);
  failed = ferror(file.stream) ? (errno ? errno : EIO) : 0;
  if (fclose(file.stream) && !failed) failed = errno;
  if (!failed && rename(part, model->rig.save)) failed = errno;
  if (failed) (void)unlink(part);
  return failed;
}

PetscErrorCode RigSave(Model model)
{
  const PetscInt n_surfaces = model->rig.with_pad ? 4 : 2;
  PetscInt       n_rows = 0, *rows = NULL;
  PetscMPIInt    rank;
  ModelFaces     faces[4];
  int            failed = 0;

  PetscFunctionBeginUser;
  if (!model->rig.save[0]) PetscFunctionReturn(0);
  for (PetscInt s = 0; s < n_surfaces; s++) PetscCall(ModelGetSetFaces(model, rig_surfaces[s], &faces[s]));
  if (model->rig.with_pad) PetscCall(ModelGetSetNodes(model, rig_rows, &n_rows, &rows));
  PetscCallMPI(MPI_Comm_rank(model->comm, &rank));
  if (rank == 0) failed = RigFileMake(model, n_surfaces, faces, n_rows, rows);
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, model->comm));
  PetscCheck(!failed, model->comm, PETSC_ERR_FILE_WRITE, "cannot write '%s' of -rig_save: %s", model->rig.save,
             FileReason(failed));
  PetscCall(PetscFree(rows));
  for (PetscInt s = 0; s < n_surfaces; s++) PetscCall(ModelFacesDestroy(&faces[s]));
  PetscFunctionReturn(0);
}
