"""What a batch of options is to cost, and what hand-written programs reached that solve on one grid (one NVIDIA H200)."""

from .gas_goals import OPTION_RATE, Goal

BATCH_US = "\u00b5s a batch"
OPTION_US = "\u00b5s an option"

# With copies; the probes of a single option and of the larger mesh without.
GOALS = (
    Goal("options/cuda/1/128x32", BATCH_US, 60.0, 40.0, 47.0, gpu="H200"),
    Goal("options/cuda/4096/128x32", BATCH_US, 400.0, 250.0, 276.0, gpu="H200"),
    Goal("options/cuda/4096/256x64", BATCH_US, 2000.0, 1200.0, 1900.0, gpu="H200"),
    Goal("options/cuda/1000000/128x32", BATCH_US, 120e3, 70e3, gpu="H200"),
    Goal("options/serial/256/128x32", OPTION_RATE, 6500.0, 10000.0, 7900.0),
)
