"""`rqt_reconfigure`: the studio, opened at its panel."""

from daidalos.nodes.studio_window import parse, rqt_node_name, run_studio, studio_parser


def main() -> int:
    """Serve the studio and open it."""
    description = "Parameters of nodes, in the studio."
    return run_studio(rqt_node_name(), "parameters", parse(studio_parser("rqt_reconfigure", description)))
