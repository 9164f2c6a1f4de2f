"""`rqt_console`: opens the studio at its log panel."""

from daidalos.nodes.studio_window import parse, rqt_node_name, run_studio, studio_parser


def main() -> int:
    """Serve the studio and open it."""
    return run_studio(rqt_node_name(), "log", parse(studio_parser("rqt_console", "What nodes log, in the studio.")))
