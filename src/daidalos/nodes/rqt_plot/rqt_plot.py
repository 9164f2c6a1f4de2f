"""`rqt_plot`: the studio, opened at its panel."""

from daidalos.nodes.studio_window import parse, rqt_node_name, run_studio, studio_parser


def main() -> int:
    """Serve the studio and open it."""
    return run_studio(rqt_node_name(), "plot", parse(studio_parser("rqt_plot", "Values over time, in the studio.")))
