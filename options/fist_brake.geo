// A disc brake with a fist caliper, in mm and in tetrahedra of second order (tet10): a ventilated disc with hat, two pads, each
// a slotted and chamfered lining, back plate and shim, the piston, the caliper, the bracket.
//
//   gmsh -3 -format msh41 options/fist_brake.geo
//
// size: length of the edges of pads and piston, mm, from which all else follows. vanes: how many the disc has; few make the
// coarse mesh of a test small. The disc turns about z, its hat points to +z, the outboard side, where the fingers are; the
// piston is at -z. The pads are at +x, where a disc that turns from x to y drags them to +y, into the bracket.
// No two bodies share nodes: those that are bonded are tied, those that touch are in contact.

SetFactory("OpenCASCADE");
DefineConstant[ size = {12, Name "size"}, vanes = {24, Name "vanes"}, order = {2, Name "order"} ];
ring = 11; groove = 4;              // outer faces of the two friction rings, and the inner ones, which the vanes join
pad = 10; plate = 5.5; shim = 0.8;  // thicknesses of lining, back plate and shim
back = ring + pad; outside = back + plate; rear = outside + shim;
taper = 0.01;                       // by which a lining is thinner at its inner radius than at its outer one
bolts = 5; pinx = 141; piny = 76;

// A sector of a ring about z: inner and outer radius, half angle in degrees, from z = z1 to z2; makes `made`
Macro Sector
  a = newv; Cylinder(a) = {0, 0, z1, 0, 0, z2 - z1, r2, half*Pi/90};
  b = newv; Cylinder(b) = {0, 0, z1, 0, 0, z2 - z1, r1};
  cut[] = BooleanDifference{ Volume{a}; Delete; }{ Volume{b}; Delete; };
  Rotate {{0, 0, 1}, {0, 0, 0}, -half*Pi/180} { Volume{cut[0]}; }
  made = cut[0];
Return

// Disc: hat and outboard ring are a profile that turns about z, the inboard ring hangs on the vanes
xz[] = {34,52, 34,45, 66,45, 72,39, 72,groove, 140,groove, 140,ring, 88,ring, 79,15, 79,46, 73,52};
For i In {0:10}
  Point(i + 1) = {xz[2*i], 0, xz[2*i + 1]};
EndFor
For i In {1:11}
  Line(i) = {i, i % 11 + 1};
EndFor
Curve Loop(1) = {1:11}; Plane Surface(1) = {1};
turned[] = Extrude {{0, 0, 1}, {0, 0, 0}, 2*Pi} { Surface{1}; };
a = newv; Cylinder(a) = {0, 0, -ring, 0, 0, ring - groove, 140};
b = newv; Cylinder(b) = {0, 0, -ring, 0, 0, ring - groove, 85};
cut[] = BooleanDifference{ Volume{a}; Delete; }{ Volume{b}; Delete; };
For i In {0:vanes - 1}
  vane[i] = newv; Box(vane[i]) = {88, -2.5, -groove - 1, 48, 5, 2*groove + 2};
  Rotate {{0, 0, 1}, {0, 0, 0}, 2*Pi*(i + 0.5)/vanes} { Volume{vane[i]}; }
EndFor
whole[] = BooleanUnion{ Volume{turned[1]}; Delete; }{ Volume{cut[0], vane[]}; Delete; };
For i In {0:bolts - 1}
  hole[i] = newv; Cylinder(hole[i]) = {54*Cos(2*Pi*i/bolts), 54*Sin(2*Pi*i/bolts), 40, 0, 0, 20, 6.5};
EndFor
disc[] = BooleanDifference{ Volume{whole[]}; Delete; }{ Volume{hole[]}; Delete; };

