; The zero lies on the table, and the stock is 20 mm high
G21 G90 G94 G17
M3 S12000
G0 Z10
G0 Z25
G0 X0 Y0
G1 Z18 F300
G1 X40 F900
G0 Z19
G0 X60 Y60
G0 Z12 ; finds: warning RapidIntoStock
G1 Z10 F300
G1 X80 F900
G0 Z25
G0 Z10
M5
M30
