/*
   Contributions of component modes. Of each body by itself, its pairs open, without damping, spin and bushings to other
   bodies, the free modes phi_k below a multiple of the highest frequency of the band are found, phi_j' M phi_k = 1 for
   j = k, else 0. In body b a mode is x = sum_k phi_k (phi_k' M x) + rest, and its left vector y likewise. Hence, with
   M_b the part of M that belongs to the unknowns of b,

      share   s_bk = Re( (y^T M_b phi_k) (phi_k^T M_b x) / y^T M x )
      energy  e_bk = |phi_k^T M_b x|^2 / x^H M x

   and with the rests, s_b - sum_k s_bk for s_b = Re(y^T M_b x / y^T M x), the shares of all bodies sum to 1, as the
   energies do. Shares are participation factors (see label/label.c): at a lock-in the right vector moves one body more
   and the left one the other. Close to it y^T M x vanishes, and they are large, with both signs; the energies are not.

   Free modes of one frequency are any basis of a plane, over several bodies too (rigid motions, two equal pads): their
   shares are summed in each body. Error of a share: the shape of a mode is off by about d = c |Q x| / (2 omega g) in
   norms of M, c its condition and g the distance of the next eigenvalue, that of a free mode by d_k = |(K - omega^2 M)
   phi| / |omega_k^2 - omega_j^2|, so that the share is off by 2 s (d + d_k), s the largest share.
*/
#include "components.h"
#include "base/events.h"
#include <complex.h>

#define LEVEL_EQUAL 1e-6 /* of the frequency: free modes of one frequency */

/* Sums over the unknowns of each body: first of every free mode with M x re, M x im, M y re, M y im, then of M x */
enum { SUM_X_RE, SUM_X_IM, SUM_Y_RE, SUM_Y_IM, N_SUMS };
enum { SUM_RE_RE, SUM_RE_IM, SUM_IM_RE, SUM_IM_IM, SUM_X_X_RE, SUM_X_X_IM, N_WHOLE }; /* y re M x re, ... */

