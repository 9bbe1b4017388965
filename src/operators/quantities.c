/* Options of the operators, of matrices without a mesh, and of their terms */
#include "operators/files/matrixterm.h"

#define OPERATORS_OPTION(member) QUANTITY_AT(struct _p_Operators, member)

static const char *const factors[] = {
  [OPERATORS_AUTO] = "auto", [OPERATORS_LU] = "lu", [OPERATORS_EVEN] = "symmetric", NULL};
static const char *const masses[] = {[PETSC_FALSE] = "consistent", [PETSC_TRUE] = "lumped", NULL};

static const char *OperatorsIdleFactors(const void *operators, const QuantityRun *run)
{
  const struct _p_Operators *o = operators;
  const ContactInterface    *c = NULL;
  PetscInt                   n = 0;

  if (run->does & RUN_PEP && !(run->does & RUN_EPS)) return "not used by -modes_damping pep in a band, which LU solves";
  if (o->contact && ContactGetInterfaces(o->contact, &n, &c)) return NULL;
  for (PetscInt i = 0; i < n; i++)
    if (c[i].law == CONTACT_CONSTRAINT) return "not used with contacts of -..._law constraint, which need LU";
  return NULL;
}

static const char *OperatorsIdleMass(const void *operators, const QuantityRun *run)
{
  (void)operators;
  return run->does & RUN_BODIES ? NULL : "not used by matrices without a mesh, whose mass is as it is";
}

static const Quantity rows[] = {
  {"-operators_mass", "mass matrix of the bodies; lumped: row sums, or of tet10, wedge15, hex20 the scaled diagonal",
   NULL, QUANTITY_WORD, OPERATORS_OPTION(lump), .words = masses, .in = RUN_LINEAR, .idle = OperatorsIdleMass},
  {"-operators_factors",
   "with friction LU, or LDL' of the symmetric part and an update for the closed pairs, or what memory and flops speak "
   "for",
   NULL, QUANTITY_WORD, OPERATORS_OPTION(factors), .words = factors, .in = RUN_LINEAR, .idle = OperatorsIdleFactors,
   .unread = "; it belongs to -analysis modes, sweep, frf, sample, quiet and design: modes beside reduced models have "
             "exact contact, "
             "which needs "
             "LU"},
  {"-operators_save", "folder for K.bin, M.bin, C.bin, H.bin and the loads F.bin (PETSc binary)", NULL, QUANTITY_TEXT,
   OPERATORS_OPTION(save), .path = "folder"},
  {"-operators_nodes", "of matrices without a mesh: table unknown,node,direction,x,y,z of their nodes", NULL,
   QUANTITY_PATH, OPERATORS_OPTION(nodes), .path = "file"},
};
static const Quantity loaded[] = {
  {"-contact_mu", "friction coefficient of K + mu H", NULL, QUANTITY_REAL, OPERATORS_OPTION(loaded_mu),
   .varies = VARIES_LINEAR},
};

/* Of one matrix: the file, or all entries */
#define MATRIX(letter, meaning, i)                                                                                     \
  {"-operators_load_" letter,                                                                                          \
   "PETSc binary file of the " meaning,                                                                                \
   NULL,                                                                                                               \
   QUANTITY_PATH,                                                                                                      \
   OPERATORS_OPTION(load[i]),                                                                                          \
   .path = "file"},                                                                                                    \
  {                                                                                                                    \
    "-operators_dense_" letter, "small dense matrix of the " meaning ", rows one after another", NULL, QUANTITY_MANY,  \
      OPERATORS_OPTION(dense[i]), .count = offsetof(struct _p_Operators, n_dense[i]), .room = OPERATORS_MAX_DENSE      \
  }

static const Quantity matrices[] = {
  MATRIX("k", "stiffness, N/m", OPERATOR_K),
  MATRIX("m", "mass, kg", OPERATOR_M),
  MATRIX("c", "damping, N s/m", OPERATOR_C),
  MATRIX("h", "friction part per unit mu, N/m", OPERATOR_H),
};

#define TERM(member) QUANTITY_AT(MatrixTerm, member)

static const char *const kinds[]      = {"stiffness", "damping", "mass", NULL}; /* of OperatorsTermKind */
static const char *const symmetries[] = {
  [MATRIX_ANY] = "any", [MATRIX_EVEN] = "symmetric", [MATRIX_SKEW] = "skew", NULL};

static const Quantity term[] = {
  {"-file", "PETSc binary file of the matrix", NULL, QUANTITY_PATH, TERM(file), .path = "file"},
  {"-dense", "or all entries of a small matrix, rows one after another", NULL, QUANTITY_MANY, TERM(dense),
   .count = offsetof(MatrixTerm, n_dense), .room = OPERATORS_MAX_DENSE},
  {"-kind", "what it is part of", NULL, QUANTITY_WORD, TERM(kind), .initial = 3, .words = kinds, .required = PETSC_TRUE,
   .why = "stiffness, damping or mass"},
  {"-symmetry", "what it must be, else the run stops", NULL, QUANTITY_WORD, TERM(symmetry), .words = symmetries},
  {"-scale", "a number that it is multiplied with", NULL, QUANTITY_REAL, TERM(scale), .initial = 1},
  {"-parameter", "numbers that it is proportional to, options of their own, e.g. speed", NULL, QUANTITY_TEXT,
   TERM(parameters), .given = offsetof(MatrixTerm, has_parameters)},
  {"-power", "power of each of them, e.g. 2 or -1", NULL, QUANTITY_INTS, TERM(power),
   .count = offsetof(MatrixTerm, n_powers), .text = "1"},
  {"-loss_factor", "of a stiffness: hysteretic loss factor", NULL, QUANTITY_REAL, TERM(loss), QUANTITY_NOT_NEGATIVE,
   VISCOELASTIC_VARIES},
  VISCOELASTIC_ROWS(MatrixTerm, viscous, .room = 0),
};

const QuantityTable operators_quantities = {"Operators", "operators.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows, .in = 0};
const QuantityTable operators_loaded     = {"Friction of loaded matrices", "operators.h", 1, loaded, .in = 0};
const QuantityTable operators_matrices   = {"Matrices", "operators.h", PETSC_STATIC_ARRAY_LENGTH(matrices), matrices,
                                            .in = 0};
const QuantityTable operators_term       = {"Matrix", "operators.h", PETSC_STATIC_ARRAY_LENGTH(term), term, .in = 0};
