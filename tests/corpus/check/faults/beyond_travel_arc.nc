; The belly of an arc
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X190 Y0
G1 Z8 F300
G3 X190 Y20 I2 J10 F600 ; finds: warning BeyondTravel
G0 Z10
M5
M30
