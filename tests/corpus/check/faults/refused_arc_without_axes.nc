; An arc that goes nowhere
G21 G90 G94 G17
M3 S12000
G0 Z10
G1 Z5 F300
G2 I5 J5 R3 ; finds: error Refused error:26
G0 Z10
M5
M30
