; Two decimal points in a number
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10
G1 Y1.2.3 F300 ; finds: error Refused error:1
G0 Z10
M5
M30
