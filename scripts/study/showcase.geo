// The disc and two pads of the Ansys technology showcase "brake squeal", as its published page has them, drawn in mm and written in m:
// tetrahedra of second order in the disc, pads of 4 x 8 x 8 hexahedra of second order as there.
//
//   gmsh -3 -format msh41 -setnumber size 12 scripts/study/showcase.geo
//
// The disc turns about z. Its front ring (z 0 to 10) goes on to the hat's wall (radii 105 to 112.5), its rear ring (25 to 35) is borne by 21
// radial vanes; the hat's plate (z 65 to 75) has a bore of radius 40 and five bolt holes of radius 10 at radius 75.

SetFactory("OpenCASCADE");
DefineConstant[ size = {12, Name "size"}, vanes = {21, Name "vanes"}, wide = {28.7, Name "wide"}, washer = {10, Name "washer"} ];

// Front ring, wall and plate: a profile that turns about z; the rear ring; vanes with parallel sides
rz[] = {40,65,  105,65,  105,0,  175,0,  175,10,  112.5,10,  112.5,75,  40,75};
For i In {0:7}
  Point(i + 1) = {rz[2*i], 0, rz[2*i + 1]};
EndFor
For i In {1:8}
  Line(i) = {i, i % 8 + 1};
EndFor
Curve Loop(1) = {1:8}; Plane Surface(1) = {1};
turned[] = Extrude {{0, 0, 1}, {0, 0, 0}, 2*Pi} { Surface{1}; };
a = newv; Cylinder(a) = {0, 0, 10, 0, 0, 25, 175};
b = newv; Cylinder(b) = {0, 0, 10, 0, 0, 25, 125};
rear[] = BooleanDifference{ Volume{a}; Delete; }{ Volume{b}; Delete; };
For i In {0:vanes - 1}
  vane[i] = newv; Box(vane[i]) = {100, -wide/2, 10, 100, wide, 15};
  Rotate {{0, 0, 1}, {0, 0, 0}, (4 + 360/vanes*i)*Pi/180} { Volume{vane[i]}; }
EndFor
c = newv; Cylinder(c) = {0, 0, 10, 0, 0, 15, 176};
gaps[] = BooleanDifference{ Volume{c}; Delete; }{ Volume{vane[]}; Delete; };
hollow[] = BooleanDifference{ Volume{rear[]}; Delete; }{ Volume{gaps[]}; Delete; };
For i In {0:4}
  hole[i] = newv; Cylinder(hole[i]) = {75*Cos(Pi/2 + 2*Pi*i/5), 75*Sin(Pi/2 + 2*Pi*i/5), 60, 0, 0, 20, 10};
EndFor
plate[] = BooleanDifference{ Volume{turned[1]}; Delete; }{ Volume{hole[]}; Delete; };
disc[] = BooleanUnion{ Volume{plate[]}; Delete; }{ Volume{hollow[]}; Delete; };
If (washer > 10) // rings of this radius about the holes, on both faces of the plate
  For k In {0:1}
    For i In {0:4}
      a = news; Disk(a) = {75*Cos(Pi/2 + 2*Pi*i/5), 75*Sin(Pi/2 + 2*Pi*i/5), 65 + 10*k, washer};
      b = news; Disk(b) = {75*Cos(Pi/2 + 2*Pi*i/5), 75*Sin(Pi/2 + 2*Pi*i/5), 65 + 10*k, 10};
      ring[] = BooleanDifference{ Surface{a}; Delete; }{ Surface{b}; Delete; };
      rings[5*k + i] = ring[0];
    EndFor
  EndFor
  BooleanFragments{ Volume{disc[]}; Delete; }{ Surface{rings[]}; Delete; }
  disc[] = Volume{:};
EndIf
reach = 76 + washer;
held[] = Surface In BoundingBox{-reach, -reach, 64.9, reach, reach, 75.1}; // bore, holes, rings
plate[] = Surface In BoundingBox{-105.1, -105.1, 64.9, 105.1, 105.1, 65.1};
front[] = Surface In BoundingBox{-175.1, -175.1, -0.1, 175.1, 175.1, 0.1};
behind[] = Surface In BoundingBox{-175.1, -175.1, 34.9, 175.1, 175.1, 35.1};

// Pads from 60 to 120 degrees, radii 130 to 167.5, 15 thick, on the rings
z[] = {-15, 35};
For i In {0:1}
  s = news; Rectangle(s) = {130, 0, 0, 37.5, 15};
  Rotate {{1, 0, 0}, {0, 0, 0}, Pi/2} { Surface{s}; }
  Translate {0, 0, z[i]} { Surface{s}; }
  Rotate {{0, 0, 1}, {0, 0, 0}, Pi/3} { Surface{s}; }
  edge[] = Boundary{ Surface{s}; };
  Transfinite Curve{edge[0], edge[2]} = 5;
  Transfinite Curve{edge[1], edge[3]} = 9;
  Transfinite Surface{s};
  Recombine Surface{s};
  pad[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi/3} { Surface{s}; Layers{8}; Recombine; };
  body[i] = pad[1];
EndFor

Physical Volume("disc") = {disc[]};
Physical Volume("inner_pad") = {body[0]};
Physical Volume("outer_pad") = {body[1]};
Physical Surface("held") = {held[]};
Physical Surface("plate") = {plate[]};
Physical Surface("disc_inner") = {front[]};
Physical Surface("disc_outer") = {behind[]};
side[] = Surface In BoundingBox{-100, 110, -15.1, 100, 170, -14.9}; Physical Surface("inner_back") = {side[]};
side[] = Surface In BoundingBox{-100, 110, -0.1, 100, 170, 0.1}; Physical Surface("inner_face") = {side[]};
side[] = Surface In BoundingBox{-100, 110, 34.9, 100, 170, 35.1}; Physical Surface("outer_face") = {side[]};
side[] = Surface In BoundingBox{-100, 110, 49.9, 100, 170, 50.1}; Physical Surface("outer_back") = {side[]};

Mesh.MeshSizeMax = size;
Mesh.MeshSizeFromCurvature = 12;
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1; // hexahedra of 20 nodes
Mesh.ScalingFactor = 1e-3;
