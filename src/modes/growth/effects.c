/*
   What a small change at a node, or between two, does to an unstable mode: modes_effects.csv, and fields over the whole
   mesh.

   With right and left vectors x and y of the eigenvalue lambda of Q(s) = s^2 M + s C + K, to first order

      d lambda = - y'(lambda^2 dM + lambda dC + dK) x / (y'Q'(lambda) x),
      y'Q'(lambda) x = 2 lambda y'(M + C / (2 lambda)) x,

   so that of the displacements x_n, y_n at a node n a point mass m (kg) does -lambda^2 m y_n'x_n, a spring to the
   ground k (N/m) along the unit vector d -k (y_n'd)(d'x_n), a dashpot to the ground c (N s/m) -lambda c (y_n'd)(d'x_n),
   each over y'Q'(lambda) x. Between the nodes n and m it is the same of x_n - x_m and y_n - y_m. Growth is
   the real part, 1/s; the imaginary part over 2 pi is the shift of the frequency, Hz.
   Source: R. L. Fox, M. P. Kapoor, AIAA J. 6 (1968) 2426, with left vectors.

   Error of a rate: right and left vectors that are off by e and f give an eigenvalue that is off by g e f, g the
   distance of the next one. Left vectors are the worse ones; f is taken for sqrt(d / g), d the error of the eigenvalue,
   hence 2 sqrt(d / g) times the largest rate of the kind.
*/
#include "effects.h"
#include "base/algebra/vec3.h"

#define EFFECTS_ROUNDING 1e-6 /* of the largest rate: nodes that are no farther apart are alike */

static const struct {
  const char *name, *between, *unit, *field;
} kinds[N_EFFECTS] = {
  [EFFECT_MASS]    = {"mass", NULL, "kg", "growth_rad_s_per_kg"},
  [EFFECT_SPRING]  = {"spring", "relative_spring", "N/m", "growth_rad_s_per_N_m"},
  [EFFECT_DASHPOT] = {"dashpot", "relative_dashpot", "N s/m", "growth_rad_s_per_N_s_m"},
};

/* Vectors and factors of mode i */
static PetscErrorCode EffectsSet(Modes modes, Operators operators, PetscInt i, ModeEffects *e)
{
  const Spectrum    *right = &modes->right, *left = &modes->left_spectrum;
  const PetscComplex lambda = CMPLX(modes->mode[i].sigma, modes->mode[i].omega);
  const PetscComplex slope  = 2 * lambda * CMPLX(modes->mode[i].product[0], modes->mode[i].product[1]);

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetNodal(operators, right->xr[i], e->xr));
  PetscCall(OperatorsGetNodal(operators, right->xi[i], e->xi));
  PetscCall(OperatorsGetNodal(operators, left->xr[i], e->yr));
  PetscCall(OperatorsGetNodal(operators, left->xi[i], e->yi));
  e->mode      = i;
  e->sigma     = modes->mode[i].sigma;
  e->uncertain = 2 * PetscSqrtReal(PetscMin(1, modes->mode[i].error / ModeGap(modes, i)));

  e->factor[EFFECT_MASS]    = -lambda * lambda / slope;
  e->factor[EFFECT_SPRING]  = -1 / slope;
  e->factor[EFFECT_DASHPOT] = -lambda / slope;
  for (int kind = 0; kind < N_EFFECTS; kind++) e->strength[kind] = cabs(e->factor[kind]);
  PetscFunctionReturn(0);
}

