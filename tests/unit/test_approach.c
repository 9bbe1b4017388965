/*
   Unit test of ContactCreateApproach() and StaticsIdentify() on two boxes, whose layers at the contact are 0.2 m
   (lower, master) and 0.3 m (upper, slave) high.

   References: a displacement of which the approach is known, exactly since master points move by bilinear weights; the
   shortening F h / (E A) of bars in compression at Poisson's ratio 0, and F / (n k_n) of their contact.
*/
#include <petscksp.h>
#include <squeal/statics.h>
#include "boxes.h"
#include "brake.h"
#include "check.h"
#include "petscmain.h"

#define BOXES                                                                                                          \
  "-parts lower,upper -lower_young 4 -lower_poisson 0 -lower_density 1 -upper_young 6 -upper_poisson 0 "               \
  "-upper_density 1 -contacts joint -joint_surfaces upper_bottom,lower_top -joint_kn 5 -joint_slip 0,1,0 "
#define HELD   "-supports base,side -base_set lower_bottom -side_set upper_bottom -side_fix x "
#define LOADED "-loads press -press_set upper_top -press_force 0,0,-3 "

static const PetscReal z_lower[] = {0, 0.5, 0.8, 1}, z_upper[] = {1, 1.3, 2};

/* A scene on two boxes */
static PetscErrorCode SceneCreate(const char scene[], const Box box[2], Chain *chain)
{
  char path[PETSC_MAX_PATH_LEN], mesh[PETSC_MAX_PATH_LEN + 16];

  PetscFunctionBeginUser;
  PetscCall(BoxesWrite(PETSC_COMM_WORLD, 2, box, path));
  PetscCall(PetscSNPrintf(mesh, sizeof(mesh), "-model_mesh %s", path));
  PetscCall(ChainCreate(scene, mesh, chain));
  PetscCall(BoxesRemove(PETSC_COMM_WORLD, path));
  PetscFunctionReturn(0);
}

/* u_z = a + b z of the upper box and c + d z + e x of the lower one, coefficient[5]; vertices on z = 1 belong to both,
   hence the cells tell which is which */
static PetscErrorCode VecSetLinear(Model model, const PetscReal coefficient[5], Vec u)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(VecSetOption(u, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Element *element;
    PetscInt       vertices[ELEMENT_MAX_NODES];
    PetscReal      x[ELEMENT_MAX_DOFS];

    PetscCall(ModelGetCell(model, c, &element, vertices, x));
    for (int i = 0; i < 8; i++) {
      const PetscReal *at = &x[3 * i], *q = coefficient;
      const PetscReal  value = mesh->cell_part[c] ? q[0] + q[1] * at[2] : q[2] + q[3] * at[2] + q[4] * at[0];

      PetscCall(VecSetValue(u, mesh->unknown[3 * vertices[i] + 2], value, INSERT_VALUES));
    }
  }
  PetscCall(VecAssemblyBegin(u));
  PetscCall(VecAssemblyEnd(u));
  PetscFunctionReturn(0);
}

