; No S word anywhere
G21 G90
M3 ; finds: warning SpeedMissing
G0 Z10
G0 X0 Y0
G1 Z-1 F300
G1 X20 F900
G0 Z10
M5
M30
