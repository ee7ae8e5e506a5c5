"""The error of bad input."""

from __future__ import annotations


class InputError(ValueError):
    """Input that is not understood, out of range or contradictory.

    Attributes
    ----------
    message : str
        What is wrong.
    help : str or None
        What to type instead, where that is known.
    text : str
        The text that was read: of a sweep, a case, or the parameters as slipmap reads them.
    line, column : int or None
        Where in the text, from 1 on; none without a place.
    """

    def __init__(
        self, message: str, help: str | None = None, text: str = "", span: tuple[int, int] | None = None
    ) -> None:
        super().__init__(message, help, text, span)
        self.message = message
        self.help = help
        self.text = text
        self._span = span
        self.line: int | None = None
        self.column: int | None = None
        if span is not None:
            before = text[: span[0]]
            self.line = before.count("\n") + 1
            self.column = len(before) - (before.rfind("\n") + 1) + 1

    def __str__(self) -> str:
        parts = [self.message]
        if self.line is not None and self.column is not None and self._span is not None:
            shown = self.text.split("\n")[self.line - 1].rstrip("\r")
            length = max(1, min(self._span[1] - self._span[0], len(shown) - self.column + 1))
            number = f"{self.line} | "
            parts.append(number + shown)
            parts.append(" " * (len(number) + self.column - 1) + "^" * length)
        if self.help:
            parts.append(f"help: {self.help}")
        return "\n".join(parts)
