/*
   Bodies: parts, superelements among them, that a term of K or M connects, but for contact and bushings, or that follow
   others. A random vector r that is zero outside of a part has A r and Z r exactly zero at what is not connected with
   it.
*/
#include "components.h"
#include "solver/block/orthonormal.h"
#include "base/text.h"

/* Random numbers from 1 to 2 that are the same on any ranks: multiples of the golden ratio */
static PetscReal Scatter(PetscInt unknown)
{
  const PetscReal x = 0.6180339887498949 * (PetscReal)(unknown + 1);

  return 1 + x - PetscFloorReal(x);
}

/* Unknowns apart are of their superelement */
static PetscErrorCode PartsOfUnknownsApart(Operators operators, PetscInt n_parts, Vec part)
{
  const PetscScalar *own;
  PetscScalar       *at;
  PetscInt           n;
  Vec                mark;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(part, &mark));
  PetscCall(VecGetLocalSize(part, &n));
  for (PetscInt k = 0; k < OperatorsCountSuperelements(operators); k++) {
    PetscCall(OperatorsMarkSuperelement(operators, k, PETSC_TRUE, mark));
    PetscCall(VecGetArrayRead(mark, &own));
    PetscCall(VecGetArray(part, &at));
    for (PetscInt i = 0; i < n; i++)
      if (own[i] != 0) at[i] = n_parts + k;
    PetscCall(VecRestoreArray(part, &at));
    PetscCall(VecRestoreArrayRead(mark, &own));
  }
  PetscCall(VecDestroy(&mark));
  PetscFunctionReturn(0);
}

/* Part of each unknown of this rank, `none` where no cell of this rank has it */
static PetscErrorCode PartsOfUnknowns(Operators operators, const Mesh *mesh, PetscInt none, Vec part)
{
  PetscScalar *at;

  PetscFunctionBeginUser;
  PetscCall(VecSet(part, none));
  PetscCall(VecGetArray(part, &at));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt k = 3 * mesh->cell_first[c]; k < 3 * mesh->cell_first[c + 1]; k++) {
      const PetscInt own = mesh->unknown[3 * mesh->cell_node[k / 3] + k % 3] - mesh->first_own;

      if (own >= 0 && own < mesh->n_own) at[own] = mesh->cell_part[c];
    }
  PetscCall(VecRestoreArray(part, &at));
  PetscCall(PartsOfUnknownsApart(operators, mesh->n_parts, part));
  PetscFunctionReturn(0);
}

/* Marks the parts (row of `joined`) at which a vector is not zero */
static PetscErrorCode PartsMark(Vec part, Vec moved, PetscInt row[])
{
  const PetscScalar *at, *u;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(part, &n));
  PetscCall(VecGetArrayRead(part, &at));
  PetscCall(VecGetArrayRead(moved, &u));
  for (PetscInt i = 0; i < n; i++)
    if (u[i] != 0) row[(PetscInt)at[i]] = 1;
  PetscCall(VecRestoreArrayRead(moved, &u));
  PetscCall(VecRestoreArrayRead(part, &at));
  PetscFunctionReturn(0);
}

/* r of one part: zero elsewhere */
static PetscErrorCode PartTake(Vec part, PetscInt which, Vec r)
{
  const PetscScalar *at;
  PetscScalar       *value;
  PetscInt           n, first;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(part, &n));
  PetscCall(VecGetOwnershipRange(part, &first, NULL));
  PetscCall(VecGetArrayRead(part, &at));
  PetscCall(VecGetArrayWrite(r, &value));
  for (PetscInt i = 0; i < n; i++) value[i] = (PetscInt)at[i] == which ? Scatter(first + i) : 0;
  PetscCall(VecRestoreArrayWrite(r, &value));
  PetscCall(VecRestoreArrayRead(part, &at));
  PetscFunctionReturn(0);
}

/* Marks in joined[p][] the parts at which column p of a matrix of n columns is not zero */
static PetscErrorCode PartsMarkAll(Vec part, Mat moved, PetscInt n, PetscInt joined[])
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < n; p++) {
    Vec column;

    PetscCall(MatDenseGetColumnVecRead(moved, p, &column));
    PetscCall(PartsMark(part, column, &joined[p * n]));
    PetscCall(MatDenseRestoreColumnVecRead(moved, p, &column));
  }
  PetscFunctionReturn(0);
}

