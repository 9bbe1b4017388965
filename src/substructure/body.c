/*
   The parts by themselves: their unknowns, and of the terms of the scene those that act on them alone. A term that
   acts on others too, as that of a part which shares nodes, or a bushing to another one, is left out; what it acts on
   must belong to the interface then, or nobody could put it back. Supports stay: what they hold is no unknown.
*/
#include "substructureimpl.h"
#include <string.h>

/* Indices of the parts of the options, in [parts of the mesh] */
static PetscErrorCode BodyChoose(Substructure s, const Mesh *mesh, PetscBool chosen[])
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  for (PetscInt i = 0; i < s->n_parts; i++) {
    PetscInt k = 0;

    while (k < mesh->n_parts && strcmp(mesh->part[k], s->parts[i])) k++;
    PetscCheck(k < mesh->n_parts, s->comm, PETSC_ERR_USER_INPUT,
               "-superelement_parts '%s' is none of -parts; the first of these is '%s'", s->parts[i], mesh->part[0]);
    PetscCheck(!chosen[k], s->comm, PETSC_ERR_USER_INPUT, "-superelement_parts names '%s' twice", s->parts[i]);
    PetscCheck(
      scene->parts[k].spin.rate == 0, s->comm, PETSC_ERR_SUP,
      "-superelement_parts '%s' spins, and gyroscopic terms are not symmetric: that is not supported; leave out "
      "-%s_spin",
      s->parts[i], s->parts[i]);
    chosen[k] = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* Which local nodes are of the parts, those too whose cells other ranks have */
static PetscErrorCode BodyMark(Substructure s, const Mesh *mesh)
{
  PetscScalar *mark;
  PetscBool   *chosen;
  Vec          marks;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_parts, &chosen));
  PetscCall(BodyChoose(s, mesh, chosen));
  PetscCall(ModelCreateNodal(s->model, &marks));
  PetscCall(VecGetArray(marks, &mark));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt i = mesh->cell_first[c]; i < mesh->cell_first[c + 1] && chosen[mesh->cell_part[c]]; i++)
      mark[3 * mesh->cell_node[i]] = 1;
  PetscCall(VecRestoreArray(marks, &mark));
  PetscCall(ModelSumShared(s->model, marks));
  PetscCall(PetscMalloc1(mesh->n_nodes, &s->body.has_part));
  PetscCall(VecGetArray(marks, &mark));
  for (PetscInt v = 0; v < mesh->n_nodes; v++) s->body.has_part[v] = PetscRealPart(mark[3 * v]) > 0;
  PetscCall(VecRestoreArray(marks, &mark));
  PetscCall(VecDestroy(&marks));
  PetscCall(PetscFree(chosen));
  PetscFunctionReturn(0);
}

/* The unknowns of the parts on this rank, ascending, with 3 local node + direction of each */
static PetscErrorCode BodyNumber(Substructure s, const Mesh *mesh, IS *unknowns)
{
  PetscInt n = 0, *unknown;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &unknown));
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &s->body.node));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) {
    if (!mesh->owned[i / 3] || !s->body.has_part[i / 3] || mesh->unknown[i] < 0) continue;
    unknown[n]        = mesh->unknown[i];
    s->body.node[n++] = i;
  }
  PetscCall(PetscSortIntWithArray(n, unknown, s->body.node));
  PetscCall(ISCreateGeneral(s->comm, n, unknown, PETSC_COPY_VALUES, unknowns));
  PetscCall(PetscFree(unknown));
  s->body.n_own = n;
  PetscFunctionReturn(0);
}

/* Whether a term acts on others beside the parts, where it acts on the parts at all; marks these rows then */
static PetscErrorCode TermJoins(Substructure s, Mat A, IS unknowns, PetscBool joined[], PetscBool *joins)
{
  PetscInt n_marked;
  Vec      probe, answer;

  PetscFunctionBeginUser;
  PetscCall(BodyCreateProbe(A, unknowns, &probe));
  PetscCall(VecDuplicate(probe, &answer));
  PetscCall(MatMult(A, probe, answer));
  PetscCall(BodyMarkRows(answer, unknowns, joined, &n_marked));
  *joins = n_marked ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(VecDestroy(&answer));
  PetscCall(VecDestroy(&probe));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, joins, 1, MPIU_BOOL, MPI_LOR, s->comm));
  PetscFunctionReturn(0);
}

/* The name of what a term depends on */
static const char *TermName(const OperatorsTerm *term, const OperatorsParameter parameter[])
{
  return term->n && term->factor[0].parameter >= 0 ? parameter[term->factor[0].parameter].name : "a matrix";
}

