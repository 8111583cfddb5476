; In the manner of LightBurn: a picture in grey, relative
; set: $32=1 $30=1000
; at: -200 -200 -40
; LightBurn 1.4
G00 G17 G40 G21 G54
G91
M3
; Scan @ 4000 mm/min, 40% power
G0 X10Y10
G1 X2S0F4000
G1 X0.1S120
G1 X0.1S400
G1 X0.3S240
G1 X2S0
G0 Y0.1
G1 X-2S0
G1 X-0.3S240
G1 X-0.1S400
G1 X-0.1S120
G1 X-2S0
G1 S0
M5
G90
G0 X0Y0
M2
