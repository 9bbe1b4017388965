/*
   Steps of so many pairs that chord.c has motions by changes of the forces on W in 16 bits (near.c), and factors in
   single precision: a block of 256 pairs on a half-space that is pressed, tilted and slid

      beside the laws written out, with W as it is                       not a step that 16 bits change
      each step from what the one before left, or from its memory        bitwise
      v of a small change beside the whole product                       within its stated size, and not to rounding
      a memory with a number that is none of its kind                    refused
      factors of pivots below what single precision carries              in double precision

   Breaks where a residual is judged by the short product alone, where memory has not what changes count from, or a gap
   that opens leaves its rounding in the border of single factors.
*/
#include "compliancescene.h"
#include "contact/compliance/complianceimpl.h"

#include "check.h"
#include "petscmain.h"
#include "scratch.h"

#include <string.h>

#define PAIRS 256
#define ROWS  (3 * PAIRS)
#define STEPS 12

/* What the bodies would do in step k without forces: pressed and tilted, so that pairs open from one side */
static void Drive(ComplianceScene *s, PetscInt k)
{
  for (PetscInt p = 0; p < PAIRS; p++) {
    const PetscReal x = (PetscReal)(p % 16) / 15 - 0.5, y = (PetscReal)(p / 16) / 15 - 0.5;
    const PetscReal tilt = 1.5 * (1 - cos(0.5 * (PetscReal)k));

    s->mu[p]            = 0.4;
    s->q[3 * p]         = -1 + tilt * (x + 0.3 * y);
    s->q[3 * p + 1]     = 0.3 * y;
    s->q[3 * p + 2]     = -0.1 * tilt * x;
    s->slip0[2 * p]     = -1;
    s->slip0[2 * p + 1] = 0;
  }
}

/* Closed pairs of the last step */
static PetscErrorCode CountClosed(ContactCompliance c, PetscInt *closed)
{
  const ContactStatus *status;

  PetscFunctionBeginUser;
  PetscCall(ContactComplianceGetStatus(c, &status));
  *closed = 0;
  for (PetscInt p = 0; p < PAIRS; p++) *closed += status[p] != CONTACT_OPEN;
  PetscFunctionReturn(0);
}

/* A step with another solver that has the memory of c; the same bits */
static PetscErrorCode StepFromMemory(const ComplianceScene *s, const PetscReal guess[], const PetscReal lambda[],
                                     PetscInt n, const PetscReal memory[], PetscBool *same)
{
  ContactCompliance other;
  PetscReal         l[ROWS];

  PetscFunctionBeginUser;
  PetscCall(ContactComplianceCreate(PAIRS, s->W, &other));
  PetscCall(SceneSetFriction(other, PAIRS, s->mu, NULL, NULL, 0));
  PetscCall(ContactComplianceSetMemory(other, n, memory));
  PetscCall(PetscArraycpy(l, guess, ROWS));
  PetscCall(ContactComplianceSolve(other, s->q, s->slip0, l, NULL, NULL));
  PetscCall(PetscArraycmp(l, lambda, ROWS, same));
  PetscCall(ContactComplianceDestroy(&other));
  PetscFunctionReturn(0);
}

static PetscErrorCode TestSteps(ComplianceScene *s, ContactCompliance c, int *failed)
{
  PetscReal        lambda[ROWS] = {0}, guess[ROWS], worst = 0;
  PetscInt         least = PAIRS, most = 0;
  PetscBool        all = PETSC_TRUE, single = PETSC_FALSE;
  ComplianceReport totals;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < STEPS; k++) {
    PetscReal *memory;
    PetscInt   n, closed;
    PetscBool  same;

    Drive(s, k);
    PetscCall(PetscArraycpy(guess, lambda, ROWS));
    PetscCall(ContactComplianceGetMemory(c, &n, &memory));
    PetscCall(ContactComplianceSolve(c, s->q, s->slip0, lambda, NULL, NULL));
    PetscCall(StepFromMemory(s, guess, lambda, n, memory, &same));
    PetscCall(PetscFree(memory));
    PetscCall(CountClosed(c, &closed));
    worst = fmax(worst, SceneViolation(s, lambda));
    all   = same && all ? PETSC_TRUE : PETSC_FALSE;
    if (c->chord.single) single = PETSC_TRUE;
    least = PetscMin(least, closed);
    most  = PetscMax(most, closed);
  }
  PetscCall(ContactComplianceGetTotals(c, &totals));
  *failed += CheckClose("laws", worst, 0, 1e-11);
  *failed += CheckTrue("steps from memory, bitwise", all, 0);
  *failed += CheckTrue("all by factors of steps before", totals.routes[COMPLIANCE_CHORD] == STEPS, totals.iterations);
  *failed += CheckTrue("pairs open and close", least < PAIRS * 3 / 4 && most > PAIRS * 9 / 10, (double)least);
  *failed += CheckTrue("some factors are in single precision", single, (double)totals.factors);
  PetscFunctionReturn(0);
}

