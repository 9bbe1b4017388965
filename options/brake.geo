// A disc brake with a floating caliper, drawn in mm and written in m, in tetrahedra of second order (tet10).
//
//   gmsh -3 -format msh41 -setnumber size 14 options/brake.geo
//
// size: length of the edges, mm, from which all else follows: 14, 6.5, 3.4 give about 50,000, 200,000, 1,000,000 unknowns.
// turn: least number of edges around a hole, 10 by default. With -setnumber alone 1 the file has the disc only, with
// -setnumber match 1 the disc has the pads' faces in its mesh.
// The disc turns about z. Its friction ring lies at |z| < 6, its hat points to +z, where the fingers are; the piston is
// at -z, the pads are at +x. Bodies that touch share no nodes, but each lining is bonded to its back plate.

SetFactory("OpenCASCADE");
DefineConstant[ size = {14, Name "size"}, turn = {10, Name "turn"}, alone = {0, Name "alone"},
  match = {0, Name "match"} ];

// Disc: a profile that turns about z, less five holes for bolts
xz[] = {34,40,  34,33,  64,33,  70,27,  70,-6,  140,-6,  140,6,  83,6,  77,12,  77,34,  71,40};
For i In {0:10}
  Point(i + 1) = {xz[2*i], 0, xz[2*i + 1]};
EndFor
For i In {1:11}
  Line(i) = {i, i % 11 + 1};
EndFor
Curve Loop(1) = {1:11}; Plane Surface(1) = {1};
turned[] = Extrude {{0, 0, 1}, {0, 0, 0}, 2*Pi} { Surface{1}; };
For i In {0:4}
  hole[i] = newv; Cylinder(hole[i]) = {54*Cos(2*Pi*i/5), 54*Sin(2*Pi*i/5), 30, 0, 0, 15, 6.5};
EndFor
disc[] = BooleanDifference{ Volume{turned[1]}; Delete; }{ Volume{hole[]}; Delete; };

// Pieces of rings: radii r1 to r2, w degrees to both sides of +x, heights z1 to z2. Linings and back plates of the inner
// and of the outer pad, then the caliper's bridge, fingers and cylinder
r1[] = { 98,  98,  94,  94, 146,  98,  86};
r2[] = {137, 137, 142, 142, 162, 162, 162};
w[]  = { 26,  26,  31,  31,  24,  24,  24};
z1[] = {-16,   6, -22,  16, -72,  22, -72};
z2[] = { -6,  16, -16,  22,  40,  40, -30};
For i In {0:6}
  a = newv; Cylinder(a) = {0, 0, z1[i], 0, 0, z2[i] - z1[i], r2[i], w[i]*Pi/90};
  b = newv; Cylinder(b) = {0, 0, z1[i], 0, 0, z2[i] - z1[i], r1[i]};
  cut[] = BooleanDifference{ Volume{a}; Delete; }{ Volume{b}; Delete; };
  Rotate {{0, 0, 1}, {0, 0, 0}, -w[i]*Pi/180} { Volume{cut[0]}; }
  piece[i] = cut[0];
EndFor

// Back plates have a lug at each end and share nodes with their linings. The inner one has the print of the piston on
// its back, the outer one those of the fingers
For i In {0:1}
  a = newv; Box(a) = {100, -78, z1[i + 2], 16, 156, 6};
  plate[] = BooleanUnion{ Volume{piece[i + 2]}; Delete; }{ Volume{a}; Delete; };
  BooleanFragments{ Volume{piece[i]}; Delete; }{ Volume{plate[0]}; Delete; }
EndFor
print[0] = news; Disk(print[0]) = {118, 0, -22, 20};
print[1] = news; Disk(print[1]) = {116, -31, 22, 13};
print[2] = news; Disk(print[2]) = {116, 31, 22, 13};
pads[] = Volume In BoundingBox{80, -80, -23, 150, 80, 23};
BooleanFragments{ Volume{pads[]}; Delete; }{ Surface{print[]}; Delete; }

