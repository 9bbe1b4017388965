/*
   Terms of a layer whose thickness h is given (material.h). The stiffness of each cell with E = 1, stretched to

      K(h) = h A + B + C / h,   M(h) = h M_1,

   has the same three matrices at every h. They are found of three thicknesses t / 2, t, 2 t,

      S = K(t / 2) + K(2 t) - 2 K(t) = (t A + C / t) / 2,   D = (K(2 t) - K(t / 2)) / 1.5 = t A - C / t,

   at which the cell is about as thick as it is wide, so that no part drowns in the rounding of another. A fourth
   thickness shows whether they are three: prisms along the normal in all formulations, any cell but of incompatible
   modes.
*/
#include "operators/operatorsimpl.h"
#include "base/algebra/vec3.h"

#define LAYER_TERMS 3
#define LAYER_SAME  1e-10 /* of the largest entry: what the three matrices may leave over at another thickness */
#define LAYER_SIZE  (ELEMENT_MAX_DOFS * ELEMENT_MAX_DOFS)

static const PetscInt layer_power[LAYER_TERMS] = {1, 0, -1};

/* The thickness of its layer at which a cell is as thick as it is wide, m */
static PetscReal LayerBalance(const Layer *layer, const Element *element, const PetscReal x[])
{
  PetscReal across[2] = {PETSC_MAX_REAL, -PETSC_MAX_REAL}, wide = 0;

  for (PetscInt i = 0; i < element->n_corners; i++) {
    const PetscReal height = Vec3Dot(&x[3 * i], layer->normal);
    PetscReal       d[3];

    across[0] = PetscMin(across[0], height);
    across[1] = PetscMax(across[1], height);
    for (int k = 0; k < 3; k++) d[k] = x[3 * i + k] - x[k] - (height - Vec3Dot(x, layer->normal)) * layer->normal[k];
    wide = PetscMax(wide, Vec3Length(d));
  }
  return layer->mesh * wide / (across[1] - across[0]);
}

/* A cell at one thickness */
static PetscErrorCode LayerCellAt(Operators o, PetscInt c, PetscReal thickness, const Elasticity *unit, PetscReal ke[],
                                  PetscReal me[])
{
  const Element *element;
  PetscInt       vertices[ELEMENT_MAX_NODES];
  PetscReal      x[ELEMENT_MAX_DOFS];

  PetscFunctionBeginUser;
  PetscCall(ModelGetCellAt(o->model, c, thickness, &element, vertices, x));
  PetscCall(ElementMatrices(element, x, unit, ke, me));
  PetscFunctionReturn(0);
}

/* The three matrices of a cell in place of K(t / 2), K(t), K(2 t); *over of what a fourth leaves of its largest
   entry */
static PetscErrorCode LayerSplit(PetscInt n, PetscReal t, PetscReal *k[LAYER_TERMS], const PetscReal fourth[],
                                 PetscReal *over)
{
  PetscReal largest = 0, off = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n * n; i++) {
    const PetscReal S = k[0][i] + k[2][i] - 2 * k[1][i], D = (k[2][i] - k[0][i]) / 1.5;
    const PetscReal a = S + D / 2, c = S - D / 2, b = k[1][i] - 2 * S;

    off     = PetscMax(off, PetscAbsReal(3 * a + b + c / 3 - fourth[i]));
    largest = PetscMax(largest, PetscAbsReal(fourth[i]));
    k[0][i] = a / t;
    k[1][i] = b;
    k[2][i] = c * t;
  }
  *over = off / largest;
  PetscFunctionReturn(0);
}

/* Of a part, with room for those of a cell; over is what LayerSplit() leaves of the worst cell */
typedef struct {
  Mat        K[LAYER_TERMS], M; /* M of one thickness */
  PetscReal *room, over;
} LayerMatrices;

/* Adds a cell */
static PetscErrorCode LayerAddCell(Operators o, PetscInt c, const Layer *layer, LayerMatrices *m)
{
  PetscReal *const k[LAYER_TERMS] = {m->room, &m->room[LAYER_SIZE], &m->room[2 * LAYER_SIZE]};
  PetscReal *const fourth = &m->room[3 * LAYER_SIZE], *mass = &m->room[4 * LAYER_SIZE];
  const Element   *element;
  const Mesh      *mesh;
  Elasticity       unit;
  PetscInt         n, vertices[ELEMENT_MAX_NODES], rows[ELEMENT_MAX_DOFS];
  PetscReal        x[ELEMENT_MAX_DOFS], t, left;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(ModelGetCell(o->model, c, &element, vertices, x));
  PetscCall(ModelGetElasticity(o->model, c, 1, 1, &unit));
  n = 3 * element->n_nodes;
  t = LayerBalance(layer, element, x);
  for (PetscInt i = 0; i < n; i++) rows[i] = mesh->unknown[3 * vertices[i / 3] + i % 3];
  PetscCall(LayerCellAt(o, c, 3 * t, &unit, fourth, mass));
  PetscCall(LayerCellAt(o, c, t / 2, &unit, k[0], mass));
  PetscCall(LayerCellAt(o, c, 2 * t, &unit, k[2], mass));
  PetscCall(LayerCellAt(o, c, t, &unit, k[1], mass)); /* last: the mass is that at t, which is divided by t below */
  PetscCall(LayerSplit(n, t, k, fourth, &left));
  m->over = PetscMax(m->over, left);
  if (o->lump) OperatorsLumpMass(element, mass);
  for (PetscInt i = 0; i < n * n; i++) mass[i] /= t;
  for (int i = 0; i < LAYER_TERMS; i++) PetscCall(MatSetValues(m->K[i], n, rows, n, rows, k[i], ADD_VALUES));
  PetscCall(MatSetValues(m->M, n, rows, n, rows, mass, ADD_VALUES));
  PetscFunctionReturn(0);
}

