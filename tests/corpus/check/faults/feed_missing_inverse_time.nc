; In inverse time every line needs its F
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z5 F300
G93
G1 X10 F2
G1 X20 ; finds: error FeedMissing error:22
G94
G0 Z10
M5
M30
