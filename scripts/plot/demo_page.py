"""The page of the demo: one HTML file that holds its pictures."""

from pathlib import Path

from . import page
from .style import check_label


def _by_role(run) -> dict[str, Path]:
    """Still picture, space-time map and moving picture of a run, as far as they exist."""
    roles = {"fields.png": "still", "fields.gif": "movie"}
    found = {}
    for file in run.pictures:
        role = "map" if file.name.startswith("space_time") else roles.get(file.name)
        if role:
            found.setdefault(role, file)
    return found


def write_page(file: Path, runs) -> Path:
    """Writes the page of all scene runs and returns its name."""
    return page.write(
        file, "demo_page.html.j2", {"pictures": _by_role, "check_label": check_label}, runs=runs,
        first=next((run.result for run in runs if run.result), {}), apps=list(dict.fromkeys(run.app for run in runs)),
    )  # fmt: skip
