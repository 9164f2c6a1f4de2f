"""Spaces between the tokens of a line of RAPID."""

from __future__ import annotations

from collections.abc import Sequence

from daidalos.industry.rapid.lexing import Lexeme

_TIGHT_BEFORE = {"COMMA", "SEMICOLON", "RPAR", "RSQB", "RBRACE", "COLON", "DOT", "QUERY", "LBRACE"}
_TIGHT_AFTER = {"LPAR", "LSQB", "LBRACE", "DOT", "BACKSLASH", "QUERY"}
_OPERAND_ENDS = {"IDENT", "NUMBER", "STRING", "LITERALS", "TRUE", "FALSE", "RPAR", "RSQB", "RBRACE"}


class Spacing:
    """Spaces before tokens, by what stands before them and what part they have."""

    def __init__(self, tokens: Sequence[Lexeme]) -> None:
        self._signs: set[int] = set()
        self._tight: set[int] = set()
        self._opening: set[int] = set()
        depth, is_open = 0, False
        for index, token in enumerate(tokens):
            type_ = token.type
            last = tokens[index - 1].type if index else ""
            depth += (type_ in ("LSQB", "LBRACE")) - (type_ in ("RSQB", "RBRACE"))
            if type_ in ("PLUS", "MINUS") and last not in _OPERAND_ENDS:
                self._signs.add(token.start)
            elif type_ == "PERCENT":
                is_open = not is_open
                if is_open:
                    self._opening.add(token.start)
            elif (
                (type_ == "CEQ" and index > 1 and tokens[index - 2].type == "BACKSLASH")
                or (type_ == "COMMA" and depth)
                or (type_ == "STAR" and last in ("LBRACE", "COMMA"))
            ):
                self._tight.add(token.start)

    def before(self, token: Lexeme, last: Lexeme | None, has_gap: bool) -> bool:
        """Return whether a space stands between two tokens; `has_gap` where there was one."""
        if last is None:
            return False
        if last.type == "PERCENT" or token.type == "PERCENT":
            return last.start not in self._opening and (token.type != "PERCENT" or token.start in self._opening)
        if token.type in _TIGHT_BEFORE or last.type in _TIGHT_AFTER:
            return False
        if token.start in self._tight or last.start in self._tight:
            return False
        if last.start in self._signs:
            return has_gap and token.type in ("NUMBER", "LITERALS")
        return token.type != "LPAR" or last.type != "IDENT"
