"""`daidalos weigh`: how heavy a robot is."""

from pathlib import Path


class WeighVerb:
    """Add up the masses of a robot's links."""

    def add_arguments(self, parser, cli_name):
        parser.add_argument("file", type=Path, help="a file in URDF or xacro")

    def main(self, *, args):
        from daidalos.description import urdf

        robot = urdf.load(args.file)
        print(f"{sum(link.inertial.mass for link in robot.links.values() if link.inertial is not None):g} kg")
        return 0
