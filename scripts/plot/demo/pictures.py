"""Pictures of one scene, drawn in a worker process."""

from pathlib import Path

from .. import cli
from ..failure import Failure


def draw(directory: Path) -> tuple[list[Path], tuple[int, str] | None]:
    """Paths of the pictures of a run directory, and exit code and message if drawing failed."""
    pictures = []
    try:
        for file in cli.draw(cli.arguments([str(directory)])):
            pictures.append(file)
    except Failure as failure:
        return pictures, (failure.code, str(failure))
    return pictures, None
