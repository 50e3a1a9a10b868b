"""Demo page: one HTML file with embedded pictures."""

from pathlib import Path

from .. import html_page
from ..checks import check_label


def pictures_by_role(run) -> dict[str, Path]:
    """Pictures of a run by role: `still`, `map` (space-time or spectrum), `profiles`, `forces` and `movie`.

    Roles without a picture are absent. The history is the still of a run without fields.
    """
    roles = {"fields.png": "still", "fields.gif": "movie", "spectrum.png": "map", "profiles.png": "profiles",
             "canopies.png": "forces", "forces.png": "forces"}
    if not any(file.name == "fields.png" for file in run.pictures):
        roles["history.png"] = "still"
    found = {}
    for file in run.pictures:
        role = "map" if file.name.startswith("space_time") else roles.get(file.name)
        if role:
            found.setdefault(role, file)
    return found


def write_page(file: Path, runs) -> Path:
    """Writes the page of all scene runs and returns its path."""
    return html_page.write(
        file, "demo/page.html.j2", {"pictures": pictures_by_role, "check_label": check_label}, runs=runs,
        first=next((run.result for run in runs if run.result), {}), apps=list(dict.fromkeys(run.app for run in runs)),
    )