/* By a solution with a pencil of its own */
static PetscErrorCode FreeModesSolve(Modes modes, Modes free)
{
  const PetscReal *p;
  Operators        operators;
  Pencil           bodies;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(PencilGetParameters(modes->pencil, NULL, NULL, &p));
  PetscCall(OperatorsLineariseBodies(operators, p, PETSC_TRUE, &bodies));
  PetscCall(PencilSetReference(bodies, PencilGetReference(modes->pencil)));
  PetscCall(ModesSetPencil(free, bodies));
  PetscCall(ModesSolve(free));
  PetscCall(ModesSetPencil(free, modes->pencil));
  PetscCall(PencilDestroy(&bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode FreeModesBegin(Modes modes, Modes *free)
{
  PetscFunctionBeginUser;
  PetscCall(ModesCreate(modes->comm, free));
  PetscCall(ModesSetPencil(*free, modes->pencil));
  (*free)->has_disc = modes->has_disc;
  (*free)->most     = modes->most;
  (*free)->max_time = modes->max_time;
  PetscCall(PetscStrncpy((*free)->disc, modes->disc, sizeof((*free)->disc)));
  PetscFunctionReturn(0);
}

/* Free modes below the multiple of the highest frequency by a solution, or from the modes found */
static PetscErrorCode FreeModesFind(Modes modes, ModesComponents c, Modes *free)
{
  const PetscReal highest = modes->mode[modes->n - 1].omega / (2 * PETSC_PI);
  const PetscReal band[2] = {0, modes->free_to * (modes->has_band ? modes->band[1] : highest)};

  PetscFunctionBeginUser;
  PetscCall(FreeModesBegin(modes, free));
  PetscCall(ModesSetBand(*free, band));
  c->found = modes->free_to > 0 ? PETSC_FALSE : PETSC_TRUE;
  if (c->found)
    PetscCall(FreeModesTake(modes, c, *free));
  else
    PetscCall(FreeModesSolve(modes, *free));
  PetscFunctionReturn(0);
}

/* What a shape with a residual is off by where the next eigenvalue kappa = omega^2 is so far, relative */
static PetscReal ShapeOff(PetscReal residual, PetscReal gap)
{
  return gap > 0 ? PetscMin(1, residual / gap) : 1;
}

/* Distance in kappa of level l from the one before it, above any where there is none that it may be mixed with */
static PetscReal LevelGap(const ModesComponents c, PetscInt l)
{
  if (l <= 0 || l >= c->n_levels || c->level[l - 1].body != c->level[l].body) return PETSC_MAX_REAL;
  return PetscSqr(c->level[l].omega) - PetscSqr(c->level[l - 1].omega);
}

PetscErrorCode FreeLevelsFind(const Modes free, ModesComponents c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(free->n, &c->level));
  for (PetscInt k = 0; k < free->n; k++) {
    const Mode     *mode  = &free->mode[k];
    const PetscReal omega = mode->rigid ? 0 : mode->omega, error = mode->rigid ? 0 : mode->error;
    const PetscInt  body = c->found_of ? c->found_of[k] : -1;
    FreeLevel      *last = c->n_levels ? &c->level[c->n_levels - 1] : NULL;

    if (!last || last->body != body || omega - last->omega > LEVEL_EQUAL * omega + error + last->error)
      c->level[c->n_levels++] = (FreeLevel){.first = k, .omega = omega, .rigid = mode->rigid, .body = body};
    last = &c->level[c->n_levels - 1];
    last->n++;
    last->error    = PetscMax(last->error, error);
    last->residual = PetscMax(last->residual, free->residual[k]);
  }
  for (PetscInt l = 0; l < c->n_levels; l++)
    c->level[l].mixed = ShapeOff(c->level[l].residual, PetscMin(LevelGap(c, l), LevelGap(c, l + 1)));
  PetscFunctionReturn(0);
}

/* part = what of a vector belongs to body b, 0 elsewhere */
static PetscErrorCode FreeBodiesTake(const FreeBodies *bodies, PetscInt b, Vec whole, Vec part)
{
  const PetscScalar *from;
  PetscScalar       *to;
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(whole, &n));
  PetscCall(VecGetArrayRead(whole, &from));
  PetscCall(VecGetArrayWrite(part, &to));
  for (PetscInt i = 0; i < n; i++) to[i] = bodies->of[i] == b ? from[i] : 0;
  PetscCall(VecRestoreArrayWrite(part, &to));
  PetscCall(VecRestoreArrayRead(whole, &from));
  PetscFunctionReturn(0);
}

/* sums[free modes][N_SUMS][bodies] of product k: of each body with those of its free modes alone, many at once */
static PetscErrorCode SharesDot(const Modes free, const ModesComponents c, Vec product, Vec part, int k,
                                PetscReal sums[])
{
  const PetscInt n = c->bodies.n;
  PetscInt      *of;
  PetscScalar   *dot;
  Vec           *phi;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(free->n, &of, free->n, &dot, free->n, &phi));
  for (PetscInt b = 0; b < n; b++) {
    PetscInt some = 0;

    for (PetscInt j = 0; j < free->n; j++) {
      if (!(c->own[j * n + b] > LABEL_TIE)) continue; /* alike on all ranks */
      of[some] = j;
      PetscCall(ModesGetVectors(free, j, &phi[some++], NULL, NULL, NULL));
    }
    if (!some) continue;
    PetscCall(FreeBodiesTake(&c->bodies, b, product, part));
    PetscCall(VecMDot(part, some, phi, dot));
    for (PetscInt j = 0; j < some; j++) sums[(of[j] * N_SUMS + k) * n + b] = dot[j];
  }
  PetscCall(PetscFree3(of, dot, phi));
  PetscFunctionReturn(0);
}

/* Sums of mode i with the free modes, [free modes][N_SUMS][bodies], then of the whole, [N_WHOLE][bodies]; product has
   room for N_SUMS + 1 vectors */
static PetscErrorCode SharesSum(Modes modes, const Modes free, PetscInt i, PetscBool left, Vec product[],
                                PetscReal sums[])
{
  const ModesComponents c      = modes->components;
  const FreeBodies     *bodies = &c->bodies;
  PetscReal            *whole  = &sums[free->n * N_SUMS * bodies->n];
  Vec                   v[N_SUMS];
  Mat                   M;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(ModesGetVectors(modes, i, &v[SUM_X_RE], &v[SUM_X_IM], &v[SUM_Y_RE], &v[SUM_Y_IM]));
  if (!left) v[SUM_Y_RE] = v[SUM_Y_IM] = NULL;
  for (int k = 0; k < N_SUMS; k++) {
    PetscReal size = 0;

    if (v[k]) PetscCall(VecDot(v[k], v[k], &size)); /* VecNorm() may remember that of a time before */
    if (size == 0) v[k] = NULL;                     /* the imaginary part of a real vector */
    if (!v[k]) continue;
    PetscCall(MatMult(M, v[k], product[k]));
    PetscCall(SharesDot(free, c, product[k], product[N_SUMS], k, sums));
  }
  for (int k = 0; k < 4; k++)
    PetscCall(FreeBodiesAddDot(bodies, v[SUM_Y_RE + k / 2], v[SUM_X_RE + k % 2] ? product[SUM_X_RE + k % 2] : NULL,
                               &whole[(SUM_RE_RE + k) * bodies->n]));
  for (int k = 0; k < 2; k++)
    PetscCall(FreeBodiesAddDot(bodies, v[SUM_X_RE + k], product[SUM_X_RE + k], &whole[(SUM_X_X_RE + k) * bodies->n]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, whole, (PetscMPIInt)(N_WHOLE * bodies->n), MPIU_REAL, MPI_SUM, modes->comm));
  PetscFunctionReturn(0);
}

