"""`ros2 doctor`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, ClassVar

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.completion import complete_packages
from daidalos.cli.ros2.extension import Status
from daidalos.cli.ros2.verbs import VerbCommand

if TYPE_CHECKING:
    from daidalos.cli.ros2.checkup.subject import Findings, Subject
    from daidalos.transport.graph import Graph


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
                nargs="+",
                default=[],
                help="Exclude packages from package checks or report.",
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
        from daidalos.cli.ros2.checkup import subjects
        from daidalos.cli.ros2.checkup.package import Package

        everything = subjects()
        for subject in everything:
            if isinstance(subject, Package):
                subject.excluded = frozenset(args.exclude_packages)
        with direct_node(args) as node:
            graph = node.handle.graph
            if args.report:
                _print_reports(everything, graph)
                return 0
            failed = _check(everything, graph, args.include_warnings)
            if args.report_failed:
                _print_reports(failed, graph)
        return 0


def _check(everything: list[Subject], graph: Graph, include_warnings: bool) -> list[Subject]:
    """Run the checks and print what they find; return those that failed."""
    checked = [subject for subject in everything if subject.checked]
    failed = [subject for subject in checked if _fails(subject.check(graph), include_warnings)]
    if failed:
        print(f"\n{len(failed)}/{len(checked)} check(s) failed\n")
        print("Failed modules:", *(subject.category for subject in failed))
    else:
        print(f"\nAll {len(checked)} checks passed\n")
    return failed


def _fails(findings: Findings, include_warnings: bool) -> bool:
    """Print the findings of a check; return whether it failed."""
    for text in findings.errors:
        print(f"UserWarning: ERROR: {text}", file=sys.stderr)
    for text in findings.warnings:
        print(f"UserWarning: {text}", file=sys.stderr)
    return bool(findings.errors or (include_warnings and findings.warnings))


def _print_reports(subjects: list[Subject], graph: Graph) -> None:
    for subject in subjects:
        for report in subject.reports(graph):
            print(report)
