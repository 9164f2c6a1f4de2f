"""Recovery from syntax errors: name the error, then change tokens or the parser's stack so that it can go on.

The least change is tried first: another token in the place of one, a token that is missing, a token that is too much.
Where none helps, the statement is left out: tokens are skipped to its end, and the stack is cut back to the list that
the statement would have been part of.
"""

from __future__ import annotations

from collections.abc import Sequence

from daidalos.industry.rapid.lexing import KEYWORDS, PLACEHOLDERS, SYMBOLS, Lexeme
from daidalos.industry.rapid.problems import Problem
from daidalos.industry.rapid.sources import Source
from daidalos.industry.rapid.tables import MAX_DEPTH, Stack

BLOCK_ENDS = {
    "MODULE": "ENDMODULE",
    "RECORD": "ENDRECORD",
    "PROC": "ENDPROC",
    "FUNC": "ENDFUNC",
    "TRAP": "ENDTRAP",
    "IF": "ENDIF",
    "FOR": "ENDFOR",
    "WHILE": "ENDWHILE",
    "TEST": "ENDTEST",
}
_BLOCK_STARTS = {end: start for start, end in BLOCK_ENDS.items()}
_LISTS = ("statements", "module_items", "components", "cases", "modules")
_ROUTINES = {"PROC", "FUNC", "TRAP"}
_STATEMENT_WORDS = {
    "IF", "FOR", "WHILE", "TEST", "GOTO", "RETURN", "RAISE", "RETRY", "TRYNEXT", "EXIT", "CONNECT", "VAR", "PERS",
    "CONST", "LOCAL", "TASK", "MODULE", "PROC", "FUNC", "TRAP", "RECORD", "ALIAS", "ELSE", "ELSEIF", "CASE", "DEFAULT",
    "ERROR", "UNDO", "BACKWARD", "$END", *BLOCK_ENDS.values(),
}  # fmt: skip
_MISSING = (
    "SEMICOLON", "RPAR", "RSQB", "RBRACE", "THEN", "DO", "COLON", "COMMA", "CEQ", "WITH", "TO", "FROM", "LPAR",
)  # fmt: skip
_TEXTS = {type_: f"'{text}'" for text, type_ in SYMBOLS.items()} | {"IDENT": "a name", "$END": "the end of the file"}
_MAX_NESTED = 40


