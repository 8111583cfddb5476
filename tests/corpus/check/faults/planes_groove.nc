; A groove across, between flat arcs
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-1 F300
G2 X20 I10 J0 F900
G18
G2 X40 Z-1 I10 K8 ; finds: note PlanesMixed
G17
G1 X45
G0 Z10
M5
M30
