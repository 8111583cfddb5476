; The controller starts the spindle by itself
; set: $N1=M3S1000
; finds: warning StartupLine
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10
G0 Z10
M5
M30
