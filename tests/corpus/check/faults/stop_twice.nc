; Two stops, to blow the chips away
G21 G90 G94 G17
M3 S12000
G0 Z10
M0 ; finds: note Stop
G0 X10
M0 ; finds: note Stop
G0 X20
G0 Z10
M5
M30
