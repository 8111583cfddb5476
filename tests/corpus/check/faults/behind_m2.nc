; A second program stands behind the first
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10
M5
M2
G21 ; finds: note BehindEnd
G0 X99 Y99
M30
