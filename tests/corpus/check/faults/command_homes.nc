; The program homes the machine itself
G21 G90
M3 S12000
; next finds: warning ControllerCommand
$H
G0 X10
M5
M30
