/* Maxwell branches of the parts on reduced coordinates (reduced.h): Phi'K_p Phi here, the rest with the residual */
#include "reduced/reducedimpl.h"
#include "solver/block/orthonormal.h"

/* The law of a part, and Phi'A Phi of its stiffness A at unit modulus, symmetric to the last bit */
static PetscErrorCode BranchSet(ReducedRun r, const PencilLaw *law, ReducedBranch *b)
{
  const PetscInt m = r->reduction.model.m;
  Mat            APhi;

  PetscFunctionBeginUser;
  b->n = ViscoelasticBranches(&law->law);
  for (PetscInt j = 0; j < b->n; j++) {
    b->stiff[j] = law->scale * law->law.value[j];
    b->time[j]  = law->law.value[b->n + j];
  }
  PetscCall(MatDuplicate(r->reduction.Phi, MAT_DO_NOT_COPY_VALUES, &APhi));
  PetscCall(BlockMultiply(law->A, r->reduction.Phi, APhi));
  PetscCall(BlockGram(r->reduction.Phi, APhi, b->S));
  ReducedSymmetrise(m, b->S);
  PetscCall(MatDestroy(&APhi));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedBranchesBegin(ReducedRun r, PencilLaw **law)
{
  ReducedModel *model = &r->reduction.model;
  PetscInt      n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetLaws(r->run.operators, r->request.p, &n, law));
  PetscCheck(!n || !model->sparse, r->comm, PETSC_ERR_USER_INPUT,
             "-..._prony_modulus with more pairs than -dynamics_dense: a reduced model has branches in dense matrices "
             "alone; raise -dynamics_dense, or take -dynamics_model full");
  PetscCheck(
    !n || !model->n_motions, r->comm, PETSC_ERR_USER_INPUT,
    "-..._prony_modulus with -motions: a reduced model has no forces of branches at nodes that are moved; take "
    "-dynamics_model full");
  PetscCall(ReducedBranchesCreate(n, model));
  for (PetscInt i = 0; i < n; i++) PetscCall(BranchSet(r, &(*law)[i], &model->branch[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode ReducedBranchesEnd(ReducedRun r, PencilLaw **law)
{
  const ReducedModel *model = &r->reduction.model;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < model->n_branches; i++) {
    ReducedSymmetrise(3 * model->n_pairs, model->branch[i].Sx);
    PetscCall(MatDestroy(&(*law)[i].A));
  }
  PetscCall(PetscFree(*law));
  PetscFunctionReturn(0);
}
