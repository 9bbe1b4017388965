/*
   Friction in the pencil where mu depends on the pressure p: each pair has its own, at its speed and at the pressure of
   its force in the sliding state, and terms have the factor of the law alone. Friction mu(p) p of a pair changes by
   mu + p d mu / dp times the change of p.
*/
#include "operators/pencilimpl.h"

PetscReal PencilFrictionShare(Pencil pencil, PetscInt interface, PetscInt k, PetscInt pair, FrictionPart part)
{
  const Contact              contact = pencil->operators->contact;
  const InterfaceParameters *q       = &pencil->operators->interface[interface];
  const ContactInterface    *c;
  const ContactPair         *pairs;
  FrictionLaw                law;
  PetscInt                   n, n_all;

  (void)ContactGetPairs(contact, &n, &n_all, &pairs);
  (void)ContactGetInterfaces(contact, &n, &c);
  if (!FrictionNeedsPressure(&c[interface].friction)) return FrictionNodeShare(q, k, pairs[pair].speed);
  law              = FrictionOfPair(&c[interface].friction, pairs[pair].speed, pairs[pair].area);
  law              = FrictionPressed(&law, pencil->force[pair]);
  law.parameter[0] = 1; /* the factor of the term */
  if (part == FRICTION_SLOPE) return FrictionSteadySlope(&law);
  return part == FRICTION_TANGENT ? FrictionSteadyTangent(&law) : FrictionSteady(&law);
}

/* Raises the error for a point with other values than those at which each pair has its mu of a table; the factor of all
   may be another */
PetscErrorCode PencilCheckTable(Pencil pencil, PetscInt interface, const PetscReal p[])
{
  const ContactInterface *c;
  PetscInt                n;
  PetscBool               closed = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(pencil->operators->contact, &n, &c));
  c += interface;
  if (!FrictionNeedsPressure(&c->friction)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < pencil->n_pairs; i++)
    if (pencil->group[i] >= 0) closed = PETSC_TRUE;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &closed, 1, MPIU_BOOL, MPI_LOR, pencil->comm));
  if (!closed) PetscFunctionReturn(0); /* the bodies alone */
  for (PetscInt i = 0; i < pencil->parameters.n; i++)
    PetscCheck(p[i] == pencil->parameters.p[i] || i == pencil->operators->interface[interface].law[0], pencil->comm,
               PETSC_ERR_USER_INPUT,
               "contact %s: friction of a table stands at the speeds and pressures of one point, and %s changes: such "
               "contacts have modes, responses and transients alone",
               c->name, pencil->parameters.list[i].name);
  PetscFunctionReturn(0);
}
