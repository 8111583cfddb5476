; A post-processor with drill cycles, for a firmware without them
; on: grbl
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X10 Y10
G81 X10 Y10 Z-5 R2 F200 ; finds: error UnknownWord error:20
G80
G0 Z10
M5
M30
