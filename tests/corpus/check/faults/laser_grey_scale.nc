; Steady power that changes from pixel to pixel
G21 G90
M3 S0
G0 X0 Y0
G1 X1 F1200 S300 ; finds: warning LaserModeOff
X2 S600 ; finds: warning LaserModeOff
X3 S100 ; finds: warning LaserModeOff
M5
M30
