"""A valid row of a batch, and invalid variants of it and of its file."""

import options_program

GOOD = options_program.row("good")
HEADER = options_program.HEADER

# Column values and expected words of the message; all other rows are priced.
BAD_ROWS = [
    # the domain of the parameters
    ({"beta": 7.5}, ["|beta+1| < alpha"]),
    ({"beta": -8.15}, ["|beta| < alpha"]),
    ({"beta": -9}, ["|beta| < alpha"]),
    ({"beta": 7.15}, ["|beta+1| < alpha"]),
    ({"delta": 0, "lambda": 0}, ["delta = 0 needs lambda > 0"]),
    ({"delta": 0, "lambda": -1}, ["delta = 0 needs lambda > 0"]),
    ({"lambda": 128}, ["lambda", "between -128 and 128"]),
    ({"lambda": -1e308}, ["lambda", "between -128 and 128"]),
    ({"alpha": 0}, ["alpha", "> 0"]),
    ({"alpha": -8}, ["alpha", "> 0"]),
    ({"delta": -0.1}, ["delta", ">= 0"]),
    ({"variance": -1e-9}, ["variance", ">= 0"]),
    ({"spot": 0}, ["spot", "> 0"]),
    ({"spot": -1}, ["spot", "> 0"]),
    ({"strike": 0}, ["strike", "> 0"]),
    ({"strike": -0.0}, ["strike", "> 0"]),
    ({"maturity": 0}, ["maturity", "> 0"]),
    ({"maturity": -1}, ["maturity", "> 0"]),
    # numbers that are not finite
    ({"spot": "nan"}, ['spot = "nan"', "not finite"]),
    ({"spot": "-nan"}, ["spot", "not finite"]),
    ({"strike": "inf"}, ["strike", "not finite"]),
    ({"rate": "-inf"}, ["rate", "not finite"]),
    ({"dividend": "infinity"}, ["dividend", "not finite"]),
    ({"maturity": "1e309"}, ["maturity", "not finite"]),
    ({"lambda": "-1e999"}, ["lambda", "not finite"]),
    ({"variance": "NaN"}, ["variance", "not finite"]),
    ({"delta": "1" + "0" * 400}, ["delta", "not finite", "..."]),
    ({"spot": "1e-400"}, ["spot", "> 0"]),
    # numbers whose Greeks would leave their range
    ({"spot": "1e308", "strike": "1e308"}, ["spot must lie between 1e-100 and 1e100"]),
    ({"spot": "5e-324", "strike": "5e-324"}, ["spot must lie between 1e-100 and 1e100"]),
    ({"strike": "1.1e100", "spot": "1e100"}, ["strike must lie between 1e-100 and 1e100"]),
    ({"spot": "1e25"}, ["spot/strike must lie between 1e-20 and 1e20"]),
    ({"strike": "1e25"}, ["spot/strike must lie between 1e-20 and 1e20"]),
    ({"alpha": "1e200"}, ["alpha must not be above 1e100"]),
    # texts in place of numbers
    ({"spot": "abc"}, ['spot = "abc"', "not a number"]),
    ({"spot": "1.0.0"}, ["spot", "not a number"]),
    ({"strike": "0x10"}, ["strike", "not a number"]),
    ({"rate": "5 %"}, ["rate", "not a number"]),
    ({"rate": "--1"}, ["rate", "not a number"]),
    ({"rate": "+-1"}, ["rate", "not a number"]),
    ({"alpha": "1e"}, ["alpha", "not a number"]),
    ({"beta": '"1,5"'}, ["beta", "not a number"]),
    ({"maturity": "1\0"}, ["maturity", "not a number"]),
    ({"variance": "\xa01"}, ["variance", "not a number"]),
    # empty fields
    ({"spot": ""}, ["spot is empty"]),
    ({"strike": "  "}, ["strike is empty"]),
    ({"rate": '""'}, ["rate is empty"]),
    ({"maturity": ""}, ["maturity is empty"]),
    ({"lambda": ""}, ["lambda is empty"]),
    ({"alpha": ""}, ["alpha is empty"]),
    ({"beta": ""}, ["beta is empty"]),
    ({"delta": ""}, ["delta is empty"]),
    # words
    ({"style": "amercan"}, ['style = "amercan"', 'did you mean "american"?']),
    ({"style": "bermudan"}, ["style", "american, european"]),
    ({"type": "Put"}, ['did you mean "put"?']),
    ({"type": "straddle"}, ["type", "put, call"]),
]

# Whole lines, words of the message.
BAD_LINES = [
    ("only,three,fields", ["3 fields", "13"]),
    (GOOD + ",more", ["14 fields", "13"]),
    ("x,", ["2 fields"]),
    ('"open' + GOOD, ["quoted field does not end"]),
    ('"closed"x' + GOOD, ["text follows the quote"]),
    ('in"side' + GOOD, ["quote stands inside"]),
    ("x\ty" + GOOD[4:], ["control character"]),
    ("i" * 300 + GOOD[4:], ["id is longer"]),
    ("x" * 70000, ["line is longer"]),
]

