; Inches or millimetres?
G90 G94 G17
M3 S12000
G0 Z10 ; finds: note UnitsUnsaid
G0 X10 Y10
M5
M30
