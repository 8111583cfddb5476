; In the manner of FreeCAD, grbl post-processor
(Exported by FreeCAD)
(Post Processor: grbl_post)
(Begin preamble)
G17 G90
G21
(Begin operation: Fixture)
(Path: Fixture)
G54
(Finish operation: Fixture)
(Begin operation: TC: Default Tool)
M5
M3 S10000
(Finish operation: TC: Default Tool)
(Begin operation: Profile)
(Profile)
(Compensated Tool Path. Diameter: 5.0)
G0 Z15.000
G0 X12.500 Y-2.500
G0 Z13.000
G1 X12.500 Y-2.500 Z8.000 F300.000
G1 X50.000 Y-2.500 Z8.000 F600.000
G3 X52.500 Y0.000 Z8.000 I-0.000 J2.500 F600.000
G1 X52.500 Y30.000 Z8.000 F600.000
G1 X12.500 Y30.000 Z8.000 F600.000
G1 X12.500 Y-2.500 Z8.000 F600.000
G1 X12.500 Y-2.500 Z6.000 F300.000
G1 X50.000 Y-2.500 Z6.000 F600.000
G0 Z15.000
(Finish operation: Profile)
(Begin postamble)
M5
G17 G90
M2
