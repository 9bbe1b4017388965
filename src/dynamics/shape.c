/*
   Shape: one complex mode, read from the files of a run of modes and laid on the mesh of this run.

   A place in space does not name a node, since nodes of bodies in contact may coincide; cells do not overlap, so that
   their centres are unique. Every local cell is looked up by its centre, and then its corners among those of the cell
   found. Cells of the file are sorted by their height along an oblique direction: few centres of a regular mesh share
   one.
*/
#include "checkpoint.h"
#include "base/fault.h"
#include <errno.h>
#include <hdf5.h>
#include <math.h>
#include <petscviewerhdf5.h>
#include <stdlib.h>
#include <string.h>

#define TOLERANCE 1e-9 /* of positions, relative to the diagonal of the mesh */
#define MAX_LINE  1024

/* Powers -1, -2 and -4 of the plastic number (p^3 = p + 1): a unit vector without small rational ratios */
static const PetscReal oblique[3] = {0.754877666246692760, 0.569840290998053266, 0.324717957244746026};

/* Mesh and shape of the file */
typedef struct {
  PetscInt   n_points, n_cells;
  PetscReal *points, *re, *im; /* [n_points][3], m */
  PetscInt  *corners;          /* [n_cells][n_nodes] */
  PetscReal *centres;          /* [n_cells][3], m */
  PetscReal *height;           /* [n_cells] ascending: places of the centres along `oblique`, m */
  PetscInt  *cell;             /* [n_cells] of each height */
  PetscReal  tolerance;        /* m */
} Shape;

/* Field i (from 0) of a line of CSV, without quotes; false where the line has fewer */
static PetscBool CsvField(const char line[], PetscInt i, char field[MAX_LINE])
{
  PetscBool quoted = PETSC_FALSE;
  size_t    n      = 0;

  for (; *line && *line != '\n' && *line != '\r' && i >= 0; line++) {
    if (*line == '"')
      quoted = quoted ? PETSC_FALSE : PETSC_TRUE;
    else if (*line == ',' && !quoted)
      i--;
    else if (i == 0 && n < MAX_LINE - 1)
      field[n++] = *line;
  }
  field[n] = '\0';
  return i <= 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Number in field i of a line; false where there is none */
static PetscBool CsvNumber(const char line[], PetscInt i, double *value)
{
  char field[MAX_LINE], *end;

  if (i < 0 || !CsvField(line, i, field)) return PETSC_FALSE;
  *value = strtod(field, &end);
  return end > field && !*end ? PETSC_TRUE : PETSC_FALSE;
}

/* Index of a column of the header, -1 without one */
static PetscInt CsvColumn(const char header[], const char name[])
{
  char field[MAX_LINE];

  for (PetscInt i = 0; CsvField(header, i, field); i++) {
    if (!strcmp(field, name)) return i;
    if (!field[0]) return -1;
  }
  return -1;
}

/* Finds the row of a mode */
static PetscErrorCode ShapeFindRow(FILE *file, const char name[], PetscInt mode, PetscReal lambda[2], Fault *fault)
{
  char      line[MAX_LINE] = "";
  PetscInt  columns[3];
  PetscBool found  = PETSC_FALSE;
  double    row[3] = {0, 0, 0}, first = 0, last = 0;

  PetscFunctionBeginUser;
  if (!fgets(line, sizeof(line), file)) line[0] = '\0';
  columns[0] = CsvColumn(line, "mode");
  columns[1] = CsvColumn(line, "freq_hz");
  columns[2] = CsvColumn(line, "growth_rad_s");
  if (PetscMin(columns[0], PetscMin(columns[1], columns[2])) < 0)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s lacks one of the columns mode, freq_hz, growth_rad_s", name));
  while (!fault->code && !found && fgets(line, sizeof(line), file)) {
    line[strcspn(line, "\r\n")] = '\0';
    for (int i = 0; i < 3; i++)
      if (!CsvNumber(line, columns[i], &row[i]))
        PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s has a row without three numbers: %.80s", name, line));
    found = row[0] == (double)mode ? PETSC_TRUE : PETSC_FALSE;
    first = first > 0 ? first : row[0];
    last  = row[0];
  }
  if (!found && last > 0)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                        "-dynamics_shape_mode %" PetscInt_FMT " is none of the modes %.6g to %.6g of %s", mode, first,
                        last, name));
  if (!found) PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s has no modes", name));
  lambda[0] = (PetscReal)row[2];
  lambda[1] = 2 * PETSC_PI * (PetscReal)row[1];
  PetscFunctionReturn(0);
}

