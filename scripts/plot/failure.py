"""Exit codes, and the exception that carries one with a message for the user."""

OK = 0
USAGE = 2
INVALID = 3  # an invalid record; its sentence begins with FILE:LINE
IO_ERROR = 6
INTERRUPTED = 130


class Failure(Exception):
    """Error with a one-sentence message for the user and the exit code of the program (USAGE, INVALID or IO_ERROR)."""

    def __init__(self, code: int, sentence: str):
        super().__init__(sentence)
        self.code = code
