"""Exact solution of the Riemann problem of the 1-D Euler equations, vacuum included.

Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics (2009), chapter 4; independent of the C++ oracle.
"""

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class State:
    """Density in kg/m^3, velocity in m/s, pressure in Pa."""

    rho: float
    u: float
    p: float

    def sound_speed(self, gamma: float) -> float:
        return math.sqrt(gamma * self.p / self.rho)


def _wave(p: float, side: State, gamma: float) -> tuple[float, float]:
    """Velocity change across the wave that joins `side` to pressure p, and its derivative (Toro 4.6, 4.7, 4.37)."""
    c = side.sound_speed(gamma)
    if p > side.p:
        a = 2 / ((gamma + 1) * side.rho)
        b = (gamma - 1) / (gamma + 1) * side.p
        root = math.sqrt(a / (p + b))
        return (p - side.p) * root, root * (1 - 0.5 * (p - side.p) / (p + b))
    ratio = p / side.p
    exponent = (gamma - 1) / (2 * gamma)
    return 2 * c / (gamma - 1) * (ratio**exponent - 1), ratio ** (-(gamma + 1) / (2 * gamma)) / (side.rho * c)


def opens_vacuum(left: State, right: State, gamma: float) -> bool:
    """Whether a vacuum forms between two receding states (Toro 4.82)."""
    escape = 2 / (gamma - 1) * (left.sound_speed(gamma) + right.sound_speed(gamma))
    # The limiting case counts as vacuum, independently of round-off.
    return right.u - left.u >= escape * (1 - 1e-12)


def star_region(left: State, right: State, gamma: float) -> tuple[float, float]:
    """Pressure and velocity between the two waves. Requires `not opens_vacuum(...)`."""

    def excess(p: float) -> tuple[float, float]:
        f_left, d_left = _wave(p, left, gamma)
        f_right, d_right = _wave(p, right, gamma)
        return f_left + f_right + right.u - left.u, d_left + d_right

    # The two-rarefaction pressure is exact for two rarefactions and an upper bound otherwise. The function is
    # concave and increasing, so Newton's method from below converges monotonically.
    z = (gamma - 1) / (2 * gamma)
    c_left, c_right = left.sound_speed(gamma), right.sound_speed(gamma)
    numerator = c_left + c_right - 0.5 * (gamma - 1) * (right.u - left.u)
    p = (numerator / (c_left / left.p**z + c_right / right.p**z)) ** (1 / z)
    while excess(p)[0] > 0:
        p *= 0.5
    for _ in range(200):
        value, slope = excess(p)
        new = p - value / slope
        if abs(new - p) <= 1e-15 * new:
            break
        p = new
    u = 0.5 * (left.u + right.u + _wave(p, right, gamma)[0] - _wave(p, left, gamma)[0])
    return p, u


def _fan(xi: np.ndarray, side: State, gamma: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Density, velocity and pressure in a left rarefaction fan (Toro 4.56)."""
    c = side.sound_speed(gamma)
    factor = 2 / (gamma + 1) + (gamma - 1) / ((gamma + 1) * c) * (side.u - xi)
    # 1 at the head, 0 in vacuum; values at speeds outside the fan are discarded by the caller.
    factor = np.clip(factor, 0.0, 1.0)
    rho = side.rho * factor ** (2 / (gamma - 1))
    u = 2 / (gamma + 1) * (c + 0.5 * (gamma - 1) * side.u + xi)
    return rho, u, side.p * factor ** (2 * gamma / (gamma - 1))


def _left_of_contact(xi, side: State, p_star: float, u_star: float, gamma: float):
    """Solution left of the contact at speeds xi = x/t; p_star = 0 denotes vacuum."""
    c = side.sound_speed(gamma)
    if p_star > side.p:
        ratio, k = p_star / side.p, (gamma - 1) / (gamma + 1)
        speed = side.u - c * math.sqrt((gamma + 1) / (2 * gamma) * ratio + (gamma - 1) / (2 * gamma))
        behind = xi > speed
        rho_star = side.rho * (ratio + k) / (k * ratio + 1)
        return (
            np.where(behind, rho_star, side.rho),
            np.where(behind, u_star, side.u),
            np.where(behind, p_star, side.p),
        )
    c_star = c * (p_star / side.p) ** ((gamma - 1) / (2 * gamma))
    rho_star = side.rho * (p_star / side.p) ** (1 / gamma)
    rho, u, p = _fan(xi, side, gamma)
    ahead, behind = xi < side.u - c, xi > u_star - c_star
    return tuple(
        np.where(ahead, before, np.where(behind, after, inside))
        for before, after, inside in ((side.rho, rho_star, rho), (side.u, u_star, u), (side.p, p_star, p))
    )


def sample(xi: np.ndarray, left: State, right: State, gamma: float):
    """Density, velocity and pressure at the speeds xi = (x - x0) / t; inside a vacuum the velocity is xi."""
    xi = np.asarray(xi, dtype=float)
    mirrored = State(right.rho, -right.u, right.p)
    if opens_vacuum(left, right, gamma):
        edge_left = left.u + 2 * left.sound_speed(gamma) / (gamma - 1)
        edge_right = right.u - 2 * right.sound_speed(gamma) / (gamma - 1)
        of_left = _left_of_contact(xi, left, 0.0, edge_left, gamma)
        of_right = _left_of_contact(-xi, mirrored, 0.0, -edge_right, gamma)
        is_left, is_right = xi < edge_left, xi > edge_right
        rho = np.where(is_left, of_left[0], np.where(is_right, of_right[0], 0.0))
        u = np.where(is_left, of_left[1], np.where(is_right, -of_right[1], xi))
        p = np.where(is_left, of_left[2], np.where(is_right, of_right[2], 0.0))
        return rho, u, p
    p_star, u_star = star_region(left, right, gamma)
    of_left = _left_of_contact(xi, left, p_star, u_star, gamma)
    of_right = _left_of_contact(-xi, mirrored, p_star, -u_star, gamma)
    is_left = xi < u_star
    return (
        np.where(is_left, of_left[0], of_right[0]),
        np.where(is_left, of_left[1], -of_right[1]),
        np.where(is_left, of_left[2], of_right[2]),
    )
