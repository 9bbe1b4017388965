/*
   Parities of a pencil with planes of symmetry: with mirrors R_1 .. R_k, which commute with each other and with K, M and
   C, the group of their products G_g, g = 0 .. 2^k - 1 by bits, has 2^k characters chi_c(g) = (-1)^bits(g and c), and
   the vectors of parity c, R_p u = u (even) or -u (odd, bit p of c), are u = S_c q with a column

      s_o = sum_g chi_c(g) G_g e_i / |.|

   for each orbit o of unknowns, i one of it; none where the sum is zero. Columns of all parities are orthonormal, and

      S_c' Q S_d = 0,  c != d,   Q = K, M, C,

   so that the modes of the whole are those of S_c' Q S_c for all c: each has 1 / 2^k of the unknowns, and its factors
   less than that of the entries. (A. Bossavit, Comput. Methods Appl. Mech. Eng. 56, 1986.)
*/
#include "pencilimpl.h"

/* Images of the unknowns of this rank under all products of mirrors, and their signs, [unknowns][group] */
typedef struct {
  PetscInt   n, n_group, first;
  PetscInt  *image;
  PetscReal *sign;
} Orbits;

/* Column g of the table, from the product of mirrors G; NULL for the identity */
static PetscErrorCode OrbitsFill(Orbits *orbits, PetscInt g, Mat G)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < orbits->n; i++) {
    const PetscInt k = i * orbits->n_group + g;

    orbits->image[k] = orbits->first + i;
    orbits->sign[k]  = 1;
    if (G) PetscCall(MirrorGetRow(G, orbits->first + i, &orbits->image[k], &orbits->sign[k]));
  }
  PetscFunctionReturn(0);
}

/* G_g = G_(g without its highest bit) times that mirror */
static PetscErrorCode OrbitsCreate(PetscInt n_planes, const Mat mirror[], Orbits *orbits)
{
  PetscInt last;
  Mat      G[1 << OPERATORS_MAX_PLANES] = {NULL};

  PetscFunctionBeginUser;
  orbits->n_group = 1 << n_planes;
  PetscCall(MatGetOwnershipRange(mirror[0], &orbits->first, &last));
  orbits->n = last - orbits->first;
  PetscCall(PetscMalloc2(orbits->n * orbits->n_group, &orbits->image, orbits->n * orbits->n_group, &orbits->sign));
  PetscCall(OrbitsFill(orbits, 0, NULL));
  for (PetscInt p = 0, bit = 1; p < n_planes; p++, bit *= 2)
    for (PetscInt g = bit; g < 2 * bit; g++) {
      if (g > bit) PetscCall(MatMatMult(G[g - bit], mirror[p], MAT_INITIAL_MATRIX, PETSC_DEFAULT, &G[g]));
      if (g == bit) PetscCall(PetscObjectReference((PetscObject)mirror[p]));
      if (g == bit) G[g] = mirror[p];
      PetscCall(OrbitsFill(orbits, g, G[g]));
    }
  for (PetscInt g = 0; g < orbits->n_group; g++) PetscCall(MatDestroy(&G[g]));
  PetscFunctionReturn(0);
}

static PetscErrorCode OrbitsDestroy(Orbits *orbits)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(orbits->image, orbits->sign));
  PetscFunctionReturn(0);
}

/* chi_c(g) */
static PetscReal ParityCharacter(PetscInt c, PetscInt g)
{
  PetscInt bits = c & g, odd = 0;

  for (; bits; bits /= 2) odd ^= bits & 1;
  return odd ? -1 : 1;
}

/* The entries of column s_o of the orbit of local unknown i: n rows and values; n = 0 where there is no such column, or
   where another unknown of the orbit makes it. Which one does is told by the sum of their numbers, so that where images
   are on two ranks each has its share, and the displacements of a node stay together. */
