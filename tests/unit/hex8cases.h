/* What the tests of kernels/element/hex8.h share: the formulations, an irregular patch of elements, and boxes. Lengths in m */
#pragma once

#include "kernels/element/hex8.h"

#define N HEX8_DOFS

typedef int (*MatricesFunction)(const Solid *, const double *, const Elasticity *, double *, double *);

typedef struct {
  const char      *name;
  MatricesFunction matrices;
} Formulation;

static const Formulation formulations[] = {
  {"incompatible", Hex8IncompatibleMatrices},
  {"full",         Hex8FullMatrices        }
};

/* Cube [0,1]^3 of seven hexahedra around an irregular one: nodes 0..7 are its corners, 8..15 the inner ones */
static const double patch_nodes[16][3] = {
  {0,     0,     0    },
  {1,     0,     0    },
  {1,     1,     0    },
  {0,     1,     0    },
  {0,     0,     1    },
  {1,     0,     1    },
  {1,     1,     1    },
  {0,     1,     1    },
  {0.249, 0.342, 0.192},
  {0.826, 0.288, 0.288},
  {0.850, 0.649, 0.263},
  {0.273, 0.750, 0.230},
  {0.320, 0.186, 0.643},
  {0.677, 0.305, 0.683},
  {0.788, 0.693, 0.644},
  {0.165, 0.745, 0.702}
};
static const int patch_cells[7][8] = {
  {8,  9,  10, 11, 12, 13, 14, 15},
  {0,  1,  2,  3,  8,  9,  10, 11},
  {12, 13, 14, 15, 4,  5,  6,  7 },
  {0,  1,  9,  8,  4,  5,  13, 12},
  {1,  2,  10, 9,  5,  6,  14, 13},
  {2,  3,  11, 10, 6,  7,  15, 14},
  {3,  0,  8,  11, 7,  4,  12, 15}
};

/* Corners of a cell of the patch, x[8][3] */
static inline void PatchCell(int cell, double x[N])
{
  for (int i = 0; i < N; i++) x[i] = patch_nodes[patch_cells[cell][i / 3]][i % 3];
}

/* Box [-l/2, l/2] x [-b/2, b/2] x [-h/2, h/2] */
static inline void Box(double l, double b, double h, double x[N])
{
  const double size[3] = {l, b, h};

  for (int i = 0; i < N; i++) x[i] = hex8_sign[i / 3][i % 3] * size[i % 3] / 2;
}
