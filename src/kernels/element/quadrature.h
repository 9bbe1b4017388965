/*
   Quadrature of the reference tetrahedron (r, s, t >= 0, r + s + t <= 1), wedge (r, s >= 0, r + s <= 1, |z| <= 1) and
   cube (|xi|, |eta|, |zeta| <= 1): points and weights {xi, eta, zeta, w}, all weights positive.

   References: P. Keast, Moderate-degree tetrahedral quadrature formulas, CMAME 55 (1986) 339-348 (15 points, degree 5);
   J. Radon, Zur mechanischen Kubatur, Monatsh. Math. 52 (1948) 286-300 (triangle, 7 points, degree 5); Gauss.
*/
#pragma once

/* Tetrahedron, degree 2: a = (5 - sqrt 5) / 20, b = (5 + 3 sqrt 5) / 20 */
#define TET_A 0.13819660112501051518
#define TET_B 0.58541019662496845446

static const double quadrature_tet4[4][4] = {{TET_A, TET_A, TET_A, 1.0 / 24},
                                             {TET_B, TET_A, TET_A, 1.0 / 24},
                                             {TET_A, TET_B, TET_A, 1.0 / 24},
                                             {TET_A, TET_A, TET_B, 1.0 / 24}};

/* Tetrahedron, degree 5: a = (7 - sqrt 15) / 34, b = (7 + sqrt 15) / 34, 1 - 3 a, 1 - 3 b; edges c = (10 - 2 sqrt 15) /
   40, 1/2 - c; weights (2665 +- 14 sqrt 15) / 226800, 5/567, and 8/405 in the middle */
#define TET_C  0.09197107805272303279
#define TET_C1 0.72408676584183090163
#define TET_D  0.31979362782962990839
#define TET_D1 0.04061911651111027484
#define TET_E  0.05635083268962915574
#define TET_E1 0.44364916731037084426
#define TET_WM 0.01975308641975308642
#define TET_WC 0.01198951396316977000
#define TET_WD 0.01151136787104539755
#define TET_WE 0.00881834215167548501

static const double quadrature_tet15[15][4] = {
  {0.25, 0.25, 0.25, TET_WM},      {TET_C, TET_C, TET_C, TET_WC},   {TET_C1, TET_C, TET_C, TET_WC},
  {TET_C, TET_C1, TET_C, TET_WC},  {TET_C, TET_C, TET_C1, TET_WC},  {TET_D, TET_D, TET_D, TET_WD},
  {TET_D1, TET_D, TET_D, TET_WD},  {TET_D, TET_D1, TET_D, TET_WD},  {TET_D, TET_D, TET_D1, TET_WD},
  {TET_E1, TET_E, TET_E, TET_WE},  {TET_E, TET_E1, TET_E, TET_WE},  {TET_E, TET_E, TET_E1, TET_WE},
  {TET_E, TET_E1, TET_E1, TET_WE}, {TET_E1, TET_E, TET_E1, TET_WE}, {TET_E1, TET_E1, TET_E, TET_WE}};

#define GAUSS2 0.57735026918962576451 /* 1 / sqrt 3, weight 1: degree 3 */
#define GAUSS3 0.77459666924148337704 /* sqrt(3/5), weights 5/9, 8/9, 5/9: degree 5 */

/* Triangle, degree 2, times a point of Gauss */
#define WEDGE3(z, w)                                                                                                   \
  {1.0 / 6, 1.0 / 6, z, (w) / 6}, {2.0 / 3, 1.0 / 6, z, (w) / 6},                                                      \
  {                                                                                                                    \
    1.0 / 6, 2.0 / 3, z, (w) / 6                                                                                       \
  }

static const double quadrature_wedge6[6][4] = {WEDGE3(-GAUSS2, 1.0), WEDGE3(GAUSS2, 1.0)};

/* Triangle, degree 5: a = (6 - sqrt 15) / 21, b = (6 + sqrt 15) / 21, 1 - 2 a, 1 - 2 b, weights (155 -+ sqrt 15) /
   2400, and 9/80 in the middle */
#define TRI_A  0.10128650732345633880
#define TRI_A1 0.79742698535308732240
#define TRI_B  0.47014206410511508977
#define TRI_B1 0.05971587178976982046
#define TRI_WA 0.06296959027241357630
#define TRI_WB 0.06619707639425309037
#define TRI_WM 0.1125

#define WEDGE7(z, w)                                                                                                   \
  {1.0 / 3, 1.0 / 3, z, TRI_WM * (w)}, {TRI_A, TRI_A, z, TRI_WA * (w)}, {TRI_A1, TRI_A, z, TRI_WA * (w)},              \
    {TRI_A, TRI_A1, z, TRI_WA * (w)}, {TRI_B, TRI_B, z, TRI_WB * (w)}, {TRI_B1, TRI_B, z, TRI_WB * (w)},               \
  {                                                                                                                    \
    TRI_B, TRI_B1, z, TRI_WB *(w)                                                                                      \
  }

static const double quadrature_wedge21[21][4] = {WEDGE7(-GAUSS3, 5.0 / 9), WEDGE7(0, 8.0 / 9), WEDGE7(GAUSS3, 5.0 / 9)};

/* Cube: Gauss, 2 and 3 points along each side */
#define CUBE2(y, z)                                                                                                    \
  {-GAUSS2, y, z, 1},                                                                                                  \
  {                                                                                                                    \
    GAUSS2, y, z, 1                                                                                                    \
  }

static const double quadrature_hex8[8][4] = {CUBE2(-GAUSS2, -GAUSS2), CUBE2(GAUSS2, -GAUSS2), CUBE2(-GAUSS2, GAUSS2),
                                             CUBE2(GAUSS2, GAUSS2)};

#define CUBE3(y, z, w)                                                                                                 \
  {-GAUSS3, y, z, 5.0 / 9 * (w)}, {0, y, z, 8.0 / 9 * (w)},                                                            \
  {                                                                                                                    \
    GAUSS3, y, z, 5.0 / 9 * (w)                                                                                        \
  }
#define CUBE9(z, w) CUBE3(-GAUSS3, z, 5.0 / 9 * (w)), CUBE3(0, z, 8.0 / 9 * (w)), CUBE3(GAUSS3, z, 5.0 / 9 * (w))

static const double quadrature_hex27[27][4] = {CUBE9(-GAUSS3, 5.0 / 9), CUBE9(0, 8.0 / 9), CUBE9(GAUSS3, 5.0 / 9)};
