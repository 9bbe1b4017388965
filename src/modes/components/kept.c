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

/* Free modes among the vectors, of all bodies up to the limit, (rad/s)^2 */
static PetscErrorCode KeptSolve(Modes modes, PetscInt n, const Vec v[], PetscReal limit)
{
  FreeMatrices bodies;
  FreeBasis    basis;
  Operators    operators;
  PetscInt    *n_modes;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(PencilGetMass(modes->pencil, &bodies.M));
  PetscCall(PencilGetStiffnessApart(modes->pencil, &bodies.K, &bodies.less));
  PetscCall(FreeBasisCreate(modes->bodies, bodies.M, n + FREE_MOTIONS, &basis));
  PetscCall(PetscArraycpy(basis.v, v, n));
  PetscCall(FreeBasisSetMotions(operators, &basis));
  PetscCall(FreeBasisSolve(&bodies, &basis));
  PetscCall(PetscCalloc1(modes->bodies->n, &n_modes));
  for (PetscInt b = 0; b < modes->bodies->n; b++)
    while (n_modes[b] < basis.n_modes[b] && basis.kappa[b * basis.n + n_modes[b]] <= limit) n_modes[b]++;
  PetscCall(FreeBasisCollect(operators, &bodies, &basis, n_modes, modes->kept, modes->kept_free));
  PetscCall(PetscFree(n_modes));
  PetscCall(FreeBasisDestroy(&basis));
  PetscFunctionReturn(0);
}

/* Levels and names; what shares are made of is not kept */
static PetscErrorCode KeptName(Modes modes)
{
  const ModesComponents c    = modes->kept;
  const Modes           free = modes->kept_free;
  Vec                   x;
  Mat                   M;

  PetscFunctionBeginUser;
  PetscCall(FreeLevelsFind(free, c));
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(FreeLevelsName(modes, free, M, c));
  PetscCall(MatCreateVecs(M, NULL, &c->probe));
  PetscCall(VecSet(c->probe, 0));
  for (PetscInt k = 0; k < free->n; k++) {
    if (k && c->found_of[k] == c->found_of[k - 1]) continue;
    PetscCall(ModesGetVectors(free, k, &x, NULL, NULL, NULL));
    PetscCall(VecAXPY(c->probe, 1, x));
  }
  c->names = PETSC_TRUE;
  PetscCall(PetscFree(c->dot));
  PetscFunctionReturn(0);
}

static PetscErrorCode KeptMake(Modes modes, PetscInt n, const Vec v[])
{
  const PetscReal top = 2 * PETSC_PI * modes->band[1];

  PetscFunctionBeginUser;
  PetscCall(PencilKeepApart(modes->pencil));
  PetscCall(FreeBodiesFind(modes->pencil, &modes->bodies));
  PetscCall(PetscCalloc1(1, &modes->kept));
  modes->kept->bodies = *modes->bodies;
  modes->kept->found  = PETSC_TRUE;
  PetscCall(FreeModesBegin(modes, &modes->kept_free));
  PetscCall(KeptSolve(modes, n, v, PetscSqr(KEPT_REACH * top)));
  if (modes->kept_free->n) PetscCall(KeptName(modes));
  PetscCall(LabelsForgetWeights(modes));
  PetscCall(LabelsForgetWeights(modes->kept_free));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesKeepFree(Modes modes, PetscInt n, const Vec vectors[])
{
  Operators operators;
  Model     model;

  PetscFunctionBeginUser;
  PetscCall(FreeBodiesDestroy(&modes->bodies));
  PetscCall(ComponentsDestroy(&modes->kept));
  PetscCall(ModesDestroy(&modes->kept_free));
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  if (!model || !modes->free_found) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_COMPONENTS));
  PetscCall(KeptMake(modes, n, vectors));
  if (!modes->kept_free->n) PetscCall(ComponentsDestroy(&modes->kept));
  PetscCall(EventEnd(EVENT_COMPONENTS));
  PetscFunctionReturn(0);
}

