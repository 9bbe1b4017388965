/*
   Terms of spinning parts, for pencils alone (kernels/element/spin.h has the equations): of each part, per unit density
   rho and spin Omega,

      C += Omega rho G,   K += Omega^2 rho (K_sigma - Q),

   sigma being the stress of the bodies under the steady load of this part's spin, u = K^-1 f, held by supports and
   springs but not by contacts, with the moduli of the scene: parameters on which it depends must keep these. With the
   stiffness sum_t c_t A_t it depends on c_t where A_t u is not zero, but for the modulus of a part that alone carries
   f: there u ~ 1 / E. Where nothing holds the bodies, f balances itself, and

      (K + s M) u_k+1 = f + s M u_k

   finds u but for a rigid motion, which has no stress. A mesh that is not quite round leaves a rigid part M R a in f,
   which stays as it is from step to step: it makes no stress either, and is left out.
*/
#include "operators/operatorsimpl.h"
#include "kernels/element/spin.h"
#include <petscksp.h>

/* s, of the largest K_ii / M_ii, (rad/s)^2: K + s M can be factored where K has rigid motions, and each step divides
   what is left of f in elastic motions of eigenvalue kappa by 1 + kappa / s */
#define SHIFT 1e-10
/* of f */
#define RESIDUAL 1e-8
#define ATTEMPTS 20   /* steps at most */
#define UNROUND  1e-2 /* of f, which may be rigid */
#define SHARE    1e-4 /* of f, which a stiffness may carry without being counted */

/* fastest = sqrt(E / rho) / radius, rad/s: a rim as fast as the waves in it, beyond which the linear theory says
   nothing. */
PetscErrorCode OperatorsAddSpinParameters(Operators o)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(PetscMalloc1(scene->n_parts, &o->spin_of_part));
  for (PetscInt part = 0; part < scene->n_parts; part++) {
    const Part              *p    = &scene->parts[part];
    const PetscReal          wave = PetscSqrtReal(p->young / p->density); /* m/s, along a rod */
    const OperatorsParameter q    = {.row     = ModelFindRow("-parts", "spin"),
                                     .value   = p->spin.rate,
                                     .fastest = p->spin.radius > 0 ? wave / p->spin.radius : 0};

    o->spin_of_part[part] = -1;
    if (p->spin.given) PetscCall(ParametersAdd(&o->parameters, p->name, "spin", &q, &o->spin_of_part[part]));
  }
  PetscFunctionReturn(0);
}

/* Entries [n][n] times the 3 x 3 identity into a matrix: G and Q act on each Cartesian component alone (spin.h) */
static PetscErrorCode SpinSetCell(PetscInt n, const PetscInt rows[], const PetscReal entry[], Mat A)
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < n; a++)
    for (PetscInt b = 0; b < n; b++)
      for (int d = 0; d < 3; d++)
        PetscCall(MatSetValues(A, 1, &rows[3 * a + d], 1, &rows[3 * b + d], &entry[a * n + b], ADD_VALUES));
  PetscFunctionReturn(0);
}

/* Adds local cell c; load holds three values per local node */
static PetscErrorCode SpinAddCell(Operators o, PetscInt c, const SpinFrame *frame, Mat G, Mat Q, PetscScalar load[])
{
  const Element *element;
  const Mesh    *mesh;
  PetscInt       n, nodes[ELEMENT_MAX_NODES], rows[ELEMENT_MAX_DOFS];
  PetscReal      x[ELEMENT_MAX_DOFS];
  SpinIntegrals  sum;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(ModelGetCell(o->model, c, &element, nodes, x));
  n = element->n_nodes;
  PetscCheck(!SpinIntegrate(element->solid, frame, x, &sum), PETSC_COMM_SELF, PETSC_ERR_PLIB, "element is inverted");
  for (PetscInt i = 0; i < 3 * n; i++) {
    rows[i] = mesh->unknown[3 * nodes[i / 3] + i % 3];
    load[3 * nodes[i / 3] + i % 3] += sum.load[i];
  }
  PetscCall(SpinSetCell(n, rows, sum.gyroscopic, G));
  PetscCall(SpinSetCell(n, rows, sum.convective, Q));
  PetscFunctionReturn(0);
}

/* G (m^3, skew), Q (m^3) and the load f (m^4) of one part, per unit density and spin: times rho Omega, rho Omega^2,
   rho Omega^2 they are N s/m, N/m and N. */
