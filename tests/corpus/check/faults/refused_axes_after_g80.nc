; Axis words, and no motion in force that takes them
G21 G90 G94 G17
M3 S12000
G0 Z10
G80
X10 Y10 ; finds: error Refused error:31
G0 Z10
M5
M30