/* Whether a memory whose number k is x instead is refused, in a line that has these words */
static PetscErrorCode CheckRefused(ContactCompliance c, PetscInt n, PetscReal memory[], PetscInt k, PetscReal x,
                                   const char words[], int *failed)
{
  const PetscReal kept   = memory[k];
  Scratch         errors = {.code = 0};
  PetscErrorCode  code;

  PetscFunctionBeginUser;
  memory[k] = x;
  PetscCall(PetscPushErrorHandler(ScratchKeepError, &errors));
  code = ContactComplianceSetMemory(c, n, memory);
  PetscCall(PetscPopErrorHandler());
  memory[k] = kept;
  *failed += CheckTrue(words, code == PETSC_ERR_FILE_UNEXPECTED && strstr(errors.message, words), (double)x);
  PetscFunctionReturn(0);
}

/* Breaks where a number of a file becomes an index as it is, or numbers left over are counted in place of those that
   came */
static PetscErrorCode TestDamaged(ContactCompliance c, int *failed)
{
  const PetscInt base = 2 * ROWS + 1;
  PetscReal     *memory, *more;
  PetscInt       n;
  char           length[80];

  PetscFunctionBeginUser;
  PetscCall(ContactComplianceGetMemory(c, &n, &memory));
  PetscCall(CheckRefused(c, n, memory, base, -1, "size of a base -1. is not a whole number of 0 to 768", failed));
  PetscCall(CheckRefused(c, n, memory, base, NAN, "size of a base", failed));
  PetscCall(CheckRefused(c, n, memory, base + 1, -1, "index -1. is not a whole number of 0 to 1023", failed));
  PetscCall(CheckRefused(c, n, memory, base + 2, 4 * PAIRS, "index 1024. is not a whole number", failed));
  PetscCall(CheckRefused(c, n, memory, base + 2, 0.5, "index 0.5 is not a whole number", failed));
  PetscCall(PetscCalloc1(n + 1, &more));
  PetscCall(PetscArraycpy(more, memory, n));
  PetscCall(CheckRefused(c, n + 1, more, n, 1e300, "column 1e+300 is not a whole number", failed));
  snprintf(length, sizeof(length), ": %d numbers are not those of %d pairs", (int)base + 7, PAIRS);
  PetscCall(CheckRefused(c, base + 7, memory, base, 0, length, failed));
  PetscCall(ContactComplianceSetMemory(c, n, memory));
  PetscCall(PetscFree(more));
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(0);
}

/* v after a change of the forces by a thousandth beside that of a whole product */
static PetscErrorCode TestProduct(ContactCompliance c, int *failed)
{
  PetscReal      near[ROWS], off = 0, change = 0;
  ComplianceMiss miss;

  PetscFunctionBeginUser;
  PetscCall(ContactComplianceSetMemory(c, 0, NULL));
  for (PetscInt i = 0; i < ROWS; i++) {
    c->free[i] = 0.1 * sin(1.3 * (double)i) - 10;
    c->l[i]    = i % 3 ? 0.1 : 1 + 0.2 * cos((double)i);
  }
  PetscCall(ComplianceNearMove(c, &miss));
  *failed += CheckTrue("begins with a whole product", c->near.stands, 0);
  PetscCall(PetscArraycpy(c->v0, c->v, ROWS));
  for (PetscInt i = 0; i < ROWS; i++) c->l[i] += 1e-3 * sin(0.7 * (double)i * (double)i);
  PetscCall(ComplianceNearMove(c, &miss));
  *failed += CheckTrue("no whole product", c->near.error > 0, c->near.error);
  PetscCall(PetscArraycpy(near, c->v, ROWS));
  PetscCall(ComplianceMove(c));
  for (PetscInt i = 0; i < ROWS; i++) {
    off    = fmax(off, fabs(near[i] - c->v[i]));
    change = fmax(change, fabs(c->v[i] - c->v0[i]));
  }
  *failed += CheckClose("16 bits of what changes", off / change, 0, 1e-4);
  *failed += CheckTrue("which are not all", off / change > 1e-9, off / change);
  *failed += CheckTrue("off by at most its stated size", off <= c->near.error, off / c->near.error);
  *failed += CheckTrue("and by a fifth of it at least", off >= 0.2 * c->near.error, off / c->near.error);
  PetscFunctionReturn(0);
}

