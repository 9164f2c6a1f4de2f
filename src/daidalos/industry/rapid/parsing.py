"""Parser of RAPID: tree and all syntax errors of a module."""

from __future__ import annotations

import contextlib
import functools
import gc
from collections.abc import Iterator
from dataclasses import dataclass, field
from importlib.resources import files

from lark import Lark

from daidalos.common.cache_folder import cache_folder
from daidalos.industry.rapid.building import TreeBuilder
from daidalos.industry.rapid.lexing import Lexeme, tokenize
from daidalos.industry.rapid.problems import Problem
from daidalos.industry.rapid.recovery import Recovery
from daidalos.industry.rapid.sources import Source
from daidalos.industry.rapid.tables import Stack, Tables
from daidalos.industry.rapid.tree import ParameterGroup, Tree

MAX_PROBLEMS = 200
_STARTS = ("file", "fragment", "parameters")
_ROUTINES = {"PROC", "FUNC", "TRAP", "RECORD"}


@dataclass
class Parsed:
    """A module as it was read.

    Attributes
    ----------
    tree
        What could be made of it; complete where there are no problems.
    problems
        Syntax errors in the order of the text.
    tokens, comments
        All tokens, and all comments.
    """

    source: Source
    tree: Tree
    tokens: list[Lexeme]
    comments: list[Lexeme]
    problems: list[Problem] = field(default_factory=list)


def parse(source: Source) -> Parsed:
    """Parse a module, or lines that stand in no module."""
    with no_collection():
        return _parse(source)


@contextlib.contextmanager
def no_collection() -> Iterator[None]:
    """Keep the garbage collector from walking through a tree, in which nothing is garbage, again and again."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def _parse(source: Source) -> Parsed:
    tokens, comments = tokenize(source.text)
    parsed = Parsed(source, Tree(), tokens, comments)
    if not tokens:
        parsed.problems.append(Problem(1, 1, "there is no module in this file; it begins with MODULE name", "syntax"))
        return parsed
    stack = Stack(_tables(), _start(tokens))
    recovery = Recovery(source, stack)
    ended = [*tokens, Lexeme("$END", "", len(source.text))]
    after: int | None = 0
    while after is not None and (position := stack.feed(ended, after)) < len(ended):
        after = recovery.recover(ended, position) if len(recovery.problems) < MAX_PROBLEMS else None
    parsed.problems = recovery.problems
    if after is not None:
        parsed.tree = stack.values[0]
    return parsed


def parse_parameters(text: str) -> list[ParameterGroup]:
    """Parse a list of parameters in parentheses, as the declarations of predefined routines have it.

    Raises
    ------
    ValueError
        If the text is not one.
    """
    stack = Stack(_tables(), "parameters")
    tokens = [*tokenize(text)[0], Lexeme("$END", "", len(text))]
    position = stack.feed(tokens, 0)
    if position < len(tokens):
        raise ValueError(f"{text}: {tokens[position]} is not expected")
    groups: list[ParameterGroup] = stack.values[0]
    return groups


def _start(tokens: list[Lexeme]) -> str:
    """Return the start symbol: what is in no module, and has no routine either, is a fragment."""
    types = {token.type for token in tokens}
    return "file" if "MODULE" in types or types & _ROUTINES else "fragment"


@functools.cache
def _tables() -> Tables:
    """Return the parser; its tables are kept in the cache folder, where one can be written."""
    text = files(__package__ or "").joinpath("grammar.lark").read_text(encoding="utf-8")
    cache: str | bool = False
    try:
        folder = cache_folder() / "rapid"
        folder.mkdir(parents=True, exist_ok=True)
        cache = str(folder / "grammar")
    except OSError:
        pass
    grammar = Lark(
        text,
        parser="lalr",
        lexer="basic",
        start=list(_STARTS),
        transformer=TreeBuilder(),
        cache=cache,
    )
    return Tables(grammar, _STARTS)
