"""Names of topics and frames in plugins' parameters."""

from __future__ import annotations


def absolute_topic(name: str, namespace: str = "") -> str:
    """Return a topic's absolute name.

    Parameters
    ----------
    name : str
        Relative names go below `namespace`; those that start with a slash stay.
    namespace : str
        With or without slashes.
    """
    if name.startswith("/"):
        return name
    return "/" + "/".join(part for part in (*namespace.split("/"), *name.split("/")) if part)


def join_namespaces(outer: str, inner: str) -> str:
    """Return the namespace `inner` resolved in `outer`; a leading slash makes it absolute."""
    return absolute_topic(inner, outer).rstrip("/") if inner else outer


def frame(name: str) -> str:
    """Return a frame's name without a leading slash, as tf2 requires."""
    return name.lstrip("/")
