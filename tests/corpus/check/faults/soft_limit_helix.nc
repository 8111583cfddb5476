; A helix goes down too far in its second half
; set: $20=1
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10 Y0
G1 Z-30 F300
G3 X10 Y0 Z-45 I-10 J0 F600 ; finds: error SoftLimit ALARM:2
G0 Z10
M5
M30