// Caliper: with ears, less the gap between its fingers, the piston's bore, and holes for two pins
ears = newv; Box(ears) = {108, -104, -60, 38, 208, 20};
cut[] = BooleanUnion{ Volume{piece[4]}; Delete; }{ Volume{piece[5], piece[6], ears}; Delete; };
gap = newv; Box(gap) = {80, -14, 20, 45, 28, 22};
bore = newv; Cylinder(bore) = {118, 0, -60, 0, 0, 40, 20};
pin[0] = newv; Cylinder(pin[0]) = {127, -88, -70, 0, 0, 40, 8};
pin[1] = newv; Cylinder(pin[1]) = {127, 88, -70, 0, 0, 40, 8};
caliper[] = BooleanDifference{ Volume{cut[0]}; Delete; }{ Volume{gap, bore, pin[]}; Delete; };

// The linings' faces, and with match copies of them in the disc, which have the same triangles
For i In {0:1}
  z = i ? 6 : -6;
  rub~{i}[] = Surface In BoundingBox{80, -80, z - 0.01, 150, 80, z + 0.01};
EndFor
If(match)
  copy[] = Translate {0, 0, 0} { Duplicata { Surface{rub_0[0], rub_1[0]}; } };
  BooleanFragments{ Volume{disc[]}; Delete; }{ Surface{copy[]}; Delete; }
  For i In {0:1}
    z = i ? 6 : -6;
    copy[] = Surface In BoundingBox{80, -80, z - 0.01, 150, 80, z + 0.01};
    copy[] -= {rub~{i}[]};
    Periodic Surface {copy[0]} = {rub~{i}[0]} Translate {0, 0, 0};
  EndFor
EndIf

// Names, by boxes that hold one thing each
e = 0.01;
Physical Volume("disc") = disc[];
Physical Surface("bolts") = Surface In BoundingBox{-61, -61, 33 - e, 61, 61, 40 + e};
If(!alone)
Physical Volume("inner_lining") = Volume In BoundingBox{80, -80, -16 - e, 150, 80, -6 + e};
Physical Volume("inner_plate") = Volume In BoundingBox{80, -80, -22 - e, 150, 80, -16 + e};
Physical Volume("outer_lining") = Volume In BoundingBox{80, -80, 6 - e, 150, 80, 16 + e};
Physical Volume("outer_plate") = Volume In BoundingBox{80, -80, 16 - e, 150, 80, 22 + e};
Physical Volume("caliper") = caliper[];
For i In {0:1}
  z = i ? 6 : -6;
  ring~{i}[] = Surface In BoundingBox{-141, -141, z - e, 141, 141, z + e};
  ring~{i}[] -= {rub~{i}[]};
  z = i ? 19 : -19;
  lugs~{i}[] = Surface In BoundingBox{99, -78 - e, z - 4, 117, -78 + e, z + 4};
  lugs~{i}[] += {Surface In BoundingBox{99, 78 - e, z - 4, 117, 78 + e, z + 4}};
EndFor
Physical Surface("disc_inner") = ring_0[]; Physical Surface("disc_outer") = ring_1[];
Physical Surface("inner_rub") = rub_0[]; Physical Surface("outer_rub") = rub_1[];
Physical Surface("inner_lugs") = lugs_0[]; Physical Surface("outer_lugs") = lugs_1[];
Physical Surface("piston") = Surface In BoundingBox{97, -21, -22 - e, 139, 21, -22 + e};
Physical Surface("bore") = Surface In BoundingBox{97, -21, -60 - e, 139, 21, -60 + e};
tips[] = Surface In BoundingBox{102, -45, 22 - e, 130, -17, 22 + e};
tips[] += {Surface In BoundingBox{102, 17, 22 - e, 130, 45, 22 + e}};
Physical Surface("tips") = tips[];
back[] = Surface In BoundingBox{80, -80, 22 - e, 143, 80, 22 + e};
fingers[] = Surface In BoundingBox{80, -80, 22 - e, 163, 80, 22 + e};
fingers[] -= {back[]};
Physical Surface("fingers") = fingers[];
pins[] = Surface In BoundingBox{118, -97, -61, 136, -79, -39};
pins[] += {Surface In BoundingBox{118, 79, -61, 136, 97, -39}};
Physical Surface("pins") = pins[];
EndIf

Mesh.MeshSizeMax = size;
Mesh.MeshSizeFromCurvature = turn;
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 1;         // no curved element is folded
Mesh.ScalingFactor = 1e-3;          // m
