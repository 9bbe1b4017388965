/*
   Fields - mesh, complex shapes and states in one HDF5 file, laid out as VTK's VTKHDF unstructured grid:

      /VTKHDF  (Version, Type)    NumberOfPoints, NumberOfCells, NumberOfConnectivityIds    [1]
         Points [nodes][3] m      Connectivity [cells x corners]   Offsets [cells + 1]   Types [cells]
         PointData/<key>_re, <key>_im [nodes][3] m, attribute title       a shape
         PointData/<key> [nodes] or [nodes][3], attribute title           an array of a state, its unit in the key
         CellData/part [cells], attribute names

   The XDMF file beside it (xdmf.c) points at the same datasets. Every node and cell appears once, in the order of the
   ranks that own them. Reference: VTK File Formats, section VTKHDF, version 1.0.
*/
#include "resultsimpl.h"
#include <petscviewerhdf5.h>

/* A further shape of cells is one more row */
static const FieldShape field_shapes[] = {
  {DM_POLYTOPE_HEXAHEDRON, 12, "Hexahedron", 8, {0, 3, 2, 1, 4, 5, 6, 7}},
};

/* The rows that belong to the points of a global numbering (negative where another rank owns the point) */
static PetscErrorCode RowsFromNumbering(MPI_Comm comm, IS numbering, ResultsRows *rows)
{
  const PetscInt *number;
  PetscInt        n;

  PetscFunctionBeginUser;
  rows->n_local = 0;
  rows->first   = 0;
  PetscCall(ISGetLocalSize(numbering, &n));
  PetscCall(ISGetIndices(numbering, &number));
  for (PetscInt i = 0; i < n; i++) rows->n_local += number[i] >= 0 ? 1 : 0;
  PetscCall(ISRestoreIndices(numbering, &number));
  PetscCallMPI(MPI_Exscan(&rows->n_local, &rows->first, 1, MPIU_INT, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(&rows->n_local, &rows->n_global, 1, MPIU_INT, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

/* Finds the one shape of all cells */
static PetscErrorCode FieldFindShape(ResultsField field)
{
  PetscInt       c_start, c_end, range[2] = {-1, -DM_NUM_POLYTOPES};
  DMPolytopeType type;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(field->dm, 0, &c_start, &c_end));
  for (PetscInt c = c_start; c < c_end; c++) {
    PetscCall(DMPlexGetCellType(field->dm, c, &type));
    range[0] = PetscMax(range[0], (PetscInt)type);
    range[1] = PetscMax(range[1], -(PetscInt)type);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_INT, MPI_MAX, field->h5.comm));
  for (size_t i = 0; i < sizeof(field_shapes) / sizeof(field_shapes[0]); i++) {
    if ((PetscInt)field_shapes[i].polytope == range[0] && range[0] == -range[1]) field->xdmf.shape = &field_shapes[i];
  }
  PetscCheck(field->xdmf.shape, field->h5.comm, PETSC_ERR_SUP, "fields need a mesh of hexahedra only");
  PetscFunctionReturn(0);
}

/* Gathers values[n_local][width] of the owned vertices from an array in the layout of a local section; NULL: one row
   per local vertex */
static PetscErrorCode FieldGatherNodes(ResultsField field, PetscSection section, PetscInt width,
                                       const PetscReal array[], PetscReal values[])
{
  IS              numbering;
  const PetscInt *number;
  PetscInt        v_start, v_end, offset, n = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(field->dm, 0, &v_start, &v_end));
  PetscCall(DMPlexGetVertexNumbering(field->dm, &numbering));
  PetscCall(ISGetIndices(numbering, &number));
  for (PetscInt v = v_start; v < v_end; v++) {
    if (number[v - v_start] < 0) continue;
    offset = width * (v - v_start);
    if (section) PetscCall(PetscSectionGetOffset(section, v, &offset));
    for (PetscInt d = 0; d < width; d++) values[n++] = array[offset + d];
  }
  PetscCall(ISRestoreIndices(numbering, &number));
  PetscFunctionReturn(0);
}

/* Writes an array as dataset `path`, [nodes][width]; section as in FieldGatherNodes() */
static PetscErrorCode FieldWriteNodes(ResultsField field, const char path[], PetscSection section, PetscInt width,
                                      const PetscReal array[])
{
  PetscReal *values;
  hid_t      real;

  PetscFunctionBeginUser;
  PetscCall(PetscDataTypeToHDF5DataType(PETSC_REAL, &real));
  PetscCall(PetscMalloc1(width * field->nodes.n_local, &values));
  PetscCall(FieldGatherNodes(field, section, width, array, values));
  PetscCall(OutFileH5Write(&field->h5, path, real, &field->nodes, width, values));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

/* Writes a local vector as dataset `path`, three values per node */
static PetscErrorCode FieldWriteVector(ResultsField field, const char path[], PetscSection section, Vec local)
{
  const PetscScalar *array;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(local, &array));
  PetscCall(FieldWriteNodes(field, path, section, 3, array));
  PetscCall(VecRestoreArrayRead(local, &array));
  PetscFunctionReturn(0);
}

/* Global numbers of the corners of local cell c in VTK's order */
static PetscErrorCode FieldCellCorners(ResultsField field, PetscInt c, PetscInt v_start, PetscInt v_end,
                                       const PetscInt number[], PetscInt corners[])
{
  PetscInt *closure = NULL, n_points, vertices[8], n = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetTransitiveClosure(field->dm, c, PETSC_TRUE, &n_points, &closure));
  for (PetscInt i = 0; i < n_points; i++) {
    const PetscInt p = closure[2 * i];

    if (p >= v_start && p < v_end)
      vertices[n++] = number[p - v_start] < 0 ? -(number[p - v_start] + 1) : number[p - v_start];
  }
  PetscCall(DMPlexRestoreTransitiveClosure(field->dm, c, PETSC_TRUE, &n_points, &closure));
  for (PetscInt i = 0; i < field->xdmf.shape->n_nodes; i++) corners[i] = vertices[field->xdmf.shape->closure_order[i]];
  PetscFunctionReturn(0);
}

