// Two bars of 100 x 10 x 10 mm along x in hexahedra of equal size, end to end at x = 0, written in m.
//
//   gmsh -3 -format msh41 options/bars.geo
//
// nx, ny, nz: elements of a bar along x, y, z, 100, 1, 1 by default, set by -setnumber nx 50. They share no nodes.

SetFactory("OpenCASCADE");
DefineConstant[ nx = {100, Name "nx"}, ny = {1, Name "ny"}, nz = {1, Name "nz"} ];

For i In {0:1}
  p = newp; Point(p) = {0.1*(i - 1), -0.005, -0.005};
  edge[] = Extrude {0, 0.01, 0} { Point{p}; Layers{ny}; };
  face[] = Extrude {0, 0, 0.01} { Curve{edge[1]}; Layers{nz}; Recombine; };
  body[] = Extrude {0.1, 0, 0} { Surface{face[1]}; Layers{nx}; Recombine; };
  start[i] = face[1]; end[i] = body[0]; bar[i] = body[1];
EndFor

Physical Volume("left") = {bar[0]};
Physical Surface("left_start") = {start[0]};
Physical Surface("left_end") = {end[0]};
Physical Volume("right") = {bar[1]};
Physical Surface("right_start") = {start[1]};
Physical Surface("right_end") = {end[1]};
