; M30 at the end of an operation
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10
M30
(second operation)
M3 S1000 ; finds: note BehindEnd
G1 X10
