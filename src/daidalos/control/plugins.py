"""Finds the classes of controllers and hardware by the names that files give them, ours and the user's."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from functools import cache
from importlib.metadata import entry_points
from types import ModuleType
from typing import TYPE_CHECKING, TypeVar

from daidalos.control.errors import ControlError, UnknownError

if TYPE_CHECKING:
    from daidalos.control.controllers.base import Controller
    from daidalos.control.hardware.base import Hardware

T = TypeVar("T")

CONTROLLER_GROUP = "daidalos.controllers"
HARDWARE_GROUP = "daidalos.hardware"


def controller_class(name: str) -> type[Controller]:
    """Return the class for a controller's type, such as ``forward_command_controller/ForwardCommandController``.

    A class of the user's is found by an entry point, or by its place: ``my_package.my_module.MyController``.

    Raises
    ------
    UnknownError
        When there is none.
    ControlError
        When the class is there and can not be used.
    """
    from daidalos.control.controllers.base import Controller

    return _find("controller type", name, controllers(), Controller)


def hardware_class(name: str) -> type[Hardware]:
    """Return the class for a hardware plugin's name; see `controller_class`."""
    from daidalos.control.hardware.base import Hardware

    return _find("hardware plugin", name, _hardware(), Hardware)


@cache
def controllers() -> dict[str, type[Controller]]:
    """Return all types of controllers that are known by name."""
    from daidalos.control import controllers as package
    from daidalos.control.controllers.base import Controller

    found = {name: cls for cls in _classes(package, Controller) for name in cls.types}
    for entry in entry_points(group=CONTROLLER_GROUP):
        found[entry.name] = entry.load()
    return found


@cache
def _hardware() -> dict[str, type[Hardware]]:
    from daidalos.control import hardware as package
    from daidalos.control.hardware.base import Hardware

    found = {name: cls for cls in _classes(package, Hardware) for name in cls.names}
    for entry in entry_points(group=HARDWARE_GROUP):
        found[entry.name] = entry.load()
    return found


def _find(what: str, name: str, known: dict[str, type[T]], base: type[T]) -> type[T]:
    if name in known:
        return known[name]
    place = name.replace("::", ".").replace("/", ".").replace(":", ".")
    module_name, _, class_name = place.rpartition(".")
    if not module_name:
        raise UnknownError(what, name, known)
    try:
        module = importlib.import_module(module_name)
    except ModuleNotFoundError as error:
        if error.name is not None and (module_name == error.name or module_name.startswith(f"{error.name}.")):
            raise UnknownError(what, name, known) from None
        raise ControlError(f"{what} '{name}' can not be imported: {error}") from error
    cls = getattr(module, class_name, None)
    if not (isinstance(cls, type) and issubclass(cls, base)):
        raise ControlError(f"{what} '{name}': module '{module_name}' has no {base.__name__} class '{class_name}'")
    return cls


def _classes(package: ModuleType, base: type[T]) -> Iterator[type[T]]:
    """Yield the subclasses of `base` that the modules of a package define."""
    for info in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        module = importlib.import_module(info.name)
        for _, cls in inspect.getmembers(module, inspect.isclass):
            if issubclass(cls, base) and cls.__module__ == module.__name__:
                yield cls
