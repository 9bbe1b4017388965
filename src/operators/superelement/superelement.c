/*
   Superelements: options, matrices, terms. B [unknowns of K_s][all unknowns] has the shares of place.c, and 1 at the
   unknowns apart, which follow those of the mesh; directions that a support holds have no column. The terms are B' K_s
   B, B' M_s B and B' C_s B, each with its scale as parameter.
*/
#include "superelement.h"
#include "base/options/help.h"
#include "operators/files/matrixterm.h"

#define SUPER(member) QUANTITY_AT(Superelement, member)

/* One matrix: its file and its scale */
#define SUPERELEMENT_FILE(letter, meaning, i)                                                                          \
  {                                                                                                                    \
    "-" letter, "PETSc binary file of its " meaning, NULL, QUANTITY_PATH, SUPER(file[i]), .path = "file",              \
                                                                                          .restart = PETSC_TRUE        \
  }
#define SUPERELEMENT_SCALE(letter, meaning, i, vary)                                                                   \
  {                                                                                                                    \
    "-" letter "_scale", "factor of its " meaning, NULL, QUANTITY_REAL, SUPER(scale[i]),                               \
      .initial = 1, QUANTITY_NOT_NEGATIVE, .varies = (vary)                                                            \
  }

static const Quantity rows[] = {
  SUPERELEMENT_FILE("k", "stiffness, N/m", SUPERELEMENT_K),
  SUPERELEMENT_FILE("m", "mass, kg", SUPERELEMENT_M),
  SUPERELEMENT_FILE("c", "damping, N s/m", SUPERELEMENT_C),
  {"-table", "table unknown,node,direction,x,y,z of its unknowns", NULL, QUANTITY_PATH, SUPER(table), .path = "file",
   .given = offsetof(Superelement, has_table)},
  {"-of", "in place of a table: another superelement, to whose unknowns its matrices are added", NULL, QUANTITY_NAME,
   SUPER(of)},
  {"-sets", "sets whose nodes, or surfaces, its unknowns are on; default any node", NULL, QUANTITY_NAMES, SUPER(sets),
   .count = offsetof(Superelement, n_sets)},
  {"-distance", "how far they may be off; default 1e-5 of the mesh from a node or point, 5 % of a facet from a surface",
   "m", QUANTITY_REAL, SUPER(distance), QUANTITY_POSITIVE, .given = offsetof(Superelement, has_distance)},
  {"-skew", "keep what its stiffness and damping have beyond symmetric, of friction or a spin", NULL, QUANTITY_BOOL,
   SUPER(skew)},
  SUPERELEMENT_SCALE("k", "stiffness", SUPERELEMENT_K, VARIES_LINEAR),
  SUPERELEMENT_SCALE("m", "mass", SUPERELEMENT_M, VARIES_LINEAR),
  SUPERELEMENT_SCALE("c", "damping", SUPERELEMENT_C, VARIES_LINEAR | VARIES_DAMPING),
};

static const QuantityTable table = {"Superelement", "operators.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = 0};

static PetscErrorCode SuperelementCheck(MPI_Comm comm, void *owner, void *record)
{
  Superelement *s = record;
  HelpKind      help;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(HelpIsAsked(&help));
  if (help != HELP_NONE) PetscFunctionReturn(0);
  PetscCheck(s->of[0] || s->has_table, comm, PETSC_ERR_USER_INPUT,
             "-%s_table must be given: the file that says where the unknowns are", s->name);
  PetscCheck(!s->of[0] || (!s->has_table && !s->n_sets && !s->has_distance), comm, PETSC_ERR_USER_INPUT,
             "-%s_of %s: its unknowns are those of %s: leave -%s_table, -%s_sets and -%s_distance out", s->name, s->of,
             s->of, s->name, s->name, s->name);
  if (!s->of[0]) PetscCall(SuperelementReadTable(comm, s));
  PetscFunctionReturn(0);
}

static const QuantityList superelements_list = {
  "-superelements",     "bodies that are matrices, each the prefix of its -k, -m and -table",
  sizeof(Superelement), &table,
  SuperelementCheck,    .in = RUN_BODIES};

PetscErrorCode SuperelementsSetFromOptions(Operators o)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(QuantitiesReadList(o->comm, &superelements_list, o, &n, &o->superelements));
  PetscCall(SuperelementsSort(o, n));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementsVisit(Operators o, const QuantityVisitor *visitor)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesVisitList(visitor, &superelements_list, o->n_superelements + o->n_pieces, o->superelements));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementsAddUnknowns(Operators o)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->n_superelements; i++) PetscCall(ModelAddUnknowns(o->model, o->superelements[i].n_apart));
  PetscFunctionReturn(0);
}

