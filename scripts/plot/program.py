"""Frame of drogue-plot, like that of the compiled programs: signals, ranks of a launcher and standard output."""

import contextlib
import os
import signal
import sys
import time

from .failure import INTERRUPTED, IO_ERROR, OK, USAGE, Failure


def _number(name: str) -> int | None:
    text = os.environ.get(name, "")
    return int(text) if text.isascii() and text.isdigit() else None


def launched_rank() -> tuple[int, int]:
    """Rank and number of ranks by the environment of a launcher, as `launched_rank()` of common/program reads them."""
    launchers = (
        ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"),
        ("PMI_RANK", "PMI_SIZE"),
        ("PMIX_RANK", "SLURM_NTASKS"),
    )
    for name, ranks in launchers:
        # Only a task has PMIX_RANK, while the job script has SLURM_NTASKS as well.
        if _number(ranks) and (name != "PMIX_RANK" or _number(name) is not None):
            return _number(name) or 0, _number(ranks)
    return 0, 1


def require_one_rank() -> None:
    """Raises Failure (USAGE) if a launcher started several ranks."""
    ranks = launched_rank()[1]
    if ranks > 1:
        raise Failure(
            USAGE,
            f"there is no parallel solver: start this program without mpirun or with one rank, not {ranks}.",
        )


def write_line(text: str) -> None:
    """Writes `text` and the end of a line to standard output at once; raises Failure (IO_ERROR)."""
    try:
        sys.stdout.write(f"{text}\n")
        sys.stdout.flush()
    except (AttributeError, OSError):  # a closed standard output is None
        # Python would write the rest of a full one at its end, and fail once more.
        sys.stdout = None
        raise Failure(IO_ERROR, "cannot write to standard output.") from None


at_signal = []  # functions without arguments that remove what is unfinished, called in reverse order


def _interrupt(*_) -> None:
    # A launcher may send several signals.
    _handle_signals(signal.SIG_IGN)
    for undo in reversed(at_signal):
        with contextlib.suppress(OSError):
            undo()
    print("drogue-plot: interrupted by a signal; the files written until then are whole.", file=sys.stderr, flush=True)
    # An exception could be lost: destructors drop it, and imports of modules of C replace it.
    os._exit(INTERRUPTED)


def _handle_signals(handler) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, handler)


def run_program(body) -> int:
    """Exit code of `body`; a signal ends the process with INTERRUPTED. Ranks other than 0 are silent."""
    _handle_signals(_interrupt)
    rank = launched_rank()[0]
    if rank != 0:
        sys.stdout = sys.stderr = open(os.devnull, "w")
    code = body()
    # All files are written, and the interpreter ends.
    _handle_signals(signal.SIG_IGN)
    if rank != 0 and code != OK:
        # A launcher ends all ranks as soon as one fails: give rank 0 time to print the reason.
        time.sleep(1)
    return code