static PetscErrorCode SpinAssemble(Operators o, PetscInt part, Mat *G, Mat *Q, Vec f)
{
  const ModelScene *scene;
  const Mesh       *mesh;
  PetscScalar      *load;
  SpinFrame         frame;
  Vec               nodal;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(PetscArraycpy(frame.axis, scene->parts[part].spin.axis, 3));
  PetscCall(PetscArraycpy(frame.centre, scene->parts[part].spin.centre, 3));
  PetscCall(PatternCreate(o->model, part, PETSC_FALSE, G, NULL));
  PetscCall(MatDuplicate(*G, MAT_DO_NOT_COPY_VALUES, Q));
  PetscCall(ModelCreateNodal(o->model, &nodal));
  PetscCall(VecGetArray(nodal, &load));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    if (mesh->cell_part[c] == part) PetscCall(SpinAddCell(o, c, &frame, *G, *Q, load));
  PetscCall(VecRestoreArray(nodal, &load));
  PetscCall(ModelSumShared(o->model, nodal));
  PetscCall(OperatorsTakeNodal(o, nodal, f));
  PetscCall(VecDestroy(&nodal));
  PetscCall(MatAssemblyBegin(*G, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyBegin(*Q, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*G, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*Q, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Factors of K + s M, s = SHIFT max K_ii / M_ii, shared by all parts: the matrix is that of all bodies. */
static PetscErrorCode SpinCreateSolver(Operators o, Mat K, Mat M, KSP *ksp)
{
  PetscReal largest;
  Vec       k, m;
  Mat       A;
  PC        pc;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(K, &k, &m));
  PetscCall(MatGetDiagonal(K, k));
  PetscCall(MatGetDiagonal(M, m));
  PetscCall(VecPointwiseDivide(k, k, m));
  PetscCall(VecMax(k, NULL, &largest));
  PetscCall(VecDestroy(&k));
  PetscCall(VecDestroy(&m));
  PetscCall(MatDuplicate(K, MAT_COPY_VALUES, &A));
  PetscCall(MatAXPY(A, SHIFT * largest, M, UNKNOWN_NONZERO_PATTERN));
  PetscCall(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(KSPCreate(o->comm, ksp));
  PetscCall(KSPSetOperators(*ksp, A, A));
  PetscCall(KSPSetType(*ksp, KSPPREONLY));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetUp(*ksp));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

/* u = K^-1 f of a part by the iteration of the header; it ends at RESIDUAL |f|, or where a step takes off less than
   a percent: what is left then is the rigid part of f, refused above UNROUND. */
static PetscErrorCode SpinSolve(Operators o, const char name[], Mat K, KSP ksp, Vec f, Vec u)
{
  PetscReal size, left, before = PETSC_INFINITY;
  Vec       r, du;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(f, &r));
  PetscCall(VecDuplicate(f, &du));
  PetscCall(VecNorm(f, NORM_2, &size));
  PetscCall(VecCopy(f, r));
  PetscCall(VecSet(u, 0));
  left = size;
  for (int i = 0; i < ATTEMPTS && left > RESIDUAL * size && left < 0.99 * before; i++) {
    before = left;
    PetscCall(KSPSolve(ksp, r, du));
    PetscCall(VecAXPY(u, 1, du));
    PetscCall(MatMult(K, u, r));
    PetscCall(VecAYPX(r, -1, f));
    PetscCall(VecNorm(r, NORM_2, &left));
  }
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&du));
  PetscCheck(
    left <= UNROUND * size, o->comm, PETSC_ERR_NOT_CONVERGED,
    "-%s_spin: nothing holds the bodies, and the load of the spin leaves %.2g of itself: its centre of mass is off "
    "-%s_spin_centre",
    name, (double)(left / size), name);
  PetscFunctionReturn(0);
}

/* Marks the parameters on which the stress depends that the load f makes, u = K^-1 f: of stiffness terms with |c_t
   A_t u| above SHARE |f|. One alone is not marked: then u ~ 1 / E, and the stress E u does not depend on it. */
static PetscErrorCode SpinMarkStressing(Operators o, Vec f, Vec u)
{
  PetscInt  n_stressing = 0, *stressing;
  PetscReal size, carried;
  Vec       r;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(o->terms.n, &stressing));
  PetscCall(VecDuplicate(f, &r));
  PetscCall(VecNorm(f, NORM_2, &size));
  for (PetscInt t = 0; t < o->terms.n; t++) {
    const OperatorsTerm *term = &o->terms.term[t];

    if (term->kind != OPERATORS_STIFFNESS || !term->n) continue;
    PetscCall(MatMult(term->A, u, r));
    PetscCall(VecNorm(r, NORM_2, &carried));
    carried *= PetscAbsReal(OperatorsTermCoefficient(term, o->parameters.p));
    if (carried > SHARE * size) stressing[n_stressing++] = term->factor[0].parameter;
  }
  for (PetscInt i = 0; i < n_stressing && n_stressing > 1; i++) o->parameters.list[stressing[i]].stressing = PETSC_TRUE;
  PetscCall(PetscFree(stressing));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}

/* Terms of one part, Omega rho G (unsymmetric by nature, N s/m) and Omega^2 rho (K_sigma - Q) (N/m); K of the bodies,
   and its factors. u is of unit rho and Omega: K_sigma is linear in the stress, so that the product of parameters
   scales it. */
