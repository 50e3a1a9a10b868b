"""Description of the schemes that the work-precision records of one mini-app compare."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class PublishedResult:
    """Points (time, error) of another program on one problem, in the units of its diagram."""

    problem: str
    label: str
    backend: str  # backend of the panel in which the points are drawn
    points: tuple[tuple[float, float], ...]
    source: str


@dataclass(frozen=True, eq=False)
class SchemeFamily:
    """Schemes of one mini-app, their settings, and the problems that they solve.

    `scheme_fact` is the fact of a record that names its scheme. Of `settings`, the first is drawn by colour, the
    second by line style, and the third, if present, by a row of panels.
    """

    app: str
    scheme_fact: str
    scheme_names: dict[str, str]
    settings: tuple[str, ...]
    default_settings: tuple[str, ...]
    default_label: str
    colour_settings: tuple[str, ...]
    line_settings: dict[str, str]
    problems: dict[str, str]
    error_titles: dict[str, str]  # by problem
    competitor: str = ""
    mesh_unit: str = "cells"
    time_label: str = "time to solution (s)"
    setting_labels: Mapping[str, str] = field(default_factory=dict)  # of settings whose label is not their key
    row_labels: Mapping[str, str] = field(default_factory=dict)  # of the third setting, where they differ
    published: tuple[PublishedResult, ...] = ()
    note: str = ""
    planar_schemes: tuple[str, ...] = ()  # schemes whose mesh size grows with the square of the edges per axis
    target_errors: tuple[float, ...] = ()  # empty: derived from the competitor's errors
    # Default settings by (problem, backend), where the usual ones do not exist.
    other_defaults: Mapping[tuple[str, str], tuple[str, ...]] = field(default_factory=dict)

    def defaults_for(self, problem: str, backend: str) -> tuple[str, ...]:
        """Default settings of a problem on a backend."""
        return self.other_defaults.get((problem, backend), self.default_settings)

    @property
    def command(self) -> str:
        """Command that writes the records."""
        return f"drogue-perf work-precision --app {self.app} --out FILE.jsonl"
