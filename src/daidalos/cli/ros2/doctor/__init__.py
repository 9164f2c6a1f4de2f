"""`ros2 doctor`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import ClassVar

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.completion import complete_packages
from daidalos.cli.ros2.extension import Status
from daidalos.cli.ros2.verbs import VerbCommand


class DoctorCommand(VerbCommand):
    """Check ROS setup and other potential issues."""

    group = "ros2doctor.verb"
    verbs: ClassVar = {"hello": "Check network connectivity between multiple hosts"}

    def add_options(self, parser: ArgumentParser) -> None:
        """Declare the arguments of the command without a verb."""
        group = parser.add_mutually_exclusive_group()
        group.add_argument("--report", "-r", action="store_true", help="Print all reports.")
        group.add_argument("--report-failed", "-rf", action="store_true", help="Print reports of failed checks only.")
        complete_packages(
            parser.add_argument(
                "--exclude-packages",
                "-ep",
                nargs="*",
                help="Exclude packages from package checks or report: those named, or all.",
            )
        )
        parser.add_argument(
            "--include-warnings",
            "-iw",
            action="store_true",
            help="Include warnings as failed checks. Warnings are ignored by default.",
        )

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Run the checks, or print the reports."""
        from ros2doctor.api import generate_reports, run_checks
        from ros2doctor.api.format import format_print
        from ros2doctor.api.graph import shared_graph

        excluded = False if args.exclude_packages is None else args.exclude_packages or True
        with direct_node(args) as node, shared_graph(node.handle.graph):
            if args.report:
                for report in generate_reports(exclude_packages=excluded):
                    format_print(report)
                return 0
            failed, fails, total = run_checks(include_warnings=args.include_warnings, exclude_packages=excluded)
            if fails:
                print(f"\n{fails}/{total} check(s) failed\n")
                print("Failed modules:", *sorted(failed))
            else:
                print(f"\nAll {total} checks passed\n")
            if args.report_failed and fails:
                for report in generate_reports(categories=failed, exclude_packages=excluded):
                    format_print(report)
        return 0
