/*
   Residuals of the laws of contact and friction. Per pair, with F the largest |lambda_n| and L the largest gap,
   closing, slip or displacement at any pair (bodies that move far together have the gap between them no finer than
   that), g = gap + c, c the closing that the law has at
   lambda_n, s the slip:
      penetration      max(0, -g) / L
      sign             max(0, -lambda_n) / F
      complementarity  |min(lambda_n / F, g / L)|
      cone             max(0, |lambda_t| - |mu| lambda_n) / F
      dissipation      slip: |lambda_t - mu lambda_n d| / F, d = s / |s|, or t where the interface slides as it is told;
                       stick: |s| / L
   L is at least 1e-9 of the width of a pair: what is shorter is rounding of the coordinates.
*/
#include "contactimpl.h"
#include "base/text.h"
#include <math.h>

/* Force (N) and length (m) that the residuals are relative to */
typedef struct {
  PetscReal force, length;
} Scale;

static PetscReal Length2(const PetscReal a[2])
{
  return PetscSqrtReal(a[0] * a[0] + a[1] * a[1]);
}

/* F (N) and L (m) over all ranks; displacement (m) is the largest of the rank. A pair's closing is its gap now less
   that of the mesh. Both are of all pairs of all interfaces: a pair that carries little is judged beside those that
   carry much, since rounding of the solution is of that size. */
static PetscErrorCode ScaleFind(MPI_Comm comm, PetscInt n, const ContactJudged pair[], PetscReal displacement,
                                Scale *scale)
{
  PetscReal largest[2] = {0, displacement};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < n; p++) {
    const ContactState *s    = pair[p].state;
    const PetscReal     move = PetscMax(PetscAbsReal(s->gap - pair[p].gap), Length2(s->slip));

    largest[0] = PetscMax(largest[0], PetscAbsReal(s->lambda_n));
    largest[1] = PetscMax(largest[1], PetscMax(move, PetscAbsReal(s->gap)));
    largest[1] = PetscMax(largest[1], 1e-9 * pair[p].width);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPIU_REAL, MPI_MAX, comm));
  scale->force  = largest[0];
  scale->length = largest[1];
  PetscFunctionReturn(0);
}

/* a / b for a >= 0, where 0 / 0 is nothing to complain about */
static PetscReal Relative(PetscReal a, PetscReal b)
{
  return a == 0 ? 0 : a / b;
}

/* |lambda_t - mu lambda_n d|, N. Where the interface slides as told, t is d whatever the small slip of the
   deformation is: the linearised state has it so. Else any direction d will do where there is no slip, and the length
   alone is judged. */
static PetscReal SlipResidual(const ContactJudged *pair)
{
  const ContactState *state = pair->state;
  const PetscReal     slip = Length2(state->slip), force = pair->mu * state->lambda_n;
  PetscReal           rest[2] = {state->lambda_t[0], state->lambda_t[1]};

  if (!pair->told && slip == 0) return PetscAbsReal(Length2(rest) - PetscAbsReal(force));
  rest[0] -= force * (pair->told ? 1 : state->slip[0] / slip);
  rest[1] -= force * (pair->told ? 0 : state->slip[1] / slip);
  return Length2(rest);
}

/* Raises the residuals to those of one pair. Infinity stands for what is no number, since PetscMax(0, nan) is 0 and
   would hide it. */