/* R, whose column p is r of part p */
static PetscErrorCode PartsScatter(Vec part, PetscInt n, Mat *R)
{
  PetscInt n_own;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(part, &n_own));
  PetscCall(MatCreateDense(PetscObjectComm((PetscObject)part), n_own, PETSC_DECIDE, PETSC_DETERMINE, n, NULL, R));
  for (PetscInt p = 0; p < n; p++) {
    Vec column;

    PetscCall(MatDenseGetColumnVecWrite(*R, p, &column));
    PetscCall(PartTake(part, p, column));
    PetscCall(MatDenseRestoreColumnVecWrite(*R, p, &column));
  }
  PetscFunctionReturn(0);
}

/* What displacements that follow others join: Z E' r of part p, in the unknowns that follow none and in all */
static PetscErrorCode PartsJoinFollowers(Operators operators, Vec part, PetscInt n, Mat R, PetscInt joined[])
{
  Mat Z, E;
  Vec q, u;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetDependents(operators, &Z, &E));
  if (!Z) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(Z, &q, &u));
  for (PetscInt p = 0; p < n; p++) {
    Vec column;

    PetscCall(MatDenseGetColumnVecRead(R, p, &column));
    PetscCall(MatMultTranspose(E, column, q));
    PetscCall(MatDenseRestoreColumnVecRead(R, p, &column));
    PetscCall(MatMult(Z, q, u));
    PetscCall(PartsMark(part, u, &joined[p * n]));
  }
  PetscCall(VecDestroy(&q));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

/* What superelements join, also those that have no unknown but those of nodes; they stand last before what has no
   part */
static PetscErrorCode PartsJoinSuperelements(Operators operators, Vec part, PetscInt n, PetscInt joined[])
{
  const PetscInt n_super = OperatorsCountSuperelements(operators);
  Vec            mark;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(part, &mark));
  for (PetscInt k = 0; k < n_super; k++) {
    const PetscInt p   = n - 1 - n_super + k;
    PetscInt      *row = &joined[p * n], any = 0;

    PetscCall(OperatorsMarkSuperelement(operators, k, PETSC_FALSE, mark));
    PetscCall(PartsMark(part, mark, row));
    for (PetscInt q = 0; q < n; q++) any = PetscMax(any, row[q]);
    row[p] = any;
  }
  PetscCall(VecDestroy(&mark));
  PetscFunctionReturn(0);
}

/* joined[p][q] of n parts: whether p is connected with q; with itself: whether it has unknowns */
static PetscErrorCode PartsJoin(Pencil pencil, Operators operators, PetscInt n, Vec part, PetscInt joined[])
{
  PetscInt n_terms;
  Mat      R, AR, *terms;

  PetscFunctionBeginUser;
  PetscCall(PartsScatter(part, n, &R));
  PetscCall(PartsMarkAll(part, R, n, joined));
  PetscCall(PartsJoinFollowers(operators, part, n, R, joined));
  PetscCall(PartsJoinSuperelements(operators, part, n, joined));
  PetscCall(MatDuplicate(R, MAT_DO_NOT_COPY_VALUES, &AR));
  PetscCall(PencilGetTermsApart(pencil, &n_terms, &terms));
  for (PetscInt t = 0; t < n_terms; t++) {
    PetscCall(BlockMultiply(terms[t], R, AR));
    PetscCall(PartsMarkAll(part, AR, n, joined));
  }
  PetscCall(PetscFree(terms));
  PetscCall(MatDestroy(&AR));
  PetscCall(MatDestroy(&R));
  PetscCallMPI(
    MPI_Allreduce(MPI_IN_PLACE, joined, (PetscMPIInt)(n * n), MPIU_INT, MPI_MAX, PetscObjectComm((PetscObject)part)));
  PetscFunctionReturn(0);
}

/* Numbers the bodies by their first parts: body[n], -1 for a part without unknowns */
static PetscInt FreeBodiesNumber(PetscInt n, const PetscInt joined[], PetscInt body[])
{
  PetscInt n_bodies = 0;

  for (PetscInt p = 0; p < n; p++) body[p] = joined[p * n + p] ? p : -1;
  for (PetscBool again = PETSC_TRUE; again;) {
    again = PETSC_FALSE;
    for (PetscInt p = 0; p < n; p++)
      for (PetscInt q = 0; q < n; q++)
        if (joined[p * n + q] && body[p] != body[q]) {
          body[p] = body[q] = PetscMin(body[p], body[q]);
          again             = PETSC_TRUE;
        }
  }
  for (PetscInt p = 0; p < n; p++) body[p] = body[p] == p ? n_bodies++ : body[p] < 0 ? -1 : body[body[p]];
  return n_bodies;
}

