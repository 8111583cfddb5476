; In the manner of pcb2gcode, in inches, with a dwell
( pcb2gcode 2.5.0 )
( Software-independent Gcode )
G94 ( Millimeters per minute feed rate. )
G20 ( Units == INCHES. )
G90 ( Absolute coordinates. )
G00 S12000 ( RPM spindle speed. )
G01 F10.00000 ( Feedrate. )
G00 Z0.40000 ( Retract )
M3 ( Spindle on clockwise. )
G04 P1 ( Wait for spindle to get up to speed )
G00 X0.51000 Y0.62000 ( rapid move to begin. )
G01 Z-0.00400 F4.0
G04 P0 ( dwell for no time -- G64 should not smooth over this point )
G01 F10.0
G01 X0.55000 Y0.62000
G01 X0.55000 Y0.70000
G01 X0.51000 Y0.70000
G01 X0.51000 Y0.62000
G00 Z0.08000
G00 Z0.40000
M5 ( Spindle off. )
M9 ( Coolant off. )
M2 ( Program end. )
