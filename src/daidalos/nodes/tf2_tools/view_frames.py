"""`view_frames`: draws the tree of frames as PDF and SVG."""

from __future__ import annotations

import argparse
from datetime import datetime
from pathlib import Path
from typing import Any

import yaml
from rclpy.node import Node

from daidalos.common.documents import parse_yaml
from daidalos.nodes.runner import UserError, program_arguments, run_program
from daidalos.nodes.tf2_tools._pdf import to_pdf
from daidalos.nodes.tf2_tools._svg import to_svg
from daidalos.nodes.tf2_tools._tree_picture import Picture, draw_tree


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="view_frames", description="Create a diagram of the TF frames being broadcast over ROS"
    )
    parser.add_argument(
        "--wait-time",
        "-t",
        type=float,
        default=5.0,
        help="Listen to the /tf topic for this many seconds before rendering the frame tree",
    )
    parser.add_argument("-o", "--output", help="Output filename, without its ending")
    parser.add_argument("--tf_topic", default="/tf", help="Topic for dynamic transforms")
    parser.add_argument("--tf_static_topic", default="/tf_static", help="Topic for static transforms")
    return parser.parse_args(program_arguments())


def _view(arguments: argparse.Namespace) -> None:
    import rclpy
    from rclpy.task import Future
    from tf2_msgs.srv import FrameGraph
    from tf2_ros import Buffer, TransformListener

    rclpy.init()
    node = Node("view_frames")
    log = node.get_logger()
    try:
        buffer = Buffer(node=node)
        listener = TransformListener(
            buffer, node, tf_topic=arguments.tf_topic, tf_static_topic=arguments.tf_static_topic
        )
        log.info(f"Listening to tf data for {arguments.wait_time} seconds...")
        over = Future()
        node.create_timer(arguments.wait_time, lambda: over.set_result(None) if not over.done() else None)
        rclpy.spin_until_future_complete(node, over)
        listener.unregister()
        if not over.done():
            return
        log.info("Generating graph...")
        described = buffer.all_frames_as_yaml()
        log.info(f"Result:{FrameGraph.Response(frame_yaml=described)}")
        recorded = f"Recorded at time: {node.get_clock().now().nanoseconds * 1e-9:f}"
        stem = (arguments.output or datetime.now().strftime("frames_%Y-%m-%d_%H.%M.%S")).removesuffix(".pdf")
        log.info(f"Exporting graph in {stem}.pdf file...")
        _write(Path(stem), _picture(recorded, _frames_of(described)), buffer._allFramesAsDot())
    finally:
        node.destroy_node()


def _frames_of(described: str) -> dict[str, Any]:
    """Return what is known of each frame that has a parent."""
    frames = parse_yaml(described, "the frames", yaml.BaseLoader)  # names stay text, whatever they look like
    return frames if isinstance(frames, dict) else {}


def _picture(title: str, frames: dict[str, Any]) -> Picture:
    notes = {
        child: [
            f"Broadcaster: {frame['broadcaster']}",
            f"Average rate: {frame['rate']}",
            f"Buffer length: {frame['buffer_length']}",
            f"Most recent transform: {frame['most_recent_transform']}",
            f"Oldest transform: {frame['oldest_transform']}",
        ]
        for child, frame in frames.items()
    }
    if not frames:
        title += "; no tf data received"
    return draw_tree(title, {child: frame["parent"] for child, frame in frames.items()}, notes)


def _write(stem: Path, picture: Picture, dot: str) -> None:
    try:
        stem.with_name(stem.name + ".pdf").write_bytes(to_pdf(picture))
        stem.with_name(stem.name + ".svg").write_text(to_svg(picture), encoding="utf-8")
        stem.with_name(stem.name + ".gv").write_text(dot, encoding="utf-8")
    except OSError as error:
        raise UserError(f"cannot write '{error.filename}': {error.strerror}") from None


def main() -> int:
    """Listen, then write ``frames_DATE.pdf``, ``.svg`` and ``.gv``."""
    arguments = _parse()
    return run_program(lambda: _view(arguments))
