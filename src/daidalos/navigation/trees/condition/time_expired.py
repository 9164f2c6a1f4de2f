"""Condition nodes on time."""

from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port, Ports, TreeContext, entry


class TimeExpired(Node):
    """Condition node that succeeds each time that `seconds` have passed since it last did, or since its first tick."""

    names = ("TimeExpired",)
    PORTS: ClassVar[dict[str, Port]] = {"seconds": Port(float, 1.0)}

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._since: float | None = None

    def update(self) -> Status:
        """Compare the time with that of the last success."""
        now = self.services.now()
        if self._since is None:
            self._since = now
        if 0.0 <= now - self._since < self.ports.get("seconds"):
            return Status.FAILURE
        self._since = now
        return Status.SUCCESS


class PathExpiringTimer(Node):
    """Condition node that succeeds when the same path is there for `seconds`."""

    names = ("PathExpiringTimer",)
    PORTS: ClassVar[dict[str, Port]] = {"seconds": Port(float, 1.0), "path": Port(entry, None)}

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._path: Any = None
        self._since: float | None = None

    def update(self) -> Status:
        """Compare the path and the time with those of the last change."""
        now, path = self.services.now(), self.ports.get("path")
        if self._since is None or path is not self._path:
            self._path, self._since = path, now
        if 0.0 <= now - self._since < self.ports.get("seconds"):
            return Status.FAILURE
        self._since = now
        return Status.SUCCESS
