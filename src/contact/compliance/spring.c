/*
   Pairs whose normal law is a spring in series (pressurelaw.h): the surfaces come together by the closing C(lambda_n),

      0 <= lambda_n,  0 <= r_n + C(lambda_n),  lambda_n (r_n + C) = 0.

   A line C ~ o + s lambda_n has s on the diagonal of W, and o in the displacement without forces. A linear law is one
   line. Another law is a line through its own point at the forces of the iterate before, whose s stays from step to
   step as long as that converges fast, by SPRING_FAST each time; where not, lines are tangents from then on in this
   step: Newton's method. Forces on lines that are not the last ones are found to SPRING_LOOSE of what the laws are
   missed by. */
#include "complianceimpl.h"

#define SPRING_SETTLED 1e-13 /* of the largest force, or of the largest closing beyond the onset */
#define SPRING_ROUNDED 1e-9  /* no better after one more iteration: what rounding of r leaves */
#define SPRING_FAST    0.3
#define SPRING_MAX_IT  100
#define SPRING_LOOSE   0.01
#define SPRING_FIRST   1e-4 /* relative tolerance on the first lines */

/* W with the compliances of the lines on its diagonal; scales, and nothing of what was factored before */
static PetscErrorCode SpringsSetDiagonal(ContactCompliance c)
{
  const PetscInt N = 3 * c->n;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < c->n; p++) {
    const PetscInt i = 3 * p * (N + 1);

    c->springs.W[i] = c->springs.diagonal[p] + c->springs.line[p].compliance;
  }
  PetscCall(ComplianceDualDestroy(c));
  PetscCall(ComplianceSetScales(c));
  c->chord.exists = c->near.stands = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Tangents at the closings springs.at */
static PetscErrorCode SpringsSetTangents(ContactCompliance c)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < c->n; p++) c->springs.line[p] = SpringTangent(&c->springs.law[p], c->springs.at[p]);
  PetscCall(SpringsSetDiagonal(c));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComplianceSetSprings(ContactCompliance c, const PairSpring law[])
{
  const PetscInt N = 3 * c->n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6(N * N, &c->springs.W, c->n, &c->springs.law, c->n, &c->springs.line, c->n, &c->springs.at,
                         c->n, &c->springs.diagonal, c->n, &c->springs.point));
  PetscCall(PetscArraycpy(c->springs.W, c->W, N * N));
  PetscCall(PetscArraycpy(c->springs.law, law, c->n));
  c->W = c->springs.W;
  for (PetscInt p = 0; p < c->n; p++) {
    c->springs.diagonal[p] = c->W[3 * p * (N + 1)];
    c->springs.at[p]       = SpringOnset(&law[p]);
    if (SpringIsCurved(&law[p])) c->springs.curved = PETSC_TRUE;
  }
  PetscCall(PetscMalloc1(N, &c->springs.q));
  PetscCall(SpringsSetTangents(c));
  PetscFunctionReturn(0);
}

PetscErrorCode ComplianceDestroySprings(ContactCompliance c)
{
  PetscFunctionBeginUser;
  PetscCall(
    PetscFree6(c->springs.W, c->springs.law, c->springs.line, c->springs.at, c->springs.diagonal, c->springs.point));
  PetscCall(PetscFree(c->springs.q));
  PetscFunctionReturn(0);
}

PetscReal ComplianceLineClosing(const ContactCompliance c, PetscInt p)
{
  const SpringLine *line = &c->springs.line[p];

  return c->springs.law ? line->closing + line->compliance * c->kappa[p] * c->l[3 * p] : 0;
}

/* What the lines led to: v_n = r_n + o */
static void SpringsTake(ContactCompliance c)
{
  for (PetscInt p = 0; p < c->n; p++) {
    SpringPoint *point = &c->springs.point[p];

    point->force   = PetscMax(0, c->kappa[p] * c->l[3 * p]);
    point->closing = point->force > 0 ? ComplianceLineClosing(c, p) : c->springs.line[p].closing - c->v[3 * p];
  }
}

/* The line through the law at a force, as steep as before */
static void SpringShift(const PairSpring *law, PetscReal force, SpringLine *line)
{
  line->closing = SpringClosing(law, force) - line->compliance * force;
}

/* Lines through the laws at the present forces, as steep as before; or tangents, at the points that Newton's method
   takes */
