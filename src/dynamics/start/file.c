/*
   What a run of modes left of one mode: its row of modes.csv, and mesh and shape in modes.h5.
*/
#include "shape.h"
#include "base/file.h"
#include <errno.h>
#include <hdf5.h>
#include <math.h>
#include <petscviewerhdf5.h>
#include <stdlib.h>
#include <string.h>

#define MAX_LINE 1024

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

/* Finds the row of a mode: lambda = growth (1/s), 2 pi freq (rad/s) */
static PetscErrorCode ShapeFindRow(FILE *file, const char name[], const ShapeSource *source, PetscReal lambda[2],
                                   Fault *fault)
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
    found = row[0] == (double)source->mode ? PETSC_TRUE : PETSC_FALSE;
    first = first > 0 ? first : row[0];
    last  = row[0];
  }
  if (!found && last > 0)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s %" PetscInt_FMT " is none of the modes %.6g to %.6g of %s",
                        source->number, source->mode, first, last, name));
  if (!found) PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s has no modes", name));
  lambda[0] = (PetscReal)row[2];
  lambda[1] = 2 * PETSC_PI * (PetscReal)row[1];
  PetscFunctionReturn(0);
}

/* Opens the table, NULL where that fails */
static PetscErrorCode ShapeOpenTable(const ShapeSource *source, char name[PETSC_MAX_PATH_LEN], FILE **file,
                                     Fault *fault)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, PETSC_MAX_PATH_LEN, "%s/modes.csv", source->dir));
  *file = FileStream(name, "r");
  if (!*file)
    PetscCall(FaultNote(fault, PETSC_ERR_FILE_OPEN, "cannot read %s: %s; %s needs the folder of a run of modes", name,
                        FileReason(errno), source->option));
  PetscFunctionReturn(0);
}

PetscErrorCode ShapeReadTable(const ShapeSource *source, PetscReal lambda[2], Fault *fault)
{
  char  name[PETSC_MAX_PATH_LEN];
  FILE *file;

  PetscFunctionBeginUser;
  PetscCall(ShapeOpenTable(source, name, &file, fault));
  if (file) PetscCall(ShapeFindRow(file, name, source, lambda, fault));
  if (file) (void)fclose(file);
  PetscFunctionReturn(0);
}

/* Numbers of the rows with unstable = 1 */
static PetscErrorCode ShapeListRows(FILE *file, const char name[], PetscInt *n, PetscInt **modes, Fault *fault)
{
  char     line[MAX_LINE] = "";
  PetscInt column[2], most = 0;
  double   number, unstable;

  PetscFunctionBeginUser;
  if (!fgets(line, sizeof(line), file)) line[0] = '\0';
  column[0] = CsvColumn(line, "mode");
  column[1] = CsvColumn(line, "unstable");
  if (PetscMin(column[0], column[1]) < 0)
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s lacks one of the columns mode, unstable", name));
  while (!fault->code && fgets(line, sizeof(line), file)) {
    line[strcspn(line, "\r\n")] = '\0';
    if (!CsvNumber(line, column[0], &number) || !CsvNumber(line, column[1], &unstable))
      PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s has a row without two numbers: %.80s", name, line));
    if (fault->code || unstable == 0) continue;
    if (*n == most) PetscCall(PetscRealloc(sizeof(**modes) * (size_t)(most = 2 * most + 16), modes));
    (*modes)[(*n)++] = (PetscInt)number;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ShapeListUnstable(MPI_Comm comm, const ShapeSource *source, PetscInt *n, PetscInt **modes)
{
  char  name[PETSC_MAX_PATH_LEN];
  Fault fault = {.code = 0};
  FILE *file;

  PetscFunctionBeginUser;
  *n     = 0;
  *modes = NULL;
  PetscCall(ShapeOpenTable(source, name, &file, &fault));
  if (file) PetscCall(ShapeListRows(file, name, n, modes, &fault));
  if (file) (void)fclose(file);
  PetscCall(FaultsRaise(comm, &fault));
  PetscFunctionReturn(0);
}

/* An open file, what is asked of it, and what is wrong */
typedef struct {
  const ShapeSource *source;
  hid_t              file;
  Fault             *fault;
} ShapeFile;

/* Reads dataset /VTKHDF/`path` of n_rows (any for -1), three numbers each or one index, which the caller frees */
static PetscErrorCode ShapeReadArray(const ShapeFile *from, const char path[], PetscDataType type, PetscInt *n_rows,
                                     void *values)
{
  const char  *name  = from->source->file;
  Fault *const fault = from->fault;
  const size_t width = type == PETSC_REAL ? 3 : 1;
  char         full[128];
  hsize_t      dims[2] = {0, 1};
  size_t       size;
  hid_t        set, space, native;
  int          n_dims;

  PetscFunctionBeginUser;
  *(void **)values = NULL;
  if (fault->code) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(full, sizeof(full), "/VTKHDF/%s", path));
  PetscCall(PetscDataTypeToHDF5DataType(type, &native));
  PetscCall(PetscDataTypeGetSize(type, &size));
  set    = H5Dopen2(from->file, full, H5P_DEFAULT);
  space  = H5Dget_space(set);
  n_dims = H5Sget_simple_extent_ndims(space);
  if (n_dims == 1 || n_dims == 2) (void)H5Sget_simple_extent_dims(space, dims, NULL);
  if ((n_dims != 1 && n_dims != 2) || dims[1] != (hsize_t)width || (*n_rows >= 0 && dims[0] != (hsize_t)*n_rows))
    PetscCall(
      FaultNote(fault, PETSC_ERR_USER_INPUT, "%s of %s has no fitting array %s", name, from->source->option, full));
  if (!fault->code) {
    *n_rows = (PetscInt)dims[0];
    PetscCall(PetscMalloc((size_t)dims[0] * width * size, values));
    if (H5Dread(set, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, *(void **)values) < 0)
      PetscCall(FaultNote(fault, PETSC_ERR_FILE_READ, "cannot read %s of %s of %s", full, name, from->source->option));
  }
  (void)H5Sclose(space);
  (void)H5Dclose(set);
  PetscFunctionReturn(0);
}

/* Checks that the cells of the file have nodes that it holds */
static PetscErrorCode ShapeCheckCells(const ShapeFile *from, const Shape *shape, PetscInt n_ids)
{
  PetscBool good = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (from->fault->code) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n_ids; i++) good = good && shape->nodes[i] >= 0 && shape->nodes[i] < shape->n_points;
  for (PetscInt c = 0; c < shape->n_cells; c++) good = good && shape->first[c] < shape->first[c + 1];
  if (shape->n_cells < 0 || shape->first[0] != 0 || shape->first[shape->n_cells] != n_ids) good = PETSC_FALSE;
  if (!good)
    PetscCall(FaultNote(from->fault, PETSC_ERR_USER_INPUT, "%s/%s has cells at nodes that it lacks", from->source->dir,
                        from->source->file));
  PetscFunctionReturn(0);
}

