; The second tool is only named
G21 G90 G94 G17
M3 S12000
G0 Z10
T1
G0 X0
G0 Z10
T2 ; finds: note ToolUsed
M3 S9000
G0 X20
G0 Z10
M5
M30
