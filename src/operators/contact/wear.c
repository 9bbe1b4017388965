/*
   Wear as parameters: <contact>_wear_rate, <contact>_wear_rate_master and wear_time. Matrices do not depend on them,
   modes through the sliding state alone. The speed of a pair goes with that of its interface, v = V v_0 / V_0.
*/
#include "operators/operatorsimpl.h"

PetscErrorCode OperatorsAddWear(Operators o, const ContactInterface *c, InterfaceParameters *q)
{
  static const char *const name[]  = {"wear_rate", "wear_rate_master"};
  const PetscReal          value[] = {c->wear_rate, c->wear_rate_master};

  PetscFunctionBeginUser;
  for (int i = 0; i < 2; i++) {
    const OperatorsParameter like = {.row = ContactFindRow(name[i]), .value = value[i], .state = PETSC_TRUE};

    q->wear[i] = -1;
    if (value[i] > 0) PetscCall(ParametersAdd(&o->parameters, c->name, name[i], &like, &q->wear[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddWearTime(Operators o)
{
  const ContactInterface *c;
  const ContactWear      *wear;
  PetscInt                n;
  PetscBool               wears = PETSC_FALSE;
  OperatorsParameter      like  = {.state = PETSC_TRUE};

  PetscFunctionBeginUser;
  o->wear_time = -1;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  PetscCall(ContactGetWear(o->contact, &wear));
  for (PetscInt i = 0; i < n; i++)
    if (ContactWears(&c[i])) wears = PETSC_TRUE;
  like.row   = ContactFindWearRow("wear_time");
  like.value = wear->time;
  if (wears) PetscCall(ParametersAdd(&o->parameters, NULL, "wear_time", &like, &o->wear_time));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetPairWear(Operators o, const PetscReal p[], const ContactPair *pair, OperatorsWear *wear)
{
  const InterfaceParameters *q       = &o->interface[pair->interface];
  const PetscReal           *value   = OperatorsPoint(o, p);
  const PetscReal            rate[2] = {q->wear[0] < 0 ? 0 : value[q->wear[0]], q->wear[1] < 0 ? 0 : value[q->wear[1]]};
  const ContactInterface    *c;
  PetscInt                   n;

  PetscFunctionBeginUser;
  PetscCall(ContactGetInterfaces(o->contact, &n, &c));
  *wear = (OperatorsWear){.rate     = rate[0] + rate[1],
                          .share    = rate[0] > 0 ? rate[0] / (rate[0] + rate[1]) : 0,
                          .exponent = c[pair->interface].wear_exponent,
                          .speed    = pair->speed};
  if (q->speed >= 0 && q->stated > 0) wear->speed *= value[q->speed] / q->stated;
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetWearTime(Operators o, const PetscReal p[], PetscReal *time)
{
  PetscFunctionBeginUser;
  *time = o->wear_time < 0 ? 0 : OperatorsPoint(o, p)[o->wear_time];
  PetscFunctionReturn(0);
}