/* y := A x of a base in which all pairs stick along e = (1, 0), rows and columns n, across, along of each pair:
   l = (x_0, x_2 - mu x_0, x_1), y = (v_0, v_2, v_1), v = W kappa l */
static void StickingTimes(const ComplianceScene *s, const ContactCompliance c, const PetscReal x[], PetscReal y[])
{
  PetscReal f[ROWS];

  for (PetscInt p = 0; p < PAIRS; p++) {
    f[3 * p]     = c->kappa[p] * x[3 * p];
    f[3 * p + 1] = c->kappa[p] * (x[3 * p + 2] - s->mu[p] * x[3 * p]);
    f[3 * p + 2] = c->kappa[p] * x[3 * p + 1];
  }
  for (PetscInt i = 0; i < ROWS; i++) {
    const PetscInt row = i % 3 ? 3 * (i / 3) + 3 - i % 3 : i;

    y[i] = 0;
    for (PetscInt j = 0; j < ROWS; j++) y[i] += s->W[row * ROWS + j] * f[j];
  }
}

/* That base by the memory of a solver, and how far from x the solution of A x is */
static PetscErrorCode SolveSticking(const ComplianceScene *s, ContactCompliance c, PetscReal *off)
{
  const PetscInt n = 3 * ROWS + 2 + 4 * PAIRS;
  PetscReal     *memory, *base, y[ROWS], x[ROWS];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &memory));
  base    = &memory[2 * ROWS + 1];
  *base++ = ROWS;
  for (PetscInt i = 0; i < ROWS; i++) *base++ = (PetscReal)(4 * (i / 3) + (i % 3 ? i % 3 + 1 : 0));
  for (PetscInt p = 0; p < PAIRS; p++) {
    *base++ = 1;
    *base++ = 0;
    *base++ = s->mu[p];
    *base++ = 0;
  }
  PetscCall(ContactComplianceSetMemory(c, n, memory));
  for (PetscInt i = 0; i < ROWS; i++) x[i] = 1 + 0.5 * sin((double)i);
  StickingTimes(s, c, x, y);
  ComplianceChordBaseSolve(c, 1, y);
  *off = 0;
  for (PetscInt i = 0; i < ROWS; i++) *off = fmax(*off, fabs(y[i] - x[i]));
  PetscCall(PetscFree(memory));
  PetscFunctionReturn(0);
}

/* Bodies that a long and soft holder lets rise together, so that what pairs do to each other is 1e-7 of what all do to
   one: pivots that single precision does not carry. Breaks where its factors are taken nevertheless, or none are */
static PetscErrorCode TestPivots(ComplianceScene *s, int *failed)
{
  ContactCompliance stiff, soft;
  PetscReal         off;

  PetscFunctionBeginUser;
  PetscCall(ContactComplianceCreate(PAIRS, s->W, &stiff));
  PetscCall(SceneSetFriction(stiff, PAIRS, s->mu, NULL, NULL, 0));
  PetscCall(SolveSticking(s, stiff, &off));
  *failed += CheckTrue("good pivots: factors in single precision", stiff->chord.exists && stiff->chord.single, off);
  *failed += CheckClose("solve to its rounding", off, 0, 1e-3);
  *failed += CheckTrue("and not to more", off > 1e-9, off);
  PetscCall(ContactComplianceDestroy(&stiff));
  for (PetscInt i = 0; i < ROWS; i += 3)
    for (PetscInt j = 0; j < ROWS; j += 3) s->W[i * ROWS + j] += 1e7;
  PetscCall(ContactComplianceCreate(PAIRS, s->W, &soft));
  PetscCall(SceneSetFriction(soft, PAIRS, s->mu, NULL, NULL, 0));
  PetscCall(SolveSticking(s, soft, &off));
  *failed += CheckTrue("small pivots: factors in double precision", soft->chord.exists && !soft->chord.single, off);
  *failed += CheckClose("solve to the rounding of pivots of 1e-7", off, 0, 1e-3);
  PetscCall(ContactComplianceDestroy(&soft));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  ComplianceScene   s;
  ContactCompliance c;

  PetscFunctionBeginUser;
  (void)size;
  PetscCall(SceneCreate(PAIRS, 3, &s));
  SceneAddHalfSpace(&s, 1, 0.5);
  Drive(&s, 0);
  PetscCall(ContactComplianceCreate(PAIRS, s.W, &c));
  PetscCall(SceneSetFriction(c, PAIRS, s.mu, NULL, NULL, 0));
  PetscCall(TestSteps(&s, c, failed));
  PetscCall(TestDamaged(c, failed));
  PetscCall(TestProduct(c, failed));
  PetscCall(ContactComplianceDestroy(&c));
  PetscCall(TestPivots(&s, failed));
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
