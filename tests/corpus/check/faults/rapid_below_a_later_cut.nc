; The first rapid goes lower than the top that is faced later
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 Z3
G0 X0 Y0 ; finds: warning RapidBelowCut
G0 Z15
G1 Z7 F300
G1 X40 F900
G0 Z10
M5
M30
