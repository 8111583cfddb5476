; G41 needs a control that knows the radius of the tool
; on: grbl rabbit
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10 Y10
G41 D1 ; finds: error UnknownWord error:20
G1 X20 F600
G40
G0 Z10
M5
M30
