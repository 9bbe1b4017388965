/* Private to operators/: the record of a pencil */
#pragma once

#include "operatorsimpl.h"

/* Sums in all unknowns, K symmetric and H = unsymmetric / mu; then those in the unknowns of the pencil, PROJECTED from
   the symmetric terms, PENCIL from all */
typedef enum {
  SUM_K,
  SUM_M,
  SUM_C,
  SUM_H,
  PROJECTED_K,
  PROJECTED_M,
  PENCIL_K,
  PENCIL_M,
  PENCIL_C,
  N_PENCIL_SUMS
} PencilSum;

struct _p_Pencil {
  MPI_Comm   comm;
  Operators  operators;
  PetscInt   n_scene;    /* parameters of the operators */
  Parameters parameters; /* those, then closed_g; at the present point */
  /* the sliding state */
  PetscBool  from_state, has_forces; /* there is one, with normal forces */
  PetscInt   n_pairs, n_groups;
  PetscInt  *group; /* [n_pairs] of each local pair as in SlidingState */
  PetscBool *slips; /* [n_pairs] of an interface that holds: at the limit of friction, hence free along the surface */
  PetscReal *force; /* [n_pairs] normal force, N: of the state, or of -contact_force shared by area */
  PetscReal *total; /* [interfaces] their sums over all ranks */
  /* matrices */
  Terms base;  /* in all unknowns: those of the bodies, of the contact, of the preload */
  Mat   Zr, E; /* right null space of the constraints and its injection; NULL without constraints */
  Mat T; /* displacements from those in which slaves have the means of their pairs (means.c); NULL for one node each */
  PetscInt                  n_left;         /* Zl = Zr + sum_i mu_i left[i] */
  Mat                      *left;           /* [n_left] */
  const OperatorsFriction **left_mu;        /* [n_left] mu_i (borrowed) */
  PetscInt                 *left_interface; /* [n_left] */
  Terms    projected; /* in the unknowns of the pencil, made when asked for; empty without constraints: base serves */
  TermsSum sum[N_PENCIL_SUMS];
  Terms    causing; /* terms that make modes grow or decay, scale the coefficient; [n_causes] what they are */
  PetscInt n_causes;
  PencilCause   *cause;
  PetscReal      reference; /* rad/s, 0 for none */
  PetscBool      real;      /* laws of materials are what they are there, without loss */
  PetscInt       n_laws, n_folded;
  OperatorsLaw **folded;        /* [n_folded] of causing */
  PencilLaw     *law;           /* [n_laws] at the present point */
  TermsSum      *law_sum;       /* [n_laws] its matrix where that is one */
  PetscBool      keeps_apart;   /* joining was formed */
  TermsSum       joining;       /* what is added to K for that of the bodies apart, in all unknowns (apart.c) */
  PetscBool      mass_singular; /* loaded: there is no mass along some directions that are no unknowns */
  PetscBool      released;      /* the terms are gone */
  PetscBool      has_laws;      /* they are those of the present point */
  PetscBool      has_factors;   /* left' right was formed at the present point */
  Mat            factor[2];     /* left and right factor of the unsymmetric stiffness, NULL where it has none */
  Mat            half; /* K without friction - half_shift M, its upper half, of which both K are made again; or NULL */
  PetscReal      half_shift; /* (rad/s)^2 */
};

/* pairrows.c - forms both factors of the unsymmetric stiffness at the present point, where they are not there yet */
PETSC_INTERN PetscErrorCode PencilFormFactors(Pencil pencil);

/* laws.c - of materials whose stiffness depends on the frequency that at the reference alone, without loss */
PETSC_INTERN void PencilDropLoss(Pencil pencil);
/* The laws at the present point, where the terms are there; frees them */
PETSC_INTERN PetscErrorCode PencilFormLaws(Pencil pencil);
PETSC_INTERN PetscErrorCode PencilForgetLaws(Pencil pencil);
/* Gives a term its law at the present point, which no other point changes; frees those */
PETSC_INTERN PetscErrorCode PencilFoldLaw(Pencil pencil, OperatorsTerm *term);
PETSC_INTERN PetscErrorCode PencilUnfoldLaws(Pencil pencil);