/* One row, where the change lowers the growth by more than the error of its rate */
static PetscErrorCode EffectsWriteRow(const ModeEffects *e, EffectKind kind, const EffectPair *pair, PetscReal error,
                                      ResultsTable table)
{
  const EffectBest *b = &pair->end[1], *to = pair->part[0] < 0 ? NULL : &pair->end[0];
  char              place[96] = ",,";

  PetscFunctionBeginUser;
  if (!b->found || !(-creal(b->rate) > error)) PetscFunctionReturn(0);
  if (to)
    PetscCall(PetscSNPrintf(place, sizeof(place), "%.15g,%.15g,%.15g", (double)to->at[0], (double)to->at[1],
                            (double)to->at[2]));
  PetscCall(ResultsTableRow(table, "%d,%s,%s,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.15g,%.3g,%s,%.15g,%s,%s",
                            (int)e->mode + 1, to ? kinds[kind].between : kinds[kind].name, e->mesh->part[pair->part[1]],
                            (double)b->at[0], (double)b->at[1], (double)b->at[2], (double)b->direction[0],
                            (double)b->direction[1], (double)b->direction[2], (double)creal(b->rate),
                            (double)(cimag(b->rate) / (2 * PETSC_PI)), (double)error, kinds[kind].unit,
                            (double)(-e->sigma / creal(b->rate)), to ? e->mesh->part[pair->part[0]] : "", place));
  PetscFunctionReturn(0);
}

/* The rows of one kind */
static PetscErrorCode EffectsWriteAlike(const ModeEffects *e, EffectKind kind, PetscInt n, const EffectPair pair[],
                                        ResultsTable table)
{
  PetscReal largest = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++)
    if (pair[k].end[1].found) largest = PetscMax(largest, cabs(pair[k].end[1].rate));
  for (PetscInt k = 0; k < n; k++) PetscCall(EffectsWriteRow(e, kind, &pair[k], e->uncertain * largest, table));
  PetscFunctionReturn(0);
}

/* Rows of one kind: a part each, on which some node lowers the growth */
static PetscErrorCode EffectsWriteRows(Modes modes, const ModeEffects *e, EffectKind kind, ResultsTable table)
{
  const PetscInt n = e->mesh->n_parts;
  EffectBest    *best;
  EffectPair    *pair;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &best, n, &pair));
  PetscCall(EffectsFindBest(modes->comm, e, kind, NULL, best));
  for (PetscInt k = 0; k < n; k++) pair[k] = (EffectPair){.end = {[1] = best[k]}, .part = {-1, k}};
  PetscCall(EffectsWriteAlike(e, kind, n, pair, table));
  PetscCall(PetscFree2(best, pair));
  PetscFunctionReturn(0);
}

/* Whether two pairs join the same nodes */
static PetscBool PairsAreOne(const EffectPair *a, const EffectPair *b)
{
  for (int swap = 0; swap < 2; swap++) {
    PetscBool same = PETSC_TRUE;

    for (int end = 0; end < 2; end++) {
      const int other = swap ? 1 - end : end;

      if (a->part[end] != b->part[other] || Vec3ComparePlaces(a->end[end].at, b->end[other].at)) same = PETSC_FALSE;
    }
    if (same) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Rows of one kind between two nodes, for each part one within it and one to another part, each pair of nodes once */
static PetscErrorCode EffectsWritePairs(Modes modes, ModeEffects *e, EffectKind kind, ResultsTable table)
{
  const PetscInt n = 2 * e->mesh->n_parts;
  EffectPair    *pair;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &pair));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(EffectsFindPair(modes->comm, e, kind, k / 2, k % 2 ? PETSC_FALSE : PETSC_TRUE, &pair[k]));
    for (PetscInt j = 0; j < k && pair[k].end[1].found; j++)
      if (pair[j].end[1].found && PairsAreOne(&pair[j], &pair[k])) pair[k].end[1].found = PETSC_FALSE;
  }
  PetscCall(EffectsWriteAlike(e, kind, n, pair, table));
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(0);
}

