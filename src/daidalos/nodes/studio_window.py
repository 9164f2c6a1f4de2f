"""The studio as the window of a program, served by a hidden node."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from subprocess import Popen, TimeoutExpired
from typing import TYPE_CHECKING, TypeVar

from daidalos.nodes.runner import UserError, create, ignore_interrupts, program_arguments, run, run_program
from daidalos.studio.arrangement import Arrangement, ArrangementError
from daidalos.studio.guarded_server import LOOPBACK
from daidalos.studio.ports import PortError

if TYPE_CHECKING:
    from rclpy.node import Node

    NodeT = TypeVar("NodeT", bound=Node)

END_S = 3.0


def run_with_window(make_node: Callable[[], NodeT], panel: str, details: Callable[[NodeT], Mapping[str, str]]) -> int:
    """Spin a node and serve its window until the process is asked to end.

    Parameters
    ----------
    make_node
        Creates the node after rclpy is initialized.
    panel
        The studio's panel to open.
    details
        Returns further query parameters of the window's address, from the node.

    Returns
    -------
    int
        The exit status.
    """
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node

    from daidalos.nodes.studio import Studio

    def body() -> None:
        rclpy.init()
        node = create(make_node)
        # Remappings and parameters on the command line are for the node, not for its window.
        hidden = Node(
            f"_{panel}_window_{os.getpid()}",
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.add_node(hidden)
        studio = None
        try:
            studio = Studio(hidden)
            show(studio.url(panel, **details(node)))
        except PortError as error:
            node.get_logger().warning(f"There is no window: {error}")
        try:
            executor.spin()
        finally:
            ignore_interrupts()
            if studio is not None:
                studio.close()
            hidden.destroy_node()
            node.destroy_node()

    return run_program(body)


def show(url: str, *, open_it: bool = True) -> None:
    """Print the address of a page, and open it in the browser."""
    from daidalos.nodes.studio import open_in_browser

    print(f"window: {url}", file=sys.stderr, flush=True)
    if open_it:
        open_in_browser(url)


def run_studio(
    name: str,
    panel: str,
    arguments: argparse.Namespace,
    arrangement: Arrangement | None = None,
    *,
    front: str = "",
    hosts: Sequence[str] = LOOPBACK,
    companion: Sequence[str] | None = None,
    **details: str,
) -> int:
    """Open the studio at a panel, and serve it until the process is asked to end.

    Parameters
    ----------
    name
        The node's name.
    panel
        The panel, empty for the whole studio.
    arguments
        Parsed by a parser of `studio_parser`.
    arrangement
        The layout with which the page opens; None: the page's default.
    front
        The panel of the whole studio that is in front; only where `panel` is empty.
    hosts
        Addresses to listen on.
    companion
        Command line of a program that runs as long as the studio; None: there is none.
    **details
        Further query parameters of the address.

    Returns
    -------
    int
        The exit status.
    """
    from rclpy.node import Node

    from daidalos.nodes.studio import Studio

    class Window(Node):
        """Server of the studio."""

        def __init__(self) -> None:
            super().__init__(name)
            try:
                self._studio = Studio(self, arguments.port, hosts, arrangement=arrangement)
            except PortError as error:
                super().destroy_node()
                raise UserError(str(error)) from None
            self._studio.warn_of_exposure(self)
            self._companion = Popen(companion) if companion else None
            show(self._studio.url(panel, front, **details), open_it=not arguments.headless)

        def destroy_node(self) -> None:
            """End the companion, close the page's connections and leave the graph."""
            if self._companion is not None:
                end(self._companion)
            self._studio.close()
            super().destroy_node()

    return run(Window)


def end(process: Popen[bytes]) -> None:
    """End a program that obeys SIGTERM; kill it where it does not within `END_S` seconds."""
    process.terminate()
    try:
        process.wait(END_S)
    except TimeoutExpired:
        process.kill()
        process.wait()


def read_arrangement(
    path: str, read: Callable[[Path], Arrangement], parser: argparse.ArgumentParser
) -> tuple[Arrangement, dict[str, str]]:
    """Read a layout file; an error in it ends the program.

    Returns
    -------
    arrangement
        The layout; what the studio does not have of it is printed.
    details
        For the page's address.
    """
    try:
        arrangement = read(Path(path))
    except FileNotFoundError:
        parser.error(f"there is no file '{path}'")
    except OSError as error:
        parser.error(f"cannot read '{path}': {error.strerror}")
    except ArrangementError as error:
        parser.error(str(error))
    if arrangement.left_out:
        print(f"{parser.prog}: not in the studio, left out: {', '.join(arrangement.left_out)}", file=sys.stderr)
    return arrangement, {"layout": Path(path).name}


def rqt_node_name() -> str:
    """Return a node name as rqt's nodes have; it is unique on this machine."""
    return f"rqt_gui_py_node_{os.getpid()}"


def studio_parser(program: str, description: str) -> argparse.ArgumentParser:
    """Return a parser of the options that every command of the studio has."""
    parser = argparse.ArgumentParser(prog=program, description=description, allow_abbrev=False)
    parser.add_argument("--headless", action="store_true", help="serve the page, but open no browser")
    parser.add_argument("--port", type=int, default=8765, metavar="N", help="the page's, or the next free one above")
    return parser


def parse(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """Parse the command line of a command of the studio, without ROS's arguments."""
    return parser.parse_args(program_arguments())
