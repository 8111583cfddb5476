; G0 instead of G1, straight into the material
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G0 Z-2 ; finds: warning RapidIntoStock
G1 X40 F900
G0 Z10
M5
M30
