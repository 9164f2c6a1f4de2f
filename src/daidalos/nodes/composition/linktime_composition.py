"""`linktime_composition`: the components that the package registers, in one process."""

from __future__ import annotations

from daidalos.nodes.composition import COMPONENTS
from daidalos.nodes.composition._together import run_together
from daidalos.nodes.extensions import find_component


def main() -> int:
    """Run the nodes."""
    import rclpy.logging

    log = rclpy.logging.get_logger("linktime_composition")
    for name in COMPONENTS:
        log.info(f"Instantiate class composition::{name}")
    return run_together([find_component("composition", f"composition::{name}") for name in COMPONENTS])