static PetscErrorCode SpringsMove(ContactCompliance c, PetscBool tangents)
{
  ComplianceSprings *s = &c->springs;

  PetscFunctionBeginUser;
  if (tangents) {
    SpringsLay(c->n, s->law, s->point, s->at, s->line);
    PetscCall(SpringsSetDiagonal(c));
  } else
    for (PetscInt p = 0; p < c->n; p++) SpringShift(&s->law[p], s->point[p].force, &s->line[p]);
  PetscFunctionReturn(0);
}

/* Lines through the guess of the forces, at first tangents there: so that a step is told by its state alone */
static PetscErrorCode SpringsBegin(ContactCompliance c, const PetscReal lambda[])
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < c->n; p++) {
    const PetscReal force = PetscMax(0, lambda[3 * p]);

    if (c->springs.laid)
      SpringShift(&c->springs.law[p], force, &c->springs.line[p]);
    else
      c->springs.at[p] = SpringClosing(&c->springs.law[p], force);
  }
  if (!c->springs.laid) PetscCall(SpringsSetTangents(c));
  c->springs.laid = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Tolerance on the present lines, where laws were missed by `miss` before; that of the step where it is the last */
static PetscReal SpringsTolerance(const ContactCompliance c, PetscReal miss, PetscReal rtol)
{
  if (!c->springs.curved) return rtol;
  return PetscMax(rtol, miss < PETSC_MAX_REAL ? PetscMin(SPRING_FIRST, SPRING_LOOSE * miss) : SPRING_FIRST);
}

PetscErrorCode ComplianceSolveSprings(ContactCompliance c, const PetscReal q[], const PetscReal slip0[],
                                      PetscReal lambda[])
{
  const PetscReal  rtol   = c->rtol;
  PetscReal        before = PETSC_MAX_REAL, miss = PETSC_MAX_REAL;
  ComplianceReport sum      = {.steps = 1};
  PetscBool        tangents = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (c->springs.curved) PetscCall(SpringsBegin(c, lambda));
  for (PetscInt it = 0; it < SPRING_MAX_IT; it++) {
    c->rtol = SpringsTolerance(c, miss, rtol);
    for (PetscInt i = 0; i < 3 * c->n; i++) c->springs.q[i] = q[i] + (i % 3 ? 0 : c->springs.line[i / 3].closing);
    PetscCall(ComplianceSolveLines(c, c->springs.q, slip0, lambda));
    sum.iterations += c->report.iterations;
    sum.factors += c->report.factors;
    sum.route = PetscMax(sum.route, c->report.route);
    if (!c->springs.curved || !c->report.converged) break;
    SpringsTake(c);
    miss = SpringsMiss(c->n, c->springs.law, c->springs.point);
    if (c->rtol == rtol && (miss <= SPRING_SETTLED || (miss <= SPRING_ROUNDED && miss > before / 2))) break;
    if (miss > SPRING_FAST * before) tangents = PETSC_TRUE;
    PetscCall(SpringsMove(c, tangents));
    before = miss;
  }
  c->rtol              = rtol;
  c->report.iterations = sum.iterations;
  c->report.factors    = sum.factors;
  c->report.route      = sum.route;
  if (c->springs.curved && miss > SPRING_ROUNDED) c->report.converged = PETSC_FALSE;
  PetscFunctionReturn(0);
}

void ComplianceSetTangents(ContactCompliance c, PetscBool tangents)
{
  const PetscInt N = 3 * c->n;

  for (PetscInt p = 0; p < c->n && c->springs.curved; p++) {
    const PairSpring *law   = &c->springs.law[p];
    const PetscReal   force = PetscMax(0, c->kappa[p] * c->l[3 * p]);
    const SpringLine  line  = tangents ? SpringTangent(law, SpringClosing(law, force)) : c->springs.line[p];

    c->springs.W[3 * p * (N + 1)] = c->springs.diagonal[p] + line.compliance;
  }
}

PetscErrorCode ComplianceLayAt(ContactCompliance c, const PetscReal at[])
{
  PetscFunctionBeginUser;
  if (!c->springs.curved) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(c->springs.at, at, c->n));
  c->springs.laid = PETSC_TRUE;
  PetscCall(SpringsSetTangents(c));
  PetscFunctionReturn(0);
}