/* Whether the mass of the unknowns apart, the others held, is positive definite: that of the mesh is not theirs */
static PetscErrorCode SuperelementHasMassApart(Operators o, const Superelement *s, Mat M, const char who[],
                                               PetscBool *has)
{
  PetscInt  first, last, n = 0, *row;
  PetscReal least;
  PetscBool singular;
  Vec       diagonal;
  Mat       own;
  IS        is;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(M, &first, &last));
  PetscCall(PetscMalloc1(last - first, &row));
  for (PetscInt i = first; i < last; i++)
    if (s->row[i].direction == SUPERELEMENT_APART) row[n++] = i;
  PetscCall(ISCreateGeneral(o->comm, n, row, PETSC_OWN_POINTER, &is));
  PetscCall(MatCreateSubMatrix(M, is, is, MAT_INITIAL_MATRIX, &own));
  PetscCall(MassCheck(own, who, &singular));
  PetscCall(MatCreateVecs(own, &diagonal, NULL));
  PetscCall(MatGetDiagonal(own, diagonal));
  PetscCall(VecMin(diagonal, NULL, &least));
  *has = least > 0 && !singular ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(VecDestroy(&diagonal));
  PetscCall(MatDestroy(&own));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(0);
}

/* Raises an error for a mass that is indefinite, or none of unknowns apart */
static PetscErrorCode SuperelementCheckMass(Operators o, const Superelement *s)
{
  PetscBool     singular, has = PETSC_FALSE;
  char          who[256];
  Superelement *piece = NULL;
  Mat           M;

  PetscFunctionBeginUser;
  while (SuperelementNext(o, s, &piece)) {
    PetscCall(PetscSNPrintf(who, sizeof(who), "superelement %s: ", piece->name));
    if (piece->A[SUPERELEMENT_M]) PetscCall(MassCheck(piece->A[SUPERELEMENT_M], who, &singular));
  }
  PetscCall(PetscSNPrintf(who, sizeof(who), "superelement %s: ", s->name));
  PetscCall(SuperelementSum(o, s, SUPERELEMENT_M, &M));
  if (M && s->n_apart) PetscCall(SuperelementHasMassApart(o, s, M, who, &has));
  PetscCall(MatDestroy(&M));
  PetscCheck(has || !s->n_apart, o->comm, PETSC_ERR_USER_INPUT,
             "superelement %s: internal unknowns have no mass of their own along some direction: eliminate these where "
             "the matrices are made, or give them a mass by -%s_m and a positive -%s_m_scale",
             s->name, s->name, s->name);
  PetscFunctionReturn(0);
}

/* Raises an error where unknowns apart have no stiffness at all: they would float at any place */
static PetscErrorCode SuperelementCheckStiffness(Operators o, const Superelement *s)
{
  Superelement       *piece = NULL;
  const Superelement *slack = NULL;
  PetscBool           has = PETSC_FALSE, counts = PETSC_FALSE;

  PetscFunctionBeginUser;
  while (SuperelementNext(o, s, &piece)) {
    if (!piece->file[SUPERELEMENT_K][0]) continue;
    has = PETSC_TRUE;
    if (piece->scale[SUPERELEMENT_K] > 0) counts = PETSC_TRUE;
    if (!slack) slack = piece;
  }
  PetscCheck(!s->n_apart || has, o->comm, PETSC_ERR_USER_INPUT,
             "superelement %s: its %" PetscInt_FMT " internal unknowns have no stiffness: give -%s_k", s->name,
             s->n_apart, s->name);
  PetscCheck(!s->n_apart || counts, o->comm, PETSC_ERR_USER_INPUT,
             "superelement %s: -%s_k_scale %.6g leaves its %" PetscInt_FMT
             " internal unknowns without stiffness: it must be positive",
             s->name, slack->name, (double)slack->scale[SUPERELEMENT_K], s->n_apart);
  PetscFunctionReturn(0);
}