/* r[bodies] */
static PetscErrorCode KeptRatios(const Modes modes, const ModesComponents kept, PetscReal r[])
{
  Mat M;
  Vec product;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(VecDuplicate(kept->probe, &product));
  PetscCall(MatMult(M, kept->probe, product));
  PetscCall(FreeBodiesAddDot(&kept->bodies, kept->probe, product, r));
  PetscCall(VecDestroy(&product));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r, (PetscMPIInt)kept->bodies.n, MPIU_REAL, MPI_SUM, modes->comm));
  PetscFunctionReturn(0);
}

/* The energies of the levels, of which the last is the whole body */
static void EnergiesDivide(PetscInt n_modes, const PetscReal r[], ModesComponents c)
{
  const PetscInt n = c->bodies.n;

  for (PetscInt i = 0; i < n_modes * (c->n_levels + 1) * n; i++)
    if (i / n % (c->n_levels + 1) < c->n_levels && r[i % n] > 0) c->energy[i] /= r[i % n];
}

/* Names of shapes by the free modes that are kept, where there are any */
static PetscErrorCode KeptLabel(Modes shapes)
{
  const ModesComponents kept = shapes->kept;
  PetscReal            *r;

  PetscFunctionBeginUser;
  if (!kept) PetscFunctionReturn(0);
  PetscCall(EventBegin(EVENT_COMPONENTS));
  PetscCall(PetscCalloc1(kept->bodies.n, &r));
  PetscCall(KeptRatios(shapes, kept, r));
  shapes->components = kept;
  PetscCall(FreeSharesFind(shapes, shapes->kept_free, kept));
  EnergiesDivide(shapes->n, r, kept);
  PetscCall(ComponentsLabel(shapes));
  shapes->components = NULL;
  PetscCall(PetscFree3(kept->share, kept->energy, kept->mixed));
  PetscCall(PetscFree(r));
  PetscCall(EventEnd(EVENT_COMPONENTS));
  PetscFunctionReturn(0);
}

/* Adds one complex vector of the pencil, expanded to all unknowns */
static PetscErrorCode SpectrumAddExpanded(Pencil pencil, PetscBool left, Vec r, Vec i, Vec work[2], Spectrum *s)
{
  PetscFunctionBeginUser;
  PetscCall(PencilExpand(pencil, left, r, work[0]));
  PetscCall(PencilExpand(pencil, left, i, work[1]));
  PetscCall(SpectrumAdd(s, 0, 0, work[0], work[1]));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesLabelShapes(Modes modes, const ModesShapes *given, char label[][32])
{
  const PetscInt  n      = given->n;
  struct _p_Modes shapes = *modes;
  Operators       operators;
  Vec             work[2];

  PetscFunctionBeginUser;
  shapes.n            = n;
  shapes.part_percent = shapes.label_percent = NULL;
  shapes.label_part                          = NULL;
  shapes.weights                             = NULL; /* densities may have changed */
  PetscCall(SpectrumCreate(n, &shapes.right));
  PetscCall(SpectrumCreate(n, &shapes.left_spectrum));
  PetscCall(PetscCalloc1(n, &shapes.mode));
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsCreateVec(operators, &work[0]));
  PetscCall(VecDuplicate(work[0], &work[1]));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(SpectrumAddExpanded(modes->pencil, PETSC_FALSE, given->xr[i], given->xi[i], work, &shapes.right));
    PetscCall(SpectrumAddExpanded(modes->pencil, PETSC_TRUE, given->yr[i], given->yi[i], work, &shapes.left_spectrum));
    shapes.mode[i].rigid = given->rigid[i];
  }
  PetscCall(ModesLabel(&shapes));
  PetscCall(KeptLabel(&shapes));
  for (PetscInt i = 0; i < n; i++) PetscCall(PetscStrncpy(label[i], shapes.mode[i].label, 32));
  PetscCall(VecDestroy(&work[0]));
  PetscCall(VecDestroy(&work[1]));
  PetscCall(SpectrumDestroy(&shapes.right));
  PetscCall(SpectrumDestroy(&shapes.left_spectrum));
  PetscCall(LabelsForgetWeights(&shapes));
  PetscCall(PetscFree(shapes.mode));
  PetscCall(PetscFree(shapes.part_percent));
  PetscCall(PetscFree(shapes.label_percent));
  PetscCall(PetscFree(shapes.label_part));
  PetscFunctionReturn(0);
}