static void PairRaise(const ContactJudged *pair, const Scale *scale, ContactKKT *kkt)
{
  const ContactState *state = pair->state;
  const PetscReal     gap   = Relative(state->gap + pair->closing, scale->length);
  const PetscReal     force = Relative(state->lambda_n, scale->force);
  const PetscReal     over  = Length2(state->lambda_t) - PetscAbsReal(pair->mu) * state->lambda_n;
  PetscReal           rest  = 0;

  if (state->status == CONTACT_SLIP) rest = Relative(SlipResidual(pair), scale->force);
  if (state->status == CONTACT_STICK) rest = Relative(Length2(state->slip), scale->length);
  if (PetscIsInfOrNanReal(gap + force + over + rest)) {
    *kkt = (ContactKKT){INFINITY, INFINITY, INFINITY, INFINITY, INFINITY};
    return;
  }
  kkt->penetration     = PetscMax(kkt->penetration, -gap);
  kkt->sign            = PetscMax(kkt->sign, -force);
  kkt->complementarity = PetscMax(kkt->complementarity, PetscAbsReal(PetscMin(force, gap)));
  kkt->cone            = PetscMax(kkt->cone, Relative(PetscMax(0, over), scale->force));
  kkt->dissipation     = PetscMax(kkt->dissipation, rest);
}

PetscErrorCode ContactJudge(MPI_Comm comm, PetscInt n, const ContactJudged pair[], PetscReal displacement,
                            ContactKKT *kkt)
{
  Scale      scale;
  ContactKKT worst = {0, 0, 0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(ScaleFind(comm, n, pair, displacement, &scale));
  for (PetscInt p = 0; p < n; p++) PairRaise(&pair[p], &scale, &worst);
  /* ContactKKT holds PetscReals alone */
  PetscCallMPI(MPI_Allreduce(&worst, kkt, (PetscMPIInt)(sizeof(worst) / sizeof(PetscReal)), MPIU_REAL, MPI_MAX, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactComputeKKT(Contact contact, const ContactState state[], const PetscReal mu[],
                                 const PressureLaw law[], PetscReal displacement, ContactKKT *kkt)
{
  ContactJudged *judged;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(contact->n_pairs, &judged));
  for (PetscInt p = 0; p < contact->n_pairs; p++) {
    const ContactPair *pair = &contact->pairs[p];
    const PetscInt     i    = pair->interface;

    judged[p] = (ContactJudged){&state[p],
                                mu[p],
                                ContactPairClosing(&contact->interfaces[i], pair, &law[i], state[p].lambda_n),
                                pair->gap,
                                PetscSqrtReal(pair->area),
                                contact->interfaces[i].slides};
  }
  PetscCall(ContactJudge(contact->comm, contact->n_pairs, judged, displacement, kkt));
  PetscCall(PetscFree(judged));
  PetscFunctionReturn(0);
}

/* A residual in words */
typedef struct {
  const char *name, *meaning;
  PetscReal   value;
} Law;

#define N_LAWS 5

static void LawsOf(const ContactKKT *kkt, Law law[N_LAWS])
{
  const Law all[N_LAWS] = {
    {"penetration", "pairs that overlap, to the largest displacement or gap", kkt->penetration},
    {"sign", "pairs that pull, to the largest normal force", kkt->sign},
    {"complementarity", "pairs that carry force across a gap", kkt->complementarity},
    {"cone", "friction beyond mu lambda_n, to the largest normal force", kkt->cone},
    {"dissipation", "friction off the direction of slip, or slip where a pair holds", kkt->dissipation},
  };

  for (int i = 0; i < N_LAWS; i++) law[i] = all[i];
}

PetscErrorCode ContactViewKKT(const ContactKKT *kkt, PetscViewer viewer)
{
  Law law[N_LAWS];

  PetscFunctionBeginUser;
  LawsOf(kkt, law);
  for (int i = 0; i < N_LAWS; i++)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-15s %8.1e  %s\n", law[i].name, (double)law[i].value, law[i].meaning));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactPrintKKT(const ContactKKT *kkt, size_t size, char text[])
{
  Law  law[N_LAWS];
  char piece[64];

  PetscFunctionBeginUser;
  LawsOf(kkt, law);
  text[0] = 0;
  for (int i = 0; i < N_LAWS; i++) {
    PetscCall(PetscSNPrintf(piece, sizeof(piece), "%s%s %.1e", i ? ", " : "", law[i].name, (double)law[i].value));
    PetscCall(WordsAdd(text, piece, size));
  }
  PetscFunctionReturn(0);
}
