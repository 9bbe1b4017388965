/*
   Unit test of ResultsFieldWriteNodal(): arrays at the nodes, read back from the HDF5 file, and their XDMF grids.

   The values are functions of the place: the vector is the node's position x (m), the scalar x + 2 y + 4 z. The values
   that a rank gives for vertices of other ranks are spoilt, so that each row must come from the owner, and once.
*/
#include <squeal/results.h>
#include <hdf5.h>
#include <petscsf.h>
#include <string.h>
#include <sys/stat.h>
#include "boxmesh.h"
#include "check.h"
#include "scratch.h"

#define N_NODES ((5 + 1) * (4 + 1) * (3 + 1))
#define SPOILT  -1e300

/* Values at the local vertices: position [n][3] and a scalar [n]; SPOILT where another rank owns the vertex */
static PetscErrorCode CreateValues(DM dm, PetscReal **position, PetscReal **scalar)
{
  PetscInt           start, end, n_leaves, offset;
  const PetscInt    *leaves;
  const PetscScalar *x;
  PetscSection       section;
  PetscSF            sf;
  Vec                coordinates;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &start, &end));
  PetscCall(PetscMalloc2(3 * (end - start), position, end - start, scalar));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecGetArrayRead(coordinates, &x));
  for (PetscInt v = start, i = 0; v < end; v++, i++) {
    PetscCall(PetscSectionGetOffset(section, v, &offset));
    for (int d = 0; d < 3; d++) (*position)[3 * i + d] = x[offset + d];
    (*scalar)[i] = x[offset] + 2 * x[offset + 1] + 4 * x[offset + 2];
  }
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  PetscCall(DMGetPointSF(dm, &sf));
  PetscCall(PetscSFGetGraph(sf, NULL, &n_leaves, &leaves, NULL));
  for (PetscInt l = 0; l < n_leaves; l++) {
    const PetscInt i = (leaves ? leaves[l] : l) - start;

    if (i < 0 || i >= end - start) continue;
    for (int d = 0; d < 3; d++) (*position)[3 * i + d] = SPOILT;
    (*scalar)[i] = SPOILT;
  }
  PetscFunctionReturn(0);
}

/* Writes two states, of two arrays and of one */
static PetscErrorCode WriteStates(Results results, DM dm)
{
  static const char *const parts[] = {"disc"};
  ResultsField             field;
  PetscInt                *cell_part, start, end;
  PetscReal               *position, *scalar;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &start, &end));
  PetscCall(PetscCalloc1(end - start, &cell_part));
  PetscCall(CreateValues(dm, &position, &scalar));
  PetscCall(ResultsFieldOpen(results, "states", dm, 1, parts, cell_part, &field));
  const ResultsNodal two[] = {
    {"pressure_pa",    1, scalar  },
    {"displacement_m", 3, position}
  };
  const ResultsNodal one = {"sum_m", 1, scalar};

  PetscCall(ResultsFieldWriteNodal(field, "0.5 & more", 2, two));
  PetscCall(ResultsFieldWriteNodal(field, "last", 1, &one));
  PetscCall(ResultsFieldClose(&field));
  PetscCall(PetscFree2(position, scalar));
  PetscCall(PetscFree(cell_part));
  PetscFunctionReturn(0);
}

/* Reads dataset /VTKHDF/`path` of shape [N_NODES] (width 1) or [N_NODES][width]; returns 0 when it has another one */
static int ReadNodes(hid_t file, const char path[], int width, double values[])
{
  char        full[64];
  hsize_t     dims[2] = {0, 1};
  const hid_t set     = (snprintf(full, sizeof(full), "/VTKHDF/%s", path), H5Dopen2(file, full, H5P_DEFAULT));
  const hid_t space   = H5Dget_space(set);
  const int   rank    = H5Sget_simple_extent_ndims(space);
  const int   fits    = rank == (width > 1 ? 2 : 1) && H5Sget_simple_extent_dims(space, dims, NULL) == rank &&
                   dims[0] == N_NODES && dims[1] == (hsize_t)width;
  const int read = fits && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;

  H5Sclose(space);
  H5Dclose(set);
  return read;
}

/* Breaks when: a node is written twice, left out, out of order or with another rank's value, or an array has another
   shape. Expected: the formula at the file's own points, exactly */
static int TestValues(const char name[])
{
  static double points[3 * N_NODES], position[3 * N_NODES], scalar[N_NODES], sum[N_NODES];
  const hid_t   file   = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
  int           failed = 0, wrong = 0;

  failed += CheckTrue("points", ReadNodes(file, "Points", 3, points), 0);
  failed += CheckTrue("vectors", ReadNodes(file, "PointData/displacement_m", 3, position), 0);
  failed += CheckTrue("scalars", ReadNodes(file, "PointData/pressure_pa", 1, scalar), 0);
  failed += CheckTrue("scalars of the second state", ReadNodes(file, "PointData/sum_m", 1, sum), 0);
  for (int i = 0; i < N_NODES; i++) {
    const double *x = &points[3 * i], expected = x[0] + 2 * x[1] + 4 * x[2];

    wrong += memcmp(x, &position[3 * i], 3 * sizeof(*x)) || scalar[i] != expected || sum[i] != expected;
  }
  failed += CheckTrue("values belong to their nodes", wrong == 0, wrong);
  H5Fclose(file);
  return failed;
}

