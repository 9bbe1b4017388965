// A pad on a strip: lining, back plate, rubber shim and piston as bricks on each other, in hexahedra, written in m.
//
//   gmsh -3 -format msh41 options/small_brake_shim.geo
//
// shim: thickness of the shim in the mesh, 0.4 mm by default, set by -setnumber shim 0.0006; n: elements along the pad, 4. The bricks
// share no nodes; they touch over faces with nodes at the same places, but for the strip.

SetFactory("OpenCASCADE");
DefineConstant[ shim = {0.0004, Name "shim"}, n = {4, Name "n"} ];

Macro Brick // corner x, y, z; sizes lx, ly, lz; elements ex, ey, ez -> low[1] its face of least z, body[]: 0 that of largest, 1 itself
  p = newp; Point(p) = {x, y, z};
  edge[] = Extrude {lx, 0, 0} { Point{p}; Layers{ex}; };
  low[] = Extrude {0, ly, 0} { Curve{edge[1]}; Layers{ey}; Recombine; };
  body[] = Extrude {0, 0, lz} { Surface{low[1]}; Layers{ez}; Recombine; };
Return

x = -0.06; y = -0.12; z = -0.008; lx = 0.12; ly = 0.24; lz = 0.008; ex = 2*n; ey = 4*n; ez = 1;
Call Brick;
Physical Volume("strip") = {body[1]};
Physical Surface("strip_top") = {body[0]};
Physical Surface("strip_inner") = {body[5]};

x = -0.02; y = -0.03; lx = 0.04; ly = 0.06; ex = n; ey = n;
z = 0; lz = 0.010; ez = 2;
Call Brick;
Physical Volume("lining") = {body[1]};
Physical Surface("lining_rub") = {low[1]};
Physical Surface("lining_top") = {body[0]};

z = z + lz; lz = 0.005; ez = 1;
Call Brick;
Physical Volume("plate") = {body[1]};
Physical Surface("plate_bottom") = {low[1]};
Physical Surface("plate_top") = {body[0]};

z = z + lz; lz = shim; ez = 1;
Call Brick;
Physical Volume("shim") = {body[1]};
Physical Surface("shim_bottom") = {low[1]};
Physical Surface("shim_top") = {body[0]};

z = z + lz; lz = 0.030; ez = 3;
Call Brick;
Physical Volume("piston") = {body[1]};
Physical Surface("piston_bottom") = {low[1]};
Physical Surface("piston_top") = {body[0]};
