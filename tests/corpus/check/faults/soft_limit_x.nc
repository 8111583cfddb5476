; A rapid to beyond the end of X
; set: $20=1
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X100 Y0
G0 X230 ; finds: error SoftLimit ALARM:2
G0 Z10
M5
M30
