; G38.3 goes on without contact
; surface: -45
G21 G91
G38.3 Z-60 F100 ; finds: warning Probing
G0 Z2
G90
M30
