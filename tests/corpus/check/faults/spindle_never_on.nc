; Nobody starts the spindle
G21 G90
G0 Z10
G0 X0 Y0
G1 Z-1 F300 ; finds: warning SpindleOff
G1 X20 F900 ; finds: warning SpindleOff
G0 Z10
M30
