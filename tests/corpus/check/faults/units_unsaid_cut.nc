; Inches or millimetres?
G90 G94 G17
M3 S12000
G1 Z10 F300 ; finds: note UnitsUnsaid
G1 X10 F900
M5
M30
