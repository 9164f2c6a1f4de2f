"""`ros2 control switch_controllers`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2topic.api import positive_float

from daidalos.cli.ros2.controllers import ControlVerb, add_controller_argument, switch
from daidalos.cli.ros2.extension import Status


class SwitchControllersVerb(ControlVerb):
    """Switch controllers in a controller manager."""

    def add_own_arguments(self, parser: ArgumentParser) -> None:
        """Declare the arguments."""
        for flag, done in (("--deactivate", "deactivated"), ("--activate", "activated")):
            text = f"Name of the controllers to be {done}"
            add_controller_argument(parser, text, flag, nargs="*", default=[])
        strictness = parser.add_mutually_exclusive_group()
        strictness.add_argument("--strict", action="store_true", help="Strict switch")
        strictness.add_argument("--best-effort", action="store_true", help="Best effort switch")
        parser.add_argument("--activate-asap", action="store_true", help="Start asap controllers")
        parser.add_argument(
            "--switch-timeout", type=positive_float, default=5.0, help="Timeout for switching controllers"
        )

    def main(self, *, args: Namespace) -> Status:
        """Switch the controllers."""
        with direct_node(args) as node:
            switch(
                node,
                args,
                "Error switching controllers",
                activate=args.activate,
                deactivate=args.deactivate,
                strict=args.strict,
                asap=args.activate_asap,
                timeout_s=args.switch_timeout,
            )
        print("Successfully switched controllers")
        return 0
