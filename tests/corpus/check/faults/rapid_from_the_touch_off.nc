; The tool still stands on the stock where its zero was set
; at: -200 -200 -40
G21 G90 G94 G17
M3 S12000
G0 X50 Y50 ; finds: warning RapidBelowCut
G0 Z5
G1 Z-2 F300
G1 X80 F900
G0 Z5
M5
M30
