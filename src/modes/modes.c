/*
   Modes: life cycle and the flow of a solution: window -> factorisation -> right vectors -> left vectors ->
   errors -> labels, with the check that no mode is missing.
*/
#include "modesimpl.h"
#include "base/events.h"
#include "base/process/memory.h"
#include "solver/block/krylov.h"
#include "solver/factor/ordering.h"
#include <squeal/options.h>

PetscErrorCode ModesCreate(MPI_Comm comm, Modes *modes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, modes));
  (*modes)->comm = comm;
  PetscCall(QuantitiesInit(&modes_quantities, *modes));
  PetscCall(OrderingRegister()); /* for -st_pc_factor_mat_ordering_type metis */
  PetscCall(BlockKrylovRegister());
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSetPencil(Modes modes, Pencil pencil)
{
  const PetscReal middle = 2 * PETSC_PI * (modes->has_band ? (modes->band[0] + modes->band[1]) / 2 : modes->target);

  PetscFunctionBeginUser;
  modes->pencil   = pencil;
  modes->may_move = PETSC_FALSE;
  if (!pencil || !PencilHasLaws(pencil) || PencilGetReference(pencil) != 0) PetscFunctionReturn(0);
  PetscCheck(middle > 0, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_target 0: the stiffness of a part depends on the frequency, and at 0 Hz nothing oscillates; give "
             "a target above it, or a -modes_band");
  PetscCall(PencilSetReference(pencil, middle));
  modes->may_move = modes->has_band ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesAddChecksum(Modes modes, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "options of modes"));
  PetscCall(QuantitiesAddChecksum(&modes_quantities, modes, c));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSetLoaded(Modes modes, PetscBool loaded)
{
  PetscFunctionBeginUser;
  modes->loaded = loaded;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesGetContact(Modes modes, PetscBool *is_static)
{
  PetscFunctionBeginUser;
  *is_static = modes->about == ABOUT_STATIC || (modes->about == ABOUT_AUTO && modes->loaded) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesAllowNone(Modes modes)
{
  PetscFunctionBeginUser;
  modes->may_be_none = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesGetBand(Modes modes, PetscReal band[2], PetscReal *growth)
{
  PetscFunctionBeginUser;
  PetscCheck(modes->has_band, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_band must be given here, as f1,f2 in Hz: -modes_target is for -analysis modes");
  band[0] = modes->band[0];
  band[1] = modes->band[1];
  *growth = modes->growth > 0 ? modes->growth : 0.1 * 2 * PETSC_PI * band[1];
  PetscFunctionReturn(0);
}

PetscErrorCode ModesGetRoutes(Modes modes, PetscBool *may_project, PetscBool *may_pep)
{
  PetscFunctionBeginUser;
  *may_project = modes->damping != DAMPING_PEP ? PETSC_TRUE : PETSC_FALSE;
  *may_pep     = modes->damping != DAMPING_PROJECT ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesHaveBand(Modes modes, PetscBool *has_band)
{
  PetscFunctionBeginUser;
  *has_band = modes->has_band;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWant(Modes modes, PetscBool *nearest, PetscBool *left)
{
  PetscFunctionBeginUser;
  *nearest = modes->has_nearest;
  *left    = modes->left;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesKeepFactor(Modes modes, PetscBool keep)
{
  PetscFunctionBeginUser;
  modes->keep = keep;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesGetFactor(Modes modes, const struct ShiftInvert **factor)
{
  PetscFunctionBeginUser;
  PetscCheck(modes->factor.ksp, modes->comm, PETSC_ERR_ARG_WRONGSTATE, "no factorisation was kept");
  *factor = &modes->factor;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSetBand(Modes modes, const PetscReal band[2])
{
  PetscFunctionBeginUser;
  modes->band[0]  = band[0];
  modes->band[1]  = band[1];
  modes->has_band = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Forgets the last solution */
static PetscErrorCode ModesReset(Modes modes)
{
  PetscFunctionBeginUser;
  PetscCall(SpectrumDestroy(&modes->right));
  PetscCall(SpectrumDestroy(&modes->left_spectrum));
  PetscCall(PetscFree(modes->mode));
  PetscCall(PetscFree(modes->mechanism));
  PetscCall(ModesForgetShares(modes));
  PetscCall(PetscFree(modes->residual));
  PetscCall(PetscFree(modes->part_percent));
  PetscCall(PetscFree(modes->label_percent));
  PetscCall(PetscFree(modes->label_part));
  PetscCall(LabelsForgetWeights(modes));
  PetscCall(ComponentsDestroy(&modes->components));
  PetscCall(ChangesReset(modes));
  PetscCall(EPSDestroy(&modes->left_solver));
  PetscCall(ShiftInvertDestroy(&modes->factor));
  PetscCall(ShiftInvertDestroy(&modes->counter));
  modes->n        = 0;
  modes->block[0] = 0;
  modes->dense    = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* All modes of the window with factorisations of their own problem */
static PetscErrorCode SolveWhole(Modes modes, const PencilMatrices *pencil, Window *window)
{
  ShiftInvert si;

  PetscFunctionBeginUser;
  if (pencil->C) PetscCall(WindowSetDamping(modes, pencil, window));
  if (window->count && pencil->C) PetscCall(WindowReach(modes, window));
  PetscCall(ShiftsSolve(modes, pencil, window, &si));
  if (modes->keep)
    modes->factor = si;
  else
    PetscCall(ShiftInvertDestroy(&si));
  MemoryReturn(); /* before K is formed again */
  PetscFunctionReturn(0);
}

/* The same of a damped pencil by projection, where that is the route, with factors of the undamped problem */
static PetscErrorCode SolveProjected(Modes modes, const PencilMatrices *pencil, Window *window)
{
  PetscFunctionBeginUser;
  PetscCheck(
    modes->damping != DAMPING_PEP || !pencil->n_laws, modes->comm, PETSC_ERR_USER_INPUT,
    "-modes_damping pep: the stiffness of a part depends on the frequency, which is no quadratic problem; leave "
    "it out");
  if (!pencil->C || modes->damping == DAMPING_PEP) PetscFunctionReturn(0);
  if (window->known.singular) /* undamped vectors orthonormal in M are no basis of unknowns without mass */
    PetscCall(PetscStrncpy(window->route.why, "unknowns have no mass", sizeof(window->route.why)));
  else
    PetscCall(ProjectSolve(modes, pencil, window, &window->route.project));
  PetscCheck(
    window->route.project || window->route.middle > 0 || !pencil->n_laws, modes->comm, PETSC_ERR_NOT_CONVERGED,
    "modes of materials whose stiffness depends on the frequency are found by projection, which cannot be done: "
    "%s; give %sless damping, or damp fewer parts, or give a loss factor with -model_loss_frequency, which is viscous "
    "damping, exact at that frequency",
    window->route.why, modes->has_band ? "" : "a -modes_band, or a -modes_target nearer to the modes, or ");
  PetscCheck(window->route.project || modes->damping != DAMPING_PROJECT, modes->comm, PETSC_ERR_NOT_CONVERGED,
             "-modes_damping project cannot be done: %s; use auto or pep", window->route.why);
  PetscFunctionReturn(0);
}

/* Raises an error where a table of a material does not reach as far as modes are asked for, or were found */
static PetscErrorCode CheckLaws(Modes modes, PetscBool found)
{
  const PetscReal turn     = 2 * PETSC_PI;
  PetscReal       range[2] = {turn * modes->band[0], turn * modes->band[1]};

  PetscFunctionBeginUser;
  if (!PencilHasLaws(modes->pencil) || modes->has_band == found) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < modes->n && found; i++) {
    if (!i) range[0] = range[1] = modes->mode[i].omega;
    range[0] = PetscMin(range[0], modes->mode[i].omega);
    range[1] = PetscMax(range[1], modes->mode[i].omega);
  }
  if (!found || modes->n) PetscCall(PencilCheckRange(modes->pencil, found ? "-modes_target" : "-modes_band", range));
  PetscFunctionReturn(0);
}

/* All modes of the pencil in the window, but for their names; none = there is none in it. Again with another reference
   where undamped modes lie far above a target (project.c) */
static PetscErrorCode FindAll(Modes modes, Window *window, PetscBool *none)
{
  PencilMatrices pencil;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(modes->pencil, &pencil));
  modes->counter = (ShiftInvert){.progress = &modes->progress, .halves = !modes->keep};
  modes->null    = (ShiftInvert){.factored = PETSC_FALSE};
  if (modes->has_route && !pencil.C)
    PetscCall(OptionsRefuse(modes->comm, MODES_DAMPING, "not used without damping; leave it out"));
  PetscCall(CheckLaws(modes, PETSC_FALSE));
  PetscCall(WindowFind(modes, window));
  PetscCall(WindowCheckCount(modes, window));
  *none = window->known.expected == 0 && pencil.symmetric && !pencil.C ? PETSC_TRUE : PETSC_FALSE;
  if (*none) PetscFunctionReturn(0);
  PetscCall(ShiftsChoose(modes, &pencil, window));
  PetscCall(SolveProjected(modes, &pencil, window));
  if (window->route.middle > 0) {
    modes->may_move = PETSC_FALSE;
    PetscCall(PencilSetReference(modes->pencil, window->route.middle));
    PetscCall(ModesReset(modes));
    PetscCall(FindAll(modes, window, none));
    PetscFunctionReturn(0);
  }
  if (!window->route.project) PetscCall(SolveWhole(modes, &pencil, window));
  PetscCall(PencilGetMatrices(modes->pencil, &pencil)); /* which may have been freed meanwhile */
  *none = modes->right.n ? PETSC_FALSE : PETSC_TRUE;
  if (*none) window->known.below = -1; /* which says nothing of a mode with friction or damping */
  if (*none) PetscFunctionReturn(0);
  PetscCall(NullDecaysCorrect(modes, &pencil, window));
  PetscCall(QualityMeasure(modes, &pencil));
  PetscCall(CheckLaws(modes, PETSC_TRUE));
  PetscCall(ShiftInvertDestroy(&modes->counter));
  if (window->known.rigid) PetscCall(TwinsDrop(modes, window));
  if (window->known.rigid) PetscCall(NullVectorsRefine(modes, &pencil, window));
  if (window->known.rigid) PetscCall(TwinsTrim(modes, window));
  PetscCall(NullForget(modes));
  PetscCall(WindowDescribe(modes, window));
  PetscCall(SavedByDamping(modes, &pencil, window));
  PetscFunctionReturn(0);
}

/* A band without a mode */
static PetscErrorCode ComplainNone(Modes modes, PetscInt below)
{
  char lower[64] = "";

  PetscFunctionBeginUser;
  if (below >= 0) PetscCall(PetscSNPrintf(lower, sizeof(lower), " (%" PetscInt_FMT " lie below it)", below));
  SETERRQ(modes->comm, PETSC_ERR_USER_INPUT, "-modes_band %.6g,%.6g Hz contains no mode%s; widen it",
          (double)modes->band[0], (double)modes->band[1], lower);
}

PetscErrorCode ModesSolve(Modes modes)
{
  Window    window;
  PetscBool none;

  PetscFunctionBeginUser;
  PetscCall(ModesReset(modes));
  PetscCall(LimitBegin(modes));
  PetscCall(FindAll(modes, &window, &none));
  if (!modes->n && modes->may_be_none) PetscFunctionReturn(0);
  if (!modes->n) PetscCall(ComplainNone(modes, window.known.below));
  PetscCall(EventBegin(EVENT_LABEL));
  PetscCall(ModesLabel(modes));
  PetscCall(EventEnd(EVENT_LABEL));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesGet(Modes modes, PetscInt *n, const Mode **mode)
{
  PetscFunctionBeginUser;
  *n    = modes->n;
  *mode = modes->mode;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesDestroy(Modes *modes)
{
  PetscFunctionBeginUser;
  if (!*modes) PetscFunctionReturn(0);
  PetscCall(ModesReset(*modes));
  PetscCall(ChangesDestroy(*modes));
  PetscCall(FreeBodiesDestroy(&(*modes)->bodies));
  PetscCall(ComponentsDestroy(&(*modes)->kept));
  PetscCall(ModesDestroy(&(*modes)->kept_free));
  PetscCall(PetscFree(*modes));
  PetscFunctionReturn(0);
}
