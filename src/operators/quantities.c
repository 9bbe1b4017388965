/* Options of the operators; matrices and their terms are read beside them */
#include "operatorsimpl.h"

#define OPERATORS_OPTION(member) QUANTITY_AT(struct _p_Operators, member)

static const char *const factors[] = {[OPERATORS_AUTO] = "auto", [OPERATORS_LU] = "lu", [OPERATORS_EVEN] = "symmetric", NULL};
static const char *const masses[]  = {[PETSC_FALSE] = "consistent", [PETSC_TRUE] = "lumped", NULL};

static const Quantity rows[] = {
  {"-operators_mass", "mass matrix of the bodies; lumped: row sums, or of tet10, wedge15, hex20 the scaled diagonal", NULL,
   QUANTITY_WORD, OPERATORS_OPTION(lump), .words = masses},
  {"-operators_factors",
   "with friction LU, or LDL' of the symmetric part and an update for the closed pairs, or what memory and flops speak for", NULL,
   QUANTITY_WORD, OPERATORS_OPTION(factors), .words = factors},
  {"-operators_save", "folder for K.bin, M.bin, C.bin, H.bin and the loads F.bin (PETSc binary)", NULL, QUANTITY_TEXT,
   OPERATORS_OPTION(save)},
  {"-operators_nodes", "of matrices without a mesh: table unknown,node,direction,x,y,z of their nodes", NULL, QUANTITY_PATH,
   OPERATORS_OPTION(nodes)},
};
static const Quantity loaded[] = {
  {"-contact_mu", "friction coefficient of K + mu H", NULL, QUANTITY_REAL, OPERATORS_OPTION(loaded_mu)},
};

const QuantityTable operators_quantities = {"Operators", "operators.h", PETSC_STATIC_ARRAY_LENGTH(rows), rows};
const QuantityTable operators_loaded     = {"Friction of loaded matrices", "operators.h", 1, loaded};
