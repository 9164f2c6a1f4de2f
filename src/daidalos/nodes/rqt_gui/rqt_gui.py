"""`rqt_gui`, which the command ``rqt`` starts: the studio with rqt's plugins to open, or one of its panels."""

from daidalos.nodes.studio_window import parse, rqt_node_name, run_studio, studio_parser

_PANELS = {
    "rqt_console": "log",
    "rqt_controller_manager": "controllers",
    "rqt_graph": "graph",
    "rqt_image_view": "image",
    "rqt_plot": "plot",
    "rqt_publisher": "publish",
    "rqt_reconfigure": "parameters",
    "rqt_service_caller": "service",
    "rqt_topic": "topics",
}


def main() -> int:
    """Serve the studio and open it."""
    parser = studio_parser("rqt", "The studio.")
    parser.add_argument("-s", "--standalone", metavar="PLUGIN", help="open only this plugin")
    parser.add_argument("-l", "--list-plugins", action="store_true", help="list the plugins and exit")
    parser.add_argument("--force-discover", action="store_true", help="accepted, and not needed")
    parser.add_argument("--clear-config", action="store_true", help="accepted; the page has 'Reset layout'")
    arguments = parse(parser)
    if arguments.list_plugins:
        print("\n".join(_PANELS))
        return 0
    panel = "plugins"
    if arguments.standalone:
        name = arguments.standalone.partition(".")[0].partition("/")[0]
        if name not in _PANELS:
            parser.error(f"there is no plugin '{arguments.standalone}'; there are: {', '.join(_PANELS)}")
        panel = _PANELS[name]
    return run_studio(rqt_node_name(), panel, arguments)
