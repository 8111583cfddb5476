; A word that nothing in the line uses
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10 P3 ; finds: error Refused error:36
G0 Z10
M5
M30