class Recovery:
    """Gathers the syntax errors of a file while its parser runs."""

    def __init__(self, source: Source, stack: Stack) -> None:
        self._source = source
        self._stack = stack
        self._list_states = {table[name] for table in stack.tables.gotos for name in _LISTS if name in table}
        self.problems: list[Problem] = []
        self._last_failed = -1

    def recover(self, tokens: Sequence[Lexeme], position: int) -> int | None:
        """Report the token at a position, and return the position to go on from; None where nothing can be done."""
        token = tokens[position]
        before = tokens[position - 1] if position else None
        if len(self._stack.states) > MAX_DEPTH:
            self._report(token, "this is nested too deeply")
            return None
        if position != self._last_failed:
            self._last_failed = position
            for attempt in (self._broken, self._replace, self._insert, self._close_blocks, self._open_module):
                after = attempt(token, before, position)
                if after is not None:
                    return after
        if token.type in _BLOCK_STARTS and not self._open(_BLOCK_STARTS[token.type]):
            self._report(token, f"{token.type} without {_BLOCK_STARTS[token.type]} before it")
            return position + 1
        self._report(token, self._unexpected(token, before))
        return self._skip(tokens, position)

    # The ways to go on

    def _broken(self, token: Lexeme, before: Lexeme | None, position: int) -> int | None:
        """Report what is no token at all."""
        if token.type != "OTHER":
            return None
        if token.text.startswith('"'):
            self._report(token, "this string has no closing '\"' on its line")
            if self._can("STRING"):
                self._feed(Lexeme("STRING", '""', token.start))
                if self._can("SEMICOLON"):
                    self._feed(Lexeme("SEMICOLON", "", token.end))
            return position + 1
        self._report(token, f"'{token.text}' is not a name, a number or a symbol of RAPID")
        if self._can("IDENT"):
            self._feed(Lexeme("IDENT", token.text, token.start))
        return position + 1

    def _replace(self, token: Lexeme, before: Lexeme | None, position: int) -> int | None:
        """Take another token where it is clear which was meant."""
        if token.type == "EQ" and self._can("CEQ"):
            self._report(token, "'=' compares; ':=' assigns a value")
            self._feed(Lexeme("CEQ", ":=", token.start))
            return position + 1
        if token.type == "CEQ" and self._can("EQ"):
            self._report(token, "':=' assigns; '=' compares two values")
            self._feed(Lexeme("EQ", "=", token.start))
            return position + 1
        is_word = token.type in KEYWORDS or token.type == "ATTRIBUTE"
        follows_name = before is not None and before.type in ("IDENT", "DOT", "FOR", *_ROUTINES, "MODULE", "BACKSLASH")
        if (
            is_word
            and follows_name
            and self._can("IDENT")
            and token.type not in _STATEMENT_WORDS - {"ERROR", "TEST", "TASK"}
        ):
            self._report(token, f"'{token.text}' is a keyword of RAPID and cannot be a name")
            self._feed(Lexeme("IDENT", token.text, token.start))
            return position + 1
        return None

    def _insert(self, token: Lexeme, before: Lexeme | None, position: int) -> int | None:
        """Insert one token that makes the next one fit."""
        starts_line = before is not None and self._line(token.start) > self._line(before.end)
        for missing in _MISSING:
            if missing == "SEMICOLON" and not (starts_line or token.type in _STATEMENT_WORDS):
                continue
            if missing in ("COMMA", "LPAR", "CEQ") and starts_line:
                continue
            if self._can(missing, token.type):
                where = before or token
                self._report_at(where.end if before else where.start, 1, f"{_text(missing)} is missing{_before(token)}")
                self._feed(Lexeme(missing, "", token.start))
                return position
        return None

    def _close_blocks(self, token: Lexeme, before: Lexeme | None, position: int) -> int | None:
        """Close blocks whose end is missing, where the token then fits."""
        ends: list[tuple[str, Lexeme]] = []
        for opened in reversed(self._open_blocks()):
            end = BLOCK_ENDS[opened.type]
            if len(ends) > _MAX_NESTED or not self._can(*(one for one, _ in ends), end):
                return None
            ends.append((end, opened))
            if self._can(*(one for one, _ in ends), token.type):
                break
        else:
            return None
        for end, opened in ends:
            self._report(token, f"{end} is missing; its {opened.type} is in line {self._line(opened.start)}")
            self._feed(Lexeme(end, "", token.start))
        return position

    def _open_module(self, token: Lexeme, before: Lexeme | None, position: int) -> int | None:
        """Open a module for declarations that stand in none."""
        if not self._can("MODULE", "IDENT", token.type):
            return None
        self._report(token, f"{_shown(token)} stands in no module; 'MODULE name' is missing before it")
        self._feed(Lexeme("MODULE", "", token.start))
        self._feed(Lexeme("IDENT", "", token.start))
        return position

    def _skip(self, tokens: Sequence[Lexeme], position: int) -> int | None:
        """Skip to where a statement can begin, and cut the stack back to a list of statements or declarations."""
        stack = self._stack
        while position < len(tokens):
            token = tokens[position]
            position += 1
            if token.type == "SEMICOLON" and position < len(tokens):
                token = tokens[position]
            elif token.type in _STATEMENT_WORDS:
                position -= 1
            else:
                continue
            for size in range(len(stack.states), 0, -1):
                if stack.states[size - 1] in self._list_states and stack.accepts((token.type,), size):
                    stack.cut(size)
                    self._last_failed = -1
                    return position
            if token.type == "$END":
                return None
            if tokens[position] is token:
                position += 1
        return None

    # Messages

    def _unexpected(self, token: Lexeme, before: Lexeme | None) -> str:
        expected = self._expected()
        if token.type == "SEMICOLON" and before is not None and before.type == "SEMICOLON":
            return "a second ';' without a statement before it"
        if token.type in ("VAR", "PERS", "CONST", "LOCAL") and not expected:
            return f"{_shown(token)} is not expected here"
        return f"{_shown(token)} is not expected here{expected}"

    def _expected(self) -> str:
        """Return the part of a message that says what would fit: a few tokens, or a kind of them."""
        fitting = {
            type_
            for type_ in self._stack.tables.actions[self._stack.states[-1]]
            if type_.isupper() and self._can(type_)
        }
        fitting -= set(PLACEHOLDERS.values())
        if {"IDENT", "NUMBER", "STRING"} <= fitting:
            others = fitting & {"RPAR", "SEMICOLON", "BACKSLASH"}
            return f"; expected an expression{''.join(f' or {_text(one)}' for one in sorted(others))}"
        if {"IDENT", "WHILE", "GOTO"} <= fitting:
            return "; expected a statement"
        if {"PROC", "FUNC", "RECORD"} <= fitting:
            return "; expected a declaration or ENDMODULE"
        if "PLUS" in fitting:
            fitting -= {
                "PLUS",
                "MINUS",
                "STAR",
                "SLASH",
                "DIV",
                "MOD",
                "EQ",
                "NE",
                "LT",
                "LE",
                "GT",
                "GE",
                "AND",
                "OR",
                "XOR",
            }
        if not fitting or len(fitting) > 6:
            return ""
        words = sorted((_text(one) for one in fitting), key=lambda word: (not word.startswith("'"), word))
        return f"; expected {' or '.join(words)}"

    def _report(self, token: Lexeme, message: str) -> None:
        self._report_at(token.start, len(token.text), message)

    def _report_at(self, offset: int, width: int, message: str) -> None:
        line, column = self._source.place(offset)
        problem = Problem(line, column, message, "syntax", column + max(width, 1))
        if problem not in self.problems:
            self.problems.append(problem)

    def _line(self, offset: int) -> int:
        return self._source.place(offset)[0]

    # The parser's stack

    def _open_blocks(self) -> list[Lexeme]:
        values = self._stack.values
        blocks = [one for one in values if isinstance(one, Lexeme) and one.type in BLOCK_ENDS]
        if values and isinstance(values[-1], Lexeme) and values[-1].type in _BLOCK_STARTS:
            blocks.pop()  # the parser has its end, and waits for the next token
        return blocks

    def _open(self, type_: str) -> bool:
        return any(one.type == type_ for one in self._open_blocks())

    def _feed(self, token: Lexeme) -> None:
        self._stack.feed((token,), 0)

    def _can(self, *types: str) -> bool:
        return self._stack.accepts(types)


def _text(type_: str) -> str:
    return _TEXTS.get(type_, type_)


def _shown(token: Lexeme) -> str:
    return "the end of the file" if token.type == "$END" else f"'{token.text}'"


def _before(token: Lexeme) -> str:
    return f" before {_shown(token)}"
