; Deeper than Z goes
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-30 F300
G1 Z-41 ; finds: warning BeyondTravel
G0 Z10
M5
M30
