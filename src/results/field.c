/*
   Fields - mesh, complex shapes and states in one HDF5 file, laid out as VTK's VTKHDF unstructured grid:

      /VTKHDF  (Version, Type)    NumberOfPoints, NumberOfCells, NumberOfConnectivityIds    [1]
         Points [nodes][3] m      Connectivity, the nodes of the cells   Offsets [cells + 1]   Types [cells]
         Mixed, for each cell the XDMF type and its nodes, in a mesh of several elements
         PointData/<key>_re, <key>_im [nodes][3] m, attribute title       a shape
         PointData/<key>_<more> [nodes] or [nodes][3], attribute title    what goes with it, its unit in the name
         PointData/<key> [nodes] or [nodes][3], attribute title           an array of a state, its unit in the key
         CellData/part [cells], attribute names

   The XDMF file beside it (xdmf.c) points at the same datasets. Every node and cell appears once, in the order of the
   ranks that own them. Reference: VTK File Formats, section VTKHDF, version 1.0.
*/
#include "resultsimpl.h"
#include <petscviewerhdf5.h>

/* The rows of this rank, n_local of them, after those of the ranks before */
static PetscErrorCode RowsSet(MPI_Comm comm, PetscInt n_local, ResultsRows *rows)
{
  PetscFunctionBeginUser;
  *rows = (ResultsRows){.n_local = n_local};
  PetscCallMPI(MPI_Exscan(&rows->n_local, &rows->first, 1, MPIU_INT, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(&rows->n_local, &rows->n_global, 1, MPIU_INT, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

/* Writes an array [local nodes][width] as dataset `path`, [nodes][width] */
static PetscErrorCode FieldWriteNodes(ResultsField field, const char path[], PetscInt width, const PetscReal array[])
{
  const Mesh *mesh = field->mesh;
  PetscReal  *values;
  PetscInt    n = 0;
  hid_t       real;

  PetscFunctionBeginUser;
  PetscCall(PetscDataTypeToHDF5DataType(PETSC_REAL, &real));
  PetscCall(PetscMalloc1(width * field->nodes.n_local, &values));
  for (PetscInt i = 0; i < width * mesh->n_nodes; i++)
    if (mesh->owned[i / width]) values[n++] = array[i];
  PetscCall(OutFileH5Write(&field->h5, path, real, &field->nodes, width, values));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

/* Writes where the nodes of each cell begin, and the end of the last, and the VTK type of each cell */
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
  for (PetscInt i = 0; i < rows.n_local; i++) offsets[i] = field->ids.first + field->mesh->cell_first[i];
  for (PetscInt i = 0; i < field->cells.n_local; i++) types[i] = (unsigned char)field->mesh->element[i]->vtk;
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/Offsets", integer, &rows, 1, offsets));
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/Types", H5T_NATIVE_UCHAR, &field->cells, 1, types));
  PetscCall(PetscFree2(offsets, types));
  PetscFunctionReturn(0);
}

/* Writes connectivity and the part of each cell */
static PetscErrorCode FieldWriteCells(ResultsField field)
{
  const Mesh *mesh = field->mesh;
  PetscInt   *connectivity;
  hid_t       integer;

  PetscFunctionBeginUser;
  PetscCall(PetscDataTypeToHDF5DataType(PETSC_INT, &integer));
  PetscCall(PetscMalloc1(field->ids.n_local, &connectivity));
  for (PetscInt i = 0; i < field->ids.n_local; i++) connectivity[i] = mesh->number[mesh->cell_node[i]];
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/Connectivity", integer, &field->ids, 1, connectivity));
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/CellData/part", integer, &field->cells, 1, mesh->cell_part));
  PetscCall(PetscFree(connectivity));
  PetscFunctionReturn(0);
}

/* Writes the XDMF type and nodes of each cell, which XDMF wants of a mesh of several elements */
static PetscErrorCode FieldWriteMixed(ResultsField field)
{
  const Mesh       *mesh = field->mesh;
  const ResultsRows rows = {field->ids.first + field->cells.first, field->ids.n_local + field->cells.n_local,
                            field->ids.n_global + field->cells.n_global};
  PetscInt         *mixed, n = 0;
  hid_t             integer;

  PetscFunctionBeginUser;
  if (field->xdmf.element) PetscFunctionReturn(0);
  PetscCall(PetscDataTypeToHDF5DataType(PETSC_INT, &integer));
  PetscCall(PetscMalloc1(rows.n_local, &mixed));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    mixed[n++] = mesh->element[c]->xdmf_number;
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1]; i++)
      mixed[n++] = mesh->number[mesh->cell_node[i]];
  }
  PetscCall(OutFileH5Write(&field->h5, "/VTKHDF/Mixed", integer, &rows, 1, mixed));
  PetscCall(PetscFree(mixed));
  PetscFunctionReturn(0);
}

/* Writes the groups and the numbers of points, cells and their nodes, one value each */
static PetscErrorCode FieldWriteHead(ResultsField field)
{
  static const char *const type[]    = {"UnstructuredGrid"};
  static const char *const groups[]  = {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData"};
  static const char *const names[]   = {"/VTKHDF/NumberOfPoints", "/VTKHDF/NumberOfCells",
                                        "/VTKHDF/NumberOfConnectivityIds"};
  static const int         version[] = {1, 0};
  const PetscInt           counts[]  = {field->nodes.n_global, field->cells.n_global, field->ids.n_global};
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

/* Row i of the table of elements, after which points follow */
static const Element *FieldElement(PetscInt i)
{
  const Element *element = ElementGet(i);

  return !element && i > 0 && ElementGet(i - 1) ? ElementPoint() : element;
}

/* The element that all cells of all ranks are of, NULL where there are several */
static PetscErrorCode FieldFindElement(MPI_Comm comm, const Mesh *mesh, const Element **element)
{
  PetscInt row[2] = {-ELEMENT_MAX_ROWS, -1}; /* the negative first and the last row of the table */

  PetscFunctionBeginUser;
  for (PetscInt i = 0; FieldElement(i); i++)
    for (PetscInt c = 0; c < mesh->n_cells; c++) {
      if (mesh->element[c] != FieldElement(i)) continue;
      row[0] = PetscMax(row[0], -i);
      row[1] = i;
      break;
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, row, 2, MPIU_INT, MPI_MAX, comm));
  *element = -row[0] == row[1] ? FieldElement(row[1]) : NULL;
  PetscFunctionReturn(0);
}

/* Counts nodes and cells, and the nodes of the cells */
static PetscErrorCode FieldSetMesh(ResultsField field, const Mesh *mesh)
{
  PetscInt n_nodes = 0;

  PetscFunctionBeginUser;
  field->mesh = mesh;
  PetscCall(FieldFindElement(field->h5.comm, mesh, &field->xdmf.element));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) n_nodes += mesh->owned[v];
  PetscCall(RowsSet(field->h5.comm, n_nodes, &field->nodes));
  PetscCall(RowsSet(field->h5.comm, mesh->n_cells, &field->cells));
  field->xdmf.n_nodes = field->nodes.n_global;
  PetscCall(RowsSet(field->h5.comm, mesh->cell_first[mesh->n_cells], &field->ids));
  field->xdmf.n_cells = field->cells.n_global;
  field->xdmf.n_ids   = field->ids.n_global;
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

PetscErrorCode ResultsFieldOpen(Results results, const char name[], const Mesh *mesh, ResultsField *field)
{
  ResultsField f;

  PetscFunctionBeginUser;
  PetscCheck(mesh, results->comm, PETSC_ERR_ARG_NULL, "fields need a mesh, and %s has none", name);
  PetscCall(PetscNew(&f));
  PetscCall(OutFileSetName(results, name, ".h5", &f->h5));
  PetscCall(OutFileSetName(results, name, ".xmf", &f->xdmf.file));
  PetscCall(PetscSNPrintf(f->xdmf.h5_name, sizeof(f->xdmf.h5_name), "%s.h5", name));
  PetscCall(FieldSetMesh(f, mesh));
  PetscCall(OutFileOpenH5(&f->h5));
  PetscCall(OutFileOpenText(&f->xdmf.file));
  PetscCall(XdmfBegin(&f->xdmf, mesh->n_parts, mesh->part));
  PetscCall(FieldCheck(f));
  PetscCall(FieldWriteHead(f));
  PetscCall(FieldWriteNodes(f, "/VTKHDF/Points", 3, mesh->x));
  PetscCall(FieldWriteShapes(f));
  PetscCall(FieldWriteCells(f));
  PetscCall(FieldWriteMixed(f));
  PetscCall(OutFileH5Strings(&f->h5, "/VTKHDF/CellData/part", "names", mesh->n_parts, mesh->part));
  PetscCall(FieldCheck(f));
  *field = f;
  PetscFunctionReturn(0);
}

/* Writes the dataset `key``suffix` with its title */
static PetscErrorCode FieldWriteArray(ResultsField field, const char key[], const char suffix[], const char title[],
                                      PetscInt width, const PetscReal array[])
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/VTKHDF/PointData/%s%s", key, suffix));
  PetscCall(FieldWriteNodes(field, path, width, array));
  PetscCall(OutFileH5Strings(&field->h5, path, "title", 0, &title));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFieldWriteMode(ResultsField field, const char key[], const char title[], const PetscReal re[],
                                     const PetscReal im[], const ResultsNodal *more)
{
  char suffix[64];

  PetscFunctionBeginUser;
  PetscCall(FieldWriteArray(field, key, "_re", title, 3, re));
  PetscCall(FieldWriteArray(field, key, "_im", title, 3, im));
  PetscCall(XdmfGridBegin(&field->xdmf, key, title, NULL));
  PetscCall(XdmfNodal(&field->xdmf, "displacement_re", key, "_re", 3));
  PetscCall(XdmfNodal(&field->xdmf, "displacement_im", key, "_im", 3));
  if (more) {
    PetscCall(PetscSNPrintf(suffix, sizeof(suffix), "_%s", more->key));
    PetscCall(FieldWriteArray(field, key, suffix, title, more->width, more->values));
    PetscCall(XdmfNodal(&field->xdmf, more->key, key, suffix, more->width));
  }
  PetscCall(XdmfGridEnd(&field->xdmf));
  PetscCall(FieldCheck(field));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFieldWriteNodal(ResultsField field, const char title[], PetscInt n, const ResultsNodal arrays[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(arrays[i].width == 1 || arrays[i].width == 3, field->h5.comm, PETSC_ERR_ARG_OUTOFRANGE,
               "array %s has %" PetscInt_FMT " values per node, must be 1 or 3", arrays[i].key, arrays[i].width);
  }
  PetscCall(XdmfGridBegin(&field->xdmf, title, title, field->timed ? &field->time : NULL));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(FieldWriteArray(field, arrays[i].key, "", title, arrays[i].width, arrays[i].values));
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
  PetscCall(PetscFree(*field));
  PetscCall(failure);
  PetscFunctionReturn(0);
}
