// Disc, pad and beam of options/massi2005.yaml in free tetrahedra, m; the faces of pad and disc as they fall. size: of
// elements of the disc and the beam, fine: under the pad
SetFactory("OpenCASCADE");
If (!Exists(size)) size = 0.009; EndIf
If (!Exists(fine)) fine = 0.0025; EndIf
Cylinder(1) = {0, 0, -0.01, 0, 0, 0.01, 0.12};
Cylinder(2) = {0, 0, -0.01, 0, 0, 0.01, 0.05};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Box(4) = {0.105, -0.005, 0, 0.01, 0.01, 0.01};
Box(5) = {0.105, -0.005, 0.01, 0.01, 0.01, 0.02};
Box(6) = {0.105, -0.005, 0.03, 0.01, 0.01, 0.06};
Box(7) = {0.105, -0.005, 0.09, 0.01, 0.01, 0.02};
BooleanFragments{ Volume{4}; Volume{5, 6, 7}; Delete; }{}
e = 1e-6;
Physical Volume("disc") = {3};
Physical Volume("pad") = {4};
Physical Volume("beam") = {5, 6, 7};
Physical Surface("disc_inner") = Surface In BoundingBox {-0.05-e, -0.05-e, -0.01-e, 0.05+e, 0.05+e, e};
pad[] = Surface In BoundingBox {0.105-e, -0.005-e, -e, 0.115+e, 0.005+e, e};
Physical Surface("pad_face") = pad[];
face[] = Surface In BoundingBox {-0.13, -0.13, -e, 0.13, 0.13, e};
face[] -= pad[];
Physical Surface("disc_face") = face[];
Physical Surface("beam_top") = Surface In BoundingBox {0.105-e, -0.005-e, 0.11-e, 0.115+e, 0.005+e, 0.11+e};
r[] = {};
For z In {0.03 : 0.09 : 0.06}
  For y In {-0.005 : 0.005 : 0.01}
    r[] += Curve In BoundingBox {0.105-e, y-e, z-e, 0.115+e, y+e, z+e};
  EndFor
EndFor
Physical Curve("beam_rows") = r[];
Field[1] = Box;
Field[1].VIn = fine;
Field[1].VOut = size;
Field[1].XMin = 0.1;
Field[1].XMax = 0.12;
Field[1].YMin = -0.01;
Field[1].YMax = 0.01;
Field[1].ZMin = -0.01;
Field[1].ZMax = 0.0101;
Field[1].Thickness = 0.02;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.CharacteristicLengthExtendFromBoundary = 0;