/* causes/causes.c - keeps the terms that make modes grow or decay at the present point, where they are there */
PETSC_INTERN PetscErrorCode PencilFormCauses(Pencil pencil);

/* The sum that is K without friction in the unknowns of the pencil */
static inline PencilSum PencilEven(Pencil pencil)
{
  return pencil->Zr ? PROJECTED_K : SUM_K;
}

/* factors.c - K without friction, or K, where it was released. Collective. */
PETSC_INTERN PetscErrorCode PencilRestore(Pencil pencil, PencilSum which);

/* dependents.c - null space of displacements that follow others, where there is none of the contact. Collective. */
PETSC_INTERN PetscErrorCode PencilTakeDependents(Pencil pencil);

/* means.c - T of n pairs, NULL where every slave is one node; T X, or T'X, in place of X; E of u in place of E of u~ */
PETSC_INTERN PetscErrorCode MeansCreate(Pencil pencil, PetscInt n, const ContactPair **list);
PETSC_INTERN PetscErrorCode MeansFollow(Mat T, PetscBool transpose, Mat *X);
PETSC_INTERN PetscErrorCode MeansTakeInjection(Pencil pencil, PetscInt n, const ContactPair **list);
/* multipliers.c - of matrices without a mesh: scales of unknowns without mass as Zr and E, where they are far from one.
   Collective. */
PETSC_INTERN PetscErrorCode PencilScaleMultipliers(Pencil pencil);

/* slidingstate.c - takes the groups and forces of a state, or those of the scene; its parameters and point */
PETSC_INTERN PetscErrorCode PencilTakeState(Pencil pencil, const SlidingState *state);

/* friction.c - terms of the closed pairs; raises an error where the scene does not say what sliding state the pencil
   would be linearised about */
PETSC_INTERN PetscErrorCode PencilAddContact(Pencil pencil);
PETSC_INTERN PetscErrorCode PencilCheckSliding(Pencil pencil);
/* friction.c - raises an error for a point with another normal force of an interface whose pressure is not linear,
   where that force alone tells its stiffness */
PETSC_INTERN PetscErrorCode PencilCheckPressure(Pencil pencil, const PetscReal p[]);

/* frictiontable.c - what a pair of this rank has in the terms of node k of its interface: its part L_k; where mu
   depends on the pressure mu, mu', or mu + p d mu / dp, over the factor of the law */
typedef enum { FRICTION_VALUE, FRICTION_SLOPE, FRICTION_TANGENT } FrictionPart;
PETSC_INTERN PetscReal PencilFrictionShare(Pencil pencil, PetscInt interface, PetscInt k, PetscInt pair,
                                           FrictionPart part);
/* Raises the error for a point at which friction of a table would be another one */
PETSC_INTERN PetscErrorCode PencilCheckTable(Pencil pencil, PetscInt interface, const PetscReal p[]);

/* constraint.c - null spaces of the closed pairs that obey the exact constraint; terms between them, where they are not
   there yet */
PETSC_INTERN PetscErrorCode PencilCreateNullSpaces(Pencil pencil);
PETSC_INTERN PetscErrorCode PencilProjectTerms(Pencil pencil);
PETSC_INTERN PetscErrorCode PencilDestroyNullSpaces(Pencil pencil);

/* matrixfile.c - opens a file of PETSc's; an error where a mass matrix has negative eigenvalues of its symmetric part
   beyond rounding. Singular: some are zero to rounding, beside those of unknowns without any mass */
PETSC_INTERN PetscErrorCode MatrixViewerOpen(MPI_Comm comm, const char file[], PetscFileMode mode, PetscViewer *viewer);
PETSC_INTERN PetscErrorCode MassCheck(Mat M, const char whose[], PetscBool *singular);
/* matrixterm.c - the same of the mass at the present point, where it depends on parameters, which may be of any sign */
PETSC_INTERN PetscErrorCode PencilCheckMass(Pencil pencil, Mat M);
