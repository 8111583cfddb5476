; The same in small steps
; zero: none
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G91
G0 Y150
G0 Y100
G0 Y60 ; finds: warning LargerThanMachine
G0 Z10
M5
M30
