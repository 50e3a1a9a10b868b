"""HTML pages that need no other file: how they write numbers, and how they hold their pictures."""

import base64
from pathlib import Path

import jinja2
from markupsafe import Markup

from .style import replace_file

_KINDS = {".png": "image/png", ".gif": "image/gif"}


def embedded(file: Path) -> str:
    """A picture as the address that holds it."""
    return f"data:{_KINDS[file.suffix]};base64,{base64.b64encode(file.read_bytes()).decode()}"


def seconds(value: float | None) -> str:
    if value is None:
        return "\u2013"
    # What three digits round to a thousand is one of the next unit.
    if value < 0.9995e-3:
        return f"{value * 1e6:.3g} \u00b5s"
    return f"{value * 1e3:.3g} ms" if value < 0.9995 else f"{value:.3g} s"


def number(value: float | None) -> str:
    """Three digits, or the whole number from 1000 on; powers of ten as HTML."""
    if value is None:
        return "not a number"
    if 1e3 <= abs(value) < 1e5:
        return grouped(round(value))
    if value == 0 or 1e-2 <= abs(value) < 1e5:
        return f"{value:.3g}"
    mantissa, exponent = f"{value:.2e}".split("e")
    mantissa = mantissa.rstrip("0").rstrip(".")
    return Markup(f"{mantissa}\u00d710<sup>{int(exponent)}</sup>".replace("-", "\u2212"))


def grouped(value: int | None) -> str:
    return f"{value:,}".replace(",", "\u2009") if isinstance(value, int) else "\u2013"


def write(file: Path, template: str, filters: dict, **values) -> Path:
    """Fills a template of this folder and writes the page; returns its name."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(embedded=embedded, seconds=seconds, number=number, grouped=grouped, **filters)
    text = environment.get_template(template).render(**values)
    return replace_file(file, lambda temporary: temporary.write_text(text, encoding="utf-8"))
