/*
   Names of shapes from elsewhere, those of sweeps, by free modes phi of the bodies that are found once, among vectors
   of the space in which the shapes are (ritz.c): all of them up to a multiple of the band. Later shapes are beside them
   as names.c says,

      MAC = sum_k |phi_k' M_b x|^2 / (r_b x^H M_b x),   r_b = phi' M_b phi of one of them,

   at whatever parameters: r_b = 1 but where a density has changed since.
*/
#include "components.h"
#include "base/events.h"

#define KEPT_REACH 3 /* of the band: parameters may bring free modes from there into it */

struct _p_ModesKept {
  FreeBodies     *bodies;
  ModesComponents c;
  Modes           free;
  Vec             probe; /* the sum of the first free modes of the bodies, one of each */
};

/* Free modes among the vectors, of all bodies up to the limit, (rad/s)^2 */
static PetscErrorCode KeptSolve(Modes modes, PetscInt n, const Vec v[], PetscReal limit, ModesKept kept)
{
  FreeMatrices bodies;
  FreeBasis    basis;
  Operators    operators;
  PetscInt    *n_modes;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(PencilGetMass(modes->pencil, &bodies.M));
  PetscCall(PencilGetStiffnessApart(modes->pencil, &bodies.K, &bodies.less));
  PetscCall(FreeBasisCreate(kept->bodies, bodies.M, n + FREE_MOTIONS, &basis));
  PetscCall(PetscArraycpy(basis.v, v, n));
  PetscCall(FreeBasisSetMotions(operators, &basis));
  PetscCall(FreeBasisSolve(&bodies, &basis));
  PetscCall(PetscCalloc1(kept->bodies->n, &n_modes));
  for (PetscInt b = 0; b < kept->bodies->n; b++)
    while (n_modes[b] < basis.n_modes[b] && basis.kappa[b * basis.n + n_modes[b]] <= limit) n_modes[b]++;
  PetscCall(FreeBasisCollect(operators, &bodies, &basis, n_modes, kept->c, kept->free));
  PetscCall(PetscFree(n_modes));
  PetscCall(FreeBasisDestroy(&basis));
  PetscFunctionReturn(0);
}

/* Levels and names; what shares are made of is not kept */
static PetscErrorCode KeptName(Modes modes, ModesKept kept)
{
  const ModesComponents c = kept->c;
  Vec                   x;
  Mat                   M;

  PetscFunctionBeginUser;
  PetscCall(FreeLevelsFind(kept->free, c));
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(FreeLevelsName(modes, kept->free, M, c));
  PetscCall(MatCreateVecs(M, NULL, &kept->probe));
  PetscCall(VecSet(kept->probe, 0));
  for (PetscInt k = 0; k < kept->free->n; k++) {
    if (k && c->found_of[k] == c->found_of[k - 1]) continue;
    PetscCall(ModesGetVectors(kept->free, k, &x, NULL, NULL, NULL));
    PetscCall(VecAXPY(kept->probe, 1, x));
  }
  c->names = PETSC_TRUE;
  PetscCall(PetscFree(c->dot));
  PetscFunctionReturn(0);
}

static PetscErrorCode KeptMake(Modes modes, PetscInt n, const Vec v[], ModesKept kept)
{
  const PetscReal top = 2 * PETSC_PI * modes->band[1];

  PetscFunctionBeginUser;
  PetscCall(PencilKeepApart(modes->pencil));
  PetscCall(FreeBodiesFind(modes->pencil, &kept->bodies));
  PetscCall(PetscCalloc1(1, &kept->c));
  kept->c->bodies = *kept->bodies;
  kept->c->found  = PETSC_TRUE;
  PetscCall(FreeModesBegin(modes, &kept->free));
  PetscCall(KeptSolve(modes, n, v, PetscSqr(KEPT_REACH * top), kept));
  if (kept->free->n) PetscCall(KeptName(modes, kept));
  PetscCall(LabelsForgetWeights(modes));
  PetscCall(LabelsForgetWeights(kept->free));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesKeepFree(Modes modes, PetscInt n, const Vec vectors[])
{
  Operators operators;
  Model     model;

  PetscFunctionBeginUser;
  PetscCall(KeptDestroy(&modes->kept));
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  if (!model || !modes->free_found) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_COMPONENTS));
  PetscCall(PetscCalloc1(1, &modes->kept));
  PetscCall(KeptMake(modes, n, vectors, modes->kept));
  if (!modes->kept->free->n) PetscCall(KeptDestroy(&modes->kept));
  PetscCall(EventEnd(EVENT_COMPONENTS));
  PetscFunctionReturn(0);
}

/* r[bodies] */
static PetscErrorCode KeptRatios(const Modes modes, const ModesKept kept, PetscReal r[])
{
  Mat M;
  Vec product;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(VecDuplicate(kept->probe, &product));
  PetscCall(MatMult(M, kept->probe, product));
  PetscCall(FreeBodiesAddDot(kept->bodies, kept->probe, product, r));
  PetscCall(VecDestroy(&product));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r, (PetscMPIInt)kept->bodies->n, MPIU_REAL, MPI_SUM, modes->comm));
  PetscFunctionReturn(0);
}

/* The energies of the levels, of which the last is the whole body */
static void EnergiesDivide(PetscInt n_modes, const PetscReal r[], ModesComponents c)
{
  const PetscInt n = c->bodies.n;

  for (PetscInt i = 0; i < n_modes * (c->n_levels + 1) * n; i++)
    if (i / n % (c->n_levels + 1) < c->n_levels && r[i % n] > 0) c->energy[i] /= r[i % n];
}

PetscErrorCode KeptLabel(Modes shapes)
{
  const ModesKept kept = shapes->kept;
  PetscReal      *r;

  PetscFunctionBeginUser;
  if (!kept) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_COMPONENTS));
  PetscCall(PetscCalloc1(kept->bodies->n, &r));
  PetscCall(KeptRatios(shapes, kept, r));
  shapes->components = kept->c;
  PetscCall(FreeSharesFind(shapes, kept->free, kept->c));
  EnergiesDivide(shapes->n, r, kept->c);
  PetscCall(ComponentsLabel(shapes));
  shapes->components = NULL;
  PetscCall(PetscFree3(kept->c->share, kept->c->energy, kept->c->mixed));
  PetscCall(PetscFree(r));
  PetscCall(EventEnd(EVENT_COMPONENTS));
  PetscFunctionReturn(0);
}

PetscErrorCode KeptDestroy(ModesKept *kept)
{
  PetscFunctionBeginUser;
  if (!*kept) PetscFunctionReturn(0);
  PetscCall(ComponentsDestroy(&(*kept)->c));
  PetscCall(FreeBodiesDestroy(&(*kept)->bodies));
  PetscCall(ModesDestroy(&(*kept)->free));
  PetscCall(VecDestroy(&(*kept)->probe));
  PetscCall(PetscFree(*kept));
  PetscFunctionReturn(0);
}
