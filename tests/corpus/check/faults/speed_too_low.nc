; Less than the spindle can
; set: $31=5000
G21 G90
S800 M3 ; finds: warning SpeedOutOfRange
G0 Z10
G0 X0 Y0
G1 Z-1 F300
G0 Z10
M5
M30
