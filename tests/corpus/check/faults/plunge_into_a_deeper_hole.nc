; The second peck goes further down than the first one drilled
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G0 Z1
G1 Z-2 F200
G0 Z1
G0 Z-3 ; finds: warning RapidIntoStock
G1 Z-5
G0 Z10
M5
M30
