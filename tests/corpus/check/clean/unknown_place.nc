; Nobody knows where the machine stands, or where its zero is
; zero: none
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-2 F300
G1 X100 F900
G2 X110 Y10 I0 J10
G0 Z10
G0 X0 Y0
M5
M30