/* Reads lambda of the mode from modes.csv */
static PetscErrorCode ShapeReadTable(const char dir[], PetscInt mode, PetscReal lambda[2], Fault *fault)
{
  char  name[PETSC_MAX_PATH_LEN];
  FILE *file;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/modes.csv", dir));
  file = fopen(name, "r");
  if (!file)
    PetscCall(FaultNote(fault, PETSC_ERR_FILE_OPEN,
                        "cannot read %s: %s; -dynamics_shape needs the folder of a run of modes", name,
                        strerror(errno)));
  if (file) PetscCall(ShapeFindRow(file, name, mode, lambda, fault));
  if (file) (void)fclose(file);
  PetscFunctionReturn(0);
}

/* Reads dataset /VTKHDF/`path` of n_rows (any for -1) times `width` values, which the caller frees */
static PetscErrorCode ShapeReadArray(hid_t file, const char path[], PetscDataType type, PetscInt width,
                                     PetscInt *n_rows, void *values, Fault *fault)
{
  char    full[128];
  hsize_t dims[2] = {0, 1};
  size_t  size;
  hid_t   set, space, native;
  int     n_dims;

  PetscFunctionBeginUser;
  *(void **)values = NULL;
  if (fault->code) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(full, sizeof(full), "/VTKHDF/%s", path));
  PetscCall(PetscDataTypeToHDF5DataType(type, &native));
  PetscCall(PetscDataTypeGetSize(type, &size));
  set    = H5Dopen2(file, full, H5P_DEFAULT);
  space  = H5Dget_space(set);
  n_dims = H5Sget_simple_extent_ndims(space);
  if (n_dims == 1 || n_dims == 2) (void)H5Sget_simple_extent_dims(space, dims, NULL);
  if ((n_dims != 1 && n_dims != 2) || dims[1] != (hsize_t)width || (*n_rows >= 0 && dims[0] != (hsize_t)*n_rows))
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "modes.h5 of -dynamics_shape has no fitting array %s", full));
  if (!fault->code) {
    *n_rows = (PetscInt)dims[0];
    PetscCall(PetscMalloc((size_t)dims[0] * (size_t)width * size, values));
    if (H5Dread(set, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, *(void **)values) < 0)
      PetscCall(FaultNote(fault, PETSC_ERR_FILE_READ, "cannot read %s of modes.h5 of -dynamics_shape", full));
  }
  (void)H5Sclose(space);
  (void)H5Dclose(set);
  PetscFunctionReturn(0);
}

/* Checks by the title of the shape, "7: 3458.21 Hz, ...", that it belongs to the table, freq in Hz */
static PetscErrorCode ShapeCheckTitle(hid_t file, const char key[], double freq, Fault *fault)
{
  char   path[128], title[256] = "";
  double written = 0;
  hid_t  attribute, type;

  PetscFunctionBeginUser;
  if (fault->code) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof(path), "/VTKHDF/%s", key));
  attribute = H5Aopen_by_name(file, path, "title", H5P_DEFAULT, H5P_DEFAULT);
  type      = H5Aget_type(attribute);
  if (H5Tget_class(type) == H5T_STRING && !H5Tis_variable_str(type) && H5Tget_size(type) < sizeof(title))
    (void)H5Aread(attribute, type, title);
  if (sscanf(title, "%*d: %lf Hz", &written) != 1 || fabs(written - freq) > 1e-5 * fabs(freq))
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                        "modes.h5 of -dynamics_shape calls %s '%s', modes.csv has %.6g Hz: they are of different runs",
                        key, title, freq));
  (void)H5Tclose(type);
  (void)H5Aclose(attribute);
  PetscFunctionReturn(0);
}

