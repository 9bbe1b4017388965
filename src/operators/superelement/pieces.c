/*
   Pieces of superelements: matrices of their own on the unknowns of another one. They stand behind all that have
   unknowns, and borrow these.
*/
#include "superelement.h"
#include "base/options/help.h"

PetscBool SuperelementNext(Operators o, const Superelement *whole, Superelement **piece)
{
  Superelement *end = o->superelements + o->n_superelements + o->n_pieces;

  for (*piece = *piece ? *piece + 1 : o->superelements; *piece < end; (*piece)++)
    if (*piece == whole || (*piece)->whole == whole) return PETSC_TRUE;
  *piece = NULL;
  return PETSC_FALSE;
}

/* Raises the error for one that has no matrix, of its own or of a piece */
static PetscErrorCode WholesCheckMatrices(Operators o)
{
  HelpKind help;

  PetscFunctionBeginUser;
  PetscCall(HelpIsAsked(&help));
  for (PetscInt k = 0; k < o->n_superelements + o->n_pieces && help == HELP_NONE; k++) {
    const Superelement *s     = &o->superelements[k];
    Superelement       *piece = NULL;
    PetscBool           has   = PETSC_FALSE;

    while (SuperelementNext(o, s, &piece))
      for (int i = 0; i < N_SUPERELEMENT; i++)
        if (piece->file[i][0]) has = PETSC_TRUE;
    PetscCheck(has, o->comm, PETSC_ERR_USER_INPUT, "superelement %s has no matrix: give -%s_k and -%s_m", s->name,
               s->name, s->name);
  }
  PetscFunctionReturn(0);
}

/* What is no piece, in the order of the options, then the pieces */
static PetscErrorCode WholesFirst(Operators o, PetscInt n)
{
  Superelement *sorted;
  PetscInt      at = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &sorted));
  for (int piece = 0; piece < 2; piece++)
    for (PetscInt i = 0; i < n; i++)
      if (!o->superelements[i].of[0] == !piece) sorted[at++] = o->superelements[i];
  PetscCall(PetscFree(o->superelements));
  o->superelements = sorted;
  PetscFunctionReturn(0);
}

/* Finds what each piece is of, and takes its unknowns */
static PetscErrorCode WholesFind(Operators o)
{
  PetscFunctionBeginUser;
  for (PetscInt i = o->n_superelements; i < o->n_superelements + o->n_pieces; i++) {
    Superelement *s = &o->superelements[i];

    for (PetscInt k = 0; k < o->n_superelements; k++)
      if (!strcmp(o->superelements[k].name, s->of)) s->whole = &o->superelements[k];
    PetscCheck(s->whole, o->comm, PETSC_ERR_USER_INPUT, "-%s_of '%s' is none of the -superelements that have a table",
               s->name, s->of);
    s->n       = s->whole->n;
    s->n_apart = s->whole->n_apart;
    s->row     = s->whole->row;
    PetscCall(PetscStrncpy(s->table, s->whole->table, sizeof(s->table)));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementsSort(Operators o, PetscInt n)
{
  PetscFunctionBeginUser;
  o->n_superelements = o->n_pieces = 0;
  for (PetscInt i = 0; i < n; i++) *(o->superelements[i].of[0] ? &o->n_pieces : &o->n_superelements) += 1;
  PetscCall(WholesFirst(o, n));
  PetscCall(WholesFind(o));
  PetscCall(WholesCheckMatrices(o));
  PetscFunctionReturn(0);
}

void SuperelementPlacePiece(Superelement *piece)
{
  piece->first_apart = piece->whole->first_apart;
  piece->n_shares    = piece->whole->n_shares;
  piece->share       = piece->whole->share;
}

PetscErrorCode SuperelementSum(Operators o, const Superelement *s, int i, Mat *sum)
{
  Superelement *piece = NULL;

  PetscFunctionBeginUser;
  *sum = NULL;
  while (SuperelementNext(o, s, &piece)) {
    if (!piece->A[i] || piece->scale[i] == 0) continue;
    if (*sum)
      PetscCall(MatAXPY(*sum, piece->scale[i], piece->A[i], DIFFERENT_NONZERO_PATTERN));
    else {
      PetscCall(MatDuplicate(piece->A[i], MAT_COPY_VALUES, sum));
      PetscCall(MatScale(*sum, piece->scale[i]));
    }
  }
  PetscFunctionReturn(0);
}
