/* Displacements at the ports, and the energy of a state, of dense models and of those without columns of the pairs */
#include "reduced/sparse/sparse.h"

#define FORM_COLUMNS 32

#define RESIDUAL_WIDE 6 /* pairs' directions over modes, beyond which products with P are cheaper than with W */

/* Column of W of a port, which must be none of a pair where these have no columns */
const PetscReal *ReducedColumn(const ReducedModel *model, PetscInt port)
{
  return &model->W[model->n_ports * (port - (model->sparse ? 3 * model->n_pairs : 0))];
}

/* Y r of a port, m, or of rates, m/s */
PetscReal ReducedMotionWay(const ReducedModel *model, const PetscReal loads[], PetscInt port)
{
  const PetscReal *r = &loads[ReducedFirstMotion(model) - 3 * model->n_pairs];
  PetscReal        y = 0;

  for (PetscInt i = 0; i < model->n_motions; i++) y += model->Y[model->n_ports * i + port] * r[i];
  return y;
}

/* y = P'eta + W p + Y r of one port, m */
PetscReal ReducedPortDisplacement(const ReducedModel *model, const PetscReal eta[], const PetscReal p[], PetscInt port)
{
  const PetscReal *w = ReducedColumn(model, port);
  PetscReal        y = 0;

  for (PetscInt k = 0; k < model->m; k++) y += model->P[k + model->m * port] * eta[k];
  for (PetscInt i = 0; i < model->n_ports; i++) y += w[i] * p[i];
  return y + ReducedMotionWay(model, &p[3 * model->n_pairs], port);
}

/* Displacements of all pairs without what q makes, P'eta + W loads */
static void PairsWithoutForces(const ReducedModel *model, const PetscReal eta[], const PetscReal p[], PetscReal y[])
{
  const PetscInt m = model->m, n = 3 * model->n_pairs, N = model->n_ports;

  for (PetscInt i = 0; i < n; i++) y[i] = 0;
  ReducedBlockTimes(&(DenseBlock){model->P, m, n, m}, PETSC_TRUE, 1, eta, y);
  ReducedBlockTimes(&(DenseBlock){ReducedColumn(model, n), n, N - n, N}, PETSC_FALSE, 1, &p[n], y);
  for (PetscInt i = 0; i < n && model->n_motions; i++) y[i] += ReducedMotionWay(model, &p[n], i);
}

PetscErrorCode ReducedPairDisplacements(const ReducedModel *model, const PetscReal eta[], const PetscReal p[],
                                        PetscReal y[])
{
  const PetscInt n = 3 * model->n_pairs;
  PetscReal     *Wp;

  PetscFunctionBeginUser;
  if (!model->sparse) {
    for (PetscInt i = 0; i < n; i++) y[i] = ReducedPortDisplacement(model, eta, p, i);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(n, &Wp));
  PetscCall(SparseTimes(model->sparse, p, Wp, NULL));
  PairsWithoutForces(model, eta, p, y);
  for (PetscInt i = 0; i < n; i++) y[i] += Wp[i];
  PetscCall(PetscFree(Wp));
  PetscFunctionReturn(0);
}

/* x'A x of a symmetric A [n][n], columns stride apart: half of it is read, FORM_COLUMNS columns at a time */
PetscReal ReducedForm(PetscInt n, PetscInt stride, const PetscReal A[], const PetscReal x[])
{
  PetscReal sum = 0, y[FORM_COLUMNS];

  for (PetscInt j = 0, columns; j < n; j += columns) {
    const PetscReal *a = &A[stride * j];

    columns = PetscMin(FORM_COLUMNS, n - j);
    for (PetscInt k = 0; k < columns; k++) y[k] = 0;
    ReducedBlockTimes(&(DenseBlock){a, j, columns, stride}, PETSC_TRUE, 2, x, y);
    ReducedBlockTimes(&(DenseBlock){a + j, columns, columns, stride}, PETSC_TRUE, 1, &x[j], y);
    for (PetscInt k = 0; k < columns; k++) sum += x[j + k] * y[k];
  }
  return sum;
}

