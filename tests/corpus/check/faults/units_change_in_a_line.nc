; The other unit in the line of a cut
G20 G90
M3 S12000
G0 Z0.5
G0 X1 Y1
G1 Z-0.1 F10
G21 G1 X50 F900 ; finds: warning UnitsMixed
G0 Z10
M5
M30
