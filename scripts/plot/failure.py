"""Failures that the user is told about in one sentence."""

OK = 0
USAGE = 2
IO_ERROR = 6


class Failure(Exception):
    """One sentence for the user and the exit code of the program (2 usage, 6 input or output)."""

    def __init__(self, code: int, sentence: str):
        super().__init__(sentence)
        self.code = code
