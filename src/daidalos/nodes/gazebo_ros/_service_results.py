"""Results of the services of `simulation_interfaces`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.description.errors import DescriptionError
from daidalos.description.resolve import default_model_path, resolve_uri
from daidalos.nodes.packages import package_share
from daidalos.simulation.errors import SimulationError, UnknownNameError

UNSUPPORTED, OK, NOT_FOUND, INCORRECT_STATE, FAILED = range(5)
"""Codes of ``simulation_interfaces/msg/Result``."""


@dataclass(frozen=True)
class Failure(Exception):
    """Error response of a service: a code of its own or of `Result`, and a message."""

    code: int
    words: str


Work = Callable[[Any, Any], None]


def create_services(node: Any, services: Iterable[tuple[Any, str, Work]], group: Any) -> None:
    """Create services of a node below its own name.

    Parameters
    ----------
    node : Node
    services : iterable of (type, name, callable)
        The callable takes request and response; a `Failure` or an error that it raises becomes the result.
    group : CallbackGroup
    """
    for kind, name, work in services:
        node.create_service(kind, f"~/{name}", _answering(work), callback_group=group)


def _answering(work: Work) -> Callable[[Any, Any], Any]:
    """Return a callback that answers with a result, whatever happens."""

    def answer(request: Any, response: Any) -> Any:
        code, words = OK, ""
        try:
            work(request, response)
        except Failure as failure:
            code, words = failure.code, failure.words
        except UnknownNameError as error:
            code, words = NOT_FOUND, str(error)
        except (SimulationError, DescriptionError, ValueError) as error:
            code, words = FAILED, str(error)
        if hasattr(response, "result"):
            response.result.result, response.result.error_message = code, words
        return response

    return answer


def find_resource(uri: str, missing: int) -> Path:
    """Return the file of an address; `Failure` of the code `missing` where there is none."""
    path = resolve_uri(uri, Path.cwd(), package_share, default_model_path()) if uri else None
    if path is None:
        raise Failure(missing, f"there is no resource {uri!r}" if uri else "no resource was given")
    return path
