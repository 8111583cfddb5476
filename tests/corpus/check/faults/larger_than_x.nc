; The part is longer than the axis
; zero: none
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X-100 Y0
G1 Z-1 F300
G1 X290 F900
G1 X305 ; finds: warning LargerThanMachine
G0 Z10
M5
M30
