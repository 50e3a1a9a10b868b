"""A valid scene of drogue-parachute with a body, and invalid variants of it."""

GOOD = """\
app = "parachute"
[fluid]
velocity = [1, 0, 0]
[grid]
cells = [16, 8, 8]
domain = [[0, 1.6], [0, 0.8], [0, 0.8]]
boundary = { x = ["inflow", "outflow"], y = "slip", z = "periodic" }
[[body]]
kind = "plate"
normal = "x"
centre = [0.8, 0.4, 0.4]
lengths = [0.4, 0.8]
edge_length = 0.05
porosity = { law = "forchheimer", alpha = 10, beta = 1 }
[coupling]
filter = 0.5
[run]
end_time = 0.1
max_dt = 0.01
[verify]
force = [{ body = 0, axis = "x", value = 1, tolerance = 1 }]
"""

# Replaced line, its new text, the line in the error, and words of the message.
BAD_LINES = [
    # unknown keys and names
    (8, "[[boby]]", 8, ['"boby"', 'did you mean "body"?']),
    (9, 'kind = "plat"', 9, ["body[0].kind", 'did you mean "plate"?']),
    (9, 'kynd = "plate"', 9, ['"body[0].kynd"', "kind"]),
    (10, 'normal = "w"', 10, ["body[0].normal", '"x"']),
    (13, "edge = 0.05", 13, ['"body[0].edge"', "edge_length"]),
    (14, 'porosity = { law = "forcheimer" }', 14, ["body[0].porosity.law", 'did you mean "forchheimer"?']),
    (14, "porosity = { lov = 1 }", 14, ['"body[0].porosity.lov"', "law"]),
    (15, "[copling]", 15, ['"copling"', 'did you mean "coupling"?']),
    # missing keys
    (9, "", 8, ['missing key "body[0].kind"']),
    (10, "", 8, ['missing key "body[0].normal"']),
    (11, "", 8, ['missing key "body[0].centre"']),
    (12, "", 8, ['missing key "body[0].lengths"']),
    (13, "", 8, ['missing key "body[0].edge_length"']),
    (19, "", 17, ['missing key "run.max_dt"', "[[body]]"]),
    # types and ranges
    (8, "[body]", 8, ["body", "array"]),
    (11, "centre = [0.8, 0.4]", 11, ["body[0].centre", "array of 3"]),
    (12, "lengths = [0.4, 0.8, 1]", 12, ["body[0].lengths", "array of 2"]),
    (12, "lengths = [0.4, 0]", 12, ["body[0].lengths[1]", "> 0"]),
    (13, "edge_length = -1", 13, ["body[0].edge_length", "> 0"]),
    (14, 'porosity = { law = "forchheimer", alpha = -1 }', 14, ["body[0].porosity.alpha", ">= 0"]),
    (14, 'porosity = { law = "forchheimer", beta = "2" }', 14, ["body[0].porosity.beta", "number"]),
    (16, "filter = 1.5", 16, ["coupling.filter", "0 .. 1"]),
    # contradictions
    (14, 'porosity = { law = "none", alpha = 10 }', 14, ["body[0].porosity.alpha", "forchheimer"]),
    (11, "centre = [1.55, 0.4, 0.4]", 11, ["body[0]", "1.55", "along x", "1.5"]),
    (12, "lengths = [0.7, 0.8]", 12, ["body[0]", "along y", "between 0.1 and 0.7"]),
    (12, "lengths = [0.4, 0.9]", 12, ["body[0]", "along z", "between 0.0 and 0.8"]),
    (13, "edge_length = 0.1", 13, ["body[0].edge_length", "0.1", "0.0714"]),
    (13, "edge_length = 1e-4", 13, ["body[0].edge_length", "vertices", "2^20"]),
    (21, 'force = [{ body = 1, axis = "x", value = 1, tolerance = 1 }]', 21, ["verify.force[0].body = 1", "number of bodies is 1"]),
    (21, 'force = [{ body = 0, axis = "x", value = 0, tolerance = 1 }]', 21, ["verify.force[0].value", "relative"]),
]
