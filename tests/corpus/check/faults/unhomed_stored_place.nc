; G28 on a machine that cannot be homed
; set: $22=0
; zero: none
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10
G0 Z10
M5
G91 G28 Z0 ; finds: warning UnhomedPosition
G90
M30
