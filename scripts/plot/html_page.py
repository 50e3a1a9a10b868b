"""Self-contained HTML pages: number formats, embedded images, and rendering of jinja2 templates."""

import base64
from pathlib import Path

import jinja2
from markupsafe import Markup

from .style import write_atomically

_MIME_TYPES = {".png": "image/png", ".gif": "image/gif"}


def data_url(file: Path) -> str:
    """Base64 data URL of a PNG or GIF file."""
    return f"data:{_MIME_TYPES[file.suffix]};base64,{base64.b64encode(file.read_bytes()).decode()}"


def format_seconds(value: float | None) -> str:
    """Time with three significant digits in \u00b5s, ms or s; a dash for None."""
    if value is None:
        return "\u2013"
    # A value that rounds to 1000 with three digits is written in the next larger unit.
    if value < 0.9995e-3:
        return f"{value * 1e6:.3g} \u00b5s"
    return f"{value * 1e3:.3g} ms" if value < 0.9995 else f"{value:.3g} s"


def format_number(value: float | None) -> str:
    """Number with three significant digits, an integer from 1000 on; powers of ten as HTML markup."""
    if value is None:
        return "not a number"
    # A value that rounds to 1000 with three digits is written as an integer too.
    if 999.5 <= abs(value) < 1e5:
        return format_grouped(round(value))
    if value == 0 or 1e-2 <= abs(value) < 1e5:
        return f"{value:.3g}"
    mantissa, exponent = f"{value:.2e}".split("e")
    mantissa = mantissa.rstrip("0").rstrip(".")
    return Markup(f"{mantissa}\u00d710<sup>{int(exponent)}</sup>".replace("-", "\u2212"))


def format_grouped(value: int | None) -> str:
    """Integer with thin spaces between groups of three digits; a dash for anything else."""
    return f"{value:,}".replace(",", "\u2009") if isinstance(value, int) else "\u2013"


def write(file: Path, template: str, filters: dict, **values) -> Path:
    """Renders a template (path below scripts/plot) with `filters` and `values` into `file`; returns `file`.

    Raises Failure (IO_ERROR) if the file cannot be written.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent), autoescape=True,
        undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )
    environment.filters.update(
        data_url=data_url, seconds=format_seconds, number=format_number, grouped=format_grouped, **filters
    )
    text = environment.get_template(template).render(**values)
    return write_atomically(file, lambda temporary: temporary.write_text(text, encoding="utf-8"))
