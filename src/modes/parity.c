/*
   Modes with planes of symmetry (-symmetry): those of each parity by themselves, with the whole solution and the proof of
   completeness that a pencil has, then all of them in one table in order of frequency. What a parity needs, factors above
   all, is freed before the next one begins.
*/
#include "modesimpl.h"
#include <string.h>

/* What was found of the parities so far */
typedef struct {
  PetscInt n, n_parities, unknowns[8]; /* modes; parities, and the unknowns of each */
  PetscInt below;                      /* modes below the band, or -1 */
  Spectrum right, left;                /* vectors of all unknowns */
  Mode    *mode;                       /* [n] */
  char (*parity)[PARITY_LENGTH];       /* [n] */
  PetscInt found[8];                   /* modes of each, */
  char    *said[8];                    /* and what is said of their completeness */
  double   entries;                    /* of the largest factors */
  PetscInt shifts;
} Parities;

/* Adds the modes of one parity, which leave `modes` */
static PetscErrorCode ParitiesAppend(Modes modes, PetscInt c, Pencil whole, Parities *all)
{
  const PetscInt n = all->n + modes->n;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)n * sizeof(*all->mode), &all->mode));
  PetscCall(PetscRealloc((size_t)n * sizeof(*all->parity), &all->parity));
  PetscCall(PetscArraycpy(&all->mode[all->n], modes->mode, modes->n));
  for (PetscInt i = all->n; i < n; i++) PetscCall(PencilNameParity(whole, c, PARITY_LENGTH, all->parity[i]));
  PetscCall(SpectrumAppend(&modes->right, &all->right));
  PetscCall(SpectrumAppend(&modes->left_spectrum, &all->left));
  all->n       = n;
  all->entries = PetscMax(all->entries, modes->entries);
  all->shifts  = PetscMax(all->shifts, modes->shifts);
  PetscFunctionReturn(0);
}

/* Into modes->completeness how many modes of each parity are left, and what is said of their completeness */
static PetscErrorCode ParitiesDescribe(Modes modes, Pencil whole, Parities *all)
{
  char name[PARITY_LENGTH], text[sizeof(modes->completeness)], found[48];

  PetscFunctionBeginUser;
  modes->completeness[0] = 0;
  for (PetscInt c = 0; c < all->n_parities; c++) {
    PetscInt n = 0;

    PetscCall(PencilNameParity(whole, c, sizeof(name), name));
    for (PetscInt i = 0; i < all->n; i++) n += strcmp(all->parity[i], name) == 0;
    PetscCall(PetscSNPrintf(found, sizeof(found), " of %" PetscInt_FMT " found", all->found[c]));
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s%s: %" PetscInt_FMT " modes%s, %s", c ? "; " : "", name, n,
                            n < all->found[c] ? found : "", all->said[c]));
    PetscCall(PetscStrlcat(modes->completeness, text, sizeof(modes->completeness)));
    PetscCall(PetscFree(all->said[c]));
  }
  PetscFunctionReturn(0);
}

/* The modes of one parity; nothing where it has no unknowns, as one node in a plane leaves */
static PetscErrorCode ParitySolve(Modes modes, PetscInt c, Pencil whole, Parities *all)
{
  const PetscInt count = modes->count;
  PetscInt       n;
  PetscBool      none = PETSC_TRUE;
  Pencil         part;
  PencilMatrices matrices;
  Window         window = {0};

  PetscFunctionBeginUser;
  PetscCall(ModesReset(modes));
  PetscCall(PencilCreateParity(whole, c, &part));
  PetscCall(PencilGetMatrices(part, &matrices));
  PetscCall(MatGetSize(matrices.K, &n, NULL));
  all->unknowns[c] = n;
  modes->pencil    = part;
  modes->count     = PetscMin(count, n);
  modes->entries   = 0;
  if (n) PetscCall(PencilReleaseTerms(part));
  if (n) PetscCall(ModesFind(modes, &window, &none));
  all->found[c] = none ? 0 : modes->n;
  PetscCall(PetscStrallocpy(none ? "none in the band" : modes->completeness, &all->said[c]));
  if (!none) PetscCall(ParitiesAppend(modes, c, whole, all));
  all->below    = all->below < 0 || window.below < 0 ? -1 : all->below + window.below;
  modes->pencil = whole;
  modes->count  = count;
  PetscCall(ModesReset(modes));
  PetscCall(PencilDestroy(&part));
  PetscFunctionReturn(0);
}