/* Checks by the title of the shape, "7: 3458.21 Hz, ...", that it belongs to the table, freq in Hz, to the digits
   of a title */
static PetscErrorCode ShapeCheckTitle(const ShapeFile *from, const char key[], double freq)
{
  char   path[128], title[256] = "";
  double written = 0;
  hid_t  attribute, type;

  PetscFunctionBeginUser;
  if (from->fault->code) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof(path), "/VTKHDF/%s", key));
  attribute = H5Aopen_by_name(from->file, path, "title", H5P_DEFAULT, H5P_DEFAULT);
  type      = H5Aget_type(attribute);
  if (H5Tget_class(type) == H5T_STRING && !H5Tis_variable_str(type) && H5Tget_size(type) < sizeof(title))
    (void)H5Aread(attribute, type, title);
  if (sscanf(title, "%*d: %lf Hz", &written) != 1 || fabs(written - freq) > 1e-5 * fabs(freq))
    PetscCall(FaultNote(from->fault, PETSC_ERR_USER_INPUT,
                        "%s of %s calls %s '%s', modes.csv has %.6g Hz: they are of different runs", from->source->file,
                        from->source->option, key, title, freq));
  (void)H5Tclose(type);
  (void)H5Aclose(attribute);
  PetscFunctionReturn(0);
}

PetscErrorCode ShapeReadField(const ShapeSource *source, PetscReal omega, Shape *shape, Fault *fault)
{
  char      name[PETSC_MAX_PATH_LEN], key[2][64];
  PetscInt  n_ids = -1, n_offsets = -1;
  ShapeFile from = {.source = source, .fault = fault};

  PetscFunctionBeginUser;
  if (fault->code) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/%s", source->dir, source->file));
  for (int i = 0; i < 2; i++)
    PetscCall(PetscSNPrintf(key[i], sizeof(key[i]), "PointData/mode_%03d%s_%s", (int)source->mode, source->kind,
                            i ? "im" : "re"));
  from.file = FileH5Open(name);
  if (from.file < 0)
    PetscCall(FaultNote(fault, PETSC_ERR_FILE_OPEN, "cannot read %s, which a run of modes writes with %s, for %s", name,
                        source->made_by, source->option));
  shape->n_points = -1;
  PetscCall(ShapeReadArray(&from, "Points", PETSC_REAL, &shape->n_points, &shape->points));
  PetscCall(ShapeReadArray(&from, "Connectivity", PETSC_INT, &n_ids, &shape->nodes));
  PetscCall(ShapeReadArray(&from, "Offsets", PETSC_INT, &n_offsets, &shape->first));
  PetscCall(ShapeReadArray(&from, key[0], PETSC_REAL, &shape->n_points, &shape->re));
  PetscCall(ShapeReadArray(&from, key[1], PETSC_REAL, &shape->n_points, &shape->im));
  PetscCall(ShapeCheckTitle(&from, key[0], (double)(omega / (2 * PETSC_PI))));
  if (from.file >= 0) (void)H5Fclose(from.file);
  shape->n_cells = n_offsets - 1;
  PetscCall(ShapeCheckCells(&from, shape, n_ids));
  PetscFunctionReturn(0);
}
