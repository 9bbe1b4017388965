/*
   Modal filters: the amplitude of one mode in any motion of the body, from its left vector.

   Small motions about the sliding state, status unchanged, are u = sum_k Re(c_k x_k), v = sum_k Re(lambda_k c_k x_k),
   the sum over eigenvalues with omega >= 0. The left vectors of the quadratic problem are biorthogonal in the state
   (u, v): y_j^T ((lambda_j M + C) u + M v) vanishes for u = x_k, v = lambda_k x_k, k /= j, conjugates included, and is
   d_j = y_j^T (2 lambda_j M + C) x_j for k = j. Hence

      c_j = a_j^T u + b_j^T v,   a_j = f (lambda_j M + C)^T y_j / d_j,   b_j = f M y_j / d_j,

   f = 2 where omega > 0 (half of Re(c x) is the conjugate's), else 1. With x_j scaled to |x_j| = 1 at its largest
   component |c_j| is the amplitude there, m; a (-), b (s). In free linear motion c_j' = lambda_j c_j.
*/
#include "modes/complexvec.h"

/* Matrices of all unknowns, and work */
typedef struct {
  PencilParts parts;
  ComplexVec  a, b;
  Vec         work;
  PetscReal  *nodal[4]; /* a re, a im, b re, b im [nodes][3] */
} Filter;

/* Largest |x_i| */
static PetscErrorCode FilterLargest(ComplexVec x, Vec work, PetscReal *largest)
{
  PetscFunctionBeginUser;
  PetscCall(VecPointwiseMult(work, x.r, x.r));
  if (x.i) {
    Vec square;

    PetscCall(VecDuplicate(work, &square));
    PetscCall(VecPointwiseMult(square, x.i, x.i));
    PetscCall(VecAXPY(work, 1, square));
    PetscCall(VecDestroy(&square));
  }
  PetscCall(VecMax(work, NULL, largest));
  *largest = PetscSqrtReal(*largest);
  PetscFunctionReturn(0);
}

/* z = s z */
static PetscErrorCode FilterScale(PetscComplex s, ComplexVec z, Vec work)
{
  PetscFunctionBeginUser;
  PetscCall(VecCopy(z.r, work));
  PetscCall(VecAXPBY(z.r, -cimag(s), creal(s), z.i));
  PetscCall(VecAXPBY(z.i, cimag(s), creal(s), work));
  PetscFunctionReturn(0);
}

/* a and b of one mode; C is symmetric but for friction damping */
static PetscErrorCode FilterForm(Filter *f, PetscComplex lambda, ComplexVec x, ComplexVec y)
{
  PetscComplex d, d_a, d_b;
  PetscReal    largest;

  PetscFunctionBeginUser;
  PetscCall(ComplexVecMult(f->parts.M, y, f->b));
  PetscCall(VecSet(f->a.r, 0));
  PetscCall(VecSet(f->a.i, 0));
  PetscCall(ComplexVecAXPY(lambda, f->b, f->a));
  if (f->parts.C) {
    PetscCall(MatMultTransposeAdd(f->parts.C, y.r, f->a.r, f->a.r));
    if (y.i) PetscCall(MatMultTransposeAdd(f->parts.C, y.i, f->a.i, f->a.i));
  }
  PetscCall(ComplexVecDot(f->a, x, &d_a));
  PetscCall(ComplexVecDot(f->b, x, &d_b));
  PetscCall(FilterLargest(x, f->work, &largest));
  d = (d_a + lambda * d_b) / (largest * (cimag(lambda) > 0 ? 2 : 1));
  PetscCall(FilterScale(1 / d, f->a, f->work));
  PetscCall(FilterScale(1 / d, f->b, f->work));
  PetscFunctionReturn(0);
}

/* Writes the filter of mode i */
static PetscErrorCode FilterWrite(Modes modes, Filter *f, PetscInt i, Model model, ResultsField field)
{
  static const char *const suffix[4] = {"u_re", "u_im", "v_re", "v_im"};
  const Mode              *m         = &modes->mode[i];
  const Spectrum          *right = &modes->right, *left = &modes->left_spectrum;
  const Vec                weights[4] = {f->a.r, f->a.i, f->b.r, f->b.i};
  char                     key[4][32], title[128];
  ResultsNodal             arrays[4];

  PetscFunctionBeginUser;
  PetscCall(FilterForm(f, CMPLX(m->sigma, m->omega), (ComplexVec){right->xr[i], right->xi[i]},
                       (ComplexVec){left->xr[i], left->xi[i]}));
  for (int k = 0; k < 4; k++) {
    PetscCall(ModelGetNodal(model, weights[k], f->nodal[k]));
    PetscCall(PetscSNPrintf(key[k], sizeof(key[k]), "mode_%03d_%s", (int)i + 1, suffix[k]));
    arrays[k] = (ResultsNodal){key[k], 3, f->nodal[k]};
  }
  PetscCall(PetscSNPrintf(title, sizeof(title), "%d: %.6g Hz, modal filter of displacements and velocities (s)",
                          (int)i + 1, (double)(m->omega / (2 * PETSC_PI))));
  PetscCall(ResultsFieldWriteNodal(field, title, 4, arrays));
  PetscFunctionReturn(0);
}

static PetscErrorCode FilterCreate(Modes modes, PetscInt n_vertices, Filter *f)
{
  Vec *const vectors[] = {&f->a.r, &f->a.i, &f->b.r, &f->b.i, &f->work};

  PetscFunctionBeginUser;
  PetscCall(PencilGetParts(modes->pencil, &f->parts));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(vectors); k++)
    PetscCall(MatCreateVecs(f->parts.M, vectors[k], NULL));
  for (int k = 0; k < 4; k++) PetscCall(PetscMalloc1(3 * n_vertices, &f->nodal[k]));
  PetscFunctionReturn(0);
}

static PetscErrorCode FilterDestroy(Filter *f)
{
  Vec *const vectors[] = {&f->a.r, &f->a.i, &f->b.r, &f->b.i, &f->work};

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(vectors); k++) PetscCall(VecDestroy(vectors[k]));
  for (int k = 0; k < 4; k++) PetscCall(PetscFree(f->nodal[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWriteFilters(Modes modes, Model model, Results results)
{
  const Mesh  *mesh;
  ResultsField field;
  Filter       f;

  PetscFunctionBeginUser;
  PetscCheck(model, modes->comm, PETSC_ERR_USER_INPUT, "-modes_filters needs a mesh: loaded matrices have none");
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(FilterCreate(modes, mesh->n_nodes, &f));
  PetscCall(ResultsFieldOpen(results, "filters", mesh, &field));
  for (PetscInt i = 0; i < modes->n; i++)
    if (!modes->mode[i].rigid) PetscCall(FilterWrite(modes, &f, i, model, field));
  PetscCall(ResultsFieldClose(&field));
  PetscCall(FilterDestroy(&f));
  PetscFunctionReturn(0);
}
