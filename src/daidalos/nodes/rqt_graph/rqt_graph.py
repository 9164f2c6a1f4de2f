"""`rqt_graph`: opens the studio at its graph panel."""

from daidalos.nodes.studio_window import parse, rqt_node_name, run_studio, studio_parser


def main() -> int:
    """Serve the studio and open it."""
    return run_studio(
        rqt_node_name(),
        "graph",
        parse(studio_parser("rqt_graph", "Nodes and topics, and who talks to whom, in the studio.")),
    )
