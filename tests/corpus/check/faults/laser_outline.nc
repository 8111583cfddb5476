; One power for all, with M4
G21 G90
M4 S800 ; finds: warning LaserModeOff
G0 X0 Y0
G1 X10 F1200
Y10
X0
Y0
M5
M30
