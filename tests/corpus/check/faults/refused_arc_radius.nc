; An arc that cannot reach its end with this radius
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-1 F300
G2 X20 Y0 R5 F600 ; finds: error Refused error:34
G1 X20 F600
G0 Z10
M5
M30
