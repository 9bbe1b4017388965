/*
   Unit test of mortar pairs on two boxes of trapezoids whose meshes do not match, the slave's beyond the master's border on two sides.

   References: closing and slip of displacements that are linear in x, also at slave nodes beyond the border, exactly; the area of the
   overlap; forces that balance. Breaks when dual functions are not those of the part that lies over the master, a facet is missed or
   taken twice, or weights are of another place than the pair.
*/
#include "boxes.h"
#include "brake.h"
#include "check.h"
#include "petscmain.h"

#define BOXES                                                                                                          \
  "-parts lower,upper -lower_young 4 -lower_poisson 0 -lower_density 1 -upper_young 6 -upper_poisson 0 "               \
  "-upper_density 1 -contacts joint -joint_surfaces upper_bottom,lower_top -joint_kn_per_area 5 -joint_slip 0,1,0 "    \
  "-joint_discretization mortar "

static const PetscReal z_lower[] = {0, 0.5, 1}, z_upper[] = {1, 1.3, 2};

/* u = A (1, x, y, z) of one box, in each direction */
static PetscReal Linear(const PetscReal A[12], const PetscReal x[3], int d)
{
  return A[4 * d] + A[4 * d + 1] * x[0] + A[4 * d + 2] * x[1] + A[4 * d + 3] * x[2];
}

static PetscErrorCode VecSetLinear(Model model, const PetscReal A[2][12], Vec u)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *element;
    PetscInt       vertices[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS];

    PetscCall(ModelGetCell(model, c, &element, vertices, x));
    for (int i = 0; i < 24; i++)
      PetscCall(VecSetValue(u, mesh->unknown[3 * vertices[i / 3] + i % 3],
                            Linear(A[mesh->cell_part[c]], &x[3 * (i / 3)], i % 3), INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(u));
  PetscCall(VecAssemblyEnd(u));
  PetscFunctionReturn(0);
}

/* N u and T u of a field, [n] each; the caller frees them */
static PetscErrorCode RowsTimes(Chain *chain, const PetscReal A[2][12], PetscInt n, PetscReal *value[2])
{
  PetscInt *list;
  Mat       rows[2];
  Vec       u, w;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &list));
  for (PetscInt p = 0; p < n; p++) list[p] = p;
  PetscCall(ContactCreatePairOperators(chain->contact, n, list, &rows[0], &rows[1], NULL));
  PetscCall(MatCreateVecs(rows[0], &u, &w));
  PetscCall(VecSetLinear(chain->model, A, u));
  for (int k = 0; k < 2; k++) {
    const PetscScalar *x;

    PetscCall(PetscMalloc1(n, &value[k]));
    PetscCall(MatMult(rows[k], u, w));
    PetscCall(VecGetArrayRead(w, &x));
    for (PetscInt p = 0; p < n; p++) value[k][p] = PetscRealPart(x[p]);
    PetscCall(VecRestoreArrayRead(w, &x));
    PetscCall(MatDestroy(&rows[k]));
  }
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&w));
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}

/* Places of the means of the slave's sides, x and y [n]: N u of u_z = -x, or -y, of the upper box alone */
static PetscErrorCode PlacesFind(Chain *chain, PetscInt n, PetscReal *place[2])
{
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) {
    PetscReal A[2][12] = {{0}}, *value[2];

    A[1][9 + d] = -1;
    PetscCall(RowsTimes(chain, (const PetscReal(*)[12])A, n, value));
    place[d] = value[0];
    PetscCall(PetscFree(value[1]));
  }
  PetscFunctionReturn(0);
}

/* Over all ranks: the largest differences of N u and T u from n . (u^m - u^s) and t . (u^m - u^s) at the means of the
   slave's sides; that of these means from the slave nodes, of pairs that take nothing of others; and sums of area times
   place */
