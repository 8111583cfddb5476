; A second program in inches was put behind the first
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X50 Y50
G1 Z-1 F300
G1 X60 F900
G0 Z10
G20 ; finds: warning UnitsMixed
G0 X2 Y2
G1 Z-0.04 F12
G0 Z0.4
G21 ; finds: warning UnitsMixed
G0 Z10
M5
M30
