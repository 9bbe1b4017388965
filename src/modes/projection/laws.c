/*
   Materials whose stiffness depends on the eigenvalue: the dense problem

      T(lambda) x = (lambda^2 M + lambda C + K + sum_j h_j(lambda) A_j) x = 0,

   h as of the laws. Held at the reference frequency of the pencil, in the middle of the window, they make it a problem
   of which LAPACK has all eigenvalues (basis/companion.c): these are followed by Newton's method (basis/follow.c), at
   once or as the laws go from there to what they are. count.c tells whether none is missing. What does not oscillate is
   not listed but for rigid modes. What the projection itself leaves out is the concern of projection/beyond.c.
*/
#include "projection.h"

#define LAWS_STAGES 4   /* of paths: 1, 4 and 16 steps of the laws, and as many about double eigenvalues */
#define LAWS_DETOUR 0.5 /* of what laws add to those held: how far these go, with both branches then apart */
#define LAWS_STEPS  64

/* The pencil with a share of what laws add to those held at the reference, turned by the detour */
typedef struct {
  DensePencil pencil;
  PencilLaw  *law;
  DenseLaw   *dense;
} SharedLaws;

static PetscErrorCode SharedLawsCreate(const DensePencil *whole, PetscReal share, PetscReal detour, SharedLaws *s)
{
  PetscFunctionBeginUser;
  s->pencil = *whole;
  PetscCall(PetscMalloc2(whole->n_laws, &s->law, whole->n_laws, &s->dense));
  for (PetscInt l = 0; l < whole->n_laws; l++) {
    s->law[l]      = *whole->law[l].law;
    s->law[l].held = 1 - share * CMPLX(1, detour * (1 - share));
    s->dense[l]    = (DenseLaw){&s->law[l], whole->law[l].A};
  }
  s->pencil.law = s->dense;
  PetscFunctionReturn(0);
}

/* Whether a mode is rigid, which laws leave as it is */
static PetscBool LambdaIsRigid(const Projection *p, PetscComplex lambda)
{
  return p->window->known.rigid && cabs(lambda) <= p->window->known.scale ? PETSC_TRUE : PETSC_FALSE;
}

/* All modes by as many steps; good = none was lost, none came twice */
static PetscErrorCode LawsFollow(const Projection *p, int steps, PetscReal detour, ProjectionModes *m, PetscBool *good)
{
  const DensePencil whole = SubspacePencil(&p->space);

  PetscFunctionBeginUser;
  *good = PETSC_TRUE;
  for (int step = 1; step <= steps && *good; step++) {
    SharedLaws shared;

    PetscCall(SharedLawsCreate(&whole, (PetscReal)step / steps, detour, &shared));
    for (PetscInt i = 0; i < m->n && *good; i++) {
      if (LambdaIsRigid(p, m->lambda[i])) continue;
      PetscCall(DensePencilFollow(&shared.pencil, &m->lambda[i], &m->vectors[0][i * m->size],
                                  &m->vectors[1][i * m->size], good));
      if (!(cimag(m->lambda[i]) > 0)) *good = PETSC_FALSE;
    }
    PetscCall(PetscFree2(shared.law, shared.dense));
    if (*good && ProjectionHasTwice(m)) *good = PETSC_FALSE;
  }
  PetscCallMPI(MPI_Bcast(good, 1, MPIU_BOOL, 0, p->modes->comm));
  PetscFunctionReturn(0);
}

/* A copy of the modes, into room that is there */
static PetscErrorCode LawsCopy(const ProjectionModes *from, ProjectionModes *to)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(to->lambda, from->lambda, from->n));
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscArraycpy(to->vectors[side], from->vectors[side], from->n * from->size));
    PetscCall(PetscArraycpy(to->backward[side], from->backward[side], from->n));
  }
  PetscFunctionReturn(0);
}

/* Leaves the modes that the window claims, of those nearest to a target as many as are asked for */
static PetscErrorCode LawsSelect(const Projection *p, ProjectionModes *m)
{
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) {
    if (!LambdaIsRigid(p, m->lambda[i]) && !ProjectionHas(p, m->lambda[i])) continue;
    m->lambda[kept] = m->lambda[i];
    for (int side = 0; side < 2; side++) {
      PetscCall(PetscArraymove(&m->vectors[side][kept * m->size], &m->vectors[side][i * m->size], m->size));
      m->backward[side][kept] = m->backward[side][i];
    }
    kept++;
  }
  m->n = kept;
  PetscFunctionReturn(0);
}

/* Where some are lost on every path: those that Newton's method finds from each by itself; the count says whether that
   is all */
static PetscErrorCode LawsGather(const Projection *p, ProjectionModes *m)
{
  const ProjectionModes all = *m;

  PetscFunctionBeginUser;
  m->n = 0;
  for (PetscInt i = 0; i < all.n; i++) {
    ProjectionModes one = {.n       = 1,
                           .size    = all.size,
                           .lambda  = &all.lambda[i],
                           .vectors = {&all.vectors[0][i * all.size], &all.vectors[1][i * all.size]}};
    PetscBool       good;

    PetscCall(LawsFollow(p, 1, 0, &one, &good));
    if (!good) continue;
    m->lambda[m->n] = all.lambda[i];
    for (int side = 0; side < 2; side++)
      PetscCall(PetscArraymove(&m->vectors[side][m->n * m->size], &m->vectors[side][i * m->size], m->size));
    m->n++;
    if (ProjectionHasTwice(m)) m->n--;
  }
  PetscCallMPI(MPI_Bcast(&m->n, 1, MPIU_INT, 0, p->modes->comm));
  PetscFunctionReturn(0);
}

/* Leaves the modes nearest to the target */
static PetscErrorCode LawsKeepNearest(const Projection *p, ProjectionModes *modes, PetscReal *d)
{
  ProjectionModes from = *modes;
  PetscInt        n    = from.n, *list;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &list));
  for (PetscInt i = 0; i < n; i++) list[i] = i;
  ProjectionKeepNearest(p->window, 0, from.lambda, list, &n, d);
  PetscCall(ProjectionModesCreate(p, n, modes));
  for (PetscInt i = 0; i < n; i++) {
    modes->lambda[i] = from.lambda[list[i]];
    for (int side = 0; side < 2; side++)
      PetscCall(
        PetscArraycpy(&modes->vectors[side][i * from.size], &from.vectors[side][list[i] * from.size], from.size));
  }
  PetscCall(ProjectionModesDestroy(&from));
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionLawsSolve(const Projection *p, ProjectionModes *m)
{
  PetscReal       d    = 0;
  PetscBool       good = PETSC_FALSE;
  ProjectionModes start;

  PetscFunctionBeginUser;
  PetscCall(ProjectionModesCreate(p, m->n, &start));
  PetscCall(LawsCopy(m, &start));
  for (int stage = 0, steps = 1; stage < LAWS_STAGES && !good; stage++, steps = PetscMin(4 * steps, LAWS_STEPS)) {
    PetscCall(LawsCopy(&start, m));
    PetscCall(LawsFollow(p, steps, stage + 1 == LAWS_STAGES ? LAWS_DETOUR : 0, m, &good));
  }
  if (!good) PetscCall(LawsCopy(&start, m));
  if (!good) PetscCall(LawsGather(p, m));
  PetscCall(ProjectionModesDestroy(&start));
  PetscCall(ProjectionModesShare(p->modes->comm, m));
  PetscCall(LawsSelect(p, m));
  if (p->window->count) PetscCall(LawsKeepNearest(p, m, &d));
  m->lambda_reach = ProjectionEdge(p, d);
  PetscFunctionReturn(0);
}