/* Breaks when: a state has no grid of its own, an array is missing or of another kind, a name is not escaped */
static int TestText(const char name[])
{
  static const char *const expected[] = {
    "<Grid Name=\"0.5 &amp; more\" GridType=\"Uniform\">\n        <Information Name=\"title\" Value=\"0.5 &amp; "
    "more\"/>\n"
    "        <Time Value=\"1\"/>\n",
    "<Attribute Name=\"pressure_pa\" AttributeType=\"Scalar\" Center=\"Node\">\n          <DataItem Format=\"HDF\" "
    "NumberType=\"Float\" Precision=\"8\" Dimensions=\"120\">states.h5:/VTKHDF/PointData/pressure_pa</DataItem>\n",
    "<Attribute Name=\"displacement_m\" AttributeType=\"Vector\" Center=\"Node\">\n          <DataItem Format=\"HDF\" "
    "NumberType=\"Float\" Precision=\"8\" Dimensions=\"120 3\">states.h5:/VTKHDF/PointData/displacement_m</DataItem>\n",
    "<Grid Name=\"last\" GridType=\"Uniform\">\n        <Information Name=\"title\" Value=\"last\"/>\n"
    "        <Time Value=\"2\"/>\n",
    "<Attribute Name=\"sum_m\" AttributeType=\"Scalar\" Center=\"Node\">\n",
    "</Grid>\n    </Grid>\n  </Domain>\n</Xdmf>\n",
  };
  static char text[8192];
  const char *place = text;
  FILE       *file  = fopen(name, "r");
  int         failed;

  if (file) text[fread(text, 1, sizeof(text) - 1, file)] = '\0';
  if (file) fclose(file);
  for (size_t i = 0; i < sizeof(expected) / sizeof(expected[0]) && place; i++) place = strstr(place, expected[i]);
  failed = CheckTrue("grids and attributes of the XDMF file, in order", place != NULL, 0);
  place  = strstr(text, "PointData/sum_m");
  return failed + CheckTrue("the first grid has two arrays only", place && place > strstr(text, "\"last\""), 0);
}

/* Breaks when: the width is not checked before anything is written */
static int TestWidth(Results results, DM dm)
{
  static const char *const parts[] = {"disc"};
  const ResultsNodal       wide    = {"strain", 2, NULL};
  ResultsField             field;
  PetscInt                *cell_part, start, end;
  int                      failed;

  (void)DMPlexGetHeightStratum(dm, 0, &start, &end);
  if (PetscCalloc1(end - start, &cell_part)) return 1;
  if (ResultsFieldOpen(results, "states", dm, 1, parts, cell_part, &field)) return 1;
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  failed = CheckTrue("two values per node are refused",
                     ResultsFieldWriteNodal(field, "wide", 1, &wide) == PETSC_ERR_ARG_OUTOFRANGE, 0);
  (void)PetscPopErrorHandler();
  (void)PetscFree(cell_part);
  return failed + CheckTrue("the field can be closed after it", !ResultsFieldClose(&field), 0);
}

int main(int argc, char **argv)
{
  const PetscInt faces[3] = {5, 4, 3};
  char           dir[PETSC_MAX_PATH_LEN], h5[PETSC_MAX_PATH_LEN + 16], xmf[PETSC_MAX_PATH_LEN + 16];
  PetscMPIInt    rank;
  Results        results;
  DM             dm;
  int            failed = 0;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(ScratchMakeFolder(dir));
  snprintf(h5, sizeof(h5), "%s/states.h5", dir);
  snprintf(xmf, sizeof(xmf), "%s/states.xmf", dir);
  PetscCall(BoxMeshDistributed(PETSC_COMM_WORLD, faces, &dm));
  PetscCall(PetscOptionsSetValue(NULL, "-output_dir", dir));
  PetscCall(ResultsCreate(PETSC_COMM_WORLD, &results));
  PetscCall(ResultsSetFromOptions(results));
  PetscCall(WriteStates(results, dm));
  if (rank == 0) failed += TestValues(h5);
  if (rank == 0) failed += TestText(xmf);
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  failed += TestWidth(results, dm);
  if (rank == 0) failed += CheckTrue("no other file is left", !unlink(h5) && !unlink(xmf) && !rmdir(dir), 0);
  PetscCall(ResultsDestroy(&results));
  PetscCall(DMDestroy(&dm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
