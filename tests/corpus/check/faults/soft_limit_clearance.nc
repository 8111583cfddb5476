; The clearance height is above the machine
; set: $20=1
G21 G90 G94 G17
M3 S12000
G0 Z45 ; finds: error SoftLimit ALARM:2
