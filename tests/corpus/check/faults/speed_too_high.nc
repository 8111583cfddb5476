; More than the spindle has
G21 G90
M3 S30000 ; finds: warning SpeedOutOfRange
G0 Z10
G0 X0 Y0
G1 Z-1 F300
G0 Z10
M5
M30
