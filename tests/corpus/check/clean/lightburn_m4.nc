; In the manner of LightBurn: lines with dynamic power
; set: $32=1 $30=1000
; LightBurn 1.4
; GRBL device profile, absolute coords
; Bounds: X10 Y10 to X60 Y40
G00 G17 G40 G21 G54
G90
M4
; Cut @ 3000 mm/min, 80% power
M8
G0 X10Y10
; Layer C00
G1 X60S800F3000
G1 Y40
G1 X10
G1 Y10
G1 S0
G0 X20Y20
G2 X20 Y20 I5 J0 S400 F2000
M9
G1 S0
M5
G90
; return to user-defined finish pos
G0 X0Y0
M2
