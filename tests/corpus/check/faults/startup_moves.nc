; The controller moves by itself after every reset
; set: $22=0 $N0=G0X0Y0
; zero: none
; finds: warning StartupLine
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10
G0 Z10
M5
M30
