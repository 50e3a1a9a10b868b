"""Pictures of one scene of the demo, made in a process of its own."""

from pathlib import Path

from . import cli
from .failure import Failure


def draw(directory: Path) -> tuple[list[Path], tuple[int, str] | None]:
    """Pictures of a run directory; with the exit code and the sentence where they failed."""
    pictures = []
    try:
        for file in cli.draw(cli.arguments([str(directory)])):
            pictures.append(file)
    except Failure as failure:
        return pictures, (failure.code, str(failure))
    return pictures, None
