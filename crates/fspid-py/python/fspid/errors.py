"""One tree of exceptions: whatever fspid refuses is an :class:`Error`.

A requirement that is not met, a loop that is unstable or a flight that fails is an answer, and no exception.
"""

from __future__ import annotations


class Error(Exception):
    """Whatever fspid refuses or cannot do."""


class InputError(Error, ValueError):
    """Something that was given cannot be used; the message says what is allowed."""


class FileError(Error, OSError):
    """A file that cannot be read or written."""


class Problem:
    """One thing that is wrong with a scenario.

    Attributes
    ----------
    path : str
        Where, such as ``controller[1].kp``; empty for the whole.
    message : str
        What is wrong.
    found : str
        What was written there; may be empty.
    allowed : str
        What may stand there; empty where the message says it.
    line, column : int or None
        Place in the text, from 1; None where the problem is not at one place of it.
    origin : str or None
        The other file or the change that it stands in, if it does not stand in the scenario itself.
    case : str or None
        The case of a tuning or a contest that makes it so, if the scenario is right without one.
    """

    __slots__ = ("allowed", "case", "column", "found", "line", "message", "origin", "path")

    def __init__(
        self,
        path: str,
        message: str,
        found: str,
        allowed: str,
        line: int | None,
        column: int | None,
        origin: str | None,
        case: str | None,
    ) -> None:
        self.path = path
        self.message = message
        self.found = found
        self.allowed = allowed
        self.line = line
        self.column = column
        self.origin = origin
        self.case = case

    def __repr__(self) -> str:
        allowed = f"; allowed: {self.allowed}" if self.allowed else ""
        case = f" in case {self.case}" if self.case else ""
        return f"<Problem {self.path or 'scenario'}{case}: {self.message}{allowed}>"


class ScenarioError(InputError):
    """A scenario that is wrong, with all that is wrong in it.

    Attributes
    ----------
    problems : list of Problem
        Each with its path, what was found and what is allowed.
    """

    def __init__(self, message: str, problems: str = "{}") -> None:
        import json

        super().__init__(message)
        keys = ("path", "message", "found", "allowed", "line", "column", "origin", "case")
        found = json.loads(problems).get("problems", [])
        self.problems = [Problem(**{key: each.get(key) for key in keys}) for each in found]
