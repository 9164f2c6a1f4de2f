"""Several launches from one test description."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator
from typing import Any


def parametrize(
    argnames: str | Iterable[str], argvalues: Iterable[Any]
) -> Callable[[Callable[..., Any]], Callable[[], Iterator[tuple[Callable[..., Any], dict[str, Any]]]]]:
    """Return a decorator that has a test description made once for each set of argument values.

    Parameters
    ----------
    argnames
        The names of the arguments; as text with commas between them, or several.
    argvalues
        For each launch a value, or a tuple of as many values as there are names.
    """
    names = [name.strip() for name in argnames.split(",")] if isinstance(argnames, str) else list(argnames)
    names = [name for name in names if name]
    sets = [tuple(values) if len(names) > 1 or isinstance(values, tuple) else (values,) for values in argvalues]

    def decorator(
        function: Callable[..., Any],
    ) -> Callable[[], Iterator[tuple[Callable[..., Any], dict[str, Any]]]]:
        @functools.wraps(function)
        def descriptions() -> Iterator[tuple[Callable[..., Any], dict[str, Any]]]:
            for values in sets:
                arguments = dict(zip(names, values, strict=True))
                partial = functools.partial(function, **arguments)
                functools.update_wrapper(partial, function)
                yield partial, arguments

        descriptions.__parametrized__ = True  # type: ignore[attr-defined]  # marks the function
        return descriptions

    return decorator
