"""`ros2 pkg xml`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from xml.etree import ElementTree

from daidalos.cli.ros2.completion import complete_packages
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.packages import package_prefix
from daidalos.common.suggestions import did_you_mean


class XmlVerb(Verb):
    """Output the XML of the package manifest or a specific tag."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        complete_packages(parser.add_argument("package_name", help="The package name"))
        parser.add_argument("-t", "--tag", help="The XML tag to output, e.g. version")

    def main(self, *, args: Namespace) -> Status:
        """Print the manifest, or the text of every element with the tag."""
        path = package_prefix(args.package_name) / "share" / args.package_name / "package.xml"
        try:
            text = path.read_text(encoding="utf-8")
            root = ElementTree.fromstring(text)
        except OSError as error:
            raise CliError(f"{path}: {error.strerror}") from None
        except (LookupError, ValueError, ElementTree.ParseError) as error:
            raise CliError(f"{path}: {error}") from None
        if not args.tag:
            print(text.rstrip())
            return 0
        found = [element.text or "" for element in root.iter(args.tag)]
        if not found:
            return f"No tag '{args.tag}' in {path}{did_you_mean(args.tag, {element.tag for element in root.iter()})}"
        for content in found:
            print(content)
        return 0
