"""The registers of actions and substitutions that launch files in markup may use."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, TypeVar

from daidalos.common.suggestions import hint

from ..some_substitutions_type import SomeSubstitutionsType

if TYPE_CHECKING:
    from ..action import Action
    from ..substitution import Substitution
    from .entity import Entity
    from .parser import Parser

T = TypeVar("T")

action_parse_methods: dict[str, Callable[..., Any]] = {}
substitution_parse_methods: dict[str, Callable[..., Any]] = {}


def instantiate_action(entity: Entity, parser: Parser) -> Action:
    """Create the action that an element stands for.

    Raises
    ------
    RuntimeError
        If no action is exposed under the element's type name.
    """
    parse = _look_up(entity.type_name, action_parse_methods, "launch.actions")
    if parse is None:
        raise RuntimeError(
            f"Unrecognized entity of the type: {entity.type_name}{hint(entity.type_name, action_parse_methods)}"
        )
    action: Action = _construct(parse(entity, parser))
    return action


def instantiate_substitution(type_name: str, args: Iterable[SomeSubstitutionsType] | None = None) -> Substitution:
    """Create the substitution that `$(type_name args...)` stands for.

    Raises
    ------
    RuntimeError
        If no substitution is exposed under this name.
    """
    parse = _look_up(type_name, substitution_parse_methods, "launch.substitutions")
    if parse is None:
        raise RuntimeError(f"Unknown substitution: {type_name}{hint(type_name, substitution_parse_methods)}")
    substitution: Substitution = _construct(parse([] if args is None else list(args)))
    return substitution


def expose_substitution(name: str) -> Callable[[T], T]:
    """Return a decorator that lets launch files use a substitution as `$(name ...)`.

    It decorates a class with a class method `parse`, or a function, that takes the arguments and returns a
    class with the keyword arguments to construct it from.
    """
    return __expose_impl(name, substitution_parse_methods, "substitution")


def expose_action(name: str) -> Callable[[T], T]:
    """Return a decorator that lets launch files use an action as an element `name`.

    It decorates a class with a class method `parse`, or a function, that takes an entity and the parser and
    returns a class with the keyword arguments to construct it from.
    """
    return __expose_impl(name, action_parse_methods, "action")


def __expose_impl(name: str, parse_methods_map: dict[str, Callable[..., Any]], exposed_type: str) -> Callable[[T], T]:
    def expose(exposed: T) -> T:
        if isinstance(exposed, type):
            parse = getattr(exposed, "parse", None)
            if not callable(parse):
                raise RuntimeError(f"Exposed {exposed_type} parser for {name} is a class without a method 'parse'")
        elif callable(exposed):
            parse = exposed
        else:
            raise RuntimeError(
                f"Exposed {exposed_type} parser for {name} is not a callable or a class containing a parse method: "
                f"{exposed!r}"
            )
        known = parse_methods_map.setdefault(name, parse)
        if not _same(known, parse):
            raise RuntimeError(f"two {exposed_type}s are exposed as '{name}': {known} and {parse}")
        return exposed

    return expose


def _same(first: Callable[..., Any], second: Callable[..., Any]) -> bool:
    # A module that is imported once more defines its classes once more.
    return first == second or (first.__module__, first.__qualname__) == (
        second.__module__,
        second.__qualname__,
    )


def _look_up(name: str, register: dict[str, Callable[..., Any]], package: str) -> Callable[..., Any] | None:
    if name not in register:
        import pkgutil

        for module in pkgutil.iter_modules(importlib.import_module(package).__path__):
            importlib.import_module(f"{package}.{module.name}")
    return register.get(name)


def _construct(parsed: tuple[Any, ...]) -> Any:
    cls, *args, kwargs = parsed
    return cls(*(args[0] if args else ()), **kwargs)