/* q'W q: with the numbers of W, or from the displacements of the pairs that it makes where there are none, or so many
   that P has far fewer */
static PetscReal ResidualForm(const ReducedModel *model, const ReducedState *s)
{
  const PetscInt m = model->m, n = 3 * model->n_pairs;
  PetscReal      sum = 0;

  if (!model->sparse && n <= RESIDUAL_WIDE * m) return ReducedForm(n, model->n_ports, model->W, s->q);
  for (PetscInt i = 0; i < n; i++) {
    PetscReal y = s->y[i] - ReducedMotionWay(model, &s->p[n], i);

    if (s->q[i] == 0) continue;
    for (PetscInt k = 0; k < m; k++) y -= model->P[k + m * i] * s->eta[k];
    for (PetscInt j = n; j < model->n_ports; j++) y -= ReducedColumn(model, j)[i] * s->p[j];
    sum += s->q[i] * y;
  }
  return sum;
}

void ReducedMotionDrag(const ReducedModel *model, const PetscReal d_eta[], const PetscReal mean[], PetscReal dt,
                       PetscReal *work)
{
  const PetscInt n = model->n_motions, first = ReducedFirstMotion(model) + n;

  *work = 0;
  for (PetscInt i = 0; i < n && model->dragged; i++) {
    const PetscReal *P  = &model->P[model->m * (first + i)];
    PetscReal        dy = 0;

    for (PetscInt k = 0; k < model->m; k++) dy += P[k] * d_eta[k];
    *work -= 2 * mean[first + i] * dy;
    for (PetscInt j = 0; j < n; j++) *work += dt * mean[first + i] * model->drag[n * i + j] * mean[first + j];
  }
}

PetscReal ReducedMotionEnergy(const ReducedModel *model, const PetscReal eta[], const PetscReal q[],
                              const PetscReal p[])
{
  const PetscInt n = 3 * model->n_pairs, N = model->n_ports, first = ReducedFirstMotion(model);
  PetscReal      sum = 0;

  for (PetscInt i = 0; i < model->n_motions; i++) {
    const PetscInt   port = first + i;
    const PetscReal *w    = ReducedColumn(model, port);
    PetscReal        y    = 0;

    for (PetscInt k = 0; k < model->m; k++) y += model->P[k + model->m * port] * eta[k];
    for (PetscInt k = 0; k < N; k++) y += w[k] * (k < n ? q[k] : p[k]);
    sum -= y * p[port];
    for (PetscInt j = 0; j < model->n_motions; j++)
      sum += 0.5 * p[port] * model->kappa[model->n_motions * i + j] * p[first + j];
  }
  return sum;
}

/* |rate|^2 / 2, eta'Omega^2 eta / 2 + p'W p / 2 with q in place of lambda, and that of laws in series, J: the blocks
   of W of pairs, of others, and, once, between both; that of what motions move. */
void ReducedEnergy(const ReducedModel *model, const ReducedState *s, PetscReal *kinetic, PetscReal *strain)
{
  const PetscInt n = 3 * model->n_pairs, n_others = model->n_ports - n;

  *kinetic = *strain = 0;
  for (PetscInt k = 0; k < model->m; k++) {
    *kinetic += 0.5 * s->rate[k] * s->rate[k];
    *strain += 0.5 * model->omega2[k] * s->eta[k] * s->eta[k];
  }
  *strain += 0.5 * ResidualForm(model, s);
  for (PetscInt i = 0; i < model->n_pairs && model->spring; i++)
    *strain += SpringEnergy(&model->spring[i], s->p[3 * i]);
  *strain += 0.5 * ReducedForm(n_others, model->n_ports, ReducedColumn(model, n) + n, &s->p[n]);
  for (PetscInt j = n; j < model->n_ports; j++)
    for (PetscInt i = 0; i < n && s->p[j] != 0; i++) *strain += s->q[i] * ReducedColumn(model, j)[i] * s->p[j];
  *strain += ReducedMotionEnergy(model, s->eta, s->q, s->p);
}
