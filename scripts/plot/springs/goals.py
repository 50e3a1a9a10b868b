"""Goals for a step of drogue-springs, with values of hand-written CUDA programs (one NVIDIA H200)."""

from ..evidence.goal import STEP_US, TIME_RATIO, VERTEX_NS, Goal

_LARGE = "springs-step/cuda/1000000"

GOALS = (
    Goal("springs-step/cuda/2640", STEP_US, 4.0, 3.0, 3.84, gpu="H200"),
    Goal("springs-step/cuda/15625", STEP_US, 6.0, 4.0, 5.2, gpu="H200"),
    Goal("springs-step/cuda/100000", VERTEX_NS, 0.25, 0.2, 0.148, gpu="H200"),
    Goal(_LARGE, VERTEX_NS, 0.25, 0.2, 0.237, gpu="H200"),
    Goal(f"{_LARGE}/quadratic", TIME_RATIO, 1.6, compared_case=_LARGE, gpu="H200"),
    Goal("springs-contact/cuda/15625", STEP_US, 1000.0, 300.0, gpu="H200"),
    Goal("springs-contact/cuda/246000", STEP_US, 6000.0, gpu="H200"),
    Goal("springs-step/serial/2640", VERTEX_NS, 150.0, 110.0, 146.0),
    Goal("springs-step/serial/15625", VERTEX_NS, 200.0, 110.0, 222.0),
)
