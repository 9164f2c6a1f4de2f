"""The command `launch_test`: runs the tests in a file that describes a launch."""

from __future__ import annotations

import argparse
import os
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from types import ModuleType
from typing import Any

from .junitxml import unittestResultsToXml
from .loader import LoadTestsFromPythonModule
from .print_arguments import print_arguments_of_launch_description
from .test_runner import LaunchTestRunner


def main() -> int:
    """Run the command."""
    parser, args = parse_arguments()
    return run(parser, args)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments to a parser."""
    parser.add_argument("launch_test_file", help="path to the launch test")
    parser.add_argument("-v", "--verbose", action="store_true", help="log everything that happens")
    parser.add_argument(
        "-s", "--show-args", "--show-arguments", action="store_true", help="show the arguments of the launch"
    )
    parser.add_argument("--show-all-subprocesses-output", action="store_true", help="show all that the processes print")
    parser.add_argument("--package-name", help="name of the package, for the results")
    parser.add_argument("--junit-xml", metavar="XMLPATH", help="write the results as JUnit's XML")
    parser.add_argument(
        "launch_arguments", nargs="*", help="arguments to the launch file in the form '<name>:=<value>'"
    )


def parse_arguments() -> tuple[argparse.ArgumentParser, argparse.Namespace]:
    """Return the command's parser and what it read from the command line."""
    parser = argparse.ArgumentParser(description="Launch integration testing tool.")
    add_arguments(parser)
    return parser, parser.parse_args()


def run(
    parser: argparse.ArgumentParser, args: argparse.Namespace, test_runner_cls: type[Any] = LaunchTestRunner
) -> int:
    """Run the tests that the arguments name, and return the exit code: 0 if they all passed.

    Parameters
    ----------
    parser
        Ends the program with a message where the arguments are wrong.
    args
        The arguments.
    test_runner_cls
        Runs the tests.
    """
    path = os.path.abspath(args.launch_test_file)
    if not os.path.isfile(path):
        parser.error(f"Test file '{args.launch_test_file}' does not exist")
    if getattr(args, "show_all_subprocesses_output", False):
        os.environ["OVERRIDE_LAUNCH_PROCESS_OUTPUT"] = "both"
    package = getattr(args, "package_name", None)
    module = _load(path)
    name = os.path.splitext(os.path.basename(path))[0]
    runs = LoadTestsFromPythonModule(module, name=f"{package or name}.{name}.launch_tests")
    runner = test_runner_cls(runs, args.launch_arguments, debug=args.verbose)
    try:
        runner.validate()
        if args.show_args:
            print_arguments_of_launch_description(launch_description=runs[0].get_launch_description())
            return 0
        results = runner.run()
    except Exception as error:
        parser.error(f"{args.launch_test_file}: {error}")
    if args.junit_xml:
        tree = unittestResultsToXml(
            name=package or "launch_test", test_results={str(run): result for run, result in results.items()}
        )
        tree.write(args.junit_xml, encoding="utf-8", xml_declaration=True)
    return 0 if all(result.wasSuccessful() for result in results.values()) else 1


def _load(path: str) -> ModuleType:
    loader = SourceFileLoader("launch_test_file", path)
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None, "a loader of its own always gives a specification"
    module = module_from_spec(spec)
    # Tests beside the file may be imported from it.
    sys.path.insert(0, os.path.dirname(path))
    try:
        loader.exec_module(module)
    finally:
        sys.path.remove(os.path.dirname(path))
    return module


if __name__ == "__main__":
    sys.exit(main())
