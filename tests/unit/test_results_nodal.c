/*
   Unit test of ResultsFieldWriteNodal(): arrays at the nodes, read back from the HDF5 file, and their XDMF grids.

   The values are functions of the place: the vector is the node's position x (m), the scalar x + 2 y + 4 z. The values
   that a rank gives for vertices of other ranks are spoilt, so that each row must come from the owner, and once.
*/
#include <squeal/results.h>
#include <hdf5.h>
#include <string.h>
#include <sys/stat.h>
#include "boxmesh.h"
#include "check.h"
#include "scratch.h"

#define N_NODES ((5 + 1) * (4 + 1) * (3 + 1))
#define SPOILT  -1e300

/* Values at the local vertices: position [n][3] and a scalar [n]; SPOILT where another rank owns the vertex */
static PetscErrorCode CreateValues(const Mesh *mesh, PetscReal **position, PetscReal **scalar)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * mesh->n_nodes, position, mesh->n_nodes, scalar));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    const PetscReal *x = &mesh->x[3 * v];

    for (int d = 0; d < 3; d++) (*position)[3 * v + d] = mesh->owned[v] ? x[d] : SPOILT;
    (*scalar)[v] = mesh->owned[v] ? x[0] + 2 * x[1] + 4 * x[2] : SPOILT;
  }
  PetscFunctionReturn(0);
}

/* Writes two states, of two arrays and of one */
static PetscErrorCode WriteStates(Results results, const Mesh *mesh)
{
  ResultsField field;
  PetscReal   *position, *scalar;

  PetscFunctionBeginUser;
  PetscCall(CreateValues(mesh, &position, &scalar));
  PetscCall(ResultsFieldOpen(results, "states", mesh, &field));
  const ResultsNodal two[] = {
    {"pressure_pa",    1, scalar  },
    {"displacement_m", 3, position}
  };
  const ResultsNodal one = {"sum_m", 1, scalar};

  PetscCall(ResultsFieldWriteNodal(field, "0.5 & more", 2, two));
  PetscCall(ResultsFieldWriteNodal(field, "last", 1, &one));
  PetscCall(ResultsFieldClose(&field));
  PetscCall(PetscFree2(position, scalar));
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
static int TestWidth(Results results, const Mesh *mesh)
{
  const ResultsNodal wide = {"strain", 2, NULL};
  ResultsField       field;
  int                failed;

  if (ResultsFieldOpen(results, "states", mesh, &field)) return 1;
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  failed = CheckTrue("two values per node are refused",
                     ResultsFieldWriteNodal(field, "wide", 1, &wide) == PETSC_ERR_ARG_OUTOFRANGE, 0);
  (void)PetscPopErrorHandler();
  return failed + CheckTrue("the field can be closed after it", !ResultsFieldClose(&field), 0);
}

int main(int argc, char **argv)
{
  const PetscInt faces[3] = {5, 4, 3};
  char           dir[PETSC_MAX_PATH_LEN], h5[PETSC_MAX_PATH_LEN + 16], xmf[PETSC_MAX_PATH_LEN + 16];
  PetscMPIInt    rank;
  Results        results;
  Mesh           mesh;
  int            failed = 0;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(ScratchMakeFolder(dir));
  snprintf(h5, sizeof(h5), "%s/states.h5", dir);
  snprintf(xmf, sizeof(xmf), "%s/states.xmf", dir);
  PetscCall(BoxMeshTabulate(PETSC_COMM_WORLD, faces, &mesh));
  PetscCall(PetscOptionsSetValue(NULL, "-output_dir", dir));
  PetscCall(ResultsCreate(PETSC_COMM_WORLD, &results));
  PetscCall(ResultsSetFromOptions(results));
  PetscCall(WriteStates(results, &mesh));
  if (rank == 0) failed += TestValues(h5);
  if (rank == 0) failed += TestText(xmf);
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  failed += TestWidth(results, &mesh);
  if (rank == 0) failed += CheckTrue("no other file is left", !unlink(h5) && !unlink(xmf) && !rmdir(dir), 0);
  PetscCall(ResultsDestroy(&results));
  PetscCall(BoxMeshDestroy(&mesh));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