static PetscErrorCode LayerAssemble(Operators o, PetscInt part, const Part *p, LayerMatrices *m)
{
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  for (int i = 0; i < LAYER_TERMS; i++) PetscCall(PatternCreate(o->model, part, o->lump, &m->K[i], i ? NULL : &m->M));
  PetscCall(PetscMalloc1(5 * LAYER_SIZE, &m->room));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    if (mesh->cell_part[c] == part) PetscCall(LayerAddCell(o, c, &p->layer, m));
  PetscCall(PetscFree(m->room));
  for (int i = 0; i < LAYER_TERMS; i++) PetscCall(MatAssemblyBegin(m->K[i], MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyBegin(m->M, MAT_FINAL_ASSEMBLY));
  for (int i = 0; i < LAYER_TERMS; i++) PetscCall(MatAssemblyEnd(m->K[i], MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(m->M, MAT_FINAL_ASSEMBLY));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &m->over, 1, MPIU_REAL, MPI_MAX, o->comm));
  PetscCheck(m->over <= LAYER_SAME, o->comm, PETSC_ERR_USER_INPUT,
             "-%s_thickness %.6g: cells of part %s are no prisms along %.4g,%.4g,%.4g, which those of incompatible "
             "modes must be; give -model_element full, or cells of second order",
             p->name, (double)p->layer.thickness, p->name, (double)p->layer.normal[0], (double)p->layer.normal[1],
             (double)p->layer.normal[2]);
  PetscFunctionReturn(0);
}

/* A term A p_1 .. p_n, each to its power; zero powers are left out */
static PetscErrorCode LayerAddTerm(Operators o, OperatorsTermKind kind, Mat A, PetscInt n, const PetscInt parameter[],
                                   const PetscInt power[])
{
  const PetscInt kept = power[n - 1] ? n : n - 1;

  PetscFunctionBeginUser;
  PetscCall(TermsAdd(&o->terms, kind, A, PETSC_TRUE, kept, parameter));
  PetscCall(TermsSetPowers(&o->terms, power));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddLayer(Operators o, PetscInt part, const Part *p)
{
  const PetscInt first = N_PART_PARAMETERS * part, h = o->thickness[part];
  const PetscInt young[2] = {first + PART_YOUNG, h}, beta[3] = {first + PART_BETA, first + PART_YOUNG, h};
  const PetscInt density[2] = {first + PART_DENSITY, h}, alpha[3] = {first + PART_ALPHA, first + PART_DENSITY, h};
  LayerMatrices  m = {.over = 0};

  PetscFunctionBeginUser;
  PetscCall(LayerAssemble(o, part, p, &m));
  for (int i = 0; i < LAYER_TERMS; i++)
    PetscCall(LayerAddTerm(o, OPERATORS_STIFFNESS, m.K[i], 2, young, (PetscInt[]){1, layer_power[i]}));
  PetscCall(LayerAddTerm(o, OPERATORS_MASS, m.M, 2, density, (PetscInt[]){1, 1}));
  PetscCall(LayerAddTerm(o, OPERATORS_DAMPING, m.M, 3, alpha, (PetscInt[]){1, 1, 1}));
  PetscCall(TermsSetCause(&o->terms, "material damping", p->name, "alpha"));
  for (int i = 0; i < LAYER_TERMS; i++) {
    PetscCall(LayerAddTerm(o, OPERATORS_DAMPING, m.K[i], 3, beta, (PetscInt[]){1, 1, layer_power[i]}));
    PetscCall(TermsSetCause(&o->terms, "material damping", p->name, "beta"));
    PetscCall(MatDestroy(&m.K[i]));
  }
  PetscCall(MatDestroy(&m.M));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddThicknesses(Operators o, PetscInt n, const Part parts[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &o->thickness));
  for (PetscInt i = 0; i < n; i++) {
    const OperatorsParameter q = {
      .row = ModelFindRow("-parts", "thickness"), .value = parts[i].layer.thickness, .divides = PETSC_TRUE};

    o->thickness[i] = -1;
    if (parts[i].layer.given)
      PetscCall(ParametersAdd(&o->parameters, parts[i].name, "thickness", &q, &o->thickness[i]));
  }
  PetscFunctionReturn(0);
}