// Pads, first the inner one, at -z. At both ends the lining is chamfered, 4 mm deep where it ends
For k In {0:1}
  s = 2*k - 1;
  r1 = 98; r2 = 137; half = 25; z1 = k ? ring : -back; z2 = z1 + pad; Call Sector;
  tool[0] = newv; Box(tool[0]) = {90, -1.5, k ? ring : -ring - 8, 60, 3, 8};
  For i In {0:1}
    e = 2*i - 1; c = newp; d = newl;
    Point(c) = {85, 44*e, s*ring}; Point(c + 1) = {85, 80*e, s*(ring + 18)}; Point(c + 2) = {85, 80*e, s*(ring - 1)};
    Point(c + 3) = {85, 44*e, s*(ring - 1)};
    Line(d) = {c, c + 1}; Line(d + 1) = {c + 1, c + 2}; Line(d + 2) = {c + 2, c + 3}; Line(d + 3) = {c + 3, c};
    f = newll; Curve Loop(f) = {d:d + 3}; g = news; Plane Surface(g) = {f};
    x[] = Extrude {60, 0, 0} { Surface{g}; }; tool[i + 1] = x[1];
  EndFor
  c = newp; d = newl;
  Point(c) = {80, -80, s*(ring - 1)}; Point(c + 1) = {140, -80, s*(ring - 1)}; Point(c + 2) = {140, -80, s*(ring - taper*3/39)};
  Point(c + 3) = {80, -80, s*(ring + taper*57/39)};
  Line(d) = {c, c + 1}; Line(d + 1) = {c + 1, c + 2}; Line(d + 2) = {c + 2, c + 3}; Line(d + 3) = {c + 3, c};
  f = newll; Curve Loop(f) = {d:d + 3}; g = news; Plane Surface(g) = {f};
  x[] = Extrude {0, 160, 0} { Surface{g}; }; tool[3] = x[1];
  cut[] = BooleanDifference{ Volume{made}; Delete; }{ Volume{tool[]}; Delete; }; lining[k] = cut[0];
  r1 = 91; r2 = 145; half = 25.8; z1 = k ? back : -outside; z2 = z1 + plate; Call Sector;
  a = newv; Box(a) = {104, -63.9, z1, 16, 127.9, plate};   // lugs: 0.1 mm of play at the leading end, none at the trailing one
  cut[] = BooleanUnion{ Volume{made}; Delete; }{ Volume{a}; Delete; }; plates[k] = cut[0];
  r1 = 92; r2 = 144; half = 24; z1 = k ? outside : -rear; z2 = z1 + shim; Call Sector;
  shims[k] = made;
EndFor

// Piston: a cup whose rim presses on the inner shim
a = newv; Cylinder(a) = {118, 0, -rear - 39, 0, 0, 39, 24};
b = newv; Cylinder(b) = {118, 0, -rear - 31, 0, 0, 40, 16};
cut[] = BooleanDifference{ Volume{a}; Delete; }{ Volume{b}; Delete; }; piston = cut[0];

// Caliper: barrel, bridge with a window, two fingers with lands on the outer shim, ears for the pins
r1 = 146; r2 = 164; half = 22; z1 = -78; z2 = 44; Call Sector;
bridge = made;
r1 = 102; r2 = 164; half = 22; z1 = rear + 1; z2 = 44; Call Sector;
part[0] = made;
part[1] = newv; Cylinder(part[1]) = {118, 0, -82, 0, 0, 48, 34};
part[2] = newv; Box(part[2]) = {118, -40, -78, 36, 80, 44};
part[3] = newv; Box(part[3]) = {103, -37, rear, 34, 22, 2};
part[4] = newv; Box(part[4]) = {103, 15, rear, 34, 22, 2};
part[5] = newv; Box(part[5]) = {129, -piny, -64, 24, 2*piny, 12};
part[6] = newv; Cylinder(part[6]) = {pinx, -piny, -64, 0, 0, 12, 12};
part[7] = newv; Cylinder(part[7]) = {pinx, piny, -64, 0, 0, 12, 12};
whole[] = BooleanUnion{ Volume{bridge}; Delete; }{ Volume{part[]}; Delete; };
off[0] = newv; Cylinder(off[0]) = {118, 0, -72, 0, 0, 60, 24.1};
off[1] = newv; Box(off[1]) = {90, -13, rear, 52, 26, 30};
off[2] = newv; Box(off[2]) = {130, -20, -22, 50, 40, 44};
For i In {0:1}
  off[i + 3] = newv; Cylinder(off[i + 3]) = {pinx, (2*i - 1)*piny, -70, 0, 0, 30, 5};
