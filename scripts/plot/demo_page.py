"""The page of the demo: one HTML file that holds its pictures."""

import base64
from pathlib import Path

import jinja2

from .style import check_label, replace_file

_KINDS = {".png": "image/png", ".gif": "image/gif"}


def _embedded(file: Path) -> str:
    return f"data:{_KINDS[file.suffix]};base64,{base64.b64encode(file.read_bytes()).decode()}"


def _seconds(value) -> str:
    if value is None:
        return "\u2013"
    return f"{value * 1e3:.3g} ms" if value < 1 else f"{value:.3g} s"


def _number(value) -> str:
    """Three digits; powers of ten as HTML."""
    if value is None:
        return "not a number"
    if value == 0 or 1e-2 <= abs(value) < 1e5:
        return f"{value:.3g}"
    mantissa, exponent = f"{value:.2e}".split("e")
    mantissa = mantissa.rstrip("0").rstrip(".")
    return jinja2.utils.markupsafe.Markup(
        f"{mantissa}\u00d710<sup>{int(exponent)}</sup>".replace("-", "\u2212")
    )


def _grouped(value) -> str:
    return f"{value:,}".replace(",", "\u2009") if isinstance(value, int) else "\u2013"


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
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        embedded=_embedded, seconds=_seconds, number=_number, grouped=_grouped, pictures=_by_role,
        check_label=check_label
    )
    first = next((run.result for run in runs if run.result), {})
    text = environment.get_template("demo_page.html.j2").render(
        runs=runs, first=first, apps=list(dict.fromkeys(run.app for run in runs))
    )
    return replace_file(file, lambda temporary: temporary.write_text(text, encoding="utf-8"))