/* Leaves the -modes_count modes nearest to the target, of as many of each parity */
static PetscErrorCode ParitiesTrim(Modes modes, Parities *all)
{
  const Window window = {.target = 2 * PETSC_PI * modes->target};

  PetscFunctionBeginUser;
  while (!modes->has_band && all->n > modes->count) {
    const PetscInt i = WindowFarthest(&window, &all->right), n = --all->n;

    PetscCall(SpectrumRemove(&all->right, i));
    if (all->left.n) PetscCall(SpectrumRemove(&all->left, i));
    PetscCall(PetscArraymove(&all->mode[i], &all->mode[i + 1], n - i));
    PetscCall(PetscArraymove(&all->parity[i], &all->parity[i + 1], n - i));
  }
  PetscFunctionReturn(0);
}

/* Puts all modes, in order of frequency, into `modes` */
static PetscErrorCode ParitiesMerge(Modes modes, Parities *all)
{
  const PetscInt n = all->n;
  PetscInt      *order;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &order));
  PetscCall(SpectrumOrder(&all->right, order));
  PetscCall(SpectrumPermute(&all->right, order));
  if (all->left.n) PetscCall(SpectrumPermute(&all->left, order));
  PetscCall(PetscMalloc1(n, &modes->mode));
  PetscCall(PetscMalloc1(n, &modes->parity));
  for (PetscInt k = 0; k < n; k++) {
    modes->mode[k] = all->mode[order[k]];
    PetscCall(PetscStrncpy(modes->parity[k], all->parity[order[k]], PARITY_LENGTH));
  }
  modes->n             = n;
  modes->shifts        = all->shifts;
  modes->right         = all->right;
  modes->left_spectrum = all->left;
  PetscCall(PetscFree(order));
  PetscCall(PetscFree(all->mode));
  PetscCall(PetscFree(all->parity));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSolveParities(Modes modes)
{
  Parities all     = {0};
  Pencil   whole   = modes->pencil;
  PetscInt n_whole = 0;

  PetscFunctionBeginUser;
  PetscCall(PencilGetParities(whole, &all.n_parities, NULL));
  if (all.n_parities == 1) {
    PetscCall(ModesSolve(modes));
    PetscFunctionReturn(0);
  }
  PetscCall(LimitBegin(modes));
  for (PetscInt c = 0; c < all.n_parities; c++) PetscCall(ParitySolve(modes, c, whole, &all));
  if (!all.n) PetscCall(ModesComplainNone(modes, all.below));
  PetscCall(ParitiesTrim(modes, &all));
  PetscCall(ParitiesDescribe(modes, whole, &all));
  PetscCall(ParitiesMerge(modes, &all));
  PetscCall(AsymmetryMeasure(modes));
  for (PetscInt c = 0; c < all.n_parities; c++) n_whole += all.unknowns[c];
  PetscCall(SavedBySymmetry(modes, all.n_parities, all.unknowns, n_whole, all.entries));
  PetscCall(ModesLabel(modes));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesSolveAny(Modes modes, PetscInt *n)
{
  Window    window;
  PetscBool none;

  PetscFunctionBeginUser;
  PetscCall(ModesReset(modes));
  PetscCall(LimitBegin(modes));
  PetscCall(ModesFind(modes, &window, &none));
  if (!none) PetscCall(ModesLabel(modes));
  modes->below = window.below;
  *n           = modes->n;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesGetParity(Modes modes, PetscInt i, const char **parity)
{
  PetscFunctionBeginUser;
  *parity = modes->parity ? modes->parity[i] : NULL;
  PetscFunctionReturn(0);
}
