; G53 on a machine that cannot be homed
; set: $22=0
; zero: none
G21 G90
M3 S1000
G53 G0 Z0 ; finds: warning UnhomedPosition
G0 X0 Y0
M5
M30
