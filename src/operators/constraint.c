/*
   Exact contact constraint N u = 0 by elimination, with force directions N' - mu T'. In the frame (n, t, b) of a pair
   the slave displacement is u_s = n alpha + t q1 + b q2, where
      right, N u = 0:            alpha = n . u_m
      left, (N - mu T) y = 0:    alpha = (n - mu t) . y_m + mu q1
   so that Z = (I + G) E: E injects the kept unknowns and, at a slave, t q1 + b q2 (left: (t + mu n) q1 + b q2); G
   takes the part of alpha that comes from the master. K, C, M become Zl' (.) Zr, and constraint forces drop out.
*/
#include "operatorsimpl.h"

/* Eliminated pairs of this rank, by their interface's law; checks that elimination is possible */
static PetscErrorCode ConstrainedPairs(Operators o, PetscInt *n, const ContactPair ***list,
                                       const ContactInterface **interfaces)
{
  const ContactPair *pairs;
  PetscInt           n_pairs, n_all, n_interfaces;
  PetscInt           held = 0;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(o->contact, &n_pairs, &n_all, &pairs));
  PetscCall(ContactGetInterfaces(o->contact, &n_interfaces, interfaces));
  PetscCall(PetscMalloc1(n_pairs, list));
  *n = 0;
  for (PetscInt p = 0; p < n_pairs; p++) {
    if ((*interfaces)[pairs[p].interface].law != CONTACT_CONSTRAINT) continue;
    (*list)[(*n)++] = &pairs[p];
    for (int d = 0; d < 3; d++)
      if (pairs[p].slave[d] < 0) held = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPIU_INT, MPI_MAX, o->comm));
  PetscCheck(!held, o->comm, PETSC_ERR_SUP,
             "the contact constraint cannot eliminate a slave node that a support holds: swap -contact_surfaces or use "
             "-contact_law penalty");
  PetscFunctionReturn(0);
}

/* Marks the unknowns of eliminated slaves and of their masters; an unknown that is both, or slave of two pairs, is an
   error */
static PetscErrorCode ConstraintCheckChains(Operators o, PetscInt n, const ContactPair **list)
{
  const PetscScalar one = 1, large = 1e6;
  PetscScalar      *value;
  PetscInt          n_local, chain = 0;
  Vec               slaves, masters;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(o, &slaves));
  PetscCall(VecDuplicate(slaves, &masters));
  PetscCall(VecSetOption(masters, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt p = 0; p < n; p++) {
    PetscCall(VecSetValues(slaves, 1, list[p]->slave, &one, ADD_VALUES));
    for (PetscInt i = 0; i < list[p]->n_master; i++)
      PetscCall(VecSetValues(masters, 1, list[p]->master[i], &large, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(slaves));
  PetscCall(VecAssemblyEnd(slaves));
  PetscCall(VecAssemblyBegin(masters));
  PetscCall(VecAssemblyEnd(masters));
  PetscCall(VecPointwiseMult(masters, masters, slaves));
  PetscCall(VecAXPY(masters, 1, slaves));
  PetscCall(VecGetLocalSize(masters, &n_local));
  PetscCall(VecGetArray(masters, &value));
  for (PetscInt i = 0; i < n_local; i++)
    if (PetscRealPart(value[i]) > 1.5) chain = 1;
  PetscCall(VecRestoreArray(masters, &value));
  PetscCall(VecDestroy(&slaves));
  PetscCall(VecDestroy(&masters));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &chain, 1, MPIU_INT, MPI_MAX, o->comm));
  PetscCheck(!chain, o->comm, PETSC_ERR_SUP,
             "a node belongs to two constrained contact pairs; the constraint needs interfaces without common nodes: "
             "use -contact_law penalty");
  PetscFunctionReturn(0);
}