EndFor
caliper[] = BooleanDifference{ Volume{whole[]}; Delete; }{ Volume{off[]}; Delete; };

// Bracket: a beam that is bolted to the knuckle, and at each end an arm over the disc with an abutment for either pad
beam = newv; Box(beam) = {60, -86, -46, 24, 172, 16};
For i In {0:1}
  y = i ? 64 : -86; e = 2*i - 1;
  arm[4*i] = newv; Box(arm[4*i]) = {62, y, -46, 40, 22, 16};
  arm[4*i + 1] = newv; Box(arm[4*i + 1]) = {98, y, -46, 54, 22, 32};
  arm[4*i + 2] = newv; Box(arm[4*i + 2]) = {130, y, -46, 22, 22, 77};
  arm[4*i + 3] = newv; Box(arm[4*i + 3]) = {98, y, 14, 54, 22, 17};
  bore[2*i] = newv; Cylinder(bore[2*i]) = {72, 60*e, -50, 0, 0, 30, 6};
  bore[2*i + 1] = newv; Cylinder(bore[2*i + 1]) = {pinx, piny*e, -50, 0, 0, 30, 5};
EndFor
whole[] = BooleanUnion{ Volume{beam}; Delete; }{ Volume{arm[]}; Delete; };
bracket[] = BooleanDifference{ Volume{whole[]}; Delete; }{ Volume{bore[]}; Delete; };

// Names. Surfaces are those of one body that lie in a box; `found` collects them
near = 0.02; lo[] = {0, 0, 0}; hi[] = {0, 0, 0};
Macro Faces
  in[] = Surface In BoundingBox{lo[0] - near, lo[1] - near, lo[2] - near, hi[0] + near, hi[1] + near, hi[2] + near};
  other[] = in[]; other[] -= {Abs(Boundary{ Volume{body}; })}; in[] -= {other[]}; found[] += {in[]};
Return

Physical Volume("disc") = disc[]; Physical Volume("piston") = piston; Physical Volume("caliper") = caliper[];
Physical Volume("bracket") = bracket[];
Physical Volume("inner_lining") = lining[0]; Physical Volume("outer_lining") = lining[1];
Physical Volume("inner_plate") = plates[0]; Physical Volume("outer_plate") = plates[1];
Physical Volume("inner_shim") = shims[0]; Physical Volume("outer_shim") = shims[1];

// Bolt holes of the disc
body = disc[0];
For i In {0:bolts - 1}
  x = 54*Cos(2*Pi*i/bolts); y = 54*Sin(2*Pi*i/bolts);
  found[] = {}; lo[] = {x - 7, y - 7, 44}; hi[] = {x + 7, y + 7, 53}; Call Faces;
  seat~{i}[] = found[];
EndFor
Physical Surface("bolt0") = seat_0[]; Physical Surface("bolt1") = seat_1[]; Physical Surface("bolt2") = seat_2[];
Physical Surface("bolt3") = seat_3[]; Physical Surface("bolt4") = seat_4[];

// Faces across the axis, from the disc outwards, first those of the inner side
For k In {0:1}
  s = 2*k - 1; lo[] = {-141, -141, s*ring}; hi[] = {141, 141, s*ring};
  body = disc[0]; found[] = {}; Call Faces;
  face~{k}[] = found[];
  lo[] = {80, -80, s*ring}; hi[] = {150, 80, s*ring};
  body = lining[k]; found[] = {}; Call Faces;
  rub~{k}[] = found[];
  lo[2] = s*back; hi[2] = s*back; found[] = {}; Call Faces;
  bonded~{k}[] = found[];
  body = plates[k]; found[] = {}; Call Faces;
  front~{k}[] = found[];
  lo[2] = s*outside; hi[2] = s*outside; found[] = {}; Call Faces;
  behind~{k}[] = found[];
  body = shims[k]; found[] = {}; Call Faces;
  glued~{k}[] = found[];
  lo[2] = s*rear; hi[2] = s*rear; found[] = {}; Call Faces;
  pressed~{k}[] = found[];
  body = plates[k]; lo[] = {80, 64, -30}; hi[] = {150, 64, 30}; found[] = {}; Call Faces;
  trail~{k}[] = found[];
  lo[1] = -63.9; hi[1] = -63.9; found[] = {}; Call Faces;
  lead~{k}[] = found[];
