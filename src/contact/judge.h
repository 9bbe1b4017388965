/* Private to the rooms that solve contact: pairs whose laws are judged */
#pragma once

#include <squeal/contact.h>

/* A pair before the laws */
typedef struct {
  const ContactState *state;
  PetscReal           mu;
  PetscReal           closing; /* that the law has at lambda_n, m; 0 where contact is exact */
  PetscReal           gap;     /* of the mesh as it is, m */
  PetscReal           width;   /* m */
  PetscBool           told;    /* slips along t as it is told, not where it moves to */
} ContactJudged;

/* kkt.c - residuals of the pairs of all ranks; displacement is the largest of this rank, m. Collective. */
PETSC_INTERN PetscErrorCode ContactJudge(MPI_Comm comm, PetscInt n, const ContactJudged pair[], PetscReal displacement,
                                         ContactKKT *kkt);