static PetscInt ParityColumn(const Orbits *orbits, PetscInt c, PetscInt i, PetscInt row[], PetscScalar value[])
{
  const PetscInt  *image = &orbits->image[i * orbits->n_group];
  const PetscReal *sign  = &orbits->sign[i * orbits->n_group];
  PetscInt         n = 0, sum = 0, rank = 0;
  PetscReal        square = 0;

  for (PetscInt g = 0; g < orbits->n_group; g++) {
    PetscInt k = 0;

    while (k < n && row[k] != image[g]) k++;
    if (k == n) row[n] = image[g], value[n++] = 0;
    value[k] += ParityCharacter(c, g) * sign[g];
  }
  for (PetscInt k = 0; k < n; k++) {
    sum += row[k] % n;
    rank += row[k] < orbits->first + i;
    square += PetscSqr(PetscRealPart(value[k]));
  }
  if (square < 0.5 || sum % n != rank) return 0;
  for (PetscInt k = 0; k < n; k++) value[k] /= PetscSqrtReal(square);
  return n;
}

/* S_c, a row for each unknown of the pencil */
static PetscErrorCode ParityCreateMap(const Orbits *orbits, MPI_Comm comm, PetscInt c, Mat *S)
{
  PetscInt    row[1 << OPERATORS_MAX_PLANES], n_columns = 0, column;
  PetscScalar value[1 << OPERATORS_MAX_PLANES];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < orbits->n; i++) n_columns += ParityColumn(orbits, c, i, row, value) > 0;
  PetscCall(MatCreateAIJ(comm, orbits->n, n_columns, PETSC_DETERMINE, PETSC_DETERMINE, 1, NULL, 1, NULL, S));
  PetscCall(MatGetOwnershipRangeColumn(*S, &column, NULL));
  for (PetscInt i = 0; i < orbits->n; i++) {
    const PetscInt n = ParityColumn(orbits, c, i, row, value);

    if (n) PetscCall(MatSetValues(*S, n, row, 1, &column, value, INSERT_VALUES));
    if (n) column++;
  }
  PetscCall(MatAssemblyBegin(*S, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*S, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsGetEven(Operators o, Mat *S)
{
  const Mat *R;
  PetscInt   n;
  Orbits     orbits;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetMirrors(o, &n, NULL, &R));
  if (n && !o->even) {
    PetscCheck(!o->Z, o->comm, PETSC_ERR_SUP, "-symmetry: " MIRROR_NO_DEPENDENTS);
    PetscCall(OrbitsCreate(n, R, &orbits));
    PetscCall(ParityCreateMap(&orbits, o->comm, 0, &o->even));
    PetscCall(OrbitsDestroy(&orbits));
  }
  *S = o->even;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilCountParities(Pencil pencil, PetscInt *n)
{
  PetscFunctionBeginUser;
  *n = 1 << pencil->operators->n_planes;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilGetParities(Pencil pencil, PetscInt *n, PetscReal *asymmetry)
{
  PetscFunctionBeginUser;
  PetscCall(PencilCountParities(pencil, n));
  if (*n > 1) PetscCall(PencilCreateMirrors(pencil));
  if (asymmetry) *asymmetry = pencil->asymmetry;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilNameParity(Pencil pencil, PetscInt c, size_t size, char name[])
{
  PetscFunctionBeginUser;
  name[0] = '\0';
  for (PetscInt p = 0; p < pencil->operators->n_planes; p++) {
    if (p) PetscCall(PetscStrlcat(name, " ", size));
    PetscCall(PetscStrlcat(name, c >> p & 1 ? "odd" : "even", size));
  }
  PetscFunctionReturn(0);
}

/* Z S, or S where there is no Z */
static PetscErrorCode ParityCompose(Mat Z, Mat S, Mat *ZS)
{
  PetscFunctionBeginUser;
  *ZS = S;
  if (!Z) {
    PetscCall(PetscObjectReference((PetscObject)S));
    PetscFunctionReturn(0);
  }
  PetscCall(MatMatMult(Z, S, MAT_INITIAL_MATRIX, PETSC_DEFAULT, ZS));
  PetscCall(MatProductClear(*ZS));
  PetscFunctionReturn(0);
}

/* What is the same for the whole and its parts: state, point, terms and mass */
static PetscErrorCode ParityCopyState(Pencil whole, Pencil part)
{
  PetscInt index;
  Mat      M;

  PetscFunctionBeginUser;
  part->comm       = whole->comm;
  part->operators  = whole->operators;
  part->n_scene    = whole->n_scene;
  part->from_state = whole->from_state;
  part->n_pairs    = whole->n_pairs;
  part->n_groups   = whole->n_groups;
  part->is_part    = PETSC_TRUE;
  for (PetscInt i = 0; i < whole->parameters.n; i++)
    PetscCall(
      ParametersAdd(&part->parameters, NULL, whole->parameters.list[i].name, &whole->parameters.list[i], &index));
  PetscCall(PetscArraycpy(part->parameters.p, whole->parameters.p, whole->parameters.n));
  PetscCall(PetscMalloc1(whole->n_pairs, &part->group));
  PetscCall(PetscArraycpy(part->group, whole->group, whole->n_pairs));
  PetscCall(PetscMalloc1(whole->n_pairs, &part->slips));
  PetscCall(PetscArraycpy(part->slips, whole->slips, whole->n_pairs));
  PetscCall(TermsAppend(&part->base, &whole->base));
  PetscCall(PencilGetMass(whole, &M));
  PetscCall(PetscObjectReference((PetscObject)M));
  part->sum[SUM_M] = (TermsSum){.A = M, .current = PETSC_TRUE};
  PetscFunctionReturn(0);
}

/* Frees the sums of the whole, but for M of all unknowns; they are formed again when asked for */
static PetscErrorCode ParityReleaseSums(Pencil pencil)
{
  PetscFunctionBeginUser;
  for (int i = 0; i < N_PENCIL_SUMS; i++)
    if (i != SUM_M) PetscCall(TermsSumDestroy(&pencil->sum[i]));
  for (int i = 0; i < 2; i++) PetscCall(MatDestroy(&pencil->factor[i]));
  pencil->has_factors = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilCreateParity(Pencil whole, PetscInt c, Pencil *part)
{
  Orbits orbits;
  Pencil s;
  Mat    S;

  PetscFunctionBeginUser;
  PetscCall(PencilCreateMirrors(whole));
  PetscCall(PetscCalloc1(1, &s));
  PetscCall(ParityCopyState(whole, s));
  PetscCall(ParityReleaseSums(whole));
  PetscCall(OrbitsCreate(whole->operators->n_planes, whole->mirror, &orbits));
  PetscCall(ParityCreateMap(&orbits, whole->comm, c, &S));
  PetscCall(OrbitsDestroy(&orbits));
  PetscCall(ParityCompose(whole->Zr, S, &s->Zr));
  PetscCall(ParityCompose(whole->E, S, &s->E));
  s->n_left = whole->n_left;
  PetscCall(PetscCalloc2(s->n_left, &s->left, s->n_left, &s->left_mu));
  PetscCall(PetscArraycpy(s->left_mu, whole->left_mu, s->n_left));
  for (PetscInt i = 0; i < s->n_left; i++) PetscCall(ParityCompose(whole->left[i], S, &s->left[i]));
  PetscCall(MatDestroy(&S));
  *part = s;
  PetscFunctionReturn(0);
}

PetscErrorCode PencilReleaseParity(Pencil part)
{
  PetscFunctionBeginUser;
  PetscCall(ParityReleaseSums(part));
  PetscCall(TermsSumDestroy(&part->sum[SUM_M]));
  PetscCall(TermsRelease(&part->base));
  PetscCall(TermsRelease(&part->projected));
  part->released = PETSC_TRUE;
  PetscFunctionReturn(0);
}
