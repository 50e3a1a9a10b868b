"""What a step of the gas mini-app is to cost, and what small hand-written CUDA programs reached (one NVIDIA H200)."""

from dataclasses import dataclass

STEP_US = "\u00b5s a step"
CELL_NS = "ns a cell-step"
VERTEX_NS = "ns a vertex-step"
RATE = "G cell-steps/s"
# These compare with the case named in `beside`, of the same run.
TIME_RATIO = "times as long"
SPEED_UP = "times as fast"
EFFICIENCY = "of the rate of all cores"

OPTION_RATE = "options/s"

HIGHER_IS_BETTER = {RATE, OPTION_RATE, SPEED_UP, EFFICIENCY}


@dataclass(frozen=True)
class Goal:
    """Bar of one case; `gpu`: part of the name of the GPU that it holds for, empty: the cores of any host build."""

    case: str
    measure: str
    goal: float
    stretch: float | None = None
    probe: float | None = None
    beside: str = ""
    gpu: str = ""
    vector_bits: int = 0  # width of the vectors that it holds for; 0: any


_LARGE = "gas-step/cuda/16777216"
_CORE = "gas-step/serial/8192"
_DENSE = "gas-step/dense-loop/8192"

GOALS = (
    Goal("gas-step/cuda/1024", STEP_US, 4.5, 3.5, 4.15, gpu="H200"),
    Goal("gas-step/cuda/8192", STEP_US, 5.0, 3.0, 4.47, gpu="H200"),
    Goal("gas-step/cuda/65536", STEP_US, 11.0, 9.0, 10.9, gpu="H200"),
    Goal(_LARGE, RATE, 8.5, 10.0, 9.0, gpu="H200"),
    Goal(f"{_LARGE}/split", RATE, 11.0, 14.0, 11.6, gpu="H200"),
    Goal(f"{_LARGE}/on", TIME_RATIO, 1.25, 1.1, beside=_LARGE, gpu="H200"),
    Goal(f"{_LARGE}/auto", TIME_RATIO, 1.03, 1.01, beside=_LARGE, gpu="H200"),
    Goal(f"{_LARGE}/z", TIME_RATIO, 1.2, 1.1, beside=_LARGE, gpu="H200"),
    Goal(f"{_LARGE}/teno5", TIME_RATIO, 1.2, 1.1, beside=_LARGE, gpu="H200"),
    Goal(_CORE, CELL_NS, 55.0, 40.0, vector_bits=512),
    Goal(_CORE, CELL_NS, 68.0, 40.0, vector_bits=256),
    Goal(_CORE, SPEED_UP, 7.0, beside=_DENSE, vector_bits=512),
    Goal(_CORE, SPEED_UP, 6.0, beside=_DENSE, vector_bits=256),
    Goal("gas-step/openmp/1048576", EFFICIENCY, 0.85, beside="gas-step/serial/1048576"),
)
