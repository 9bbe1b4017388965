/*
   Laws of viscoelastic materials; see viscoelastic.h. With z = lambda tau and h = z / (1 + z), dh/dz = 1 / (1 + z)^2;
   of Zener's law z = (lambda tau)^a on the principal branch, dz / d lambda = a z / lambda.
*/
#include <squeal/viscoelastic.h>

/* i eta E, which is no function of lambda in the upper half plane */
static void HystereticEvaluate(const Viscoelastic *law, PetscComplex lambda, ViscoelasticAt *at)
{
  if (cimag(lambda) == 0) return;
  at->modulus  = CMPLX(0, law->value[0] * law->young);
  at->young    = CMPLX(0, law->value[0]);
  at->value[0] = CMPLX(0, law->young);
}

static void PronyEvaluate(const Viscoelastic *law, PetscComplex lambda, ViscoelasticAt *at)
{
  const PetscInt n = law->n / 2;

  for (PetscInt j = 0; j < n; j++) {
    const PetscReal    modulus = law->value[j], tau = law->value[n + j];
    const PetscComplex below = 1 + lambda * tau, share = lambda * tau / below;

    at->value[j]     = share;
    at->value[n + j] = modulus * lambda / (below * below);
    at->modulus += modulus * share;
    at->slope += modulus * tau / (below * below);
  }
}

static void ZenerEvaluate(const Viscoelastic *law, PetscComplex lambda, ViscoelasticAt *at)
{
  const PetscReal    modulus = law->value[0], tau = law->value[1], a = law->value[2];
  const PetscComplex z = lambda == 0 ? 0 : cpow(lambda * tau, a), below = 1 + z, share = z / below;

  if (lambda == 0) return;
  at->modulus  = modulus * share;
  at->slope    = modulus * a * z / (lambda * below * below);
  at->value[0] = share;
  at->value[1] = modulus * a * z / (tau * below * below);
  at->value[2] = modulus * clog(lambda * tau) * z / (below * below);
}

/* log E of one temperature and its slope by log w, at log w = x: the cubic of the segment that holds it */
static void RowsEvaluate(const ViscoelasticTable *table, PetscReal x, PetscComplex *logE, PetscComplex *slope)
{
  const ViscoelasticRow *row  = table->row;
  const PetscInt         last = table->n_rows - 1;
  PetscComplex           value;
  PetscInt               k = 0;

  while (k < last - 1 && x > row[k + 1].x) k++;
  if (x <= row[0].x || x >= row[last].x) {
    value  = row[x <= row[0].x ? 0 : last].modulus;
    *slope = 0;
  } else {
    const PetscReal    h = row[k + 1].x - row[k].x, t = (x - row[k].x) / h;
    const PetscComplex a = row[k].modulus, b = row[k + 1].modulus, p = h * row[k].slope, q = h * row[k + 1].slope;
    const PetscComplex c = 3 * (b - a) - 2 * p - q, d = 2 * (a - b) + p + q;

    value  = a + t * (p + t * (c + t * d));
    *slope = (p + t * (2 * c + 3 * t * d)) / h;
  }
  *logE  = clog(value);
  *slope = *slope / value;
}

/* The tables about the temperature, and its place from the first, 0, to the second, 1 */
static PetscReal TablesAbout(const Viscoelastic *law, const ViscoelasticTable *about[2])
{
  PetscInt k = 0;

  while (k < law->n_tables - 2 && law->value[0] > law->table[k + 1].temperature) k++;
  about[0] = &law->table[k];
  about[1] = &law->table[PetscMin(k + 1, law->n_tables - 1)];
  if (about[1] == about[0]) return 0;
  return (law->value[0] - about[0]->temperature) / (about[1]->temperature - about[0]->temperature);
}

/* To first order off the axis; constant beyond the ends */
static void TableEvaluate(const Viscoelastic *law, PetscComplex lambda, ViscoelasticAt *at)
{
  const ViscoelasticTable *about[2];
  const PetscReal          t = TablesAbout(law, about), size = cabs(lambda);
  const PetscReal          x    = size > 0 ? PetscLogReal(size) : about[0]->row[0].x;
  const PetscComplex       turn = I * (carg(lambda) - PETSC_PI / 2);
  PetscComplex             logE[2], slope[2], value, both;

  for (int k = 0; k < 2; k++) RowsEvaluate(about[k], x, &logE[k], &slope[k]);
  value       = cexp((1 - t) * logE[0] + t * logE[1]);
  both        = value * ((1 - t) * slope[0] + t * slope[1]);
  at->modulus = value + turn * both - law->young;
  at->slope   = size > 0 ? both / lambda : 0;
  at->young   = -1;
  if (about[1] == about[0]) return;
  at->value[0] = (value + turn * both) * (logE[1] - logE[0]) + turn * value * (slope[1] - slope[0]);
  at->value[0] /= about[1]->temperature - about[0]->temperature;
}

