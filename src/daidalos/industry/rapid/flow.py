"""Flow of control in a routine: what cannot be reached, and functions that end without a result."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from daidalos.industry.rapid import tree

_ENDING_CALLS = {"exitcycle", "raisetouser", "systemstopaction"}


def goes_on(body: Sequence[tree.Statement]) -> bool:
    """Return whether control can get behind the last statement of a list."""
    reachable = True
    for statement in body:
        if isinstance(statement, tree.Label):
            reachable = True
        reachable = reachable and _passes(statement)
    return reachable


def _passes(statement: tree.Statement) -> bool:
    """Return whether control can get behind a statement."""
    match statement:
        case tree.Return() | tree.Raise() | tree.Exit() | tree.Goto() | tree.Retry() | tree.TryNext():
            return False
        case tree.CallStatement():
            return statement.name.key not in _ENDING_CALLS
        case tree.If():
            bodies = [branch.body for branch in statement.branches]
            return statement.otherwise is None or any(goes_on(body) for body in [*bodies, statement.otherwise])
        case tree.While():
            endless = isinstance(statement.condition, tree.Boolean) and statement.condition.value
            return not endless
        case tree.Test():
            cases = [case for case in statement.cases if isinstance(case, tree.Case)]
            has_default = any(case.values is None for case in cases)
            return not has_default or any(goes_on(case.body) for case in cases)
    return True


def unreachable(body: Sequence[tree.Statement]) -> Iterator[tuple[tree.Statement, tree.Statement]]:
    """Yield the first statement of each list that cannot be reached, with the one that keeps control from it."""
    for index, statement in enumerate(body):
        for inner in inner_bodies(statement):
            yield from unreachable(inner)
        if not _passes(statement):
            rest = body[index + 1 :]
            if rest and not isinstance(rest[0], tree.Label):
                yield rest[0], statement
                return


def inner_bodies(statement: tree.Statement) -> Iterator[list[tree.Statement]]:
    """Yield the lists of statements in a statement."""
    match statement:
        case tree.If():
            yield from (branch.body for branch in statement.branches)
            if statement.otherwise is not None:
                yield statement.otherwise
        case tree.For() | tree.While():
            yield statement.body
        case tree.Test():
            yield from (case.body for case in statement.cases if isinstance(case, tree.Case))


def statements(body: Sequence[tree.Statement]) -> Iterator[tree.Statement]:
    """Yield all statements of a list, and those in them."""
    for statement in body:
        yield statement
        for inner in inner_bodies(statement):
            yield from statements(inner)
