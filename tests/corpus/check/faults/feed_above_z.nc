; The plunge is faster than Z goes
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-1 F3500 ; finds: warning FeedTooHigh
G1 X100 Y100
G0 Z10
M5
M30
