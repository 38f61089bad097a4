// Two spur gears of module 5 mm and pressure angle 20°, with 17 and 24 teeth; involute flanks. Lengths in metres.
//
//   gmsh -2 -order 2 -bin -format msh41 gears.geo -o mesh.msh
//
// The pinion turns about the origin, the wheel about (a, 0). Flanks touch on the line of action, which is
// tangent to both base circles and passes the pitch point (r_1, 0) under the pressure angle; here half a
// base pitch before and behind it, so that two pairs of teeth share the load.
SetFactory("OpenCASCADE");

module = 5e-3;
alpha = 20 * Pi / 180;
teeth_1 = 17;
teeth_2 = 24;
backlash = 0.04 * module; // by which each tooth is thinner than half of the pitch
fillet = 0.38 * module;   // radius at the root of a tooth
steps = 24;               // points along a flank, less one; closer at its base, where it is curved most
teeth[] = {};

r_1 = module * teeth_1 / 2;
r_2 = module * teeth_2 / 2;
a = r_1 + r_2;
base_pitch = Pi * module * Cos(alpha);

// Sizes of cells: where flanks touch, on teeth and inside.
fine = 0.06e-3;
on_teeth = 2.2e-3;
inside = 6e-3;

// A tooth of the gear at (x_0, 0), turned by half a turn where `turn` is -1. Its flanks start at the angles
// centre - half and centre + half on the base circle r_b and end at the tip r_a. Appends its curves to
// outline[], after the root between it and the tooth before; `flank` is the one of the larger angles.
Macro Tooth
  r_tangent = Sqrt((r_f + fillet)^2 - fillet^2);
  t_tip = Sqrt((r_a / r_b)^2 - 1);
  For side In {-1 : 1 : 2}
    start = centre + side * half;
    beta = start + side * Asin(fillet / (r_f + fillet));
    foot = newp; Point(foot) = {x_0 + turn * r_f * Cos(beta), turn * r_f * Sin(beta), 0};
    middle = newp; Point(middle) = {x_0 + turn * (r_f + fillet) * Cos(beta), turn * (r_f + fillet) * Sin(beta), 0};
    heel = newp; Point(heel) = {x_0 + turn * r_tangent * Cos(start), turn * r_tangent * Sin(start), 0};
    involute[] = {};
    For i In {0 : steps}
      t = side * t_tip * (i / steps)^1.5;
      at = newp; involute[] += at;
      Point(at) = {x_0 + turn * r_b * (Cos(start - t) - t * Sin(start - t)),
                   turn * r_b * (Sin(start - t) + t * Cos(start - t)), 0};
    EndFor
    round = newc; Circle(round) = {foot, middle, heel};
    straight = newc; Line(straight) = {heel, involute[0]};
    flank = newc; Spline(flank) = involute[];
    teeth[] += {round, straight, flank};
    If (side < 0)
      If (last > 0)
        root = newc; Circle(root) = {last, axis, foot}; outline[] += root;
      Else
        first = foot; beta_first = beta;
      EndIf
      outline[] += {round, straight, flank};
      tip = involute[steps];
    Else
      top = newc; Circle(top) = {tip, axis, involute[steps]};
      outline[] += {top, -flank, -straight, -round};
      last = foot; beta_last = beta;
    EndIf
  EndFor
Return

// The pinion, the whole of it. Its tooth 0 touches behind the pitch point, tooth 1 before it.
x_0 = 0; turn = 1;
r_b = r_1 * Cos(alpha); r_a = r_1 + module; r_f = r_1 - 1.25 * module;
half = Pi / (2 * teeth_1) + Tan(alpha) - alpha - backlash / (2 * r_1);
touching = (r_1 * Sin(alpha) - base_pitch / 2) / r_b - alpha;
axis = newp; Point(axis) = {0, 0, 0};
outline[] = {}; last = -1; flanks_1[] = {};
For k In {0 : teeth_1 - 1}
  centre = touching - half + 2 * Pi * k / teeth_1;
  Call Tooth;
  flanks_1[] += flank;
EndFor
root = newc; Circle(root) = {last, axis, first}; outline[] += root;
bore = newc; Circle(bore) = {0, 0, 0, 0.45 * r_1};
// Equal cells: among others the torque on the bore would differ from what it is in sum.
Transfinite Curve {bore} = 33;
Curve Loop(1) = outline[];
Curve Loop(2) = {bore};
Plane Surface(1) = {1, 2};

// A sector of the wheel, six teeth of it; turned by half a turn it looks as the pinion does.
x_0 = a; turn = -1;
r_b = r_2 * Cos(alpha); r_a = r_2 + module; r_f = r_2 - 1.25 * module;
half = Pi / (2 * teeth_2) + Tan(alpha) - alpha - backlash / (2 * r_2);
touching = (r_2 * Sin(alpha) - base_pitch / 2) / r_b - alpha;
axis = newp; Point(axis) = {a, 0, 0};
outline[] = {}; last = -1; flanks_2[] = {};
For k In {-2 : 3}
  centre = touching - half + 2 * Pi * k / teeth_2;
  Call Tooth;
  flanks_2[] += flank;
EndFor
r_i = 0.68 * r_2;
p = newp; Point(p) = {a - r_i * Cos(beta_last), -r_i * Sin(beta_last), 0};
q = newp; Point(q) = {a - r_i * Cos(beta_first), -r_i * Sin(beta_first), 0};
end = newc; Line(end) = {last, p};
rim = newc; Circle(rim) = {p, axis, q};
begin = newc; Line(begin) = {q, first};
Curve Loop(3) = {outline[], end, rim, begin};
Plane Surface(2) = {3};

Physical Surface("pinion") = {1};
Physical Surface("wheel") = {2};
Physical Curve("bore") = {bore};
Physical Curve("rim") = {end, rim, begin};
// In approach tooth 0 of the pinion and tooth 1 of the wheel touch, in recess tooth 1 and tooth 0.
Physical Curve("pinion flank in approach") = {flanks_1[0]};
Physical Curve("pinion flank in recess") = {flanks_1[1]};
Physical Curve("wheel flank in approach") = {flanks_2[3]};
Physical Curve("wheel flank in recess") = {flanks_2[2]};

behind = newp; Point(behind) = {r_1 - base_pitch / 2 * Sin(alpha), -base_pitch / 2 * Cos(alpha), 0};
before = newp; Point(before) = {r_1 + base_pitch / 2 * Sin(alpha), base_pitch / 2 * Cos(alpha), 0};
Field[1] = Distance; Field[1].PointsList = {behind, before};
Field[2] = Threshold; Field[2].InField = 1;
Field[2].SizeMin = fine; Field[2].DistMin = 0.25e-3;
Field[2].SizeMax = inside; Field[2].DistMax = 0.25e-3 + (inside - fine) / 0.15;
Field[3] = Distance; Field[3].CurvesList = {teeth[]}; Field[3].Sampling = 60;
Field[4] = Threshold; Field[4].InField = 3;
Field[4].SizeMin = on_teeth; Field[4].DistMin = 0;
Field[4].SizeMax = inside; Field[4].DistMax = 8e-3;
Field[6] = Min; Field[6].FieldsList = {2, 4};
Background Field = 6;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
Mesh.Algorithm = 6;
Mesh.HighOrderOptimize = 1;
