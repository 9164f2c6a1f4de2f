"""Formatter of RAPID: one instruction a line, indentation by blocks, spaces by one rule; comments stay.

It changes white space and the case of keywords only, and keeps line breaks within an instruction. So the tokens, and
with them the tree, are those of before.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from daidalos.common.errors import UserError
from daidalos.industry.rapid import tree
from daidalos.industry.rapid.lexing import KEYWORDS, Lexeme, header_end
from daidalos.industry.rapid.parsing import Parsed, parse
from daidalos.industry.rapid.sources import Source
from daidalos.industry.rapid.spacing import Spacing

INDENT = "  "
CONTINUATION = 2
"""Levels that the lines of an instruction after its first are indented by."""

_CLOSING = {"ENDMODULE", "ENDRECORD", "ENDPROC", "ENDFUNC", "ENDTRAP", "ENDIF", "ENDFOR", "ENDWHILE", "ENDTEST"}
_BETWEEN = {"ELSE", "ELSEIF", "BACKWARD", "UNDO"}
_CASES = {"CASE", "DEFAULT", "PLACEHOLDER_CASE"}
_LINE_BREAK = re.compile(r"\r\n|\n|\r")
_LITERAL_PARTS = re.compile(r'"(?:[^"]|"")*"|[^\s"]+|\r\n|\n|\r')


def format_source(source: Source) -> str:
    """Return the formatted text of a module.

    Raises
    ------
    UserError
        If the module has syntax errors; the first one is named.
    """
    parsed = parse(source)
    if parsed.problems:
        raise UserError(parsed.problems[0].text(source.file))
    newline = "\r\n" if "\r\n" in source.text else "\n"
    header = source.text[: header_end(source.text)].strip("\ufeff \t\r\n")
    lines = [line.rstrip() for line in header.splitlines()] + _Formatter(parsed).lines()
    return newline.join([*lines, ""])


class _Formatter:
    """Puts the tokens and comments of a module into lines."""

    def __init__(self, parsed: Parsed) -> None:
        self._text = parsed.source.text
        self._tokens = sorted((*parsed.tokens, *parsed.comments), key=lambda one: one.start)
        self._first, self._error_handlers = _line_starts(parsed.tree)
        self._spacing = Spacing(parsed.tokens)
        self._lines: list[str] = []
        self._line = ""
        self._depth = 0
        self._level = 0
        """Level of the latest instruction's first line."""
        self._inside = self._comments_inside()

    def lines(self) -> list[str]:
        """Return the lines."""
        end = header_end(self._text)
        before: Lexeme | None = None
        for token in self._tokens:
            gap = self._text[end : token.start]
            breaks = len(_LINE_BREAK.findall(gap))
            if token.type == "COMMENT":
                self._add_comment(token, breaks)
            else:
                self._add_token(token, before, breaks, bool(gap))
                before = token
            end = token.end
        self._end_line()
        return self._lines

    def _add_comment(self, comment: Lexeme, breaks: int) -> None:
        text = comment.text.rstrip()
        if self._line and not breaks:
            self._line += f" {text}"
        else:
            is_inside = comment.start in self._inside
            self._begin_line(text, breaks, self._level + CONTINUATION if is_inside else self._depth)
        self._end_line()

    def _add_token(self, token: Lexeme, before: Lexeme | None, breaks: int, has_gap: bool) -> None:
        type_ = token.type
        is_between = self._is_between(token)
        if type_ in _CLOSING or is_between or type_ in _CASES:
            self._level = self._depth = self._depth - 1
            self._begin_line(_spelled(token, self._depth), breaks, self._depth)
            self._depth += is_between or type_ in _CASES
        elif token.start in self._first:
            self._level = self._depth
            self._begin_line(_spelled(token, self._depth), breaks, self._depth)
            self._depth += self._first[token.start]
        elif not self._line or breaks:
            level = self._level + CONTINUATION
            self._begin_line(_spelled(token, level), min(breaks, 1), level)
        else:
            self._line += " " * self._spacing.before(token, before, has_gap) + _spelled(token, self._level)

    def _is_between(self, token: Lexeme) -> bool:
        return token.type in _BETWEEN or token.start in self._error_handlers

    def _comments_inside(self) -> set[int]:
        """Return the offsets of comments behind which an instruction goes on."""
        inside: set[int] = set()
        goes_on = False
        for token in reversed(self._tokens):
            if token.type != "COMMENT":
                begins = token.start in self._first or token.type in _CLOSING or token.type in _CASES
                goes_on = not begins and not self._is_between(token)
            elif goes_on:
                inside.add(token.start)
        return inside

    def _begin_line(self, text: str, breaks: int, level: int) -> None:
        self._end_line()
        if breaks > 1 and self._lines and self._lines[-1]:
            self._lines.append("")
        self._line = INDENT * level + text

    def _end_line(self) -> None:
        if self._line:
            self._lines += [line.rstrip() for line in self._line.split("\n")]
        self._line = ""


def _spelled(token: Lexeme, level: int) -> str:
    if token.type in KEYWORDS or token.type == "ATTRIBUTE" or token.type.startswith("PLACEHOLDER"):
        return token.text.upper()
    if token.type != "LITERALS":
        return token.text
    indent = INDENT * (level + CONTINUATION)
    return "".join(f"\n{indent}" if part.isspace() else part for part in _LITERAL_PARTS.findall(token.text))


def _line_starts(root: tree.Tree) -> tuple[dict[int, int], set[int]]:
    """Return the offsets that lines begin at, with the levels that what follows is indented by; and error handlers."""
    first: dict[int, int] = {}
    handlers: set[int] = set()
    for module in root.modules:
        first[module.start] = 1
        for item in module.items:
            first[item.start] = int(isinstance(item, tree.Routine | tree.Record))
            if isinstance(item, tree.Record):
                first.update((component.type.start, 0) for component in item.components)
            if isinstance(item, tree.Routine):
                _body_starts(item.body, first)
                for handler in item.handlers:
                    if handler.kind == "ERROR":
                        handlers.add(handler.start)
                    _body_starts(handler.body, first)
    _body_starts(root.fragment, first)
    return first, handlers


def _body_starts(body: Sequence[tree.Statement], first: dict[int, int]) -> None:
    for one in body:
        first[one.start] = 0
        match one:
            case tree.If() if one.is_compact:
                continue
            case tree.If():
                for branch in one.branches:
                    _body_starts(branch.body, first)
                _body_starts(one.otherwise or (), first)
            case tree.For() | tree.While():
                _body_starts(one.body, first)
            case tree.Test():
                for case in one.cases:
                    if isinstance(case, tree.Case):
                        _body_starts(case.body, first)
            case _:
                continue
        first[one.start] = 1