/* The same from the products of the basis in which the free modes were found: all vectors of the mode are in it */
static void SharesTake(const ModesComponents c, PetscInt n_free, PetscInt i, PetscBool left, PetscReal sums[])
{
  const PetscInt  n = c->bodies.n, m = c->n_vectors;
  const PetscInt *column = c->column[i];
  PetscReal      *whole  = &sums[n_free * N_SUMS * n];

  for (int k = 0; k < (left ? 4 : 2); k++)
    for (PetscInt j = 0; j < n_free && column[k] >= 0; j++)
      sums[(j * N_SUMS + k) * n + c->found_of[j]] = c->dot[j * m + column[k]];
  for (PetscInt b = 0; b < n; b++) {
    const PetscReal *mass = &c->mass[b * m * m];

    for (int k = 0; k < 4 && left; k++) {
      const PetscInt y = column[SUM_Y_RE + k / 2], x = column[SUM_X_RE + k % 2];

      if (x >= 0 && y >= 0) whole[(SUM_RE_RE + k) * n + b] = mass[y * m + x];
    }
    for (int k = 0; k < 2; k++)
      if (column[k] >= 0) whole[(SUM_X_X_RE + k) * n + b] = mass[column[k] * m + column[k]];
  }
}

/* y^T M_b x of body b, of a mode without left vector x^H M_b x */
static PetscComplex WholeOf(PetscBool left, PetscInt n, PetscInt b, const PetscReal whole[], PetscReal *energy)
{
  *energy = whole[SUM_X_X_RE * n + b] + whole[SUM_X_X_IM * n + b];
  if (!left) return *energy;
  return CMPLX(whole[SUM_RE_RE * n + b] - whole[SUM_IM_IM * n + b],
               whole[SUM_RE_IM * n + b] + whole[SUM_IM_RE * n + b]);
}

/* Shares and energies of all levels, and of the bodies, of mode i from its sums */
static void SharesForm(ModesComponents c, PetscBool left, PetscInt n_free, PetscInt i, const PetscReal sums[])
{
  const PetscInt   n     = c->bodies.n;
  const PetscReal *whole = &sums[n_free * N_SUMS * n];
  PetscReal       *share = &c->share[i * (c->n_levels + 1) * n], *energy = &c->energy[i * (c->n_levels + 1) * n], e;
  PetscReal        energies = 0;
  PetscComplex     total    = 0;

  for (PetscInt b = 0; b < n; b++) total += WholeOf(left, n, b, whole, &e), energies += e;
  for (PetscInt b = 0; b < n; b++) {
    share[c->n_levels * n + b]  = creal(WholeOf(left, n, b, whole, &e) / total);
    energy[c->n_levels * n + b] = e / energies;
    for (PetscInt l = 0; l < c->n_levels; l++)
      for (PetscInt k = c->level[l].first; k < c->level[l].first + c->level[l].n; k++) {
        const PetscReal   *s = &sums[k * N_SUMS * n + b];
        const PetscComplex x = CMPLX(s[SUM_X_RE * n], s[SUM_X_IM * n]);
        const PetscComplex y = left ? CMPLX(s[SUM_Y_RE * n], s[SUM_Y_IM * n]) : conj(x);

        share[l * n + b] += creal(y * x / total);
        energy[l * n + b] += creal(conj(x) * x) / energies;
      }
  }
}

/* What the shape of mode i is off by, relative: rigid modes are any basis of theirs */
static PetscReal ShapeMixed(const Modes modes, PetscInt i)
{
  const Mode *mode = &modes->mode[i];
  PetscReal   gap  = PETSC_MAX_REAL;

  if (!mode->rigid) return ShapeOff(mode->condition * modes->residual[i], 2 * mode->omega * ModeGap(modes, i));
  for (PetscInt k = 0; k < modes->n; k++)
    if (k != i) gap = PetscMin(gap, modes->mode[k].rigid ? 0 : PetscSqr(modes->mode[k].omega));
  return ShapeOff(modes->residual[i], gap);
}

