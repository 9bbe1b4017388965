/*
   Exact contact constraint N u = 0 by elimination, with force directions N' - mu T'. In the frame (n, t, b) of a pair
   the slave displacement is u_s = n alpha + t q1 + b q2, where
      right, N u = 0:            alpha = n . u_m
      left, (N - mu T) y = 0:    alpha = (n - mu t) . y_m + mu q1
   so that Zr = (I + G) E: E injects the kept unknowns and, at a slave, t q1 + b q2; G = n n' takes the part of alpha
   that comes from the master. The left null space is affine in the friction coefficients mu_i of the interfaces, each
   at one sliding speed or at several, between which those of the pairs are interpolated (frictionfactor.c); F_i and G_i
   have the pairs' parts then,

      Zl = Zr + sum_i mu_i Zl_i,   Zl_i = F_i + G_i E,   F_i: n q1 at a slave,   G_i = -n t' from its master,

   no master being slave of another pair. Displacements that follow others (dependents.c) are then filled in by P = Z
   E_d' of these, E and E_d their injection: Zr = P (E + G P E), Zl_i = P (F_i + G_i P E). A becomes Zl' A Zr, and
   constraint forces drop out: a term c A of all unknowns makes the terms c (Zr' A Zr) and c mu_i (Zl_i' A Zr) of the
   pencil. Open pairs are no constraints.

   Where the slave's side is a mean of several nodes, u_s = sum_k v_k u_k, all of this is said of u_s in place of the
   node's own displacement u_0, which follows: u_0 = (u_s - sum_k>0 v_k u_k) / v_0, u = T u~. Then T Zr and T Zl_i stand
   for Zr and Zl_i, and forces are T' f.
*/
#include "operators/pencilimpl.h"

/* Raises the error for a slave that follows others, of pairs of this rank or of means beside them (means.c) */
static PetscErrorCode ConstraintCheckFollowers(Pencil pencil, PetscInt n, const ContactPair **list)
{
  const Operators    o = pencil->operators;
  const ContactMean *means;
  PetscInt           n_means, first, follows = 0;

  PetscFunctionBeginUser;
  if (!o->Z) PetscFunctionReturn(0);
  PetscCall(ContactGetMeans(o->contact, &n_means, &means));
  PetscCall(MatGetOwnershipRange(o->E, &first, NULL));
  for (PetscInt i = 0; i < 3 * (n + n_means); i++) {
    const ContactPairNode *node = i < 3 * n ? list[i / 3]->slave : means[i / 3 - n].node;
    const PetscInt         row  = node->unknown[i % 3];

    if (row >= 0 && o->follows[row - first]) follows = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &follows, 1, MPIU_INT, MPI_MAX, pencil->comm));
  PetscCheck(
    !follows, pencil->comm, PETSC_ERR_SUP,
    "the contact constraint cannot eliminate a slave node that follows others, by %s: swap -contact_surfaces or use "
    "-contact_law penalty",
    o->dependent);
  PetscFunctionReturn(0);
}

/* Whether a mean of several nodes, that pairs take in, belongs to a node that a support holds, and others are not held
   there: it cannot be an unknown in place of that node's then */
static PetscBool MeanIsHeld(const ContactMean *mean)
{
  for (PetscInt i = 3; i < 3 * mean->n; i++)
    if (mean->node->unknown[i % 3] < 0 && mean->node[i / 3].unknown[i % 3] >= 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Eliminated pairs of this rank: closed, by their interface's law; checks that elimination is possible. The list is
   the caller's to free, its pairs the contact's. Faults of any rank are raised on all. */
static PetscErrorCode ConstrainedPairs(Pencil pencil, PetscInt *n, const ContactPair ***list,
                                       const ContactInterface **interfaces)
{
  const ContactPair *pairs;
  const ContactMean *means;
  PetscInt           n_pairs, n_all, n_means, n_interfaces, held = 0;

  PetscFunctionBeginUser;
  PetscCall(ContactGetMeans(pencil->operators->contact, &n_means, &means));
  PetscCall(ContactGetPairs(pencil->operators->contact, &n_pairs, &n_all, &pairs));
  PetscCall(ContactGetInterfaces(pencil->operators->contact, &n_interfaces, interfaces));
  PetscCall(PetscMalloc1(n_pairs, list));
  *n = 0;
  for (PetscInt p = 0; p < n_pairs; p++) {
    if ((*interfaces)[pairs[p].interface].law != CONTACT_CONSTRAINT || pencil->group[p] < 0) continue;
    (*list)[(*n)++] = &pairs[p];
    for (int d = 0; d < 3; d++)
      if (pairs[p].slave[0].unknown[d] < 0) held = 1;
  }
  for (PetscInt i = 0; i < n_means; i++)
    if ((*interfaces)[means[i].interface].law == CONTACT_CONSTRAINT && MeanIsHeld(&means[i])) held = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPIU_INT, MPI_MAX, pencil->comm));
  PetscCheck(!held, pencil->comm, PETSC_ERR_SUP,
             "the contact constraint cannot eliminate a slave node that a support holds: swap -contact_surfaces or use "
             "-contact_law penalty");
  PetscCall(ConstraintCheckFollowers(pencil, *n, *list));
  PetscFunctionReturn(0);
}

