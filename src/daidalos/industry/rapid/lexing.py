"""Lexical analysis of RAPID: one pass of one regular expression."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

KEYWORDS = {
    "ALIAS", "AND", "BACKWARD", "CASE", "CONNECT", "CONST", "DEFAULT", "DIV", "DO", "ELSE", "ELSEIF", "ENDFOR",
    "ENDFUNC", "ENDIF", "ENDMODULE", "ENDPROC", "ENDRECORD", "ENDTEST", "ENDTRAP", "ENDWHILE", "ERROR", "EXIT",
    "FALSE", "FOR", "FROM", "FUNC", "GOTO", "IF", "INOUT", "LOCAL", "MOD", "MODULE", "NOT", "OR", "PERS",
    "PROC", "RAISE", "RECORD", "RETRY", "RETURN", "STEP", "TASK", "TEST", "THEN", "TO", "TRAP", "TRUE",
    "TRYNEXT", "UNDO", "VAR", "WHILE", "WITH", "XOR",
}  # fmt: skip
MODULE_ATTRIBUTES = {"SYSMODULE", "NOVIEW", "NOSTEPIN", "VIEWONLY", "READONLY"}

PLACEHOLDERS = {
    "<TDN>": "PLACEHOLDER_DECLARATION",
    "<DDN>": "PLACEHOLDER_DECLARATION",
    "<RDN>": "PLACEHOLDER_DECLARATION",
    "<ID>": "PLACEHOLDER_ID",
    "<PAR>": "PLACEHOLDER_PARAMETER",
    "<ALT>": "PLACEHOLDER_PARAMETER",
    "<DIM>": "PLACEHOLDER_PARAMETER",
    "<SMT>": "PLACEHOLDER_STATEMENT",
    "<EIT>": "PLACEHOLDER_STATEMENT",
    "<CSE>": "PLACEHOLDER_CASE",
    "<ARG>": "PLACEHOLDER_ARGUMENT",
    "<EXP>": "PLACEHOLDER_EXPRESSION",
    "<VAR>": "PLACEHOLDER_VARIABLE",
}

SYMBOLS = {
    "(": "LPAR",
    ")": "RPAR",
    "[": "LSQB",
    "]": "RSQB",
    "{": "LBRACE",
    "}": "RBRACE",
    ",": "COMMA",
    ";": "SEMICOLON",
    ":": "COLON",
    ":=": "CEQ",
    "\\": "BACKSLASH",
    "?": "QUERY",
    "%": "PERCENT",
    "|": "BAR",
    ".": "DOT",
    "=": "EQ",
    "<>": "NE",
    "<=": "LE",
    "<": "LT",
    ">=": "GE",
    ">": "GT",
    "+": "PLUS",
    "-": "MINUS",
    "*": "STAR",
    "/": "SLASH",
}

_NUMBER = r"(?:0[xX][0-9a-fA-F]+|0[oO][0-7]+|0[bB][01]+|(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?)"
_STRING = r'"(?:[^"\r\n]|"")*+"'


def _list_of(element: str) -> str:
    return rf"\[(?:\s*+(?>{element})\s*+(?:,(?!\s*\])|(?=\])))++\]"


# Data of positions, tools and work objects are nested lists of literals. Taken as one token each, they cost next to
# nothing. Atomic groups and possessive quantifiers keep an attempt that fails linear.
_LITERAL = rf"[+-]?{_NUMBER}|{_STRING}|TRUE\b|FALSE\b"
_LITERALS = _list_of(_LITERAL)
for _ in range(4):
    _LITERALS = _list_of(rf"{_LITERALS}|{_LITERAL}")

_KINDS = ("WORD", "SYMBOL", "LITERALS", "NUMBER", "STRING", "COMMENT", "PLACEHOLDER", "OTHER")
_TOKEN = re.compile(
    rf"""\s*+(?:
      ([^\W\d_]\w*+)
    | (:=|<>|<=|>=|[](){{}},;:\\?%|=>+*/-]|<(?!(?:{"|".join(name[1:-1] for name in PLACEHOLDERS)})>)|\.(?!\d))
    | ({_LITERALS})
    | ({_NUMBER})
    | ({_STRING})
    | (![^\r\n]*+)
    | (<\w++>)
    | (\[|"[^\r\n]*|[^\s()\[\]{{}},;:]+)
    )""",
    re.VERBOSE | re.IGNORECASE,
)
_HEADER = re.compile(r"\ufeff?\s*%%%[^%]*%%%")


class Lexeme:
    """A token: its terminal in the grammar, its text as written and where it starts."""

    __slots__ = ("start", "text", "type")

    def __init__(self, type: str, text: str, start: int) -> None:
        self.type = type
        self.text = text
        self.start = start

    @property
    def end(self) -> int:
        """The offset behind the token."""
        return self.start + len(self.text)

    def __repr__(self) -> str:
        return f"{self.type}({self.text!r}, {self.start})"


_WORD_TYPES: dict[str, str] = {
    **{word: word for word in KEYWORDS},
    **dict.fromkeys(MODULE_ATTRIBUTES, "ATTRIBUTE"),
}


def tokenize(text: str) -> tuple[list[Lexeme], list[Lexeme]]:
    """Return the tokens of a text, and apart from them its comments.

    What is no token has the type ``OTHER``. Numbers, strings and words keep the spelling of the text.
    """
    tokens: list[Lexeme] = []
    comments: list[Lexeme] = []
    add = tokens.append
    types, symbols = dict(_WORD_TYPES), SYMBOLS
    for match in _TOKEN.finditer(text, header_end(text)):
        kind: int = match.lastindex  # type: ignore[assignment]  # one of the groups always matches
        word = match[kind]
        if kind == 1:
            type_ = types.get(word)
            if type_ is None:  # spellings that were seen are looked up once
                type_ = types[word] = types.get(word.upper(), "IDENT")
            add(Lexeme(type_, word, match.start(1)))
        elif kind == 2:
            add(Lexeme(symbols[word], word, match.start(2)))
        elif kind == 6:
            comments.append(Lexeme("COMMENT", word, match.start(6)))
        elif kind == 7:
            add(Lexeme(PLACEHOLDERS[word.upper()], word, match.start(7)))
        elif word == "[":
            add(Lexeme("LSQB", word, match.start(kind)))
        else:
            add(Lexeme(_KINDS[kind - 1], word, match.start(kind)))
    return tokens, comments


def header_end(text: str) -> int:
    """Return where the text begins behind the header ``%%% VERSION:1 LANGUAGE:ENGLISH %%%`` of older controllers."""
    match = _HEADER.match(text)
    if match:
        return match.end()
    return 1 if text.startswith("\ufeff") else 0


def words(text: str) -> Iterator[str]:
    """Yield the identifiers in a text, keywords left out."""
    yield from (token.text for token in tokenize(text)[0] if token.type == "IDENT")


def string_value(literal: str) -> str:
    r"""Return the characters of a string literal: ``""`` is a quote, ``\\`` a backslash and ``\0A`` a code."""
    inner = literal[1:-1].replace('""', '"')
    if "\\" not in inner:
        return inner
    return re.sub(r"\\(\\|[0-9A-Fa-f]{2})", _character, inner)


def _character(match: re.Match[str]) -> str:
    return "\\" if match[1] == "\\" else chr(int(match[1], 16))


def number_value(literal: str) -> float:
    """Return the value of a number literal, with hexadecimal, octal and binary ones; infinity where it is too large."""
    base = {"x": 16, "o": 8, "b": 2}.get(literal[1:2].lower())
    try:
        return float(int(literal[2:], base)) if base else float(literal)
    except OverflowError:
        return math.inf
