; Only a circle sticks out
; zero: none
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G0 X0 Y290
G1 Z5 F300
G2 X0 Y290 I10 J0 F900
G2 X0 Y290 I14.5 J0 ; finds: warning LargerThanMachine
G0 Z10
M5
M30