/* Growth by each kind of change at all nodes: of a spring or dashpot along each axis */
static PetscErrorCode EffectsWriteFields(Modes modes, const ModeEffects *e, PetscInt i, ResultsField field)
{
  const PetscInt width[N_EFFECTS] = {1, 3, 3};
  ResultsNodal   array[N_EFFECTS];
  PetscReal     *values[N_EFFECTS];
  char           key[N_EFFECTS][64], title[96];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(title, sizeof(title), "%d: %.6g Hz, growth %.4g 1/s", (int)i + 1,
                          (double)(modes->mode[i].omega / (2 * PETSC_PI)), (double)modes->mode[i].sigma));
  for (int kind = 0; kind < N_EFFECTS; kind++) {
    PetscCall(PetscCalloc1(width[kind] * e->mesh->n_nodes, &values[kind]));
    for (PetscInt node = 0; node < e->mesh->n_nodes; node++) {
      PetscComplex form[3][3];

      EffectAtNode(e, (EffectKind)kind, node, form);
      for (int a = 0; a < 3; a++) values[kind][width[kind] * node + a % width[kind]] += creal(form[a][a]);
    }
    PetscCall(PetscSNPrintf(key[kind], sizeof(key[kind]), "mode_%03d_%s", (int)i + 1, kinds[kind].field));
    array[kind] = (ResultsNodal){.key = key[kind], .width = width[kind], .values = values[kind]};
  }
  PetscCall(ResultsFieldWriteNodal(field, title, N_EFFECTS, array));
  for (int kind = 0; kind < N_EFFECTS; kind++) PetscCall(PetscFree(values[kind]));
  PetscFunctionReturn(0);
}

/* Table and fields of all unstable modes */
static PetscErrorCode EffectsWriteAll(Modes modes, Operators operators, const Mesh *mesh, ResultsTable table,
                                      ResultsField field)
{
  ModeEffects e = {.mesh = mesh, .rounding = EFFECTS_ROUNDING};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(3 * mesh->n_nodes, &e.xr, 3 * mesh->n_nodes, &e.xi, 3 * mesh->n_nodes, &e.yr,
                         3 * mesh->n_nodes, &e.yi));
  PetscCall(EffectsListNodes(mesh, &e.first, &e.node));
  for (PetscInt i = 0; i < modes->n; i++) {
    if (!modes->mode[i].unstable) continue;
    PetscCall(EffectsSet(modes, operators, i, &e));
    for (int kind = 0; kind < N_EFFECTS; kind++) PetscCall(EffectsWriteRows(modes, &e, (EffectKind)kind, table));
    for (int kind = EFFECT_SPRING; kind < N_EFFECTS; kind++)
      PetscCall(EffectsWritePairs(modes, &e, (EffectKind)kind, table));
    if (field) PetscCall(EffectsWriteFields(modes, &e, i, field));
  }
  PetscCall(PetscFree(e.first));
  PetscCall(PetscFree(e.node));
  PetscCall(PetscFree4(e.xr, e.xi, e.yr, e.yi));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWriteEffects(Modes modes, Operators operators, const Mesh *mesh, Results results)
{
  PetscBool    wanted, unstable = PETSC_FALSE;
  ResultsTable table;
  ResultsField field = NULL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n; i++) unstable = unstable || modes->mode[i].unstable ? PETSC_TRUE : PETSC_FALSE;
  if (!mesh || !unstable || !modes->left_spectrum.n) PetscFunctionReturn(0);
  PetscCall(ResultsWantFields(results, &wanted));
  PetscCall(ResultsTableOpen(
    results, "modes_effects",
    "mode,change,part,x_m,y_m,z_m,direction_x,direction_y,direction_z,growth_rad_s_per_unit,"
    "freq_hz_per_unit,error_rad_s_per_unit,unit,first_order_units_to_zero,to_part,to_x_m,to_y_m,to_z_m",
    &table));
  if (wanted) PetscCall(ResultsFieldOpen(results, "modes_effects", mesh, &field));
  PetscCall(EffectsWriteAll(modes, operators, mesh, table, field));
  PetscCall(ResultsTableClose(&table));
  PetscCall(ResultsFieldClose(&field));
  PetscFunctionReturn(0);
}