void ViscoelasticEvaluate(const Viscoelastic *law, PetscComplex lambda, ViscoelasticAt *at)
{
  *at = (ViscoelasticAt){.modulus = 0};
  if (law->kind == VISCOELASTIC_HYSTERETIC) HystereticEvaluate(law, lambda, at);
  if (law->kind == VISCOELASTIC_PRONY) PronyEvaluate(law, lambda, at);
  if (law->kind == VISCOELASTIC_ZENER) ZenerEvaluate(law, lambda, at);
  if (law->kind == VISCOELASTIC_TABLE) TableEvaluate(law, lambda, at);
}

PetscInt ViscoelasticBranches(const Viscoelastic *law)
{
  if (law->kind == VISCOELASTIC_PRONY) return law->n / 2;
  return law->kind == VISCOELASTIC_ZENER && law->value[2] == 1 ? 1 : 0;
}

void ViscoelasticRange(const Viscoelastic *law, PetscReal range[2])
{
  const ViscoelasticTable *about[2];
  PetscReal                t;

  range[0] = 0, range[1] = INFINITY;
  if (law->kind != VISCOELASTIC_TABLE) return;
  t = TablesAbout(law, about);
  for (int k = 0; k < 2; k++) {
    if (t == 1 - k) continue; /* of the other one alone */
    range[0] = PetscMax(range[0], PetscExpReal(about[k]->row[0].x));
    range[1] = PetscMin(range[1], PetscExpReal(about[k]->row[about[k]->n_rows - 1].x));
  }
}

void ViscoelasticLimits(const Viscoelastic *law, PetscReal limit[2])
{
  limit[0] = -INFINITY, limit[1] = INFINITY;
  if (law->kind == VISCOELASTIC_HYSTERETIC) limit[0] = 0, limit[1] = VISCOELASTIC_LOSS_MOST;
  if (law->kind != VISCOELASTIC_TABLE) return;
  limit[0] = law->table[0].temperature;
  limit[1] = law->table[law->n_tables - 1].temperature;
}

PetscErrorCode ViscoelasticName(const Viscoelastic *law, PetscInt i, const char **option, char name[32])
{
  static const char *const zener[] = {"zener_modulus", "zener_time", "zener_order"};
  const PetscInt           n       = law->n / 2;

  PetscFunctionBeginUser;
  *option = law->kind == VISCOELASTIC_HYSTERETIC ? "loss_factor" : zener[PetscMax(i, 0) % 3];
  if (law->kind == VISCOELASTIC_TABLE) *option = i < 0 ? "table" : "table_temperature";
  if (law->kind == VISCOELASTIC_PRONY) *option = i < n ? "prony_modulus" : "prony_time";
  if (law->kind == VISCOELASTIC_PRONY && n > 1 && i >= 0)
    PetscCall(PetscSNPrintf(name, 32, "%s_%" PetscInt_FMT, *option, i % n + 1));
  else
    PetscCall(PetscStrncpy(name, *option, 32));
  PetscFunctionReturn(0);
}

static PetscErrorCode TableDescribe(const Viscoelastic *law, size_t size, char text[])
{
  const ViscoelasticTable *first = &law->table[0];
  const ViscoelasticRow   *last  = &first->row[first->n_rows - 1];

  PetscFunctionBeginUser;
  if (law->n_tables > 1)
    PetscCall(PetscSNPrintf(text, size, "tables of %" PetscInt_FMT " temperatures, %.6g to %.6g: E at %.6g",
                            law->n_tables, (double)first->temperature,
                            (double)law->table[law->n_tables - 1].temperature, (double)law->value[0]));
  else
    PetscCall(PetscSNPrintf(text, size, "table of %" PetscInt_FMT " frequencies, %.6g to %.6g Hz: E from %.6g to %.6g",
                            first->n_rows, (double)(PetscExpReal(first->row[0].x) / (2 * PETSC_PI)),
                            (double)(PetscExpReal(last->x) / (2 * PETSC_PI)), (double)creal(first->row[0].modulus),
                            (double)creal(last->modulus)));
  PetscFunctionReturn(0);
}

PetscErrorCode ViscoelasticDescribe(const Viscoelastic *law, size_t size, char text[])
{
  const PetscReal *v   = law->value;
  PetscReal        sum = law->young;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < law->n / 2; j++) sum += v[j];
  if (law->kind == VISCOELASTIC_HYSTERETIC)
    PetscCall(PetscSNPrintf(text, size, "hysteretic: loss factor %.6g at the frequency of each mode", (double)v[0]));
  if (law->kind == VISCOELASTIC_PRONY)
    PetscCall(PetscSNPrintf(text, size, "Prony series of %" PetscInt_FMT " branches: E from %.6g to %.6g", law->n / 2,
                            (double)law->young, (double)sum));
  if (law->kind == VISCOELASTIC_TABLE) PetscCall(TableDescribe(law, size, text));
  if (law->kind == VISCOELASTIC_ZENER)
    PetscCall(PetscSNPrintf(text, size, "fractional Zener: E from %.6g to %.6g, time %.6g s, order %.6g",
                            (double)law->young, (double)(law->young + v[0]), (double)v[1], (double)v[2]));
  PetscFunctionReturn(0);
}