/* Looks at a matrix of a term that was not there before: takes its part, or leaves it out */
static PetscErrorCode BodyTakeMatrix(Substructure s, const OperatorsTerm *term, IS unknowns, Mat *A)
{
  SubstructureBody         *body = &s->body;
  const OperatorsParameter *parameter;
  PetscInt                  n;
  PetscReal                 norm;
  PetscBool                 joins, *rows;

  PetscFunctionBeginUser;
  *A = NULL;
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameter));
  PetscCall(PetscCalloc1(body->n_own, &rows));
  PetscCall(TermJoins(s, term->A, unknowns, rows, &joins));
  if (joins) PetscCall(BodyJoin(body, rows, TermName(term, parameter)));
  PetscCall(PetscFree(rows));
  if (joins) PetscFunctionReturn(0);
  PetscCall(MatCreateSubMatrix(term->A, unknowns, unknowns, MAT_INITIAL_MATRIX, A));
  PetscCall(MatNorm(*A, NORM_FROBENIUS, &norm));
  if (norm == 0) PetscCall(MatDestroy(A));
  PetscFunctionReturn(0);
}

/* The terms that act on the parts alone, several of which may share a matrix */
static PetscErrorCode BodyTakeTerms(Substructure s, IS unknowns)
{
  SubstructureBody    *body = &s->body;
  const OperatorsTerm *term;
  PetscInt             n, n_seen = 0;
  Mat                 *seen;
  PetscInt            *number; /* [n_seen] -1 for what is left out */

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetTerms(s->operators, &n, &term));
  PetscCall(PetscMalloc2(n, &seen, n, &number));
  PetscCall(PetscMalloc1(n, &body->A));
  PetscCall(PetscMalloc2(n, &body->term, n, &body->of_term));
  for (PetscInt t = 0; t < n; t++) {
    PetscInt k = 0;

    while (k < n_seen && seen[k] != term[t].A) k++;
    if (k == n_seen) {
      Mat A;

      seen[n_seen++] = term[t].A;
      PetscCall(BodyTakeMatrix(s, &term[t], unknowns, &A));
      number[k] = A ? body->n_matrices : -1;
      if (A) body->A[body->n_matrices++] = A;
    }
    if (number[k] < 0) continue;
    body->term[body->n_terms]      = &term[t];
    body->of_term[body->n_terms++] = number[k];
  }
  PetscCall(PetscFree2(seen, number));
  PetscFunctionReturn(0);
}

/* Marks what contacts press: they are no terms, and can be made again at the interface alone */
static PetscErrorCode BodyMarkContacts(Substructure s, IS unknowns)
{
  const OperatorsTerm *term;
  const ContactPair   *pair;
  Contact              contact;
  PetscInt             n_terms, n_pairs, n_all, n_marked;
  Vec                  marks;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(s->operators, NULL, &contact));
  if (!contact) PetscFunctionReturn(0);
  PetscCall(ContactGetPairs(contact, &n_pairs, &n_all, &pair));
  PetscCall(OperatorsGetTerms(s->operators, &n_terms, &term));
  PetscCall(MatCreateVecs(term[0].A, &marks, NULL));
  for (PetscInt p = 0; p < n_pairs; p++)
    for (PetscInt k = 0; k < pair[p].n_slave + pair[p].n_master; k++) {
      const ContactPairNode *node = k < pair[p].n_slave ? &pair[p].slave[k] : &pair[p].master[k - pair[p].n_slave];

      PetscCall(VecSetValues(marks, 3, node->unknown, (PetscScalar[]){1, 1, 1}, ADD_VALUES));
    }
  PetscCall(VecAssemblyBegin(marks));
  PetscCall(VecAssemblyEnd(marks));
  PetscCall(BodyMarkRows(marks, unknowns, s->body.pressed, &n_marked));
  PetscCall(VecDestroy(&marks));
  PetscFunctionReturn(0);
}

/* What presses a follower presses what it follows: Z' of ones at such rows */
static PetscErrorCode BodyPassPressed(Substructure s, const PetscBool keep[], Mat Z)
{
  SubstructureBody *body = &s->body;
  PetscScalar      *value;
  PetscInt          n = 0;
  Vec               all, leaders;

  PetscFunctionBeginUser;
  if (!Z) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(Z, &leaders, &all));
  PetscCall(VecGetArrayWrite(all, &value));
  for (PetscInt k = 0; k < body->n_own; k++) value[k] = body->pressed[k];
  PetscCall(VecRestoreArrayWrite(all, &value));
  PetscCall(MatMultTranspose(Z, all, leaders));
  PetscCall(VecGetArray(leaders, &value));
  for (PetscInt k = 0; k < body->n_own; k++)
    if (keep[k] && value[n++] != 0) body->pressed[k] = PETSC_TRUE;
  PetscCall(VecRestoreArray(leaders, &value));
  PetscCall(VecDestroy(&leaders));
  PetscCall(VecDestroy(&all));
  PetscFunctionReturn(0);
}

