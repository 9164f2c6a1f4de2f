"""Services and actions of controllers, with the conversions of their messages."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class ServiceEntry:
    """Service of a controller's request class.

    Parameters
    ----------
    message : callable
        Returns the service's class.
    question : callable
        Makes the question of a request.
    fill : callable
        Puts an answer into a response and returns that.
    """

    message: Callable[[], Any]
    question: Callable[[Any], Any]
    fill: Callable[[Any, Any], Any]


@dataclass(frozen=True)
class ActionEntry:
    """Action of a controller's goal class.

    Parameters
    ----------
    message : callable
        Returns the action's class.
    request, feedback, result : callable
        Make the request of a goal, and messages of feedback and results.
    """

    message: Callable[[], Any]
    request: Callable[[Any], Any]
    feedback: Callable[[Any], Any]
    result: Callable[[Any], Any]
