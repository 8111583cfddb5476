; A word that stands twice in a line
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10 X20 ; finds: error Refused error:25
G0 Z10
M5
M30
