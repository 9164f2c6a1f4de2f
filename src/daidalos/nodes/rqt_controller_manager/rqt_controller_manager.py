"""`rqt_controller_manager`: the studio, opened at its panel of controllers."""

from daidalos.nodes.studio_window import parse, rqt_node_name, run_studio, studio_parser


def main() -> int:
    """Serve the studio and open it."""
    description = "Controllers of a controller manager and its hardware, in the studio."
    return run_studio(rqt_node_name(), "controllers", parse(studio_parser("rqt_controller_manager", description)))
