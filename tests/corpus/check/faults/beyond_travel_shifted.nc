; G92 shifts the part out of the machine
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X150 Y0
G92 X0
G0 X40
G0 X60 ; finds: warning BeyondTravel
G92.1
G0 Z10
M5
M30
