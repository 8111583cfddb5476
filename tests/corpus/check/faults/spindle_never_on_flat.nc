; A flat program that starts neither spindle nor laser
G21 G90
G0 X0 Y0
G1 X20 F900 ; finds: warning SpindleOff
Y20
X0
M30
