; The operator turns the part
G21 G90
M3 S1000
G0 Z10
M0 ; finds: note Stop
G0 X10
M5
M30