/* Approach d . u of a linear displacement */
static PetscErrorCode CheckLinear(const char name[], Chain *chain, const PetscReal coefficient[5], PetscReal expected,
                                  int *failed)
{
  PetscReal approach;
  Vec       d, u;

  PetscFunctionBeginUser;
  PetscCall(ContactCreateApproach(chain->contact, 0, &d));
  PetscCall(OperatorsCreateVec(chain->operators, &u));
  PetscCall(VecSetLinear(chain->model, coefficient, u));
  PetscCall(VecDot(d, u, &approach));
  *failed += CheckClose(name, approach, expected, 1e-14);
  PetscCall(VecDestroy(&d));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

/* Breaks when: the sign is wrong, pairs are weighted, the first or third row is taken, an edge that leans with the mesh
   (shear 0.5) is missed, or directions held by a support (x of the upper surface) hide a vertex. The meshes do not
   match: a slave node lies in a facet of the master. Mean x of the slave nodes: 2/5 + shear z. */
static PetscErrorCode TestLinear(int *failed)
{
  static const PetscReal wide[] = {0, 0.3, 0.6, 1}, narrow[] = {0.2, 0.3, 0.7}, y_wide[] = {0, 0.35, 0.7, 1};
  static const PetscReal y_narrow[] = {0.1, 0.4};
  const Box              box[]      = {
                      {.name = "lower", .n = {4, 4, 4}, .x = {wide, y_wide, z_lower},     .shear = 0.5},
                      {.name = "upper", .n = {3, 2, 3}, .x = {narrow, y_narrow, z_upper}, .shear = 0.5}
  };
  Chain chain;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate(BOXES HELD, box, &chain));
  PetscCall(CheckLinear("upper box comes down by 0.01 m", &chain, (PetscReal[]){-0.01, 0, 0, 0, 0}, 0.01, failed));
  PetscCall(CheckLinear("lower box goes down by 0.01 m", &chain, (PetscReal[]){0, 0, -0.01, 0, 0}, -0.01, failed));
  PetscCall(CheckLinear("upper box shrinks", &chain, (PetscReal[]){1, -1, 0, 0, 0}, 0.3, failed));
  PetscCall(CheckLinear("lower box shrinks", &chain, (PetscReal[]){0, 0, 1, -1, 0}, 0.2, failed));
  PetscCall(CheckLinear("lower box turns", &chain, (PetscReal[]){0, 0, 0, 0, 1}, 0.4 + 0.5 * 0.8, failed));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* Approach of the rows under the load */
static PetscErrorCode PressedApproach(Chain *chain, PetscReal *approach)
{
  PencilMatrices pencil;
  Vec            d, f, u;
  KSP            ksp;
  PC             pc;

  PetscFunctionBeginUser;
  PetscCall(ChainLinearise(chain, NULL));
  PetscCall(PencilGetMatrices(chain->pencil, &pencil));
  PetscCall(ChainCreateLoads(chain, &f));
  PetscCall(VecDuplicate(f, &u));
  PetscCall(ContactCreateApproach(chain->contact, 0, &d));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(KSPSetOperators(ksp, pencil.K, pencil.K));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSolve(ksp, f, u));
  PetscCall(VecDot(d, u, approach));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&f));
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(0);
}

/* Breaks when: the rows are not those one element from the surface, or the mean is no mean. Two columns of one element
   each, 0.5 m x 0.5 m, the upper one guided at its top: four equal pairs, uniform compression */
static PetscErrorCode TestPressed(int *failed)
{
  static const PetscReal side[] = {0, 0.5};
  const Box              box[]  = {
                  {.name = "lower", .n = {2, 2, 4}, .x = {side, side, z_lower}},
                  {.name = "upper", .n = {2, 2, 3}, .x = {side, side, z_upper}}
  };
  const PetscReal shortening = 3 * 0.3 / (6 * 0.25) + 3 * 0.2 / (4 * 0.25) + 3 / (4 * 5.0);
  PetscReal       approach;
  Chain           chain;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate(BOXES LOADED "-supports base,head -base_set lower_bottom -head_set upper_top -head_fix xy", box,
                        &chain));
  PetscCall(PressedApproach(&chain, &approach));
  *failed += CheckClose("approach under 3 N, m", approach, shortening, 1e-12);
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

/* Breaks when: pressing keeps friction or the penalty's own stiffness, the slope is that of one pair, or the line goes
   through other rows. The two layers in series: k = 1 / (h_1 / (E_1 A) + h_2 / (E_2 A)); asked within 0.1 % */
static PetscErrorCode TestIdentify(int *failed)
{
  static const PetscReal side[] = {0, 0.2, 0.5};
  const Box              box[]  = {
                  {.name = "lower", .n = {3, 3, 4}, .x = {side, side, z_lower}},
                  {.name = "upper", .n = {3, 3, 3}, .x = {side, side, z_upper}}
  };
  const PetscReal  k = 1 / (0.3 / (6 * 0.25) + 0.2 / (4 * 0.25));
  StaticsStiffness stiffness;
  Statics          statics;
  Chain            chain;

  PetscFunctionBeginUser;
  PetscCall(SceneCreate(BOXES LOADED
                        "-joint_mu 0.2 -supports base,head -base_set lower_bottom -head_set upper_top -head_fix xy",
                        box, &chain));
  PetscCall(StaticsCreate(PETSC_COMM_WORLD, &statics));
  PetscCall(StaticsSetOperators(statics, chain.operators));
  PetscCall(StaticsIdentify(statics, NULL, 0, &stiffness));
  *failed += CheckClose("k of two layers in series, N/m", stiffness.total, k, 1e-10 * k);
  *failed += CheckClose("k of each of nine pairs, N/m", stiffness.per_pair, k / 9, 1e-10 * k);
  *failed += CheckClose("last force, N", stiffness.range[1], 3, 1e-10);
  *failed += CheckClose("distance from the line", stiffness.residual, 0, 1e-10);
  PetscCall(StaticsDestroy(&statics));
  PetscCall(ChainDestroy(&chain));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestLinear(failed));
  PetscCall(TestPressed(failed));
  PetscCall(TestIdentify(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
