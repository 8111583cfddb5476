; The depth is a parameter
; on: grblhal-expr
G21 G90
M3 S1000
G0 Z5
#1=-2 ; finds: warning Computed
G1 Z#1 F100 ; finds: warning Computed
G0 Z5
M5
M30
