"""Goals for batches of options, with values of hand-written programs on a single grid (one NVIDIA H200)."""

from ..evidence.goal import BATCH_US, OPTION_RATE, Goal

# Times include copies, except for the probes of a single option and of the larger mesh.
GOALS = (
    Goal("options/cuda/1/128x32", BATCH_US, 60.0, 40.0, 47.0, gpu="H200"),
    Goal("options/cuda/4096/128x32", BATCH_US, 400.0, 250.0, 276.0, gpu="H200"),
    Goal("options/cuda/4096/256x64", BATCH_US, 2000.0, 1200.0, 1900.0, gpu="H200"),
    Goal("options/cuda/1000000/128x32", BATCH_US, 120e3, 70e3, gpu="H200"),
    Goal("options/serial/256/128x32", OPTION_RATE, 6500.0, 10000.0, 7900.0),
)
