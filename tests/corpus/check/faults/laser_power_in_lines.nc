; Power in the lines, and the machine is no laser
G21 G90
M4 S0
G0 X0 Y0
G1 X10 F1200 S300 ; finds: warning LaserModeOff
G1 X20 S600 ; finds: warning LaserModeOff
M5
M30