/* Reads a matrix, of the size that the table says */
static PetscErrorCode SuperelementLoad(Operators o, Superelement *s, int i)
{
  static const char letter[N_SUPERELEMENT] = {'k', 'm', 'c'};
  char              option[256];
  PetscInt          rows_read, columns;

  PetscFunctionBeginUser;
  if (!s->file[i][0]) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_%c", s->name, letter[i]));
  PetscCall(MatrixReadFile(o->comm, option, s->file[i], &s->A[i]));
  PetscCall(MatGetSize(s->A[i], &rows_read, &columns));
  PetscCheck(rows_read == columns, o->comm, PETSC_ERR_USER_INPUT,
             "%s %s is %" PetscInt_FMT " x %" PetscInt_FMT ": it must be square", option, s->file[i], rows_read,
             columns);
  PetscCheck(rows_read == s->n, o->comm, PETSC_ERR_USER_INPUT,
             "%s %s has %" PetscInt_FMT " rows, but -%s_table %s has %" PetscInt_FMT
             " unknowns: a line is needed for each",
             option, s->file[i], rows_read, s->name, s->table, s->n);
  PetscCall(SuperelementCheckEven(s, i, option, &s->A[i]));
  PetscFunctionReturn(0);
}

/* B, with rows as K_s has them */
static PetscErrorCode SuperelementCreateB(Operators o, const Superelement *s, Mat like, Mat *B)
{
  const Mesh  *mesh;
  PetscInt     n_own, n = 0, *i, *j;
  PetscScalar *value;
  PetscMPIInt  rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(o->comm, &rank));
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(MatGetLocalSize(like, &n_own, NULL));
  PetscCall(MatCreate(o->comm, B));
  PetscCall(MatSetSizes(*B, n_own, mesh->n_own, s->n, mesh->n_unknowns));
  PetscCall(MatSetType(*B, MATAIJ));
  PetscCall(PetscMalloc3(s->n_shares + s->n_apart, &i, s->n_shares + s->n_apart, &j, s->n_shares + s->n_apart, &value));
  for (PetscInt k = 0; k < s->n_shares; k++) {
    const SuperelementShare *share = &s->share[k];

    if (mesh->unknown[share->at] < 0) continue;
    i[n]       = share->row;
    j[n]       = mesh->unknown[share->at];
    value[n++] = share->weight;
  }
  for (PetscInt k = 0, apart = s->first_apart; k < s->n && !rank; k++) {
    if (s->row[k].direction != SUPERELEMENT_APART) continue;
    i[n]       = k;
    j[n]       = apart++;
    value[n++] = 1;
  }
  PetscCall(MatSetPreallocationCOO(*B, n, i, j));
  PetscCall(MatSetValuesCOO(*B, value, INSERT_VALUES));
  PetscCall(PetscFree3(i, j, value));
  PetscFunctionReturn(0);
}

