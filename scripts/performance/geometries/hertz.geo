SetFactory("OpenCASCADE");
Rectangle(1) = {0, -2, 0, 2, 2};
Physical Surface("cylinder") = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("axis") = {4};
MeshSize {:} = 0.5;
