"""`daidalos rapid serve`: a program on a simulated controller that others reach by Robot Web Services."""

from __future__ import annotations

import argparse
import asyncio
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Callable

    from daidalos.industry.rapid.runtime.task import Task

PORTS = {1: 8080, 2: 8443}


def add_serve_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments beside those of the program."""
    parser.add_argument("--robot", default="irb120", metavar="ARM", help="arm that moves (default: irb120)")
    parser.add_argument(
        "--rws", type=int, choices=[1, 2], default=1, help="version: 1 (HTTP) or 2 (HTTPS) (default: 1)"
    )
    parser.add_argument("--listen", default="127.0.0.1", metavar="ADDRESS", help="own address (default: loopback)")
    parser.add_argument("--port", type=int, metavar="N", help="own port (default: 8080, of version 2: 8443)")
    parser.add_argument("--user", default="Default User", help="user name (default: Default User)")
    parser.add_argument("--password", default="robotics", help="password (default: robotics)")
    parser.add_argument("--certificate", type=Path, metavar="FILE.pem", help="of version 2 (default: a new one)")
    parser.add_argument("--key", type=Path, metavar="FILE.pem", help="of the certificate")
    parser.add_argument("--start", action="store_true", help="start the program at once")


def serve_program(args: argparse.Namespace) -> int:
    """Serve until Ctrl-C; return 0, or 2 where the program cannot be loaded.

    Raises
    ------
    UserError
        Where the port or the certificate cannot be used.
    """
    import ssl

    from daidalos.cli.daidalos.rapid_loading import load_task
    from daidalos.industry.rapid.runtime.pacing import Pace
    from daidalos.industry.rws.access import Access
    from daidalos.industry.rws.certificate import context_of, self_signed_context
    from daidalos.industry.rws.controller import VirtualController
    from daidalos.industry.rws.server import RwsServer

    if (args.certificate is None) != (args.key is None):
        raise UserError("--certificate and --key go together")
    if load_task(args, None, 0.0) is None:
        return 2

    def make_task(pace: Callable[[float], None]) -> Task:
        task = load_task(args, pace, 0.0)
        if task is None:
            raise UserError(f"{args.path}: the program cannot be loaded any more")
        return task

    context: ssl.SSLContext | None = None
    if args.rws == 2:
        context = context_of(args.certificate, args.key) if args.certificate else self_signed_context(args.listen)
    controller = VirtualController(make_task, Pace())
    server = RwsServer(controller, args.rws, Access(args.user, args.password, args.rws == 2))
    port = PORTS[args.rws] if args.port is None else args.port

    def say(own: int) -> None:
        scheme = "https" if args.rws == 2 else "http"
        print(f"Robot Web Services {args.rws}.0 at {scheme}://{args.listen}:{own}", flush=True)

    try:
        if args.start:
            controller.start()
        asyncio.run(server.serve(args.listen, port, context, say))
    except KeyboardInterrupt:
        print(file=sys.stderr)
    finally:
        controller.close()
    return 0
