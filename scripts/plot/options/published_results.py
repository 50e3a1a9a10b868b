"""Speed and error of other programs on American puts, as published or as measured for this project."""

from ..evidence.scheme_family import PublishedResult

_PEERS = "measured for this project on one core of a Xeon, 2026-11-21; strike 100, a year, QuantLib 1.44"
_PROJ = (
    "Bermudan puts on 2048 nodes with 4 to 32, 8 to 64 and 16 to 128 dates, extrapolated, by "
    "PROJ_Option_Pricing_Matlab (commit 8fd82b2, Kirkby 2018) in GNU Octave 7.3; least of nine times an option on "
    "one core of an AMD EPYC that others shared, 2026-11-23, measured for this project"
)
_PROBE = "a prototype of this project without error estimate, one grid, 128 intervals and 32 steps"

PUBLISHED_RESULTS = (
    PublishedResult(
        "thesis", "[Shi], one option", "serial", ((2.881832, 9.1e-5), (12.050523, 1.0e-5)),
        "its Table 5.7, Quadro 6000, 512 and 4096 intervals; errors computed for this project",
    ),
    PublishedResult(
        "thesis", "[Shi], 4096 options", "serial", ((9.546837 / 4096, 4.4e-4),),
        "its Table 5.8, Quadro 6000, 128 intervals; error computed for this project",
    ),
    PublishedResult(
        "thesis", "hand-written CUDA", "cuda", ((0.25e-3 / 4096, 1.6e-5),), f"{_PROBE}, H200, kernel alone",
    ),
    PublishedResult("thesis", "hand-written AVX-512", "serial", ((1 / 7900, 3.4e-5),), f"{_PROBE}, one core"),
    PublishedResult("thesis", "PROJ", "serial", ((0.032, 3.2e-6), (0.055, 2.2e-6), (0.069, 1.2e-6)), _PROJ),
    PublishedResult("five-years", "PROJ", "serial", ((0.033, 6.9e-5), (0.038, 8.9e-6), (0.084, 3.5e-6)), _PROJ),
    PublishedResult("pure-jumps", "PROJ", "serial", ((0.031, 2.0e-6), (0.048, 1.1e-6), (0.104, 1.3e-7)), _PROJ),
    PublishedResult("merton", "PROJ", "serial", ((0.028, 2.5e-5), (0.047, 1.3e-5), (0.059, 7.8e-6)), _PROJ),
    PublishedResult("black-scholes", "PROJ", "serial", ((0.015, 1.8e-6), (0.028, 2.1e-7), (0.055, 5.4e-8)), _PROJ),
    PublishedResult(
        "black-scholes", "QuantLib FD", "serial", ((1 / 4298, 1.7e-4), (1 / 2361, 7.7e-5), (1 / 186, 1.6e-5)),
        f"FdBlackScholes, 128 x 32, 100 x 100 and 400 x 400, {_PEERS}",
    ),
    PublishedResult(
        "black-scholes", "QuantLib QdFp", "serial", ((1 / 64180, 8.7e-8), (1 / 6798, 4.1e-8)),
        f"QdFp, fast and accurate scheme, no jumps, {_PEERS}",
    ),
    PublishedResult(
        "black-scholes", "QuantLib CRR", "serial", ((1 / 337, 1.9e-5),),
        f"binomial tree of 801 steps, {_PEERS}",
    ),
    PublishedResult(
        "merton", "QuantLib FdBates", "serial", ((1 / 89, 1.8e-4), (1 / 5.2, 1.8e-4), (1 / 0.38, 1.8e-4)),
        "FdBates with frozen variance, 32 x 128 x 5 to 400 x 800 x 10, whose European prices stay 0.018 off on all "
        f"grids; the same jumps with volatility 0.2, {_PEERS}",
    ),
)
