/*
   What a run of modes left of one mode: its row of modes.csv, and mesh and shape in modes.h5.
*/
#include "shape.h"
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

PetscErrorCode ShapeReadTable(const char dir[], PetscInt mode, PetscReal lambda[2], Fault *fault)
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

/* Reads dataset /VTKHDF/`path` of n_rows (any for -1), three numbers each or one index, which the caller frees */
static PetscErrorCode ShapeReadArray(hid_t file, const char path[], PetscDataType type, PetscInt *n_rows, void *values,
                                     Fault *fault)
{
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
  set    = H5Dopen2(file, full, H5P_DEFAULT);
  space  = H5Dget_space(set);
  n_dims = H5Sget_simple_extent_ndims(space);
  if (n_dims == 1 || n_dims == 2) (void)H5Sget_simple_extent_dims(space, dims, NULL);
  if ((n_dims != 1 && n_dims != 2) || dims[1] != (hsize_t)width || (*n_rows >= 0 && dims[0] != (hsize_t)*n_rows))
    PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "modes.h5 of -dynamics_shape has no fitting array %s", full));
  if (!fault->code) {
    *n_rows = (PetscInt)dims[0];
    PetscCall(PetscMalloc((size_t)dims[0] * width * size, values));
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

PetscErrorCode ShapeReadField(const char dir[], PetscInt mode, PetscReal omega, Shape *shape, Fault *fault)
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
  PetscCall(ShapeReadArray(file, "Points", PETSC_REAL, &shape->n_points, &shape->points, fault));
  PetscCall(ShapeReadArray(file, "Connectivity", PETSC_INT, &n_corners, &shape->corners, fault));
  PetscCall(ShapeReadArray(file, key[0], PETSC_REAL, &shape->n_points, &shape->re, fault));
  PetscCall(ShapeReadArray(file, key[1], PETSC_REAL, &shape->n_points, &shape->im, fault));
  PetscCall(ShapeCheckTitle(file, key[0], (double)(omega / (2 * PETSC_PI)), fault));
  if (file >= 0) (void)H5Fclose(file);
  for (PetscInt i = 0; i < n_corners && !fault->code; i++)
    if (shape->corners[i] < 0 || shape->corners[i] >= shape->n_points)
      PetscCall(FaultNote(fault, PETSC_ERR_USER_INPUT, "%s has cells at nodes that it lacks", name));
  shape->n_cells = n_corners / shape->n_nodes;
  PetscFunctionReturn(0);
}