static PetscErrorCode CompareRows(Chain *chain, const PetscReal A[2][12], PetscReal off[3], PetscReal moment[2])
{
  const ContactPair *pair;
  PetscReal         *value[2], *place[2];
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pair));
  PetscCall(PlacesFind(chain, n, place));
  PetscCall(RowsTimes(chain, A, n, value));
  off[0] = off[1] = off[2] = moment[0] = moment[1] = 0;
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal at[3] = {place[0][p], place[1][p], pair[p].x[2]}, below[3] = {at[0], at[1], 1}; /* of the master */

    for (int k = 0; k < 2; k++) {
      PetscReal expected = 0;

      for (int d = 0; d < 3; d++)
        expected += (k ? pair[p].t : pair[p].n)[d] * (Linear(A[0], below, d) - Linear(A[1], at, d));
      off[k] = PetscMax(off[k], PetscAbsReal(value[k][p] - expected));
      moment[k] += pair[p].area * at[k];
      if (!pair[p].n_taken) off[2] = PetscMax(off[2], PetscAbsReal(at[k] - pair[p].x[k]));
    }
  }
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscFree(value[k]));
    PetscCall(PetscFree(place[k]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, off, 3, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, moment, 2, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* Sums over the pairs: area, and gap times area; and the largest deviation of a sum of weights from 1 */
static PetscErrorCode PairsSum(Chain *chain, PetscReal sum[2], PetscReal *weights)
{
  const ContactPair *pair;
  PetscInt           n, n_all;

  PetscFunctionBeginUser;
  sum[0] = sum[1] = *weights = 0;
  PetscCall(ContactGetPairs(chain->contact, &n, &n_all, &pair));
  for (PetscInt p = 0; p < n; p++) {
    PetscReal one[2] = {-1, -1};

    sum[0] += pair[p].area;
    sum[1] += pair[p].area * pair[p].gap;
    for (PetscInt i = 0; i < pair[p].n_slave; i++) one[0] += pair[p].slave[i].weight;
    for (PetscInt i = 0; i < pair[p].n_master; i++) one[1] += pair[p].master[i].weight;
    *weights = PetscMax(*weights, PetscMax(PetscAbsReal(one[0]), PetscAbsReal(one[1])));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, weights, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* One scene; area, its integrals of x and y, and mean gap of the overlap are known */
static PetscErrorCode TestBoxes(const char name[], const Box box[2], const char more[], const PetscReal area[3],
                                PetscReal gap, int *failed)
{
  static const PetscReal A[2][12] = {{0.1, 0.3, -0.2, 0.4, 0.2, 0.1, 0.5, -0.3, -0.1, 0.7, 0.2, 0.6},
                                     {0.3, -0.4, 0.1, 0.2, -0.2, 0.6, -0.1, 0.5, 0.4, 0.1, 0.9, -0.2}};
  char                   path[PETSC_MAX_PATH_LEN], mesh[PETSC_MAX_PATH_LEN + 256];
  PetscReal              off[3], sum[2], moment[2], weights;
  Chain                  chain;

  PetscFunctionBeginUser;
  PetscCall(BoxesWrite(PETSC_COMM_WORLD, 2, box, path));
  PetscCall(PetscSNPrintf(mesh, sizeof(mesh), "-model_mesh %s %s", path, more));
  PetscCall(ChainCreate(BOXES, mesh, &chain));
  PetscCall(BoxesRemove(PETSC_COMM_WORLD, path));
  PetscCall(CompareRows(&chain, A, off, moment));
  PetscCall(PairsSum(&chain, sum, &weights));
  *failed += CheckClose(name, off[0], 0, 1e-12) + CheckClose(name, off[1], 0, 1e-12);
  *failed += CheckClose(name, off[2], 0, 1e-12);
  *failed += CheckClose(name, sum[0], area[0], 1e-12) + CheckClose(name, sum[1], gap * area[0], 1e-12);
  for (int d = 0; d < 2; d++) *failed += CheckClose(name, moment[d], area[1 + d], 1e-12);
  *failed += CheckClose(name, weights, 0, 1e-13);
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  static const PetscReal x_lower[] = {0, 0.3, 0.65, 1}, y_lower[] = {0, 0.35, 0.8, 1};
  static const PetscReal x_upper[] = {0.2, 0.3, 0.75, 1.3}, y_upper[] = {-0.4, 0.1, 0.4, 0.7};
  static const PetscReal y_sliver[] = {-0.4, 1e-9, 0.4, 0.7}, y_thin[] = {-0.4, -0.001, 0.4, 0.7};
  static const PetscReal z_apart[] = {1.001, 1.3, 2};
  Box                    box[]     = {{.name = "lower", .n = {4, 4, 3}, .x = {x_lower, y_lower, z_lower}},
                                      {.name = "upper", .n = {4, 4, 3}, .x = {x_upper, y_upper, z_upper}}};

  const PetscReal flat[3] = {0.56, 0.56 * 0.6, 0.56 * 0.35};
  /* from a = 0.2 (1 + 0.3 y) to the lower box's border b = 1 + 0.2 y, y from 0 to h: integrals of b - a = 0.8 + 0.14 y,
     (b^2 - a^2) / 2 = (0.96 + 0.376 y + 0.0364 y^2) / 2 and (b - a) y */
  const PetscReal h       = 0.7;
  const PetscReal lean[3] = {0.8 * h + 0.07 * h * h, (0.96 * h + 0.188 * h * h + 0.0364 * h * h * h / 3) / 2,
                             0.4 * h * h + 0.14 * h * h * h / 3};

  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestBoxes("rectangles", box, "", flat, 0, failed));
  box[1].x[1] = y_sliver;
  PetscCall(TestBoxes("a sliver", box, "", flat, 0, failed));
  box[1].x[1] = y_thin;
  PetscCall(TestBoxes("a thin overlap", box, "", flat, 0, failed));
  box[1].x[1] = y_upper;
  box[1].x[2] = z_apart;
  PetscCall(TestBoxes("a gap", box, "-joint_tolerance 2e-3", flat, 1e-3, failed));
  box[1].x[2]  = z_upper;
  box[0].taper = 0.2;
  box[1].taper = 0.3;
  PetscCall(TestBoxes("trapezoids", box, "", lean, 0, failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
