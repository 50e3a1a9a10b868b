"""Goals for a step of flow, with values of hand-written CUDA programs (one NVIDIA H200)."""

from ..evidence.goal import CELL_NS, FLIGHT_MS, STEP_US, Goal

_LARGE = "flow-step/cuda/256x256x256"

GOALS = (
    Goal(f"{_LARGE}/periodic", CELL_NS, 0.2, 0.12, 0.150, gpu="H200"),
    Goal(f"{_LARGE}/periodic/rk3", CELL_NS, 0.55, 0.4, 0.45, gpu="H200"),
    Goal(f"{_LARGE}/tunnel", CELL_NS, 0.35, 0.2, gpu="H200"),
    Goal("flow-step/cuda/60x60x120/tunnel", STEP_US, 120.0, 70.0, gpu="H200"),
    Goal("flow-step/openmp/64x64x64/periodic", CELL_NS, 150.0, 100.0),
)

_FLIGHT = "parachute-flight/cuda"

FLIGHT_GOALS = (
    Goal(f"{_FLIGHT}/60x60x120/c9", FLIGHT_MS, 1000.0, 500.0, gpu="H200"),
    Goal(f"{_FLIGHT}/120x120x240/c9", FLIGHT_MS, 10000.0, 3750.0, gpu="H200"),
    Goal("parachute-flight/openmp/40x40x80/c9", FLIGHT_MS, 300000.0, 120000.0),
)

BYTES_PER_CELL = (130.0, 100.0)  # goal and stretch for the memory of a solver on 512^3 cells
