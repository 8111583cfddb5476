(Facing: takes 0.5 mm off a field of 60 x 40 mm in a zigzag)
(Zero: lower left corner, top face. T1: 8 mm end mill)
G17 G21 G90 G94 G54
G0 Z5
T1 M3 S8000
G4 P1
G0 X0 Y0
G0 Z1
G1 Z-0.5 F120

(Incremental from here: over, up by 5 mm, back, up by 5 mm)
G91 F480
G1 X60
Y5
X-60
Y5
G1 X60
Y5
X-60
Y5
G1 X60
Y5
X-60
Y5
G1 X60
Y5
X-60
Y5
X60

G90
(Once around the edge)
G1 Y0
X0
Y40
X60
G0 Z5
M5
G0 X0 Y0
M2
