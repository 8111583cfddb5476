; The plane of the lead-in is left on
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-1 F300
G3 X10 I5 J0 F900
G19
G3 Y20 Z-1 J10 K20 ; finds: note PlanesMixed
G17
G3 X20 I5 J0 ; finds: note PlanesMixed
G0 Z10
M5
M30
