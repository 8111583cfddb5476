; Two units in one line
G21 G90 G94 G17
M3 S12000
G0 Z10
G20 G21 X10 ; finds: error Refused error:21
G0 Z10
M5
M30
