; Nothing guards the end of Y
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G0 Y205 ; finds: warning BeyondTravel
G0 Y0
G0 Z10
M5
M30