/* Fills connectivity[n_local][n_nodes] and part[n_local] of the owned cells */
static PetscErrorCode FieldGatherCells(ResultsField field, const PetscInt cell_part[], PetscInt connectivity[],
                                       PetscInt part[])
{
  IS              cells, vertices;
  const PetscInt *cell_number, *number;
  PetscInt        c_start, c_end, v_start, v_end, n = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(field->dm, 0, &c_start, &c_end));
  PetscCall(DMPlexGetDepthStratum(field->dm, 0, &v_start, &v_end));
  PetscCall(DMPlexGetCellNumbering(field->dm, &cells));
  PetscCall(DMPlexGetVertexNumbering(field->dm, &vertices));
  PetscCall(ISGetIndices(cells, &cell_number));
  PetscCall(ISGetIndices(vertices, &number));
  for (PetscInt c = c_start; c < c_end; c++) {
    if (cell_number[c - c_start] < 0) continue;
    PetscCall(FieldCellCorners(field, c, v_start, v_end, number, &connectivity[n * field->xdmf.shape->n_nodes]));
    part[n++] = cell_part[c - c_start];
  }
  PetscCall(ISRestoreIndices(cells, &cell_number));
  PetscCall(ISRestoreIndices(vertices, &number));
  PetscFunctionReturn(0);
}

/* Writes where the corners of each cell begin, and the end of the last, and the VTK type of each cell */
static PetscErrorCode FieldWriteShapes(ResultsField field)
{
  const PetscInt last = field->cells.first + field->cells.n_local == field->cells.n_global ? 1 : 0;
  ResultsRows    rows = {field->cells.first, field->cells.n_local, field->cells.n_global + 1};
  hid_t          integer;
  PetscInt      *offsets;
  unsigned char *types;

  PetscFunctionBeginUser;
  PetscCall(PetscDataTypeToHDF5DataType(PETSC_INT, &integer));
  rows.n_local += last; /* ranks without cells at the end write the same value */
  PetscCall(PetscMalloc2(rows.n_local, &offsets, rows.n_local, &types));
  for (PetscInt i = 0; i < rows.n_local; i++) {
    offsets[i] = (rows.first + i) * field->xdmf.shape->n_nodes;
    types[i]   = field->xdmf.shape->vtk;
  }
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/Offsets", integer, &rows, 1, offsets));
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/Types", H5T_NATIVE_UCHAR, &field->cells, 1, types));
  PetscCall(PetscFree2(offsets, types));
  PetscFunctionReturn(0);
}

