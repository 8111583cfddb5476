; The first cut says no feed
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 X0 Y0
G1 Z-1 ; finds: error FeedMissing error:22
G0 Z10
M5
M30