/* Leaves of the unknowns those that follow none inside: Z'A Z for all matrices */
static PetscErrorCode BodyTakeLeaders(Substructure s, const PetscBool keep[], Mat Z)
{
  SubstructureBody *body = &s->body;
  PetscInt          n    = 0;

  PetscFunctionBeginUser;
  if (!Z) PetscFunctionReturn(0);
  for (PetscInt j = 0; j < body->n_matrices; j++) {
    Mat A;

    PetscCall(MatPtAP(body->A[j], Z, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &A));
    PetscCall(MatProductClear(A));
    PetscCall(MatDestroy(&body->A[j]));
    body->A[j] = A;
  }
  for (PetscInt k = 0; k < body->n_own; k++) {
    if (!keep[k]) continue;
    body->node[n]     = body->node[k];
    body->pressed[n]  = body->pressed[k];
    body->by[n]       = body->by[k];
    body->joined[n++] = body->joined[k];
  }
  body->n_own = n;
  PetscFunctionReturn(0);
}

PetscErrorCode BodySum(const Substructure s, const Mat A[], Mat *K, Mat *M, Mat *C)
{
  Mat *const sum[] = {[OPERATORS_STIFFNESS] = K, [OPERATORS_DAMPING] = C, [OPERATORS_MASS] = M};

  PetscFunctionBeginUser;
  *K = *M = *C = NULL;
  for (PetscInt t = 0; t < s->body.n_terms; t++) {
    const PetscReal c    = OperatorsTermCoefficient(s->body.term[t], s->p);
    const Mat       term = A[s->body.of_term[t]];
    Mat *const      to   = sum[s->body.term[t]->kind];

    if (c == 0) continue;
    if (*to) {
      PetscCall(MatAXPY(*to, c, term, DIFFERENT_NONZERO_PATTERN));
    } else {
      PetscCall(MatDuplicate(term, MAT_COPY_VALUES, to));
      PetscCall(MatScale(*to, c));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BodyCreate(Substructure s)
{
  SubstructureBody *body = &s->body;
  const Mesh       *mesh;
  PetscBool        *keep;
  IS                unknowns;
  Mat               Z;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(s->model, &mesh));
  PetscCall(OperatorsCheckEven(s->operators, PETSC_TRUE, "-analysis superelement"));
  PetscCall(BodyMark(s, mesh));
  PetscCall(BodyNumber(s, mesh, &unknowns));
  PetscCall(PetscCalloc3(body->n_own, &body->joined, body->n_own, &body->pressed, body->n_own, &body->by));
  PetscCall(PetscMalloc1(body->n_own, &keep));
  PetscCall(BodyTakeTerms(s, unknowns));
  PetscCall(BodyMarkContacts(s, unknowns));
  PetscCall(BodyFollow(s, unknowns, keep, &Z));
  PetscCall(BodyPassPressed(s, keep, Z));
  PetscCall(BodyTakeLeaders(s, keep, Z));
  PetscCall(PetscFree(keep));
  PetscCall(MatDestroy(&Z));
  PetscCall(ISDestroy(&unknowns));
  PetscCall(BodySum(s, body->A, &body->K, &body->M, &body->C));
  PetscCheck(body->K && body->M, s->comm, PETSC_ERR_USER_INPUT,
             "-superelement_parts: the parts have no %s of their own, or no unknown", body->K ? "mass" : "stiffness");
  PetscCall(MatGetOwnershipRange(body->K, &body->first, NULL));
  PetscCall(MatGetSize(body->K, &body->n, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode BodyDestroy(SubstructureBody *body)
{
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < body->n_matrices; j++) PetscCall(MatDestroy(&body->A[j]));
  PetscCall(MatDestroy(&body->K));
  PetscCall(MatDestroy(&body->M));
  PetscCall(MatDestroy(&body->C));
  PetscCall(PetscFree(body->A));
  PetscCall(PetscFree2(body->term, body->of_term));
  PetscCall(PetscFree(body->node));
  PetscCall(PetscFree3(body->joined, body->pressed, body->by));
  PetscCall(PetscFree(body->has_part));
  PetscFunctionReturn(0);
}
