(Coaster: 36 x 36 mm, three wooden layers deep, with a flower and eight holes)
(Zero: lower left corner of the stock, top face. Stock 60 x 40 x 3 mm)
(T1: 3 mm end mill. T2: 2 mm drill)
G17 G21 G40 G49 G54
G80 G90 G94
G0 Z5

(T1: end mill)
T1
M3 S10000
G4 P1
M8

(Flower: six petals, each of two arcs through the centre)
G0 X30 Y20
G0 Z1
G1 Z-0.8 F120
G2 X41 Y20 R9 F380
G2 X30 Y20 R9
G2 X35.5 Y29.526 R9
G2 X30 Y20 R9
G2 X24.5 Y29.526 R9
G2 X30 Y20 R9
G2 X19 Y20 R9
G2 X30 Y20 R9
G2 X24.5 Y10.474 R9
G2 X30 Y20 R9
G2 X35.5 Y10.474 R9
G2 X30 Y20 R9
G0 Z2

(Ring: a full circle twice, 0.8 mm deeper each time)
G0 X44 Y20
G0 Z0.5
G1 Z-0.8 F120
G3 X44 Y20 I-14 J0 F400
G1 Z-1.6 F120
G3 X44 Y20 I-14 J0 F400
G0 Z2

(Thumb notch: an arc in the XZ plane, three cuts side by side)
G18
G0 X27 Y18.5
G1 Z0 F150
G2 X33 Z0 I3 K4 F250
G0 Z2
G0 X27 Y20
G1 Z0 F150
G2 X33 Z0 I3 K4 F250
G0 Z2
G0 X27 Y21.5
G1 Z0 F150
G2 X33 Z0 I3 K4 F250
G0 Z2
G17

(Outline: rounded square, down a helix in the first corner, three depths)
G0 X10.5 Y6.5
G0 Z0.5
G1 Z0 F120
G3 X16.5 Y0.5 Z-1 I6 J0 F300
G1 X43.5 F450
G3 X49.5 Y6.5 I0 J6
G1 Y33.5
G3 X43.5 Y39.5 I-6 J0
G1 X16.5
G3 X10.5 Y33.5 I0 J-6
G1 Y6.5
G3 X16.5 Y0.5 Z-2 I6 J0 F300
G1 X43.5 F450
G3 X49.5 Y6.5 I0 J6
G1 Y33.5
G3 X43.5 Y39.5 I-6 J0
G1 X16.5
G3 X10.5 Y33.5 I0 J-6
G1 Y6.5
G3 X16.5 Y0.5 Z-3 I6 J0 F300
G1 X43.5 F450
G3 X49.5 Y6.5 I0 J6
G1 Y33.5
G3 X43.5 Y39.5 I-6 J0
G1 X16.5
G3 X10.5 Y33.5 I0 J-6
G1 Y6.5
(The last corner once more, at full depth)
G3 X16.5 Y0.5 I6 J0
G0 Z5
M9
M5

(T2: drill. The tool number is told; nobody has to be there to change it)
T2
M3 S6000
G4 P1

(Eight holes on a circle of 17 mm, pecked in three steps)
G0 X45.706 Y26.506
G0 Z1
G1 Z-1 F100
G0 Z1
G0 Z-0.8
G1 Z-2
G0 Z1
G0 Z-1.8
G1 Z-3.2
G0 Z1
G0 X36.506 Y35.706
G1 Z-1 F100
G0 Z1
G0 Z-0.8
G1 Z-2
G0 Z1
G0 Z-1.8
G1 Z-3.2
G0 Z1
G0 X23.494 Y35.706
G1 Z-1 F100
G0 Z1
G0 Z-0.8
G1 Z-2
G0 Z1
G0 Z-1.8
G1 Z-3.2
G0 Z1
G0 X14.294 Y26.506
G1 Z-1 F100
G0 Z1
G0 Z-0.8
G1 Z-2
G0 Z1
G0 Z-1.8
G1 Z-3.2
G0 Z1
G0 X14.294 Y13.494
G1 Z-1 F100
G0 Z1
G0 Z-0.8
G1 Z-2
G0 Z1
G0 Z-1.8
G1 Z-3.2
G0 Z1
G0 X23.494 Y4.294
G1 Z-1 F100
G0 Z1
G0 Z-0.8
G1 Z-2
G0 Z1
G0 Z-1.8
G1 Z-3.2
G0 Z1
G0 X36.506 Y4.294
G1 Z-1 F100
G0 Z1
G0 Z-0.8
G1 Z-2
G0 Z1
G0 Z-1.8
G1 Z-3.2
G0 Z1
G0 X45.706 Y13.494
G1 Z-1 F100
G0 Z1
G0 Z-0.8
G1 Z-2
G0 Z1
G0 Z-1.8
G1 Z-3.2
G0 Z1

(Done: up, spindle off, back to zero)
G0 Z5
M5
G0 X0 Y0
M30