/* Reads mesh and shape from modes.h5 */
static PetscErrorCode ShapeReadField(const char dir[], PetscInt mode, PetscReal omega, PetscInt n_nodes, Shape *shape,
                                     Fault *fault)
{
  char     name[PETSC_MAX_PATH_LEN], key[2][64];
  PetscInt n_corners = -1;
  hid_t    file;

  PetscFunctionBeginUser;
  if (fault->code) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/modes.h5", dir));
  for (int i = 0; i < 2; i++)
    PetscCall(PetscSNPrintf(key[i], sizeof(key[i]), "PointData/mode_%03d_%s", (int)mode, i ? "im" : "re"));
  file = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
    PetscCall(FaultNote(fault, PETSC_ERR_FILE_OPEN,
                        "cannot read %s, which a run of modes writes with -output_fields, for -dynamics_shape", name));
  shape->n_points = -1;
  PetscCall(ShapeReadArray(file, "Points", PETSC_REAL, 3, &shape->n_points, &shape->points, fault));
  PetscCall(ShapeReadArray(file, "Connectivity", PETSC_INT, 1, &n_corners, &shape->corners, fault));
  PetscCall(ShapeReadArray(file, key[0], PETSC_REAL, 3, &shape->n_points, &shape->re, fault));
  PetscCall(ShapeReadArray(file, key[1], PETSC_REAL, 3, &shape->n_points, &shape->im, fault));
  PetscCall(ShapeCheckTitle(file, key[0], (double)(omega / (2 * PETSC_PI)), fault));
  if (file >= 0) (void)H5Fclose(file);
  for (PetscInt i = 0; i < n_corners && !fault->code; i++)
    if (shape->corners[i] < 0 || shape->corners[i] >= shape->n_points)
      PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s has cells at nodes that it lacks", name));
  shape->n_cells = n_corners / n_nodes;
  PetscFunctionReturn(0);
}

static PetscReal ShapeHeight(const PetscReal x[3])
{
  return oblique[0] * x[0] + oblique[1] * x[1] + oblique[2] * x[2];
}

static PetscReal ShapeDistance(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}

/* Tolerance, centres, and cells by height */
static PetscErrorCode ShapeSort(Shape *shape, PetscInt n_nodes)
{
  PetscReal lower[3], upper[3];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) lower[d] = PETSC_MAX_REAL, upper[d] = PETSC_MIN_REAL;
  for (PetscInt i = 0; i < 3 * shape->n_points; i++) {
    lower[i % 3] = PetscMin(lower[i % 3], shape->points[i]);
    upper[i % 3] = PetscMax(upper[i % 3], shape->points[i]);
  }
  shape->tolerance = TOLERANCE * ShapeDistance(lower, upper);
  PetscCall(PetscCalloc1(3 * shape->n_cells, &shape->centres));
  PetscCall(PetscMalloc2(shape->n_cells, &shape->height, shape->n_cells, &shape->cell));
  for (PetscInt c = 0; c < shape->n_cells; c++) {
    PetscReal *const x = &shape->centres[3 * c];

    for (PetscInt i = 0; i < n_nodes; i++)
      for (int d = 0; d < 3; d++) x[d] += shape->points[3 * shape->corners[n_nodes * c + i] + d] / (PetscReal)n_nodes;
    shape->height[c] = ShapeHeight(x);
    shape->cell[c]   = c;
  }
  PetscCall(PetscSortRealWithArrayInt(shape->n_cells, shape->height, shape->cell));
  PetscFunctionReturn(0);
}

/* Cell of the file with this centre, -1 without one */
static PetscInt ShapeFindCell(const Shape *shape, const PetscReal centre[3])
{
  const PetscReal height = ShapeHeight(centre);
  PetscInt        low = 0, high = shape->n_cells;

  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;

    if (shape->height[middle] < height - shape->tolerance)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < shape->n_cells && shape->height[low] <= height + shape->tolerance; low++)
    if (ShapeDistance(&shape->centres[3 * shape->cell[low]], centre) <= shape->tolerance) return shape->cell[low];
  return -1;
}

