; Three tools, and no M6
G21 G90
T1 M3 S1000
G0 Z10
T2 ; finds: note ToolUsed
G0 X10
T3 ; finds: note ToolUsed
G0 X20
M5
M30
