/*
   Unit test of OperatorsInternalForces() on a bar of two glued parts: it is K u where K has rows, and the reaction
   where supports hold.

   References: the assembled K of the same model; equilibrium, by which the supports of a bar in rest exert the opposite
   of its loads, in force and in moment.
*/
#include <petscksp.h>
#include "boxes.h"
#include "brake.h"
#include "check.h"

#define BAR                                                                                                            \
  "-parts foot,head -foot_young 3 -foot_poisson 0.2 -foot_density 1 -head_young 5 -head_poisson 0.3 -head_density 1 "  \
  "-supports clamp -clamp_set foot_bottom -loads pull -pull_set head_top -pull_force 2,-3,7 "

static const PetscReal force[3] = {2, -3, 7};

/* A tapered, sheared bar from z = 0 to 1 m, foot below z = 0.4 m */
static PetscErrorCode BarCreate(Chain *chain)
{
  static const PetscReal x[] = {0, 0.4, 1}, y[] = {0, 0.7, 1}, z_foot[] = {0, 0.1, 0.4}, z_head[] = {0.4, 0.7, 0.8, 1};
  const Box              box[] = {
                 {.name = "foot",  .n = {3, 3, 3},      .x = {x, y, z_foot}, .taper = 0.3, .shear = 0.2},
                 { .name = "head", .n = {3, 3, 4}, .x = {x, y, z_head},        .taper = 0.3, .shear = 0.2,   .glued = 1}
  };
  char path[PETSC_MAX_PATH_LEN], mesh[PETSC_MAX_PATH_LEN + 16];

  PetscFunctionBeginUser;
  PetscCall(BoxesWrite(PETSC_COMM_WORLD, 2, box, path));
  PetscCall(PetscSNPrintf(mesh, sizeof(mesh), "-model_mesh %s", path));
  PetscCall(ChainCreate(BAR, mesh, chain));
  PetscCall(BoxesRemove(PETSC_COMM_WORLD, path));
  PetscFunctionReturn(0);
}

/* The values of a local vector at the unknowns */
static PetscErrorCode LocalRestrict(Model model, Vec local, Vec u)
{
  const PetscScalar *value;
  const Mesh        *mesh;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(VecGetLocalSize(local, &n));
  PetscCall(VecGetArrayRead(local, &value));
  for (PetscInt i = 0; i < n; i++)
    if (mesh->unknown[i] >= 0) PetscCall(VecSetValue(u, mesh->unknown[i], value[i], INSERT_VALUES));
  PetscCall(VecRestoreArrayRead(local, &value));
  PetscCall(VecAssemblyBegin(u));
  PetscCall(VecAssemblyEnd(u));
  PetscFunctionReturn(0);
}

/* Values at the unknowns that depend on them alone, not on the ranks */
static PetscErrorCode VecSetAny(Vec u)
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  PetscCall(VecGetOwnershipRange(u, &first, &last));
  for (PetscInt i = first; i < last; i++) PetscCall(VecSetValue(u, i, sin(1 + 7 * (double)i), INSERT_VALUES));
  PetscCall(VecAssemblyBegin(u));
  PetscCall(VecAssemblyEnd(u));
  PetscFunctionReturn(0);
}

/* Breaks when: a cell is left out or counted by two ranks, its part is mistaken, or the modulus is not the present one
   (the first Young's modulus is doubled) */
static PetscErrorCode TestProduct(Chain *chain, int *failed)
{
  const OperatorsParameter *parameter;
  PetscInt                  n;
  Mat                       K;
  PetscReal                 value[16], norm, error;
  Vec                       u, Ku, f, local;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(chain->operators, &n, &parameter));
  PetscCheck(n <= 16, PETSC_COMM_WORLD, PETSC_ERR_PLIB, "%d parameters", (int)n);
  for (PetscInt i = 0; i < n; i++) value[i] = parameter[i].value * (i == 0 ? 2 : 1);
  PetscCall(OperatorsGetBodies(chain->operators, value, &K, NULL, NULL));
  PetscCall(ModelCreateNodal(chain->model, &local));
  PetscCall(OperatorsCreateVec(chain->operators, &u));
  PetscCall(VecDuplicate(u, &Ku));
  PetscCall(VecDuplicate(u, &f));
  PetscCall(VecSetAny(u));
  PetscCall(MatMult(K, u, Ku));
  PetscCall(VecSet(local, 1e3)); /* is to be replaced */
  PetscCall(OperatorsInternalForces(chain->operators, value, u, local));
  PetscCall(LocalRestrict(chain->model, local, f));
  PetscCall(VecNorm(Ku, NORM_INFINITY, &norm));
  PetscCall(VecAXPY(f, -1, Ku));
  PetscCall(VecNorm(f, NORM_INFINITY, &error));
  *failed += CheckClose("internal forces against K u, relative", error / norm, 0, 1e-12);
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&Ku));
  PetscCall(VecDestroy(&f));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}

/* Sum of the forces at a set and their moment about the origin, each vertex once */
static PetscErrorCode SetSum(Model model, const char set[], Vec local, PetscReal sum[6])
{
  const PetscScalar *f;
  const Mesh        *mesh;
  PetscInt           n, *vertices;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sum, 6));
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(ModelGetOwnedNodes(model, set, &n, &vertices));
  PetscCall(VecGetArrayRead(local, &f));
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) {
      const PetscInt v = 3 * vertices[i], d1 = (d + 1) % 3, d2 = (d + 2) % 3;

      sum[d] += f[v + d];
      sum[3 + d] += mesh->x[v + d1] * f[v + d2] - mesh->x[v + d2] * f[v + d1];
    }
  PetscCall(VecRestoreArrayRead(local, &f));
  PetscCall(PetscFree(vertices));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

/* K u = f */
static PetscErrorCode Solve(Mat K, Vec f, Vec u)
{
  KSP ksp;
  PC  pc;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(KSPSetOperators(ksp, K, K));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSolve(ksp, f, u));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(0);
}

/* Breaks when: held directions get no force, or half of it where ranks share them */
static PetscErrorCode TestReaction(Chain *chain, int *failed)
{
  PetscReal load[6], reaction[6];
  Vec       u, f, external, internal;
  Mat       K;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetBodies(chain->operators, NULL, &K, NULL, NULL));
  PetscCall(ModelCreateNodal(chain->model, &external));
  PetscCall(ModelCreateNodal(chain->model, &internal));
  PetscCall(OperatorsCreateVec(chain->operators, &u));
  PetscCall(VecDuplicate(u, &f));
  PetscCall(ModelAddLoad(chain->model, 0, NULL, external));
  PetscCall(LocalRestrict(chain->model, external, f));
  PetscCall(Solve(K, f, u));
  PetscCall(OperatorsInternalForces(chain->operators, NULL, u, internal));
  PetscCall(SetSum(chain->model, "head_top", external, load));
  PetscCall(SetSum(chain->model, "foot_bottom", internal, reaction));
  for (int d = 0; d < 3; d++) *failed += CheckClose("reaction of the clamp, N", reaction[d], -force[d], 1e-11);
  for (int d = 3; d < 6; d++) *failed += CheckClose("its moment, N m", reaction[d], -load[d], 1e-11);
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&f));
  PetscCall(VecDestroy(&external));
  PetscCall(VecDestroy(&internal));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int   failed = 0;
  Chain chain;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(BarCreate(&chain));
  PetscCall(TestProduct(&chain, &failed));
  PetscCall(TestReaction(&chain, &failed));
  PetscCall(ChainDestroy(&chain));
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscFinalize());
  printf("%d failed\n", failed);
  return failed ? 1 : 0;
}
