; Drill cycles, as a post-processor for grblHAL writes them
; on: grblhal
G21 G90 G94 G17 G54
M3 S6000
G0 Z10
G98 G83 X10 Y10 Z-8 R2 Q2 F150
X30
Y30
X10
G80
G99 G81 X50 Y10 Z-4 R2 F150
Y30
G80
G0 Z10
M5
M30
