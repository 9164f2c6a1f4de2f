"""Node that survives a change of the machine's network."""

from __future__ import annotations

import argparse
import functools
import inspect
from types import TracebackType
from typing import Any

from ros2cli.node.direct import DirectNode


def get_interfaces_ip_addresses() -> dict[str, Any]:
    """Return the addresses of the machine's network interfaces by name."""
    import psutil

    return psutil.net_if_addrs()


class NetworkAwareNode:
    """Node of a command that is made anew, before it is next used, when the machine's addresses have changed.

    Parameters
    ----------
    args
        What `ros2cli.node.direct.add_arguments` declared.
    """

    def __init__(self, args: argparse.Namespace) -> None:
        self.args = args
        self.node = DirectNode(args)
        self.addresses_at_start = get_interfaces_ip_addresses()

    def __enter__(self) -> NetworkAwareNode:
        self.node.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.node.__exit__(kind, error, trace)

    def __getattr__(self, name: str) -> Any:
        attribute = getattr(self.node, name)
        if not inspect.ismethod(attribute):
            self.reset_if_addresses_changed()
            return getattr(self.node, name)

        @functools.wraps(attribute)
        def call(*args: Any, **kwargs: Any) -> Any:
            self.reset_if_addresses_changed()
            return getattr(self.node, name)(*args, **kwargs)

        return call

    def reset_if_addresses_changed(self) -> None:
        """Replace the node if the machine's addresses are not those that it was made with."""
        addresses = get_interfaces_ip_addresses()
        if addresses != self.addresses_at_start:
            self.addresses_at_start = addresses
            self.node.__exit__(None, None, None)
            self.node = DirectNode(self.args)
            self.node.__enter__()
