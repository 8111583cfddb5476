; In the manner of jscut
G21         ; Set units to mm
G90         ; Absolute positioning
M3 S12000   ; Start spindle
G0 Z2.5400  ; Move to clearance level
;
; Operation:    0
; Name:         Pocket
; Path 0
; Rapid to initial position
G0 X20.0000 Y20.0000
G0 Z0.0000
; plunge
G1 Z-1.0000 F127
; cut
G1 X30.0000 Y20.0000 F1016
G1 X30.0000 Y30.0000
G1 X20.0000 Y30.0000
G1 X20.0000 Y20.0000
; plunge
G1 Z-2.0000 F127
; cut
G1 X30.0000 Y20.0000 F1016
G1 X30.0000 Y30.0000
G1 X20.0000 Y30.0000
G1 X20.0000 Y20.0000
; Retract
G0 Z2.5400
M5
M2
