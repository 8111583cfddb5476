; G64 is what other controls have
G21 G90 G94 G17
M3 S12000
G0 Z10
G64 P0.05 ; finds: error UnknownWord error:20
G0 X10
G0 Z10
M5
M30
