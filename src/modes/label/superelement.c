/*
   Participation of a superelement, y^T M_s x with its own mass, as label.c has it of parts: that of nodes which it
   shares with the mesh counts with each by what each gives to it.
*/
#include "modes/modesimpl.h"

/* y' M_s x of two real vectors, NULL for zero ones */
static PetscErrorCode SuperelementDot(Modes modes, Operators operators, PetscInt k, Vec y, Vec x, PetscReal *dot)
{
  const PetscReal *p;
  PetscScalar      product;
  Vec              Mx;

  PetscFunctionBeginUser;
  *dot = 0;
  if (!x || !y) PetscFunctionReturn(0);
  PetscCall(PencilGetParameters(modes->pencil, NULL, NULL, &p));
  PetscCall(VecDuplicate(x, &Mx));
  PetscCall(OperatorsMultiplySuperelementMass(operators, p, k, x, Mx));
  PetscCall(VecDot(Mx, y, &product));
  PetscCall(VecDestroy(&Mx));
  *dot = PetscRealPart(product);
  PetscFunctionReturn(0);
}

PetscErrorCode LabelsShareSuperelement(Modes modes, Operators operators, PetscInt k, const Vec x[2], const Vec y[2],
                                       PetscReal share[2])
{
  const PetscReal sign    = y[0] ? -1 : 1;
  const Vec       left[2] = {y[0] ? y[0] : x[0], y[0] ? y[1] : x[1]};
  PetscReal       dot[2][2];

  PetscFunctionBeginUser;
  for (int a = 0; a < 4; a++)
    PetscCall(SuperelementDot(modes, operators, k, left[a / 2], x[a % 2], &dot[a / 2][a % 2]));
  share[0] = dot[0][0] + sign * dot[1][1];
  share[1] = dot[0][1] - sign * dot[1][0];
  PetscFunctionReturn(0);
}