/* Marks of followers become marks of all that they follow: a row of Z names these. Marks are values of a vector,
   since an unknown may live on another rank than what marks it. */
static PetscErrorCode MarksPass(Operators o, Vec marks)
{
  const PetscScalar one = 1e6;
  const PetscInt   *column;
  PetscScalar      *value;
  PetscInt          first, last, n;
  Vec               q;

  PetscFunctionBeginUser;
  if (!o->Z) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(o->Z, &q, NULL));
  PetscCall(MatGetOwnershipRange(o->Z, &first, &last));
  PetscCall(VecGetArray(marks, &value));
  for (PetscInt i = first; i < last; i++) {
    if (value[i - first] == 0) continue;
    PetscCall(MatGetRow(o->Z, i, &n, &column, NULL));
    for (PetscInt k = 0; k < n; k++) PetscCall(VecSetValues(q, 1, &column[k], &one, INSERT_VALUES));
    PetscCall(MatRestoreRow(o->Z, i, &n, &column, NULL));
  }
  PetscCall(VecRestoreArray(marks, &value));
  PetscCall(VecAssemblyBegin(q));
  PetscCall(VecAssemblyEnd(q));
  PetscCall(MatMult(o->E, q, marks));
  PetscCall(VecDestroy(&q));
  PetscFunctionReturn(0);
}

/* Marks the unknowns of eliminated slaves (1 for each pair) and of their masters, and of nodes whose share they take
   (1e6, once); an unknown that is both, or slave of two pairs, is an error: slaves (1 + masters) is then 2 or more.
   G G = 0 and one E for all pairs rest on it. */
static PetscErrorCode ConstraintCheckChains(Pencil pencil, PetscInt n, const ContactPair **list)
{
  const PetscScalar one = 1, large = 1e6;
  PetscScalar      *value;
  PetscInt          n_local, chain = 0;
  Vec               slaves, masters;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCreateVec(pencil->operators, &slaves));
  PetscCall(VecDuplicate(slaves, &masters));
  PetscCall(VecSetOption(masters, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt p = 0; p < n; p++) {
    PetscCall(VecSetValues(slaves, 1, list[p]->slave[0].unknown, &one, ADD_VALUES));
    for (PetscInt i = 0; i < list[p]->n_master; i++)
      PetscCall(VecSetValues(masters, 1, list[p]->master[i].unknown, &large, INSERT_VALUES));
    for (PetscInt i = 0; i < list[p]->n_taken; i++)
      PetscCall(VecSetValues(masters, 1, list[p]->taken[i].unknown, &large, INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(slaves));
  PetscCall(VecAssemblyEnd(slaves));
  PetscCall(VecAssemblyBegin(masters));
  PetscCall(VecAssemblyEnd(masters));
  PetscCall(MarksPass(pencil->operators, masters));
  PetscCall(VecPointwiseMult(masters, masters, slaves));
  PetscCall(VecAXPY(masters, 1, slaves));
  PetscCall(VecGetLocalSize(masters, &n_local));
  PetscCall(VecGetArray(masters, &value));
  for (PetscInt i = 0; i < n_local; i++)
    if (PetscRealPart(value[i]) > 1.5) chain = 1;
  PetscCall(VecRestoreArray(masters, &value));
  PetscCall(VecDestroy(&slaves));
  PetscCall(VecDestroy(&masters));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &chain, 1, MPIU_INT, MPI_MAX, pencil->comm));
  PetscCheck(!chain, pencil->comm, PETSC_ERR_SUP,
             "a node belongs to two constrained contact pairs; the constraint needs interfaces without common nodes%s: "
             "use -contact_law penalty",
             pencil->operators->Z ? ", by way of nodes that follow others too" : "");
  PetscFunctionReturn(0);
}

