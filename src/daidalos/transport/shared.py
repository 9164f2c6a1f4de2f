"""Sessions shared within a process, one for each domain and middleware."""

from __future__ import annotations

import atexit
import functools
import os
import signal
import threading
from importlib.util import find_spec

from daidalos.transport.abandoned import AbandonedObjects
from daidalos.transport.backend import Backend
from daidalos.transport.environment import Environment, EnvironmentVariableError
from daidalos.transport.session import Session

_lock = threading.Lock()
_sessions: dict[tuple[int, Environment], tuple[Session, int]] = {}
_abandoned = AbandonedObjects()

# The packages of the middlewares that reach other processes.
_LIBRARIES = {"rmw_zenoh_cpp": "zenoh", "rmw_cyclonedds_cpp": "cyclonedds"}
MIDDLEWARES = (*_LIBRARIES, "rmw_daidalos_inprocess")


def installed_middlewares() -> list[str]:
    """Return the names of the middlewares that reach other processes and whose libraries are installed."""
    return [name for name, library in _LIBRARIES.items() if find_spec(library) is not None]


def acquire(environment: Environment) -> Session:
    """Return the process's session for this environment, opened if needed; `release` it once for each call.

    Raises
    ------
    EnvironmentVariableError
        When ``RMW_IMPLEMENTATION`` names a middleware that is not available.
    """
    key = (os.getpid(), environment)
    with _lock:
        session, users = _sessions.get(key) or (Session(make_backend(environment)), 0)
        _sessions[key] = (session, users + 1)
        return session


def release(environment: Environment) -> None:
    """Release a session; the last release closes it."""
    key = (os.getpid(), environment)
    with _lock:
        session, users = _sessions.pop(key, (None, 0))
        if session is None:
            return  # the process ends, and has left the graph
        if users > 1:
            _sessions[key] = (session, users - 1)
            return
    session.close()


def abandon(environment: Environment) -> None:
    """Release a session in a thread, on behalf of an object that the garbage collector found."""
    _abandoned.close(functools.partial(release, environment))


def make_backend(environment: Environment) -> Backend:
    """Return a new backend of the middleware that an environment names.

    Raises
    ------
    EnvironmentVariableError
        When there is none of that name, or what it needs is not installed.
    """
    match environment.middleware:
        case "rmw_zenoh_cpp":
            from daidalos.transport.zenoh.backend import ZenohBackend

            return ZenohBackend(environment)
        case "rmw_cyclonedds_cpp":
            from daidalos.transport.cyclonedds.backend import CycloneBackend

            return CycloneBackend(environment)
        case "rmw_daidalos_inprocess":
            from daidalos.transport.inprocess import InProcessBackend

            return InProcessBackend()
    raise EnvironmentVariableError(
        f"RMW_IMPLEMENTATION is '{environment.middleware}', which is not available; use one of {', '.join(MIDDLEWARES)}"
    )


@atexit.register
def _close_all() -> None:
    """Leave the graph when the process ends without having done so."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second Ctrl-C must not leave it half done
    _abandoned.finish()
    with _lock:
        mine = [session for (process, _), (session, _) in _sessions.items() if process == os.getpid()]
        _sessions.clear()
    for session in mine:
        session.close()
