; The program changes a setting
; next finds: warning ControllerCommand
$110=3000
G21 G90
G0 X10
M30
