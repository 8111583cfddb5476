; The same with rapids turned into feeds, as the free version writes them
(Pocket)
G90 G94
G17
G21
(2D Pocket1)
T2
S12000 M3
G54
G0 X20. Y20.
Z15.
G1 Z5. F1000.
Z1. F333.
G3 X18. Y20. Z0. I-1. J0. F800.
X20. Z-1. I1. J0.
X18. Z-2. I-1. J0.
G1 X22. F1000.
Y24.
X18.
Y16.
X22.
Y20.
Z15.
X40. Y40.
Z5.
Z1. F333.
G3 X38. Y40. Z0. I-1. J0. F800.
X40. Z-1. I1. J0.
G1 X44. F1000.
G1 Z15.
M5
M30
