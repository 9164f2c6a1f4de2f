"""`daidalos arm egm`: a simulated controller that is guided over the network, and a look at what a controller sends."""

from __future__ import annotations

import argparse
import math

from daidalos.common.errors import UserError

PORT = 6510


def add_egm_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `daidalos arm egm`."""
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    serve = commands.add_parser("serve", help="simulate a controller whose robot is guided by EGM")
    serve.add_argument("arm", metavar="ARM", help="such as irb120")
    serve.add_argument(
        "--to", default="127.0.0.1", metavar="ADDRESS", help="of the guiding program (default: loopback)"
    )
    serve.add_argument("--port", type=int, default=PORT, help=f"of the guiding program (default: {PORT})")
    serve.add_argument("--mode", choices=["joint", "pose"], default="joint", help="what is guided (default: joint)")
    serve.add_argument(
        "--timeout", type=_positive, default=1.0, metavar="S", help="without guidance after which it stops (default: 1)"
    )
    serve.add_argument("--wait", action="store_true", help="wait for the first guidance, and begin anew after a stop")
    serve.add_argument("--time", type=_positive, default=math.inf, metavar="S", help="end after so many seconds")
    serve.set_defaults(_command=_serve)
    watch = commands.add_parser("watch", help="print what a controller sends, once a second")
    watch.add_argument("--listen", default="127.0.0.1", metavar="ADDRESS", help="own address (default: loopback)")
    watch.add_argument("--port", type=int, default=PORT, help=f"own port (default: {PORT})")
    watch.add_argument("--time", type=_positive, default=math.inf, metavar="S", help="end after so many seconds")
    watch.set_defaults(_command=_watch)


def _positive(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and value > 0.0):
        raise argparse.ArgumentTypeError(f"'{text}' is not greater than 0")
    return value


def _serve(args: argparse.Namespace) -> None:
    import numpy as np

    from daidalos.industry.egm.controller import EgmSettings, GuidedController
    from daidalos.industry.egm.controller_server import EgmControllerServer
    from daidalos.industry.robots import REDUNDANT_ARMS, arm_named

    arm = REDUNDANT_ARMS.get(args.arm.lower()) or arm_named(args.arm)
    settings = EgmSettings(args.mode, args.timeout, args.wait)
    controller = GuidedController(arm, settings=settings)
    left = args.time
    try:
        with EgmControllerServer(controller, args.to, args.port) as server:
            print(f"{arm.title} sends to {args.to}:{args.port} every 4 ms", flush=True)
            while True:
                server.run(left)
                controller = server.controller
                left -= controller.time
                if not controller.stopped or not args.wait or left <= 0.0:
                    break
                server.controller = GuidedController(arm, controller.joints, settings)
    except KeyboardInterrupt:
        print()
    angles = ", ".join(f"{angle:.3f}" for angle in np.degrees(controller.joints))
    print(f"the robot is at [{angles}] deg, {controller.refused} messages refused")
    if controller.refused:
        print(f"the last one since {controller.last_refusal}")
    if controller.stopped and not args.wait:
        raise UserError(f"the robot has stopped: {controller.stopped}")


def _watch(args: argparse.Namespace) -> None:
    import time

    import numpy as np

    from daidalos.industry.egm.client import EgmClient

    begin = time.monotonic()
    shown = -math.inf
    try:
        with EgmClient(args.listen, args.port) as client:
            print(f"listening on {args.listen}:{client.port}", flush=True)
            while time.monotonic() - begin < args.time:
                state = client.wait(5.0)
                if time.monotonic() - shown < 1.0:
                    continue
                shown = time.monotonic()
                angles = ", ".join(f"{angle:.3f}" for angle in np.degrees(state.joints))
                guided = "guided" if state.is_guided else "not guided"
                print(f"message {state.number}: [{angles}] deg, {guided}", flush=True)
    except KeyboardInterrupt:
        print()
    counts = client.statistics
    print(f"{counts.taken} messages, {counts.missed} missed, {counts.late} late, {counts.refused} refused")
