; Sideways and up at once, out of the groove
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-2 F300
G1 X40 F900
G0 X80 Y40 Z10 ; finds: warning RapidBelowCut
G0 Z10
M5
M30
