; Both ends of the arc lie inside, its belly does not
; set: $20=1
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X150 Y150
G1 Z8 F300
G3 X150 Y190 I0 J20 F600
G2 X150 Y150 I0 J-20
G3 X150 Y190 I45 J20 ; finds: error SoftLimit ALARM:2
G0 Z10
M5
M30
