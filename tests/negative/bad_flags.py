"""A valid scene of drogue-parachute with a flag, and invalid variants of it."""

GOOD = """\
app = "parachute"
[fluid]
density = 1
viscosity = 0.005
velocity = [1, 0, 0]
[grid]
cells = [40, 24, 1]
domain = [[-1, 4], [-1.5, 1.5], [0, 0.125]]
boundary = { x = ["inflow", "outflow"], y = "slip" }
[[flag]]
leading_edge = [0.01, 0.02]
length = 1
angle = 18
area_density = 1.5
bending_stiffness = 0.0015
membrane_modulus = 200
edge_length = 0.0625
[coupling]
gravity = [0.5, 0, 0]
[run]
end_time = 2
max_dt = 0.02
[output]
history_every = 1
[verify]
[[verify.history]]
column = "flag_0_tip_y"
statistic = "frequency"
value = 0.3
tolerance = 1
"""

# The same in three dimensions: it ends within the domain, and its trailing edge has nine vertices.
WIDE = GOOD.replace("cells = [40, 24, 1]", "cells = [40, 24, 12]").replace("[0, 0.125]]", "[-0.75, 0.75]]").replace(
    'y = "slip" }', 'y = "slip", z = "slip" }').replace("edge_length = 0.0625\n", "edge_length = 0.0625\nwidth = 0.5\n")

# Replaced line, its new text, the line in the error, and words of the message.
BAD_LINES = [
    (10, "[[flags]]", 10, ['"flags"', 'did you mean "flag"?']),
    (11, "", 10, ['missing key "flag[0].leading_edge"']),
    (11, "leading_edge = [1, 2, 3]", 11, ["flag[0].leading_edge", "array of 2"]),
    (11, "leading_edge = [3.2, 0]", 11, ["flag[0] reaches", "along x", "-0.875 and 3.875"]),
    (11, "leading_edge = [0, 1.1]", 11, ["flag[0] reaches", "along y"]),
    (12, "length = 0", 12, ["flag[0].length", "> 0"]),
    (13, "angle = 200", 13, ["flag[0].angle", "180"]),
    (14, "", 10, ['missing key "flag[0].area_density"']),
    (15, "", 10, ['missing key "flag[0].bending_stiffness"']),
    (15, "bending_stiffness = -1", 15, ["flag[0].bending_stiffness", ">= 0"]),
    (16, "membrane_modulos = 200", 16, ['"flag[0].membrane_modulos"', "membrane_modulus"]),
    (17, "edge_length = 0.1", 17, ["flag[0].edge_length", "0.1", "0.0892"]),
    (17, "edge_length = 1e-7", 17, ["flag[0].edge_length", "2^20"]),
    (7, "cells = [40, 24, 4]", 9, ["grid.boundary.z"]),
    (8, "domain = [[-1, 4], [-1.5, 1.5], [0, 0]]", 8, ["grid.domain"]),
    (17, "edge_length = 0.0625\nwidth = 0.5", 18, ["flag[0].width", "several cells along z"]),
    (17, "edge_length = 0.0625\nmiddle = 0.5", 18, ["flag[0].middle", "with a width"]),
    (17, "edge_length = 0.0625\nwidth = 0", 18, ["flag[0].width", "> 0"]),
    (19, 'method = "explicit"', 19, ["coupling.method", "[[flag]]"]),
    (19, "gravity = [0, -1e4, 0]", 19, ["coupling.gravity: 1e+04 m/s^2", "an edge of flag[0]", "at most 2.13e+03 m/s^2"]),
    (19, "contact = true", 19, ["coupling.contact", "[[canopy]]"]),
    (27, 'column = "flag_0_tip_z"', 27, ["verify.history[0].column", 'did you mean "flag_0_tip_']),
]