/* E: kept unknowns one to one, two columns (q1, q2) for each slave; mu = 0 gives the right one */
static PetscErrorCode InjectionCreate(Operators o, PetscInt n, const ContactPair **list, const PetscReal mu[], Mat *E)
{
  PetscInt n_local, first, last, column, *is_slave;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(o->A[OPERATOR_K], &first, &last));
  n_local = last - first;
  PetscCall(MatCreateAIJ(o->comm, n_local, n_local - n, PETSC_DETERMINE, PETSC_DETERMINE, 2, NULL, 2, NULL, E));
  PetscCall(MatGetOwnershipRangeColumn(*E, &column, NULL));
  PetscCall(PetscCalloc1(n_local, &is_slave));
  for (PetscInt p = 0; p < n; p++) {
    const ContactPair *pair = list[p];

    for (int d = 0; d < 3; d++) {
      const PetscScalar values[2]  = {pair->t[d] + mu[p] * pair->n[d], pair->b[d]};
      const PetscInt    columns[2] = {column, column + 1};

      PetscCall(MatSetValues(*E, 1, &pair->slave[d], 2, columns, values, INSERT_VALUES));
      is_slave[pair->slave[d] - first] = 1;
    }
    column += 2;
  }
  for (PetscInt i = 0; i < n_local; i++)
    if (!is_slave[i]) PetscCall(MatSetValue(*E, first + i, column++, 1, INSERT_VALUES));
  PetscCall(PetscFree(is_slave));
  PetscCall(MatAssemblyBegin(*E, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*E, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* G: n (n - mu t)' w_i from each master corner to the slave; mu = 0 gives the right one */
static PetscErrorCode CouplingCreate(Operators o, PetscInt n, const ContactPair **list, const PetscReal mu[], Mat *G)
{
  PetscInt n_local;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(o->A[OPERATOR_K], &n_local, NULL));
  PetscCall(MatCreateAIJ(o->comm, n_local, n_local, PETSC_DETERMINE, PETSC_DETERMINE, 12, NULL, 12, NULL, G));
  for (PetscInt p = 0; p < n; p++) {
    const ContactPair *pair = list[p];

    for (PetscInt i = 0; i < pair->n_master; i++) {
      PetscScalar block[9];

      for (int k = 0; k < 9; k++)
        block[k] = pair->weight[i] * pair->n[k / 3] * (pair->n[k % 3] - mu[p] * pair->t[k % 3]);
      PetscCall(MatSetValues(*G, 3, pair->slave, 3, pair->master[i], block, INSERT_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(*G, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*G, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Z = (I + G) E with a friction coefficient per pair */
static PetscErrorCode NullSpaceCreate(Operators o, PetscInt n, const ContactPair **list, const PetscReal mu[], Mat *Z)
{
  Mat E, G;

  PetscFunctionBeginUser;
  PetscCall(InjectionCreate(o, n, list, mu, &E));
  PetscCall(CouplingCreate(o, n, list, mu, &G));
  PetscCall(MatMatMult(G, E, MAT_INITIAL_MATRIX, PETSC_DEFAULT, Z));
  PetscCall(MatAXPY(*Z, 1, E, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatDestroy(&G));
  PetscCall(MatDestroy(&E));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCreateNullSpaces(Operators o)
{
  const ContactPair     **list;
  const ContactInterface *interfaces;
  PetscReal              *mu;
  PetscInt                n, n_all;

  PetscFunctionBeginUser;
  PetscCall(ConstrainedPairs(o, &n, &list, &interfaces));
  PetscCallMPI(MPI_Allreduce(&n, &n_all, 1, MPIU_INT, MPI_SUM, o->comm));
  if (n_all) {
    PetscCall(ConstraintCheckChains(o, n, list));
    PetscCall(PetscCalloc1(n, &mu));
    PetscCall(NullSpaceCreate(o, n, list, mu, &o->Zr));
    for (PetscInt p = 0; p < n; p++) mu[p] = interfaces[list[p]->interface].mu;
    if (o->mu != 0) {
      PetscCall(NullSpaceCreate(o, n, list, mu, &o->Zl));
    } else {
      o->Zl = o->Zr;
      PetscCall(PetscObjectReference((PetscObject)o->Zl));
    }
    PetscCall(PetscFree(mu));
  }
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}
