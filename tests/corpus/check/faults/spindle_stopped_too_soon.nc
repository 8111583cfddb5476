; M5 comes before the last pass
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-1 F300
G1 X20 F900
G0 Z5
M5
G0 X0
G1 Z-2 F300 ; finds: warning SpindleOff
G1 X20 F900 ; finds: warning SpindleOff
G0 Z10
M5
M30
