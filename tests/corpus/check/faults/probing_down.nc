; Looks for the plate, and nobody has said that there is one
; surface: -45
G21 G90
G0 X0 Y0
G38.2 Z-20 F100 ; finds: warning Probing
G92 Z0
G0 Z5
M30
