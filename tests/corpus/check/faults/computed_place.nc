; The place is an expression
; on: grblhal-expr
G21 G90
M3 S1000
G0 Z5
G0 X[10+5] Y20 ; finds: warning Computed
G0 Z5
M5
M30
