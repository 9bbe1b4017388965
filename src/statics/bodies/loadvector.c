/*
   The loads of a stage, the weight of the parts, and what its motions with displacements d exert, -K_fd d, as a vector
   of the unknowns. What falls on held directions goes straight into a support and is no part of it. The size, beside
   which a force along a free motion is judged (hold.c, 1e-8), counts loads and weight in full and of |K_fd d|_1 a
   hundredth. That sum is no force that passes through the bodies: with n elements along them it is some 2 n times as
   large (bars of 5 and 40 elements: 10 and 80 times). Rounding along a free motion was measured as 1.3e-16 to 1.6e-16
   of it, at displacements from 1e-6 to 1e-2 m; the bound is 1e-10 of it, far from both.
*/
#include "statics/staticsimpl.h"

#define MOTION_SHARE 1e-2 /* of |K_fd d| in the size */

/* f -= K_fd d; and its share of the size */
static PetscErrorCode LoadAddMotions(Operators operators, const PetscReal p[], const PetscReal prescribed[], Vec local,
                                     Vec f, PetscReal *size)
{
  PetscReal norm;
  Vec       part;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(f, &part));
  PetscCall(OperatorsPrescribedForces(operators, p, prescribed, local));
  PetscCall(OperatorsTakeNodal(operators, local, part));
  PetscCall(VecNorm(part, NORM_1, &norm));
  PetscCall(VecAXPY(f, -1, part));
  PetscCall(VecDestroy(&part));
  *size += MOTION_SHARE * norm;
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsCreateLoad(Operators operators, const PetscReal p[], const Stage *stage, Vec *f, PetscReal *size)
{
  Vec       local;
  PetscReal weight[3], *prescribed;
  Model     model;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(StageGetMotions(model, stage, &prescribed));
  PetscCall(ModelCreateNodal(model, &local));
  PetscCall(OperatorsAddLoads(operators, p, stage->share, local, size));
  PetscCall(OperatorsAddWeight(operators, p, local, weight));
  for (int d = 0; d < 3; d++) *size += PetscAbsReal(weight[d]);
  PetscCall(OperatorsCreateVec(operators, f));
  PetscCall(OperatorsTakeNodal(operators, local, *f));
  if (prescribed) PetscCall(LoadAddMotions(operators, p, prescribed, local, *f, size));
  PetscCall(PetscFree(prescribed));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsSaveLoad(Statics statics, const PetscReal p[], Pencil pencil)
{
  PetscReal size;
  Vec       f;

  PetscFunctionBeginUser;
  if (!statics->model) PetscFunctionReturn(0);
  PetscCall(StaticsCreateLoad(statics->operators, p, StagesGet(statics, StagesCount(statics) - 1), &f, &size));
  if (size > 0) PetscCall(PencilSaveLoad(pencil, f));
  PetscCall(VecDestroy(&f));
  PetscFunctionReturn(0);
}
