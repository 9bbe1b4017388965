/*
   Terms of the bodies, springs and dashpots. Of each part p, at its Poisson's ratio, K_p (m) per unit Young's modulus E
   (E_1 where it is not isotropic: all other moduli keep their ratio to it) and M_p (m^3) per unit density rho; of each
   list of springs or dashpots the diagonal matrix of its nodes' shares:
      K = sum_p E_p K_p + sum_s k_s D_s,   M = sum_p rho_p M_p,
      C = sum_p (alpha_p rho_p M_p + beta_p E_p K_p) + sum_d c_d D_d
   and those of bushings and points (joint.c).
*/
#include "operators/operatorsimpl.h"

/* Adds local cell c to K_p and M_p, with E = 1 and rho = 1. Rows and columns of held directions are -1, which
   MatSetValues() leaves out. Cells live on one rank each: entries of nodes that other ranks own go there in the
   assembly. */
static PetscErrorCode OperatorsAddCell(Operators o, PetscInt c, Mat K, Mat M)
{
  const Element *element;
  const Mesh    *mesh;
  Elasticity     unit;
  PetscInt       n, vertices[ELEMENT_MAX_NODES], rows[ELEMENT_MAX_DOFS];
  PetscReal      x[ELEMENT_MAX_DOFS], ke[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS], me[ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(ModelGetCell(o->model, c, &element, vertices, x));
  PetscCall(ModelGetElasticity(o->model, c, 1, 1, &unit));
  n = 3 * element->n_nodes;
  for (PetscInt i = 0; i < n; i++) rows[i] = mesh->unknown[3 * vertices[i / 3] + i % 3];
  PetscCall(ElementMatrices(element, x, &unit, ke, me));
  if (o->lump) OperatorsLumpMass(element, me);
  PetscCall(MatSetValues(K, n, rows, n, rows, ke, ADD_VALUES));
  PetscCall(MatSetValues(M, n, rows, n, rows, me, ADD_VALUES));
  PetscFunctionReturn(0);
}

/* K_p, m, and M_p, m^3, of one part, in the unknowns of all: rows of other parts are empty. The cells of each rank
   alone; both assemblies are begun before either is waited for. */
static PetscErrorCode OperatorsCreatePart(Operators o, PetscInt part, Mat *K, Mat *M)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(PatternCreate(o->model, part, o->lump, K, M));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    if (mesh->cell_part[c] == part) PetscCall(OperatorsAddCell(o, c, *K, *M));
  PetscCall(MatAssemblyBegin(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyBegin(*M, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*M, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Parameters of one part */
static PetscErrorCode OperatorsAddPartParameters(Operators o, const Part *p)
{
  const struct {
    const char *name;
    PetscReal   value;
  } what[N_PART_PARAMETERS] = {{"young", p->young}, {"density", p->density}, {"alpha", p->alpha}, {"beta", p->beta}};
  PetscInt index;

  PetscFunctionBeginUser;
  for (int k = 0; k < N_PART_PARAMETERS; k++) {
    const OperatorsParameter q = {.row = ModelFindRow("-parts", what[k].name), .value = what[k].value};

    PetscCall(ParametersAdd(&o->parameters, p->name, what[k].name, &q, &index));
  }
  PetscFunctionReturn(0);
}

/* Terms of one part: E K_p, rho M_p, alpha rho M_p and beta E K_p share two matrices */
static PetscErrorCode OperatorsAddPart(Operators o, PetscInt part, const Part *p)
{
  PetscInt i[N_PART_PARAMETERS];
  Mat      K, M;

  PetscFunctionBeginUser;
  for (int k = 0; k < N_PART_PARAMETERS; k++) i[k] = N_PART_PARAMETERS * part + k;
  PetscCall(OperatorsCreatePart(o, part, &K, &M));
  PetscCall(TermsAdd(&o->terms, OPERATORS_STIFFNESS, K, PETSC_TRUE, 1, &i[PART_YOUNG]));
  PetscCall(TermsAdd(&o->terms, OPERATORS_MASS, M, PETSC_TRUE, 1, &i[PART_DENSITY]));
  PetscCall(TermsAdd(&o->terms, OPERATORS_DAMPING, M, PETSC_TRUE, 2, (PetscInt[]){i[PART_ALPHA], i[PART_DENSITY]}));
  PetscCall(TermsSetCause(&o->terms, "material damping", p->name, "alpha"));
  PetscCall(TermsAdd(&o->terms, OPERATORS_DAMPING, K, PETSC_TRUE, 2, (PetscInt[]){i[PART_BETA], i[PART_YOUNG]}));
  PetscCall(TermsSetCause(&o->terms, "material damping", p->name, "beta"));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscFunctionReturn(0);
}

static const Quantity *PartFindRow(const char option[])
{
  return ModelFindRow("-parts", option);
}

/* Parameters and terms of the parts whose stiffness depends on the eigenvalue: each term of E once more */
static PetscErrorCode OperatorsAddLaws(Operators o, PetscInt n, const Part parts[])
{
  const PetscInt n_terms = o->terms.n;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt young = N_PART_PARAMETERS * i + PART_YOUNG;
    OperatorsLaw  *law;

    if (parts[i].law.kind == VISCOELASTIC_NONE) continue;
    PetscCall(OperatorsAddLaw(o, parts[i].name, &parts[i].law, PartFindRow, young, &law));
    for (PetscInt t = 0; t < n_terms; t++) {
      OperatorsTerm term = o->terms.term[t];

      if (term.kind != OPERATORS_STIFFNESS || !term.n || term.factor[0].parameter != young) continue;
      term.n--;
      PetscCall(PetscArraymove(term.factor, &term.factor[1], term.n));
      PetscCall(OperatorsAddLawTerms(o, parts[i].name, law, &term));
    }
  }
  PetscFunctionReturn(0);
}

/* Diagonal matrix of the shares of the nodes of a set, in the directions of the mask. Nodes of two sets are in two
   terms. */
static PetscErrorCode ShareDiagonalCreate(Operators o, const void *of, const PetscBool mask[3], Mat *D)
{
  const Grounded    *g = of;
  const Mesh        *mesh;
  const PetscScalar *share;
  PetscInt           n_vertices, *vertices;
  Vec                shares;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(MatCreateAIJ(o->comm, mesh->n_own, mesh->n_own, PETSC_DETERMINE, PETSC_DETERMINE, 1, NULL, 0, NULL, D));
  PetscCall(ModelCreateShares(o->model, g->name, g->set, g->spread, &shares));
  PetscCall(VecGetArrayRead(shares, &share));
  PetscCall(ModelGetOwnedNodes(o->model, g->set, &n_vertices, &vertices));
  for (PetscInt j = 0; j < 3 * n_vertices; j++) {
    const PetscInt row = mesh->unknown[3 * vertices[j / 3] + j % 3];

    if (mask[j % 3]) PetscCall(MatSetValues(*D, 1, &row, 1, &row, &share[3 * vertices[j / 3]], ADD_VALUES));
  }
  PetscCall(PetscFree(vertices));
  PetscCall(VecRestoreArrayRead(shares, &share));
  PetscCall(VecDestroy(&shares));
  PetscCall(MatAssemblyBegin(*D, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*D, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/* Parameters and terms of a list of springs or dashpots */
static PetscErrorCode OperatorsAddGrounded(Operators o, OperatorsTermKind kind, const Grounded *g)
{
  const Quantity  *row = ModelFindRow(kind == OPERATORS_STIFFNESS ? "-springs" : "-dashpots", g->quantity);
  const Components c   = {kind, "dashpot", g->name, g->quantity, row, g->value, ShareDiagonalCreate, g};
  PetscInt         index[3];

  PetscFunctionBeginUser;
  PetscCall(OperatorsAddComponents(o, &c, index));
  PetscFunctionReturn(0);
}

/* Parameters in the order that operators.c promises: parts, layers, springs, dashpots, bushings and points. */
PetscErrorCode OperatorsAssemble(Operators o)
{
  const ModelScene *scene;
  const Mesh       *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(o->model, &scene));
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCheck(mesh->n_unknowns, o->comm, PETSC_ERR_USER_INPUT, "the -supports hold every node: nothing can vibrate");
  for (PetscInt i = 0; i < scene->n_parts; i++) PetscCall(OperatorsAddPartParameters(o, &scene->parts[i]));
  PetscCall(OperatorsAddThicknesses(o, scene->n_parts, scene->parts));
  for (PetscInt i = 0; i < scene->n_parts && !o->omit; i++) {
    const Part *p = &scene->parts[i];

    PetscCall(p->layer.given ? OperatorsAddLayer(o, i, p) : OperatorsAddPart(o, i, p));
  }
  for (PetscInt i = 0; i < scene->n_springs; i++)
    PetscCall(OperatorsAddGrounded(o, OPERATORS_STIFFNESS, &scene->springs[i]));
  for (PetscInt i = 0; i < scene->n_dashpots; i++)
    PetscCall(OperatorsAddGrounded(o, OPERATORS_DAMPING, &scene->dashpots[i]));
  PetscCall(OperatorsAddJoints(o));
  PetscCall(OperatorsAddLaws(o, scene->n_parts, scene->parts));
  PetscFunctionReturn(0);
}
