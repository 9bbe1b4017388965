// A bar of 100 x 10 x 5 mm along x in hexahedra of equal size, written in m.
//
//   gmsh -3 -format msh41 options/cantilever.geo
//
// nx, ny, nz: elements along x, y, z, 40, 8, 4 by default, set by -setnumber nx 80.

SetFactory("OpenCASCADE");
DefineConstant[ nx = {40, Name "nx"}, ny = {8, Name "ny"}, nz = {4, Name "nz"} ];

Point(1) = {0, -0.005, -0.0025};
edge[] = Extrude {0, 0.01, 0} { Point{1}; Layers{ny}; };
root[] = Extrude {0, 0, 0.005} { Curve{edge[1]}; Layers{nz}; Recombine; };
beam[] = Extrude {0.1, 0, 0} { Surface{root[1]}; Layers{nx}; Recombine; };

Physical Volume("beam") = {beam[1]};
Physical Surface("root") = {root[1]};
