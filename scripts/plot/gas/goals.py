"""Goals for a step of drogue-gas, with values of hand-written CUDA programs (one NVIDIA H200)."""

from ..evidence.goal import CELL_NS, EFFICIENCY, RATE, SPEED_UP, STEP_US, TIME_RATIO, Goal

_LARGE = "gas-step/cuda/16777216"
_CORE = "gas-step/serial/8192"
_DENSE = "gas-step/dense-loop/8192"

GOALS = (
    Goal("gas-step/cuda/1024", STEP_US, 4.5, 3.5, 4.15, gpu="H200"),
    Goal("gas-step/cuda/8192", STEP_US, 5.0, 3.0, 4.47, gpu="H200"),
    Goal("gas-step/cuda/65536", STEP_US, 11.0, 9.0, 10.9, gpu="H200"),
    Goal(_LARGE, RATE, 8.5, 10.0, 9.0, gpu="H200"),
    Goal(f"{_LARGE}/split", RATE, 11.0, 14.0, 11.6, gpu="H200"),
    Goal(f"{_LARGE}/on", TIME_RATIO, 1.25, 1.1, compared_case=_LARGE, gpu="H200"),
    Goal(f"{_LARGE}/auto", TIME_RATIO, 1.03, 1.01, compared_case=_LARGE, gpu="H200"),
    Goal(f"{_LARGE}/z", TIME_RATIO, 1.2, 1.1, compared_case=_LARGE, gpu="H200"),
    Goal(f"{_LARGE}/teno5", TIME_RATIO, 1.2, 1.1, compared_case=_LARGE, gpu="H200"),
    Goal(_CORE, CELL_NS, 55.0, 40.0, vector_bits=512),
    Goal(_CORE, CELL_NS, 68.0, 40.0, vector_bits=256),
    Goal(_CORE, SPEED_UP, 7.0, compared_case=_DENSE, vector_bits=512),
    Goal(_CORE, SPEED_UP, 6.0, compared_case=_DENSE, vector_bits=256),
    Goal("gas-step/openmp/1048576", EFFICIENCY, 0.85, compared_case="gas-step/serial/1048576"),
)
