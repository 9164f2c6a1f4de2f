"""Tables of the parser that lark has computed, in the form that is quickest to run.

A rule such as ``?sum: term`` changes nothing but the state. Expressions pass many of them at each name or number; so
where a chain of them leads is looked up by the state below, the state and the next token, once it is known.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

from lark import Lark
from lark.parsers.lalr_analysis import Shift

from daidalos.industry.rapid.lexing import Lexeme

MAX_DEPTH = 500
"""States on the stack, of which each open bracket takes one and each open block about four."""


class Reduction(NamedTuple):
    """Replacement of the last `size` values by what `action` makes of them; without an action the value stays."""

    size: int
    action: Callable[[list[Any]], Any] | None
    origin: str


Action: TypeAlias = int | Reduction
"""The state after a shift, or a reduction."""


class Tables:
    """What to do in each state, for each type of the next token."""

    def __init__(self, grammar: Lark, starts: Sequence[str]) -> None:
        conf = {start: grammar.parse_interactive("", start=start).parser_state.parse_conf for start in starts}
        table = conf[starts[0]].parse_table
        self.actions: list[dict[str, Action]] = [{} for _ in range(max(table.states) + 1)]
        self.gotos: list[dict[str, int]] = [{} for _ in self.actions]
        callbacks = conf[starts[0]].callbacks
        reductions: dict[Any, Reduction] = {}
        for state, entries in table.states.items():
            for symbol, (action, argument) in entries.items():
                if action is Shift:
                    self.actions[state][symbol] = self.gotos[state][symbol] = argument
                    continue
                if argument not in reductions:
                    reductions[argument] = _reduction(argument, callbacks[argument])
                self.actions[state][symbol] = reductions[argument]
        self.start_states = {start: table.start_states[start] for start in starts}
        self.end_states = {start: table.end_states[start] for start in starts}
        self._chains: dict[tuple[int, int, str], int] = {}

    def chain(self, below: int, state: int, type_: str) -> int:
        """Return the state behind all rules that change nothing, from a state on another one."""
        key = (below, state, type_)
        found = self._chains.get(key)
        if found is None:
            found = state
            while True:
                action = self.actions[found].get(type_)
                if not isinstance(action, Reduction) or action.action is not None:
                    break
                found = self.gotos[below][action.origin]
            self._chains[key] = found
        return found


def _reduction(rule: Any, callback: Callable[[list[Any]], Any]) -> Reduction:
    size = len(rule.expansion)
    is_unit = size == 1 and (rule.alias == "itself" or (rule.options.expand1 and not rule.alias))
    return Reduction(size, None if is_unit else callback, rule.origin.name)


class Stack:
    """The parser's stack: states, and between each two the value that led from one to the other."""

    def __init__(self, tables: Tables, start: str) -> None:
        self.tables = tables
        self.states = [tables.start_states[start]]
        self.values: list[Any] = []
        self._end_state = tables.end_states[start]

    def feed(self, tokens: Sequence[Lexeme], first: int) -> int:
        """Push tokens from the first on; return the index of one that does not fit or is too deep, else their number.

        After the token ``$END`` fits, the only value is the result.
        """
        actions, gotos, chain = self.tables.actions, self.tables.gotos, self.tables.chain
        states, values = self.states, self.values
        end_state = self._end_state
        for position in range(first, len(tokens)):
            if len(states) > MAX_DEPTH:
                return position
            token = tokens[position]
            type_ = token.type
            while True:
                action = actions[states[-1]].get(type_)
                if action.__class__ is int:
                    states.append(action)
                    values.append(token)
                    break
                if action is None:
                    return position
                size, make, origin = action
                if make is None:
                    states[-1] = chain(states[-2], states[-1], type_)
                    continue
                if size == 1:
                    values[-1] = make(values[-1:])
                    states[-1] = gotos[states[-2]][origin]
                    if type_ == "$END" and states[-1] == end_state:
                        break
                    continue
                if size:
                    parts = values[-size:]
                    del values[-size:], states[-size:]
                else:
                    parts = []
                values.append(make(parts))
                states.append(gotos[states[-1]][origin])
                if type_ == "$END" and states[-1] == end_state:
                    break
        return len(tokens)

    def accepts(self, types: Sequence[str], size: int | None = None) -> bool:
        """Return whether tokens of these types fit, on the whole stack or its first states."""
        states = self.states[:size]
        for type_ in types:
            while True:
                action = self.tables.actions[states[-1]].get(type_)
                if action is None:
                    return False
                if not isinstance(action, Reduction):
                    states.append(action)
                    break
                if action.size:
                    del states[-action.size :]
                states.append(self.tables.gotos[states[-1]][action.origin])
                if type_ == "$END" and states[-1] == self._end_state:
                    break
        return True

    def cut(self, size: int) -> None:
        """Keep the first states only, and the values between them."""
        del self.states[size:], self.values[size - 1 :]