/* Parameter and term of one matrix */
static PetscErrorCode SuperelementAddTerm(Operators o, Superelement *s, int i, Mat B)
{
  static const OperatorsTermKind kind[]  = {OPERATORS_STIFFNESS, OPERATORS_MASS, OPERATORS_DAMPING};
  static const char *const       scale[] = {"k_scale", "m_scale", "c_scale"};
  const OperatorsParameter       like    = {
             .row = QuantityFind(&table, scale[i]), .value = s->scale[i], .damps = (PetscBool)(i == SUPERELEMENT_C)};
  Mat A, part[2];

  PetscFunctionBeginUser;
  s->index[i] = -1;
  if (!s->file[i][0]) PetscFunctionReturn(0);
  PetscCall(ParametersAdd(&o->parameters, s->name, scale[i], &like, &s->index[i]));
  if (s->n_apart && i != SUPERELEMENT_C) o->parameters.list[s->index[i]].closed = PETSC_FALSE;
  if (!B) PetscFunctionReturn(0);
  PetscCall(MatPtAP(s->A[i], B, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &A));
  PetscCall(MatProductClear(A));
  PetscCall(SuperelementSplit(A, &part[0], &part[1]));
  for (int odd = 0; odd < 2; odd++) {
    if (!part[odd]) continue;
    PetscCall(TermsAdd(&o->terms, kind[i], part[odd], (PetscBool)!odd, 1, &s->index[i]));
    PetscCall(TermsSetCause(&o->terms, "superelement", s->name, scale[i]));
    PetscCall(MatDestroy(&part[odd]));
  }
  if (i == SUPERELEMENT_M) PetscCall(PetscObjectReference((PetscObject)A));
  if (i == SUPERELEMENT_M) s->mass = A;
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementsSetUp(Operators o)
{
  const Mesh *mesh;
  PetscInt    apart;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(o->model, &mesh));
  apart = mesh->n_unknowns - mesh->n_apart;
  for (PetscInt k = 0; k < o->n_superelements; k++) {
    Superelement *s = &o->superelements[k], *piece = NULL;
    Mat           B = NULL, like = NULL;

    s->first_apart = apart;
    apart += s->n_apart;
    PetscCall(SuperelementPlace(o, s));
    while (SuperelementNext(o, s, &piece))
      for (int i = 0; i < N_SUPERELEMENT; i++) {
        PetscCall(SuperelementLoad(o, piece, i));
        if (piece->A[i]) like = piece->A[i];
      }
    PetscCall(SuperelementCheckStiffness(o, s));
    PetscCall(SuperelementCheckMass(o, s));
    if (like && !o->omit) PetscCall(SuperelementCreateB(o, s, like, &B));
    while (SuperelementNext(o, s, &piece)) {
      if (piece->whole) SuperelementPlacePiece(piece);
      for (int i = 0; i < N_SUPERELEMENT; i++) PetscCall(SuperelementAddTerm(o, piece, i, B));
    }
    PetscCall(MatDestroy(&B));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementsCheckWeight(Operators o)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->n_superelements + o->n_pieces; i++)
    PetscCheck(
      !o->superelements[i].file[SUPERELEMENT_M][0], o->comm, PETSC_ERR_SUP,
      "-model_gravity is not supported with the mass of superelement %s: its internal unknowns do not tell how "
      "they fall; give its weight as a load",
      o->superelements[i].name);
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsViewSuperelements(Operators o, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < o->n_superelements; i++) {
    const Superelement *s = &o->superelements[i];

    PetscCall(PetscViewerASCIIPrintf(
      viewer,
      "  superelement %s: %" PetscInt_FMT " unknowns, %" PetscInt_FMT " internal, %" PetscInt_FMT
      " on nodes and points, %" PetscInt_FMT " on surfaces between nodes; places are off by at most %.3g m\n",
      s->name, s->n, s->n_apart, s->n - s->n_apart - s->n_follow, s->n_follow, (double)s->off));
  }
  PetscFunctionReturn(0);
}

PetscBool OperatorsIsOfSuperelement(Operators o, PetscInt parameter)
{
  for (PetscInt k = 0; k < o->n_superelements + o->n_pieces; k++)
    for (int i = 0; i < N_SUPERELEMENT; i++)
      if (o->superelements[k].index[i] == parameter) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SuperelementsAddChecksum(Operators o, Checksum c)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < o->n_superelements + o->n_pieces; k++) {
    const Superelement *s = &o->superelements[k];

    PetscCall(ChecksumSetPart(c, "superelement %s", s->name));
    PetscCall(ChecksumAddReals(c, N_SUPERELEMENT, s->scale));
    for (PetscInt i = 0; i < s->n; i++) {
      PetscCall(ChecksumAddInts(c, 2, (const PetscInt[]){s->row[i].node, s->row[i].direction}));
      PetscCall(ChecksumAddReals(c, 3, s->row[i].x));
    }
    for (int i = 0; i < N_SUPERELEMENT; i++)
      if (s->A[i]) PetscCall(MatrixAddChecksum(s->A[i], c));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementsDestroy(Operators o)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < o->n_superelements + o->n_pieces; k++) {
    Superelement *s = &o->superelements[k];

    for (PetscInt i = 0; i < s->n_sets; i++) PetscCall(PetscFree(s->sets[i]));
    PetscCall(PetscFree(s->sets));
    for (int i = 0; i < N_SUPERELEMENT; i++) PetscCall(MatDestroy(&s->A[i]));
    PetscCall(MatDestroy(&s->mass));
    if (!s->whole) PetscCall(PetscFree(s->row));
    if (!s->whole) PetscCall(PetscFree(s->share));
    PetscCall(PetscFree(s->name));
    PetscCall(PetscFree(s->of));
  }
  PetscCall(PetscFree(o->superelements));
  PetscFunctionReturn(0);
}