# Unreadable lines and the id that each reports. Rows around them have the ids 0, 1, 2, ...
BROKEN_LINES = [
    ("short,american,put,1,1", "short"),
    (options_program.row("long") + ",more", "long"),
    ("7,american,put,1,1", "7"),
    ('open,american,"put,1,1', "open"),
    ('"in ""quotes""",a"b', 'in "quotes"'),
    ('"open' + GOOD, ""),
    ('"closed"x' + GOOD, ""),
    ('in"side' + GOOD, ""),
    (",american,put", ""),
    ("x\ty" + GOOD[4:], ""),
    ("i" * 300 + GOOD[4:], ""),
    ("i" * 300 + ",american", ""),
    ("x" * 70000, ""),
]

# Invalid files, the line in the error, and words of the message; nothing is priced.
BAD_FILES = [
    (b"", 1, ["empty"]),
    (b"\n\n  \n", 1, ["empty"]),
    (b"\xef\xbb\xbf", 1, ["empty"]),
    (HEADER.replace("strike", "strke").encode(), 1, ['"strke"', 'did you mean "strike"?']),
    (HEADER.replace("strike", "Strike").encode(), 1, ['"Strike"', '"strike"']),
    (HEADER.replace("variance", "sigma").encode(), 1, ['"sigma"']),
    (HEADER.replace(",strike", "").encode(), 1, ['missing column "strike"']),
    (HEADER.replace(",delta", "").encode(), 1, ['missing column "delta"']),
    (HEADER.replace(",spot", "").encode(), 1, ['missing column "spot"']),
    (b"spot,strike,rate,maturity,variance\n100,100,0.05,1,0.04\n", 1, ['missing column "lambda"', 'gh', 'column "model"']),
    (b"\n\n" + HEADER.replace(",rate", "").encode(), 3, ['missing column "rate"']),
    ((HEADER + ",spot").encode(), 1, ['"spot" is named twice']),
    ((HEADER + ",").encode(), 1, ["unknown column"]),
    ((HEADER + ",price\n").encode(), 1, ["unknown column", '"price"']),
    (HEADER.replace(",", ";").encode(), 1, ["unknown column", "the separator is a semicolon"]),
    (HEADER.replace(",", "\t").encode(), 1, ["unknown column", "the separator is a tab"]),
    (f"sep=;\n{HEADER}".encode(), 1, ["the separator is a semicolon"]),
    (f"{HEADER}\n{GOOD}\n".encode("utf-16"), 1, ["the encoding is UTF-16"]),
    (f"{HEADER}\n{GOOD}\n".encode("utf-16-be"), 1, ["the encoding is UTF-16"]),
    (f"{HEADER}\n{GOOD}\n".encode("utf-32"), 1, ["the encoding is UTF-32"]),
    (f"{HEADER}\r{GOOD}\r".encode(), 1, ["the lines end in CR alone"]),
    (f"{HEADER},,\n{GOOD},,\n".encode(), 1, ["unknown column", "comma", "remove the empty columns"]),
    (b'"' + HEADER.encode(), 1, ["header", "does not end"]),
    (b"x" * 70000, 1, ["header is longer"]),
    (b"\x00\x01\x02", 1, ["unknown column"]),
    (b"\x89PNG\r\n\x1a\n" + bytes(range(256)), 1, []),
    (f"{HEADER}\n{GOOD}\n\n{GOOD}\n".encode(), 4, ['"good"', "line 2"]),
    (f'{HEADER}\n{GOOD}\n"{GOOD[:4]}"{GOOD[4:]}\n'.encode(), 3, ['"good"', "line 2"]),
    (f"{HEADER}\n2{GOOD[4:]}\n{GOOD[4:]}\n".encode(), 3, ['"2"', "line 2"]),
]

# Rows with a last column `model`, and words of the message.
BAD_MODELS = [
    ("kuo,,,,,,", ['model = "kuo"', 'did you mean "kou"?']),
    ("heston,,,,,,", ['model = "heston"', "valid names are gh, black-scholes, merton, kou"]),
    ("merton,-1,0,0.1,,,", ["intensity", ">= 0"]),
    ("merton,1,,0.1,,,", ["jump_mean is empty"]),
    ("merton,1,0,-0.1,,,", ["jump_deviation", ">= 0"]),
    ("kou,1,,,1.5,2,2", ["up_probability", "0 .. 1"]),
    ("kou,1,,,0.5,1,2", ["up_rate", "> 1"]),
    ("kou,1,,,0.5,2,0", ["down_rate", "> 0"]),
    ("black-scholes,1,,,,,", ["intensity must be empty", "black-scholes"]),
    ("gh,,,,,,", ["lambda is empty"]),
]