static PetscErrorCode SpinAddPart(Operators o, PetscInt part, const char name[], Mat K, KSP ksp)
{
  const PetscInt spin = o->spin_of_part[part], density = N_PART_PARAMETERS * part + PART_DENSITY;
  const Mesh    *mesh;
  PetscReal     *displacement;
  Mat            G, Q, S;
  Vec            f, u;

  PetscFunctionBeginUser;
  PetscCall(OperatorsCheckSpinningPoints(o, part));
  PetscCall(OperatorsCheckSpinningTies(o, part));
  PetscCall(OperatorsCheckSpinningEquations(o, part));
  PetscCall(OperatorsCheckSpinningSuperelements(o, part));
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &displacement));
  PetscCall(MatCreateVecs(K, &u, &f));
  PetscCall(SpinAssemble(o, part, &G, &Q, f));
  PetscCall(SpinSolve(o, name, K, ksp, f, u));
  PetscCall(SpinMarkStressing(o, f, u));
  PetscCall(ModelGetNodal(o->model, u, displacement));
  PetscCall(OperatorsCreateGeometric(o, NULL, displacement, NULL, &S));
  PetscCall(PetscFree(displacement));
  PetscCall(MatAXPY(S, -1, Q, UNKNOWN_NONZERO_PATTERN));
  PetscCall(TermsAdd(&o->spin, OPERATORS_DAMPING, G, PETSC_FALSE, 2, (PetscInt[]){spin, density}));
  PetscCall(TermsSetCause(&o->spin, "spin", name, "spin"));
  PetscCall(TermsAdd(&o->spin, OPERATORS_STIFFNESS, S, PETSC_TRUE, 3, (PetscInt[]){spin, spin, density}));
  PetscCall(MatDestroy(&G));
  PetscCall(MatDestroy(&Q));
  PetscCall(MatDestroy(&S));
  PetscCall(VecDestroy(&f));
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(0);
}

/* Made when the first pencil asks for it, since a solution with all bodies is behind it. Collective. */
PetscErrorCode OperatorsNeedSpin(Operators o)
{
  const ModelScene *scene;
  KSP               ksp = NULL;
  Mat               K, M;

  PetscFunctionBeginUser;
  if (!o->model || o->spin.n) PetscFunctionReturn(0);
  PetscCall(ModelGetScene(o->model, &scene));
  for (PetscInt part = 0; part < scene->n_parts; part++) {
    if (o->spin_of_part[part] < 0) continue;
    PetscCall(OperatorsGetBodies(o, NULL, &K, &M, NULL));
    if (!ksp) PetscCall(SpinCreateSolver(o, K, M, &ksp));
    PetscCall(SpinAddPart(o, part, scene->parts[part].name, K, ksp));
  }
  PetscCall(KSPDestroy(&ksp));
  if (o->spin.n) PetscCall(OperatorsReleaseBodies(o));
  PetscFunctionReturn(0);
}

/* Raises an error where a part that shares nodes with `part` keeps its spin, while that of `part` moves */
static PetscErrorCode SpinCheckTogether(Operators o, const char option[], PetscInt part, PetscInt n,
                                        const PetscInt parameter[])
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  for (PetscInt other = 0; other < scene->n_parts; other++) {
    PetscBool moves = PETSC_FALSE;

    if (scene->parts[other].spin.body != scene->parts[part].spin.body) continue;
    for (PetscInt i = 0; i < n; i++)
      if (parameter[i] == o->spin_of_part[other]) moves = PETSC_TRUE;
    PetscCheck(moves, o->comm, PETSC_ERR_USER_INPUT,
               "%s %s_spin leaves %s_spin as it is, but these parts share nodes: give -sweep_link %s_spin,%s_spin",
               option, scene->parts[part].name, scene->parts[other].name, scene->parts[part].name,
               scene->parts[other].name);
  }
  PetscFunctionReturn(0);
}

/* parameter NULL: all parameters, as sensitivities move them; then parts need not move together. */
PetscErrorCode OperatorsCheckMoved(Operators o, const char option[], PetscInt n, const PetscInt parameter[])
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  if (!o->model) PetscFunctionReturn(0);
  PetscCall(OperatorsNeedSpin(o));
  PetscCall(ModelGetScene(o->model, &scene));
  for (PetscInt i = 0; i < (parameter ? n : o->parameters.n); i++) {
    const OperatorsParameter *q = &o->parameters.list[parameter ? parameter[i] : i];

    PetscCheck(
      !q->stressing, o->comm, PETSC_ERR_USER_INPUT,
      "%s cannot vary %s: the stress of a -..._spin is found once, with its value; densities, damping, spins and "
      "what is of contacts may vary, stiffness where it does not carry the load of the spin",
      option, q->name);
    for (PetscInt part = 0; parameter && part < scene->n_parts; part++)
      if (o->spin_of_part[part] == parameter[i]) PetscCall(SpinCheckTogether(o, option, part, n, parameter));
  }
  PetscFunctionReturn(0);
}
