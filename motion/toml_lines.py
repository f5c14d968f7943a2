"""On which line of a TOML file each field is, so that a fault can name the line.

Signals in: the text of a file that tomllib has read. Signals out: the line (from 1) of every field, by its
path: the keys down to it, and the number (from 0) of an element of an array: `("stop", 1, "moves", 0,
"down")`.

tomllib gives the values, and not their lines. So this module reads the text once more, for its keys, brackets
and commas only; the values are left to tomllib.

Source: TOML 1.0.0 (toml.io/en/v1.0.0): keys, strings, arrays, inline tables, tables, arrays of tables.
"""

from __future__ import annotations

import re

Path = tuple[str | int, ...]

_WORD = re.compile(
    r'''(?P<string>"""(?:[^\\]|\\.)*?""""{0,2}|\'\'\'.*?\'\'\'\'{0,2}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')'''
    r"""|(?P<comment>\#[^\n]*)|(?P<mark>[\[\]{}=,\n])|(?P<dot>\.)|(?P<bare>[^\s\[\]{}=,.#"']+)""",
    re.DOTALL,
)
_END = ("", "", 0)


def lines_of(text: str) -> dict[Path, int]:
    """The line of every field of a text that tomllib can read; the first of a table opened more than once."""
    return _Reader(text.replace("\r\n", "\n")).read()


def too_deep(text: str, deepest: int) -> tuple[int, str] | None:
    """The line of a key of more parts than this, or of as many brackets in one another, and which it is.

    tomllib goes down by recursion, and takes the square of the time for a key of many parts.
    """
    dots = brackets = 0
    for word in _WORD.finditer(text):
        kind, mark = word.lastgroup, word[0]
        if kind == "comment":
            continue
        dots = dots + 1 if kind == "dot" else 0 if kind == "mark" else dots
        brackets = max(0, brackets + (mark in ("[", "{")) - (mark in ("]", "}")))
        if dots >= deepest:
            return text.count("\n", 0, word.start()) + 1, "a key of too many parts"
        if brackets > deepest:
            return text.count("\n", 0, word.start()) + 1, "too many brackets in one another"
    return None


class _Reader:
    """Goes through the words of a file: (kind, text, line)."""

    def __init__(self, text: str) -> None:
        found = (word for word in _WORD.finditer(text) if word.lastgroup != "comment")
        self._words, line, seen = list[tuple[str, str, int]](), 1, 0
        for word in found:
            line += text.count("\n", seen, word.start())
            seen = word.start()
            self._words.append((word.lastgroup or "", word[0], line))
        self._next = 0
        self._lines: dict[Path, int] = {(): 1}
        self._opened: dict[Path, int] = {}  # arrays of tables: how many so far

    def read(self) -> dict[Path, int]:
        """Go through all statements."""
        table: Path = ()
        while self._past_newlines() != _END:
            if self._peek()[1] == "[":
                table = self._header()
            else:
                self._pair(table)
        return self._lines

    def _peek(self) -> tuple[str, str, int]:
        return self._words[self._next] if self._next < len(self._words) else _END

    def _take(self) -> tuple[str, str, int]:
        word = self._peek()
        self._next += 1
        return word

    def _past_newlines(self) -> tuple[str, str, int]:
        """The next word that is no end of a line."""
        while self._peek()[1] == "\n":
            self._next += 1
        return self._peek()

    def _header(self) -> Path:
        """The table that `[key]` or `[[key]]` opens."""
        line = self._take()[2]
        many = self._peek()[1] == "["
        self._next += many
        key = self._key()
        self._next += 1 + many
        path: Path = ()
        for k, part in enumerate(key):
            path += (part,)
            self._lines.setdefault(path, line)
            if many and k == len(key) - 1:
                self._opened[path] = self._opened.get(path, 0) + 1
            if path in self._opened:
                path += (self._opened[path] - 1,)
                self._lines.setdefault(path, line)
        return path

    def _key(self) -> list[str]:
        """The parts of a key, up to the mark behind it."""
        import tomllib

        parts = []
        while self._peek()[0] in ("bare", "string", "dot"):
            kind, text, _ = self._take()
            if kind != "dot":
                parts.append(
                    str(tomllib.loads(f"key = {text}")["key"]) if kind == "string" else text
                )
        return parts

    def _pair(self, table: Path) -> None:
        """A key and its value."""
        line, path = self._peek()[2], table
        for part in self._key():
            path += (part,)
            self._lines.setdefault(path, line)
        self._next += 1
        self._value(path)

    def _value(self, path: Path) -> None:
        """A value: what is in it, if anything can be."""
        if self._peek()[1] in ("[", "{"):
            self._inside(path, self._take()[1])
            return
        while self._peek()[1] not in (",", "]", "}", "\n", ""):
            self._next += 1

    def _inside(self, path: Path, bracket: str) -> None:
        """The elements of an array, or the pairs of an inline table."""
        count = 0
        while (word := self._past_newlines())[1] not in ("]", "}", ""):
            if word[1] == ",":
                self._next += 1
            elif bracket == "{":
                self._pair(path)
            else:
                self._lines[(*path, count)] = word[2]
                self._value((*path, count))
                count += 1
        self._next += 1
