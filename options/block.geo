// A block of 100 x 100 x 100 mm on a base 20 mm high, in hexahedra of equal size, written in m.
//
//   gmsh -3 -format msh41 options/block.geo
//
// nx, ny, nz: elements of the block along x, y, z, 6 each by default; -setnumber n 2 sets all three. The base reaches two of its
// elements, as large as the block's, farther on each side, and has a quarter of nz along z, at least one. The block stands
// with x and y around 0 and z from 0. Block and base share no nodes; where they touch their nodes lie at the same places.

SetFactory("OpenCASCADE");
DefineConstant[ n = {6, Name "n"} ];
DefineConstant[ nx = {n, Name "nx"}, ny = {n, Name "ny"}, nz = {n, Name "nz"} ];
margin = 2;

Macro Brick // corner x, y, z; sizes lx, ly, lz; elements ex, ey, ez -> low[1] its face of least z, body[]: 0 that of largest, 1 itself
  p = newp; Point(p) = {x, y, z};
  edge[] = Extrude {lx, 0, 0} { Point{p}; Layers{ex}; };
  low[] = Extrude {0, ly, 0} { Curve{edge[1]}; Layers{ey}; Recombine; };
  body[] = Extrude {0, 0, lz} { Surface{low[1]}; Layers{ez}; Recombine; };
Return

// Base
ex = nx + 2*margin; ey = ny + 2*margin; ez = nz < 8 ? 1 : Floor(nz/4);
lx = 0.1*ex/nx; ly = 0.1*ey/ny; lz = 0.02;
x = -0.5*lx; y = -0.5*ly; z = -lz;
Call Brick;
Physical Volume("base") = {body[1]};
Physical Surface("base_bottom") = {low[1]};
Physical Surface("base_top") = {body[0]};

// Block
ex = nx; ey = ny; ez = nz;
lx = 0.1; ly = 0.1; lz = 0.1;
x = -0.05; y = -0.05; z = 0;
Call Brick;
Physical Volume("block") = {body[1]};
Physical Surface("block_bottom") = {low[1]};
Physical Surface("block_top") = {body[0]};
Physical Surface("block_left") = {body[4]};
Physical Surface("block_right") = {body[5]};
