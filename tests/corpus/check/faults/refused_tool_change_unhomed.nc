; The machine raises the tool before a change, and was not homed
; on: grblhal
; set: $22=0 $341=1
; zero: none
G21 G90
T1 M6 ; finds: note ToolChange ; finds: error Refused error:46
M30