/* E (part NULL): kept unknowns one to one, columns q1, q2 with t and b at each slave, so that a pair has two columns
   for its three unknowns. Else F_i: part [n] times n in the columns q1. Columns of pairs stand before those of the
   kept unknowns of the rank. Followers have no column. */
static PetscErrorCode InjectionCreate(Pencil pencil, PetscInt n, const ContactPair **list, const PetscReal part[],
                                      Mat *E)
{
  const Operators o = pencil->operators;
  PetscInt        n_local, first, last, column, n_follow = 0;
  PetscBool      *is_slave; /* or follows others */

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(pencil->base.term[0].A, &first, &last));
  n_local = last - first;
  PetscCall(PetscCalloc1(n_local, &is_slave));
  if (o->Z) PetscCall(PetscArraycpy(is_slave, o->follows, n_local));
  for (PetscInt i = 0; i < n_local; i++) n_follow += is_slave[i];
  PetscCall(
    MatCreateAIJ(pencil->comm, n_local, n_local - n - n_follow, PETSC_DETERMINE, PETSC_DETERMINE, 2, NULL, 0, NULL, E));
  PetscCall(MatGetOwnershipRangeColumn(*E, &column, NULL));
  for (PetscInt p = 0; p < n; p++, column += 2) {
    const ContactPair *pair = list[p];

    for (int d = 0; d < 3; d++) {
      const PetscScalar values[2]  = {part ? part[p] * pair->n[d] : pair->t[d], pair->b[d]};
      const PetscInt    columns[2] = {column, column + 1}, n_columns = part ? 1 : 2;

      is_slave[pair->slave[0].unknown[d] - first] = PETSC_TRUE;
      if (part && part[p] == 0) continue;
      PetscCall(MatSetValues(*E, 1, &pair->slave[0].unknown[d], n_columns, columns, values, INSERT_VALUES));
    }
  }
  for (PetscInt i = 0; i < n_local && !part; i++)
    if (!is_slave[i]) PetscCall(MatSetValue(*E, first + i, column++, 1, INSERT_VALUES));
  PetscCall(PetscFree(is_slave));
  PetscCall(MatAssemblyBegin(*E, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*E, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* From each master node to the slave: G = n n' w_i (part NULL), or G_i = -part n t' w_i */
static PetscErrorCode CouplingCreate(Pencil pencil, PetscInt n, const ContactPair **list, const PetscReal part[],
                                     Mat *G)
{
  PetscInt n_local, n_entries = 0;

  PetscFunctionBeginUser;
  PetscCall(MatGetLocalSize(pencil->base.term[0].A, &n_local, NULL));
  for (PetscInt p = 0; p < n; p++) n_entries = PetscMax(n_entries, 3 * list[p]->n_master);
  PetscCall(MatCreateAIJ(pencil->comm, n_local, n_local, PETSC_DETERMINE, PETSC_DETERMINE, n_entries, NULL, n_entries,
                         NULL, G));
  for (PetscInt p = 0; p < n; p++) {
    const ContactPair *pair = list[p];

    if (part && part[p] == 0) continue;
    for (PetscInt i = 0; i < pair->n_master; i++) {
      PetscScalar block[9];

      for (int k = 0; k < 9; k++)
        block[k] = pair->master[i].weight * pair->n[k / 3] * (part ? -part[p] * pair->t[k % 3] : pair->n[k % 3]);
      PetscCall(MatSetValues(*G, 3, pair->slave[0].unknown, 3, pair->master[i].unknown, block, INSERT_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(*G, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*G, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* P X, where followers have what they follow; X itself without any */
static PetscErrorCode NullSpaceFill(Operators o, Mat X, Mat *filled)
{
  Mat q;

  PetscFunctionBeginUser;
  if (!o->Z) {
    PetscCall(PetscObjectReference((PetscObject)X));
    *filled = X;
    PetscFunctionReturn(0);
  }
  PetscCall(MatTransposeMatMult(o->E, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &q));
  PetscCall(MatMatMult(o->Z, q, MAT_INITIAL_MATRIX, PETSC_DEFAULT, filled));
  PetscCall(MatProductClear(*filled));
  PetscCall(MatDestroy(&q));
  PetscFunctionReturn(0);
}

/* Zr = T P (E + G P E) (part NULL), or Zl_i = T P (F_i + G_i P E) of the parts [n] that pairs have in it */
static PetscErrorCode NullSpaceCreate(Pencil pencil, PetscInt n, const ContactPair **list, const PetscReal part[],
                                      Mat *Z)
{
  Mat F = pencil->E, G, PE, sum;

  PetscFunctionBeginUser;
  if (part) PetscCall(InjectionCreate(pencil, n, list, part, &F));
  PetscCall(CouplingCreate(pencil, n, list, part, &G));
  PetscCall(NullSpaceFill(pencil->operators, pencil->E, &PE));
  PetscCall(MatMatMult(G, PE, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &sum));
  PetscCall(MatProductClear(sum));
  PetscCall(MatAXPY(sum, 1, F, DIFFERENT_NONZERO_PATTERN));
  PetscCall(NullSpaceFill(pencil->operators, sum, Z));
  PetscCall(MeansFollow(pencil->T, PETSC_FALSE, Z));
  if (part) PetscCall(MatDestroy(&F));
  PetscCall(MatDestroy(&PE));
  PetscCall(MatDestroy(&sum));
  PetscCall(MatDestroy(&G));
  PetscFunctionReturn(0);
}

/* Zl_i of each speed of one interface: part_p = L_k(v_p), or what mu of the pair is there, 0 for pairs of other
   interfaces */
static PetscErrorCode NullSpacesAdd(Pencil pencil, PetscInt n, const ContactPair **list, PetscInt interface)
{
  const InterfaceParameters *q = &pencil->operators->interface[interface];
  const ContactPair         *pairs;
  PetscReal                 *part;
  PetscInt                   n_pairs, n_all;

  PetscFunctionBeginUser;
  PetscCall(ContactGetPairs(pencil->operators->contact, &n_pairs, &n_all, &pairs));
  PetscCall(PetscMalloc1(n + 1, &part));
  for (PetscInt k = 0; k < q->n_nodes; k++) {
    for (PetscInt p = 0; p < n; p++)
      part[p] = list[p]->interface != interface ? 0
                                                : PencilFrictionShare(pencil, interface, k, (PetscInt)(list[p] - pairs),
                                                                      FRICTION_TANGENT);
    PetscCall(NullSpaceCreate(pencil, n, list, part, &pencil->left[pencil->n_left]));
    pencil->left_interface[pencil->n_left] = interface;
    pencil->left_mu[pencil->n_left++]      = &q->node[k];
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(0);
}

/* Zr NULL where no rank has a constrained pair: nothing is projected. All left null spaces are of the size of Zr,
   with few rows that are not empty. */
PetscErrorCode PencilCreateNullSpaces(Pencil pencil)
{
  const ContactPair     **list;
  const ContactInterface *interfaces;
  PetscInt                n, n_all, n_interfaces, n_nodes = 0;

  PetscFunctionBeginUser;
  PetscCall(ConstrainedPairs(pencil, &n, &list, &interfaces));
  PetscCallMPI(MPI_Allreduce(&n, &n_all, 1, MPIU_INT, MPI_SUM, pencil->comm));
  if (n_all) {
    PetscCall(ConstraintCheckChains(pencil, n, list));
    PetscCall(ContactGetInterfaces(pencil->operators->contact, &n_interfaces, &interfaces));
    for (PetscInt i = 0; i < n_interfaces; i++) n_nodes += pencil->operators->interface[i].n_nodes;
    PetscCall(PetscCalloc3(n_nodes, &pencil->left, n_nodes, &pencil->left_mu, n_nodes, &pencil->left_interface));
    PetscCall(InjectionCreate(pencil, n, list, NULL, &pencil->E));
    PetscCall(MeansCreate(pencil, n, list));
    PetscCall(NullSpaceCreate(pencil, n, list, NULL, &pencil->Zr));
    for (PetscInt i = 0; i < n_interfaces; i++)
      if (interfaces[i].law == CONTACT_CONSTRAINT) PetscCall(NullSpacesAdd(pencil, n, list, i));
    PetscCall(MeansTakeInjection(pencil, n, list));
  }
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilDestroyNullSpaces(Pencil pencil)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < pencil->n_left; i++) PetscCall(MatDestroy(&pencil->left[i]));
  PetscCall(PetscFree3(pencil->left, pencil->left_mu, pencil->left_interface));
  PetscCall(MatDestroy(&pencil->Zr));
  PetscCall(MatDestroy(&pencil->E));
  PetscCall(MatDestroy(&pencil->T));
  PetscCall(TermsDestroy(&pencil->projected));
  PetscFunctionReturn(0);
}