/* Whether shares of mode i are wanted */
static PetscBool SharesWanted(const Modes modes, const ModesComponents c, PetscInt i)
{
  if (c->names) return modes->label_part[i] >= 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!c->found) return PETSC_TRUE;
  if (c->column[i][0] < 0 && c->column[i][1] < 0) return PETSC_FALSE; /* there was no room for it */
  return ComponentsAsks(modes, i);
}

PetscErrorCode FreeSharesFind(Modes modes, const Modes free, ModesComponents c)
{
  const PetscInt  n = (c->n_levels + 1) * c->bodies.n, n_sums = (free->n * N_SUMS + N_WHOLE) * c->bodies.n;
  const PetscBool taken = c->found && !c->names ? PETSC_TRUE : PETSC_FALSE; /* from the basis of the free modes */
  PetscReal      *sums;
  Vec             product[N_SUMS + 1], yr;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(modes->n * n, &c->share, modes->n * n, &c->energy, modes->n, &c->mixed));
  PetscCall(PetscMalloc1(n_sums, &sums));
  for (int k = 0; k <= N_SUMS && !taken; k++) PetscCall(VecDuplicate(modes->right.xr[0], &product[k]));
  for (PetscInt i = 0; i < modes->n; i++) {
    PetscBool left;

    if (!SharesWanted(modes, c, i)) continue;
    PetscCall(ModesGetVectors(modes, i, NULL, NULL, &yr, NULL));
    /* names need energies alone */
    left = yr && !c->names && (!c->found || modes->mode[i].unstable) ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(PetscArrayzero(sums, n_sums));
    if (taken)
      SharesTake(c, free->n, i, left, sums);
    else
      PetscCall(SharesSum(modes, free, i, left, product, sums));
    SharesForm(c, left, free->n, i, sums);
    c->mixed[i] = c->names ? 0 : ShapeMixed(modes, i);
  }
  for (int k = 0; k <= N_SUMS && !taken; k++) PetscCall(VecDestroy(&product[k]));
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(0);
}

/* From the free modes to names and shares; none: nothing */
static PetscErrorCode ComponentsMake(Modes modes, const Modes free)
{
  const ModesComponents c = modes->components;
  Mat                   M;

  PetscFunctionBeginUser;
  if (!free->n) {
    PetscCall(ComponentsDestroy(&modes->components));
    PetscFunctionReturn(0);
  }
  PetscCall(FreeLevelsFind(free, c));
  PetscCall(PencilGetMass(modes->pencil, &M));
  PetscCall(FreeLevelsName(modes, free, M, c));
  PetscCall(FreeSharesFind(modes, free, c));
  PetscCall(ComponentsLabel(modes));
  PetscFunctionReturn(0);
}

/* Bodies, while the terms are there, and what joins them */
static PetscErrorCode ComponentsPrepare(Modes modes, PetscBool solve)
{
  Operators operators;
  Model     model;

  PetscFunctionBeginUser;
  PetscCall(FreeBodiesDestroy(&modes->bodies));
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCheck(model || !solve, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_components needs a mesh: loaded matrices have no bodies");
  if (!model || !(solve || modes->free_found)) PetscFunctionReturn(0);
  PetscCall(FreeBodiesFind(modes->pencil, &modes->bodies));
  if (!solve) PetscCall(PencilKeepApart(modes->pencil));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesPrepareComponents(Modes modes, PetscBool *keep_terms)
{
  PetscFunctionBeginUser;
  *keep_terms = modes->free_to > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(EventBegin(EVENT_COMPONENTS));
  PetscCall(ComponentsPrepare(modes, *keep_terms));
  PetscCall(EventEnd(EVENT_COMPONENTS));
  PetscFunctionReturn(0);
}

/* From bodies to names and shares */
static PetscErrorCode ContributionsFind(Modes modes)
{
  Modes free;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, &modes->components));
  modes->components->bodies = *modes->bodies;
  PetscCall(FreeModesFind(modes, modes->components, &free));
  PetscCall(ComponentsMake(modes, free));
  PetscCall(ModesDestroy(&free));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesFindComponents(Modes modes)
{
  PetscBool asked = modes->free_to > 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(EventBegin(EVENT_COMPONENTS));
  PetscCall(ComponentsDestroy(&modes->components));
  for (PetscInt i = 0; i < modes->n && modes->bodies && !asked; i++) asked = ComponentsAsks(modes, i);
  if (asked && modes->bodies) PetscCall(ContributionsFind(modes));
  PetscCall(LabelsForgetWeights(modes)); /* with the disc's basis */
  PetscCall(EventEnd(EVENT_COMPONENTS));
  PetscFunctionReturn(0);
}
