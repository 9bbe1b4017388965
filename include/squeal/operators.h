/*
   Operators - the matrices of the system linearised about steady sliding

      M u'' + C u' + (K + mu H) u = 0

   M, K symmetric; C damping; H the unsymmetric friction part per unit friction coefficient. They are assembled from a
   model and its contact, or loaded, or given densely. Where an interface obeys the exact constraint N u = 0, the
   pencil is the projection Zl' (.) Zr with N Zr = 0 and (N - mu T) Zl = 0; without constraints Zl = Zr = identity,
   and nothing is projected.
*/
#pragma once

#include <squeal/contact.h>

typedef struct _p_Operators *Operators;

/* Matrices of (lambda^2 M + lambda C + K) x = 0, friction included in K; borrowed */
typedef struct {
  Mat       K, C, M;   /* C is NULL without damping */
  PetscBool symmetric; /* K, M (and C) symmetric */
} OperatorsPencil;

/*@ OperatorsCreate - makes empty operators. Collective. @*/
PetscErrorCode OperatorsCreate(MPI_Comm comm, Operators *operators);

/*@ OperatorsSetModel - takes the matrices from a model and its contact. Collective. @*/
PetscErrorCode OperatorsSetModel(Operators operators, Model model, Contact contact);

/*@
   OperatorsSetFromOptions - reads where the matrices come from and go to. Collective.

   Options Database Keys:
+  -operators_load_k, _m, _c, _h <file>  - PETSc binary matrices; K and M are required together
.  -operators_dense_k, _m, _c, _h <list> - small dense matrices inline, rows one after another
.  -operators_mass <consistent|lumped>   - mass matrix of a model
.  -contact_mu <mu>                      - friction coefficient of K + mu H for loaded or dense matrices
-  -operators_save <dir>                 - write K.bin, M.bin and, where there are any, C.bin and H.bin; with the
contact
                                          constraint the projected matrices, friction included in K.bin and M.bin
@*/
PetscErrorCode OperatorsSetFromOptions(Operators operators);

/*@ OperatorsHaveMatrices - whether matrices are loaded or given densely, so that no model is needed. Not collective.
    @*/
PetscErrorCode OperatorsHaveMatrices(Operators operators, PetscBool *have);

/*@ OperatorsSetUp - assembles or loads the matrices. Collective. @*/
PetscErrorCode OperatorsSetUp(Operators operators);

/*@ OperatorsGetMatrices - K, M, C, H of all unknowns (borrowed; C and H may be NULL) and mu. Not collective. @*/
PetscErrorCode OperatorsGetMatrices(Operators operators, Mat *K, Mat *M, Mat *C, Mat *H, PetscReal *mu);

/*@ OperatorsGetPencil - the pencil with friction. Collective at the first call. @*/
PetscErrorCode OperatorsGetPencil(Operators operators, OperatorsPencil *pencil);

/*@ OperatorsGetFrictionless - the symmetric undamped pencil at mu = 0, of the same size. Collective at the first
    call. @*/
PetscErrorCode OperatorsGetFrictionless(Operators operators, OperatorsPencil *pencil);

/*@ OperatorsExpand - unknowns of the pencil to all unknowns, u = Zr q (or Zl q for a left vector). Collective. @*/
PetscErrorCode OperatorsExpand(Operators operators, PetscBool left, Vec q, Vec u);

/*@ OperatorsCreateVec - a vector of all unknowns. Collective. @*/
PetscErrorCode OperatorsCreateVec(Operators operators, Vec *u);

/*@ OperatorsGetModel - the model and contact, NULL for loaded matrices (borrowed). Not collective. @*/
PetscErrorCode OperatorsGetModel(Operators operators, Model *model, Contact *contact);

/*@ OperatorsView - sizes and kinds in words. Collective. @*/
PetscErrorCode OperatorsView(Operators operators, PetscViewer viewer);

/*@ OperatorsDestroy - frees the operators. Collective. @*/
PetscErrorCode OperatorsDestroy(Operators *operators);
