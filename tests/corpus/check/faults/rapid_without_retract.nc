; The tool is not raised before it goes to the next place
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-2 F300
G1 X40 F900
G0 X80 Y40 ; finds: warning RapidBelowCut
G1 X100 F900
G0 Z10
M5
M30
