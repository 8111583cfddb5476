; Small steps, one too many
; set: $20=1
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X150 Y0
G91
G0 X20
G0 X20
G0 X20 ; finds: error SoftLimit ALARM:2
G0 Z10
M5
M30