/* Point of the file at x among the corners of a cell, -1 without one */
static PetscInt ShapeFindCorner(const Shape *shape, PetscInt n_nodes, PetscInt cell, const PetscReal x[3])
{
  for (PetscInt i = 0; i < n_nodes && cell >= 0; i++) {
    const PetscInt p = shape->corners[n_nodes * cell + i];

    if (ShapeDistance(&shape->points[3 * p], x) <= shape->tolerance) return p;
  }
  return -1;
}

/* Lays the shape on the corners of local cell c */
static PetscErrorCode ShapeFillCell(Model model, const Shape *shape, PetscInt c, PetscInt n_nodes, PetscReal re[],
                                    PetscReal im[], Fault *fault)
{
  PetscInt  vertices[ELEMENT_MAX_NODES], cell;
  PetscReal x[3 * ELEMENT_MAX_NODES], centre[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(ModelGetCell(model, c, vertices, x));
  for (PetscInt i = 0; i < 3 * n_nodes; i++) centre[i % 3] += x[i] / (PetscReal)n_nodes;
  cell = ShapeFindCell(shape, centre);
  for (PetscInt i = 0; i < n_nodes && !fault->code; i++) {
    const PetscInt v = vertices[i], p = ShapeFindCorner(shape, n_nodes, cell, &x[3 * i]);

    if (p < 0)
      PetscCall(
        FaultNote(fault, PETSC_ERR_USER_INPUT,
                  "the mesh of -dynamics_shape has no node at %.9g, %.9g, %.9g m of a cell about %.9g, %.9g, %.9g "
                  "m; it must be the mesh of this run",
                  (double)x[3 * i], (double)x[3 * i + 1], (double)x[3 * i + 2], (double)centre[0], (double)centre[1],
                  (double)centre[2]));
    for (int d = 0; d < 3 && p >= 0; d++) re[3 * v + d] = shape->re[3 * p + d], im[3 * v + d] = shape->im[3 * p + d];
  }
  PetscFunctionReturn(0);
}

/* Lays the shape on all local cells */
static PetscErrorCode ShapeFillCells(MPI_Comm comm, Model model, const Shape *shape, PetscInt n_nodes, PetscReal re[],
                                     PetscReal im[], Fault *fault)
{
  const Mesh *mesh;
  PetscInt    n_cells;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(PetscArrayzero(re, 3 * mesh->n_vertices));
  PetscCall(PetscArrayzero(im, 3 * mesh->n_vertices));
  n_cells = mesh->n_cells;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_cells, 1, MPIU_INT, MPI_SUM, comm));
  for (PetscInt c = 0; c < mesh->n_cells && !fault->code; c++)
    PetscCall(ShapeFillCell(model, shape, c, n_nodes, re, im, fault));
  PetscCall(FaultsAgree(comm, fault)); /* a place says more than numbers */
  if (n_cells != shape->n_cells)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT,
                        "the mesh of -dynamics_shape has %" PetscInt_FMT " cells, that of this run %" PetscInt_FMT,
                        shape->n_cells, n_cells));
  PetscFunctionReturn(0);
}

PetscErrorCode ShapeRead(MPI_Comm comm, Model model, const char dir[], PetscInt mode, PetscReal re[], PetscReal im[],
                         PetscReal lambda[2])
{
  const Element *element;
  Shape          shape = {.n_cells = 0};
  Fault          fault = {.code = 0};

  PetscFunctionBeginUser;
  PetscCall(ModelGetElement(model, &element));
  PetscCall(ShapeReadTable(dir, mode, lambda, &fault));
  PetscCall(ShapeReadField(dir, mode, lambda[1], element->n_nodes, &shape, &fault));
  PetscCall(FaultsAgree(comm, &fault));
  if (!fault.code) {
    PetscCall(ShapeSort(&shape, element->n_nodes));
    PetscCall(ShapeFillCells(comm, model, &shape, element->n_nodes, re, im, &fault));
  }
  PetscCall(PetscFree(shape.points));
  PetscCall(PetscFree(shape.re));
  PetscCall(PetscFree(shape.im));
  PetscCall(PetscFree(shape.corners));
  PetscCall(PetscFree(shape.centres));
  PetscCall(PetscFree2(shape.height, shape.cell));
  PetscCall(FaultsRaise(comm, &fault));
  PetscFunctionReturn(0);
}
