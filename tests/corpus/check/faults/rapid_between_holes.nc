; Between two holes the drill stays in the wood
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-5 F200
G0 Z-1
G0 X20 ; finds: warning RapidBelowCut
G1 Z-5
G0 Z10
M5
M30