/* Writes connectivity and the part of each cell */
static PetscErrorCode FieldWriteCells(ResultsField field, const PetscInt cell_part[])
{
  const PetscInt    n_nodes = field->xdmf.shape->n_nodes;
  const ResultsRows ids     = {field->cells.first * n_nodes, field->cells.n_local * n_nodes,
                               field->cells.n_global * n_nodes};
  PetscInt         *connectivity, *part;
  hid_t             integer;

  PetscFunctionBeginUser;
  PetscCall(PetscDataTypeToHDF5DataType(PETSC_INT, &integer));
  PetscCall(PetscMalloc2(ids.n_local, &connectivity, field->cells.n_local, &part));
  PetscCall(FieldGatherCells(field, cell_part, connectivity, part));
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/Connectivity", integer, &ids, 1, connectivity));
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/CellData/part", integer, &field->cells, 1, part));
  PetscCall(PetscFree2(connectivity, part));
  PetscFunctionReturn(0);
}

/* Writes the groups and the numbers of points, cells and corners, one value each */
static PetscErrorCode FieldWriteHead(ResultsField field)
{
  static const char *const type[]    = {"UnstructuredGrid"};
  static const char *const groups[]  = {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData"};
  static const char *const names[]   = {"/VTKHDF/NumberOfPoints", "/VTKHDF/NumberOfCells",
                                        "/VTKHDF/NumberOfConnectivityIds"};
  static const int         version[] = {1, 0};
  const PetscInt           counts[]  = {field->nodes.n_global, field->cells.n_global,
                                        field->cells.n_global * field->xdmf.shape->n_nodes};
  ResultsRows              one       = {0, 0, 1};
  PetscMPIInt              rank;
  hid_t                    integer;

  PetscFunctionBeginUser;
  PetscCall(PetscDataTypeToHDF5DataType(PETSC_INT, &integer));
  PetscCallMPI(MPI_Comm_rank(field->h5.comm, &rank));
  one.n_local = rank == 0 ? 1 : 0;
  for (int i = 0; i < 3; i++) PetscCall(OutFileH5Group(&field->h5, groups[i]));
  PetscCall(OutFileH5Integers(&field->h5, groups[0], "Version", 2, version));
  PetscCall(OutFileH5Strings(&field->h5, groups[0], "Type", 0, type));
  for (int i = 0; i < 3; i++) PetscCall(OutFileH5Write(&field->h5, names[i], integer, &one, 1, &counts[i]));
  PetscFunctionReturn(0);
}

/* Checks that the mesh is one that can be written, and counts its nodes and cells */
static PetscErrorCode FieldSetMesh(ResultsField field, DM dm)
{
  PetscInt dim;
  IS       numbering;

  PetscFunctionBeginUser;
  PetscCall(DMGetCoordinateDim(dm, &dim));
  PetscCheck(dim == 3, field->h5.comm, PETSC_ERR_SUP, "fields need a mesh in three dimensions, not %" PetscInt_FMT,
             dim);
  PetscCall(PetscObjectReference((PetscObject)dm));
  field->dm = dm;
  PetscCall(FieldFindShape(field));
  PetscCall(DMPlexGetVertexNumbering(dm, &numbering));
  PetscCall(RowsFromNumbering(field->h5.comm, numbering, &field->nodes));
  PetscCall(DMPlexGetCellNumbering(dm, &numbering));
  PetscCall(RowsFromNumbering(field->h5.comm, numbering, &field->cells));
  field->xdmf.n_nodes = field->nodes.n_global;
  field->xdmf.n_cells = field->cells.n_global;
  PetscFunctionReturn(0);
}

/* Raises failures of either file on all ranks; both are then removed */
static PetscErrorCode FieldCheck(ResultsField field)
{
  OutFile *const files[] = {&field->h5, &field->xdmf.file};

  PetscFunctionBeginUser;
  PetscCall(OutFilesCheck(2, files));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFieldOpen(Results results, const char name[], DM dm, PetscInt n_parts, const char *const parts[],
                                const PetscInt cell_part[], ResultsField *field)
{
  ResultsField f;
  PetscSection section;
  Vec          coordinates;

  PetscFunctionBeginUser;
  PetscCheck(dm, results->comm, PETSC_ERR_ARG_NULL, "fields need a mesh, and %s has none", name);
  PetscCall(PetscNew(&f));
  PetscCall(OutFileSetName(results, name, ".h5", &f->h5));
  PetscCall(OutFileSetName(results, name, ".xmf", &f->xdmf.file));
  PetscCall(PetscSNPrintf(f->xdmf.h5_name, sizeof(f->xdmf.h5_name), "%s.h5", name));
  PetscCall(FieldSetMesh(f, dm));
  PetscCall(OutFileOpenH5(&f->h5));
  PetscCall(OutFileOpenText(&f->xdmf.file));
  PetscCall(XdmfBegin(&f->xdmf, n_parts, parts));
  PetscCall(FieldCheck(f));
  PetscCall(FieldWriteHead(f));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(FieldWriteVector(f, "/VTKHDF/Points", section, coordinates));
  PetscCall(FieldWriteShapes(f));
  PetscCall(FieldWriteCells(f, cell_part));
  PetscCall(OutFileH5Strings(&f->h5, "/VTKHDF/CellData/part", "names", n_parts, parts));
  PetscCall(FieldCheck(f));
  *field = f;
  PetscFunctionReturn(0);
}

/* Writes the dataset `key``suffix` with its title; zero for x = NULL and where a support fixes the displacement */
static PetscErrorCode FieldWriteShape(ResultsField field, const char key[], const char suffix[], const char title[],
                                      Vec x)
{
  char         path[PETSC_MAX_PATH_LEN];
  PetscSection section;
  Vec          local;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/VTKHDF/PointData/%s%s", key, suffix));
  PetscCall(DMGetLocalSection(field->dm, &section));
  PetscCall(DMGetLocalVector(field->dm, &local));
  PetscCall(VecSet(local, 0));
  if (x) PetscCall(DMGlobalToLocal(field->dm, x, INSERT_VALUES, local));
  PetscCall(FieldWriteVector(field, path, section, local));
  PetscCall(DMRestoreLocalVector(field->dm, &local));
  PetscCall(OutFileH5Strings(&field->h5, path, "title", 0, &title));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFieldWriteMode(ResultsField field, const char key[], const char title[], Vec re, Vec im)
{
  PetscFunctionBeginUser;
  PetscCall(FieldWriteShape(field, key, "_re", title, re));
  PetscCall(FieldWriteShape(field, key, "_im", title, im));
  PetscCall(XdmfGridBegin(&field->xdmf, key, title, NULL));
  PetscCall(XdmfNodal(&field->xdmf, "displacement_re", key, "_re", 3));
  PetscCall(XdmfNodal(&field->xdmf, "displacement_im", key, "_im", 3));
  PetscCall(XdmfGridEnd(&field->xdmf));
  PetscCall(FieldCheck(field));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFieldWriteNodal(ResultsField field, const char title[], PetscInt n, const ResultsNodal arrays[])
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(arrays[i].width == 1 || arrays[i].width == 3, field->h5.comm, PETSC_ERR_ARG_OUTOFRANGE,
               "array %s has %" PetscInt_FMT " values per node, must be 1 or 3", arrays[i].key, arrays[i].width);
  }
  PetscCall(XdmfGridBegin(&field->xdmf, title, title, field->timed ? &field->time : NULL));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscSNPrintf(path, sizeof(path), "/VTKHDF/PointData/%s", arrays[i].key));
    PetscCall(FieldWriteNodes(field, path, NULL, arrays[i].width, arrays[i].values));
    PetscCall(OutFileH5Strings(&field->h5, path, "title", 0, &title));
    PetscCall(XdmfNodal(&field->xdmf, arrays[i].key, arrays[i].key, "", arrays[i].width));
  }
  PetscCall(XdmfGridEnd(&field->xdmf));
  PetscCall(FieldCheck(field));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFieldClose(ResultsField *field)
{
  PetscErrorCode failure;

  PetscFunctionBeginUser;
  if (!*field) PetscFunctionReturn(0);
  OutFile *const files[] = {&(*field)->h5, &(*field)->xdmf.file};

  PetscCall(XdmfEnd(&(*field)->xdmf));
  failure = OutFilesPublish(2, files);
  PetscCall(DMDestroy(&(*field)->dm));
  PetscCall(PetscFree(*field));
  PetscCall(failure);
  PetscFunctionReturn(0);
}
