; With the tool length the depth is below the end of Z
; set: $20=1
G21 G90 G94 G17
M3 S12000
G0 Z10
G43.1 Z-12
G0 X0 Y0
G1 Z-20 F300
G1 Z-30 ; finds: error SoftLimit ALARM:2
G0 Z10
M5
M30
