"""Measures of benchmark cases, and goals for their values."""

from dataclasses import dataclass

# Labels of measures, as the pages print them.
STEP_US = "\u00b5s per step"
FLIGHT_MS = "ms per s of flight"
CELL_NS = "ns per cell-step"
VERTEX_NS = "ns per vertex-step"
RATE = "G cell-steps/s"
BATCH_US = "\u00b5s per batch"
OPTION_US = "\u00b5s per option"
OPTION_RATE = "options/s"
# Measures relative to `Goal.compared_case` of the same run.
TIME_RATIO = "times as long"
SPEED_UP = "times as fast"
EFFICIENCY = "of the rate of all cores"

HIGHER_IS_BETTER = {RATE, OPTION_RATE, SPEED_UP, EFFICIENCY}


@dataclass(frozen=True)
class Goal:
    """Goal for one measure of one case, with a more ambitious `stretch` goal.

    `probe` is the value of a small hand-written program. `gpu` is part of the name of the GPU for which the goal
    holds; it is empty for goals of host cores.
    """

    case: str
    measure: str
    goal: float
    stretch: float | None = None
    probe: float | None = None
    compared_case: str = ""
    gpu: str = ""
    vector_bits: int = 0  # width of the host's vector registers for which the goal holds; 0: any
