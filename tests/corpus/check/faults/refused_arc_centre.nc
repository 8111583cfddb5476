; The centre lies nearer to the start than to the end
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-1 F300
G3 X10 Y10 I1 J0 F600 ; finds: error Refused error:33
G0 Z10
M5
M30
