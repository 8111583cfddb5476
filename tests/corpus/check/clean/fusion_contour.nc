; In the manner of Fusion 360: contour with ramp, retracts to machine zero
(1001)
(Machine)
(  vendor: Generic)
(T1  D=6. CR=0. - ZMIN=-6. - flat end mill)
G90 G94
G17
G21
G28 G91 Z0.
G90
(2D Contour1)
T1
S15000 M3
G54
G0 X42.3 Y-3.6
Z15.
Z5.
G1 Z1. F333.
X42. Y-3.4 Z0.2 F1000.
X40. Y-3. Z-0.5
X0. Z-2.
G2 X-3. Y0. I0. J3.
G1 Y40.
G2 X0. Y43. I3. J0.
G1 X60.
G2 X63. Y40. I0. J-3.
G1 Y0.
G2 X60. Y-3. I-3. J0.
G1 X40.
X0. Z-4.
G2 X-3. Y0. I0. J3.
G1 Y40.
G2 X0. Y43. I3. J0.
G1 X60.
G2 X63. Y40. I0. J-3.
G1 Y0.
G2 X60. Y-3. I-3. J0.
G1 X40.
G1 Z15. F1000.
G0 X42.3 Y-3.6
M5
G28 G91 Z0.
G90
G28 G91 X0. Y0.
G90
M30
