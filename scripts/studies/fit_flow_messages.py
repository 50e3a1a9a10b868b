#!/usr/bin/env python3
"""Fits the machine of `drogue-perf extrapolate` to times of two GPUs.

    scripts/studies/fit_flow_messages.py

Data: docs/flow-notebook.md, "Several GPUs". A step of n^3 cells on one GPU takes a + b n^3, and the messages of a step between two take
5 L + 8 bytes 22 n^2 / B: ghost cells, two single layers, a gather and an all-reduce wait for one another, with the numbers that
a rank sends. Least squares of the relative errors.
"""

import math

STEPS = {128: 0.484e-3, 256: 3.15e-3, 512: 25.1e-3}  # s, on one GPU
MESSAGES = {128: 53e-6, 256: 83e-6, 512: 171e-6}  # s, of two


def fit(rows):
    """Coefficients a, b of y = a u + b v for rows (u, v, y), with weights 1 / y."""
    uu, uv, vv, u1, v1 = (math.fsum(f(u / y, v / y) for u, v, y in rows) for f in (
        lambda u, v: u * u, lambda u, v: u * v, lambda u, v: v * v, lambda u, v: u, lambda u, v: v))
    determinant = uu * vv - uv * uv
    return (u1 * vv - v1 * uv) / determinant, (v1 * uu - u1 * uv) / determinant


def main():
    fixed, per_cell = fit([(1, n**3, time) for n, time in STEPS.items()])
    latency, per_byte = fit([(5, 8 * 22 * n**2, time) for n, time in MESSAGES.items()])
    print(f"--fixed-us {1e6 * fixed:.0f} --cell-ns {1e9 * per_cell:.3f} --link {1e6 * latency:.1f} {1e-9 / per_byte:.0f}")


if __name__ == "__main__":
    main()
