; The second fixture lies too near to the end
; set: $20=1
G21 G90 G94 G17
M3 S12000
G0 Z10
G10 L2 P2 X-50 Y-200 Z-40
G0 X40 Y0
G55
G0 X40
G0 X60 ; finds: error SoftLimit ALARM:2
G0 Z10
M5
M30
