"""Scalar quantities of the fields of a flow: components, magnitudes, pressure, vorticity and Q-criterion."""

from dataclasses import dataclass

import numpy as np

from ..run_directory import Run, Snapshot
from .plane import AXES, cell_counts, dimension


@dataclass(frozen=True)
class Quantity:
    """Scalar of a dataset of fields.h5: one component of a vector, its magnitude (component None), or a scalar."""

    name: str
    label: str
    dataset: str
    units: str
    component: int | None = None

    def values(self, snapshot: Snapshot) -> np.ndarray:
        """Values at the cell centres, (nx, ny, nz)."""
        values = snapshot.fields[self.dataset].values
        if values.ndim == 3:
            return values
        return np.linalg.norm(values, axis=-1) if self.component is None else values[..., self.component]

    @property
    def is_deviation(self) -> bool:
        """Whether 0 is the undisturbed value, so that positive and negative values are compared."""
        return self.dataset == "q_criterion" or (self.dataset == "vorticity" and self.component is not None)


def quantities(run: Run) -> dict[str, Quantity]:
    """Quantities of the last snapshot by name; the ones drawn by default come first."""
    fields = run.snapshots[-1].fields
    usual, rest = [], []
    if (velocity := fields.get("velocity")) is not None:
        usual.append(Quantity("speed", "speed", "velocity", velocity.units))
        rest += [
            Quantity(f"velocity_{axis}", f"velocity along {axis}", "velocity", velocity.units, component)
            for component, axis in enumerate(AXES)
        ]
    if (pressure := fields.get("pressure")) is not None:
        usual.append(Quantity("pressure", "pressure", "pressure", pressure.units))
    if (vorticity := fields.get("vorticity")) is not None:
        if dimension(run) < 3:
            flat = max(axis for axis in range(3) if cell_counts(run)[axis] == 1)
            usual.append(Quantity("vorticity", "vorticity", "vorticity", vorticity.units, flat))
        else:
            usual.append(Quantity("vorticity", "vorticity, magnitude", "vorticity", vorticity.units))
        rest += [
            Quantity(f"vorticity_{axis}", f"vorticity along {axis}", "vorticity", vorticity.units, component)
            for component, axis in enumerate(AXES)
        ]
    if (q := fields.get("q_criterion")) is not None:
        usual.append(Quantity("q_criterion", "Q-criterion", "q_criterion", q.units))
    return {quantity.name: quantity for quantity in (*usual, *rest)}


def default_names(run: Run) -> list[str]:
    """Quantities drawn by default: one of each dataset."""
    seen = {}
    for quantity in quantities(run).values():
        seen.setdefault(quantity.dataset, quantity.name)
    return list(seen.values())


def movie_name(names: list[str]) -> str:
    """Quantity of the animation: the one that shows vortices best."""
    return next((name for name in ("vorticity", "q_criterion", "speed") if name in names), names[0])