/* Names of the bodies; what has no part is called so */
static PetscErrorCode FreeBodiesName(Operators operators, PetscInt n_parts, const PetscInt body[], FreeBodies *bodies)
{
  char        name[1024];
  const char *part;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(bodies->n, &bodies->name));
  for (PetscInt b = 0; b < bodies->n; b++) {
    name[0] = 0;
    for (PetscInt p = 0; p < n_parts; p++) {
      if (body[p] != b) continue;
      PetscCall(OperatorsGetPartName(operators, p, &part));
      PetscCall(TextAdd(name, name[0] ? "+" : "", sizeof(name)));
      PetscCall(TextAdd(name, part, sizeof(name)));
    }
    PetscCall(PetscStrallocpy(name[0] ? name : "no part", &bodies->name[b]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBodiesFind(Pencil pencil, FreeBodies **found)
{
  FreeBodies        *bodies;
  const PetscScalar *at;
  PetscInt           n, n_parts, n_own, *joined, *body;
  Operators          operators;
  const Mesh        *mesh;
  Vec                part;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(pencil, &operators));
  PetscCall(OperatorsGetMesh(operators, &mesh));
  PetscCall(OperatorsCountParts(operators, &n_parts));
  n = n_parts + 1;
  PetscCall(PetscCalloc1(1, found));
  bodies = *found;
  PetscCall(PetscCalloc2(n * n, &joined, n, &body));
  PetscCall(OperatorsCreateVec(operators, &part));
  PetscCall(PartsOfUnknowns(operators, mesh, n_parts, part));
  PetscCall(PartsJoin(pencil, operators, n, part, joined));
  bodies->n = FreeBodiesNumber(n, joined, body);
  PetscCall(FreeBodiesName(operators, n_parts, body, bodies));
  PetscCall(VecGetLocalSize(part, &n_own));
  PetscCall(PetscMalloc1(n_own, &bodies->of));
  PetscCall(VecGetArrayRead(part, &at));
  for (PetscInt i = 0; i < n_own; i++) bodies->of[i] = body[(PetscInt)at[i]];
  PetscCall(VecRestoreArrayRead(part, &at));
  PetscCall(PetscMalloc1(n_parts, &bodies->of_part));
  PetscCall(PetscArraycpy(bodies->of_part, body, n_parts));
  PetscCall(VecDestroy(&part));
  PetscCall(PetscFree2(joined, body));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBodiesAddDot(const FreeBodies *bodies, Vec a, Vec b, PetscReal sums[])
{
  const PetscScalar *x, *y;
  PetscInt           n;

  PetscFunctionBeginUser;
  if (!a || !b) PetscFunctionReturn(0);
  PetscCall(VecGetLocalSize(a, &n));
  PetscCall(VecGetArrayRead(a, &x));
  PetscCall(VecGetArrayRead(b, &y));
  for (PetscInt i = 0; i < n; i++) sums[bodies->of[i]] += x[i] * y[i];
  PetscCall(VecRestoreArrayRead(b, &y));
  PetscCall(VecRestoreArrayRead(a, &x));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeBodiesDestroy(FreeBodies **bodies)
{
  PetscFunctionBeginUser;
  if (!*bodies) PetscFunctionReturn(0);
  for (PetscInt b = 0; b < (*bodies)->n; b++) PetscCall(PetscFree((*bodies)->name[b]));
  PetscCall(PetscFree((*bodies)->name));
  PetscCall(PetscFree((*bodies)->of));
  PetscCall(PetscFree((*bodies)->of_part));
  PetscCall(PetscFree(*bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode ComponentsDestroy(ModesComponents *c)
{
  PetscFunctionBeginUser;
  if (!*c) PetscFunctionReturn(0);
  PetscCall(PetscFree((*c)->level));
  PetscCall(PetscFree((*c)->found_of));
  PetscCall(PetscFree((*c)->column));
  PetscCall(PetscFree((*c)->dot));
  PetscCall(PetscFree((*c)->mass));
  PetscCall(PetscFree((*c)->free));
  PetscCall(PetscFree((*c)->own));
  PetscCall(VecDestroy(&(*c)->probe));
  PetscCall(PetscFree3((*c)->share, (*c)->energy, (*c)->mixed));
  PetscCall(PetscFree(*c));
  PetscFunctionReturn(0);
}