EndFor
Physical Surface("disc_inner") = face_0[]; Physical Surface("disc_outer") = face_1[];
Physical Surface("inner_rub") = rub_0[]; Physical Surface("outer_rub") = rub_1[];
Physical Surface("inner_bond") = bonded_0[]; Physical Surface("outer_bond") = bonded_1[];
Physical Surface("inner_front") = front_0[]; Physical Surface("outer_front") = front_1[];
Physical Surface("inner_behind") = behind_0[]; Physical Surface("outer_behind") = behind_1[];
Physical Surface("inner_glue") = glued_0[]; Physical Surface("outer_glue") = glued_1[];
Physical Surface("inner_pressed") = pressed_0[]; Physical Surface("outer_pressed") = pressed_1[];
Physical Surface("inner_trail") = trail_0[]; Physical Surface("outer_trail") = trail_1[];
Physical Surface("inner_lead") = lead_0[]; Physical Surface("outer_lead") = lead_1[];

// Piston, bore and fingers; the fluid presses on the piston's base and on that of the bore
body = piston; lo[] = {90, -30, -rear}; hi[] = {150, 30, -rear}; found[] = {};
Call Faces;
rim[] = found[]; lo[2] = -rear - 39; hi[2] = lo[2]; found[] = {};
Call Faces;
fluid[] = found[];
side[] = Abs(Boundary{ Volume{piston}; }); side[] -= {rim[], fluid[]};
lo[] = {101, -17, -rear - 39}; hi[] = {135, 17, -rear}; found[] = {};
Call Faces;
side[] -= {found[]};
body = caliper[0]; lo[] = {93, -25, -72}; hi[] = {143, 25, -72}; found[] = {};
Call Faces;
base[] = found[]; hi[2] = -33; found[] = {};
Call Faces;
found[] -= {base[]};
Physical Surface("rim") = rim[]; Physical Surface("piston_side") = side[]; Physical Surface("bore") = found[];
Physical Surface("fluid") = {fluid[], base[]};
lo[] = {102, -38, rear}; hi[] = {138, 38, rear}; found[] = {};
Call Faces;
Physical Surface("lands") = found[];

// Pins, in the ears and in the bracket, abutments and the bracket's own bolts; first those at the trailing end
For k In {0:1}
  e = 1 - 2*k;
  lo[] = {pinx - 6, piny*e - 6, -64}; hi[] = {pinx + 6, piny*e + 6, -52};
  body = caliper[0]; found[] = {}; Call Faces;
  ear~{k}[] = found[];
  lo[2] = -46; hi[2] = -20; body = bracket[0]; found[] = {}; Call Faces;
  guide~{k}[] = found[];
  lo[] = {65, 60*e - 7, -46}; hi[] = {79, 60*e + 7, -30}; found[] = {}; Call Faces;
  knuckle~{k}[] = found[];
  lo[] = {50, 64*e, -46}; hi[] = {153, 64*e, 31}; found[] = {}; Call Faces;
  stop~{k}[] = found[];
EndFor
Physical Surface("trail_ear") = ear_0[]; Physical Surface("lead_ear") = ear_1[];
Physical Surface("trail_guide") = guide_0[]; Physical Surface("lead_guide") = guide_1[];
Physical Surface("trail_knuckle") = knuckle_0[]; Physical Surface("lead_knuckle") = knuckle_1[];
Physical Surface("trail_stop") = stop_0[]; Physical Surface("lead_stop") = stop_1[];

MeshSize{ PointsOf{ Volume{caliper[], bracket[]}; } } = 1.5*size;
MeshSize{ PointsOf{ Volume{disc[]}; } } = 1.4*size;
MeshSize{ PointsOf{ Volume{lining[], plates[], piston}; } } = size;
MeshSize{ PointsOf{ Volume{shims[]}; } } = 0.8*size;
Mesh.MeshSizeFromCurvature = 8;
Mesh.ElementOrder = order;
Mesh.HighOrderOptimize = 1;         // no curved element is folded
