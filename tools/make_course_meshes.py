"""Makes the STL meshes of the course's robots: `python tools/make_course_meshes.py`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import shapely
import trimesh
from mesh_kit import Paint, Part, box, disc, extrude, revolve, rod

SHARE = Path(__file__).parent.parent / "src/daidalos/share"
PLAIN = Paint("plain", (0.8, 0.8, 0.8))
TURN_X = (1.0, 0.0, 0.0)
QUARTER = 1.5707963267948966


def main() -> None:
    """Write every mesh."""
    _save([finger()], SHARE / "urdf_tutorial/meshes/finger.stl")
    _save([tip()], SHARE / "urdf_tutorial/meshes/tip.stl")
    humanoid = SHARE / "humanoid_description/meshes"
    _save(head(), humanoid / "head.stl")
    _save(torso(), humanoid / "torso.stl")
    _save([rod((0, 0, 0), (0, 0.10, 0), 0.06, PLAIN, 24)], humanoid / "shoulder.stl")
    _save(limb(0.28, 0.050, 0.042), humanoid / "upper_arm.stl")
    _save(limb(0.26, 0.042, 0.034), humanoid / "lower_arm.stl")
    _save(hand(), humanoid / "hand.stl")
    truck = SHARE / "truck_description/meshes"
    _save([truck_body()], truck / "body.stl")
    _save([truck_window()], truck / "window.stl")
    _save(truck_wheel(), truck / "wheel.stl")


def finger() -> Part:
    """Build the left finger: it bends inwards, from its hinge at the origin along x."""
    outline = shapely.Polygon([(0, -0.008), (0.05, 0.012), (0.1, 0.0), (0.1, 0.01), (0.05, 0.026), (-0.008, 0.008)])
    return extrude(outline.union(disc(0, 0, 0.012, 6)), 0.02, PLAIN, -0.01)


def tip() -> Part:
    """Build the pad at the end of a finger."""
    return box((0.03, 0.01, 0.03), (0.015, 0.0, 0.0), PLAIN, 0.003)


def head() -> list[Part]:
    """Build a head that looks along x, its middle at the origin, with a neck below."""
    skull = revolve([(0.0, -0.12), (0.07, -0.11), (0.095, -0.02), (0.09, 0.06), (0.05, 0.115), (0.0, 0.125)], PLAIN)
    return [skull, rod((0, 0, -0.17), (0, 0, -0.1), 0.045, PLAIN, 24), box((0.02, 0.11, 0.03), (0.09, 0, 0.03), PLAIN)]


def torso() -> list[Part]:
    """Build a chest that tapers to a waist, its upper end at the origin."""
    chest = shapely.Polygon([(-0.19, 0.0), (0.19, 0.0), (0.17, -0.3), (0.12, -0.5), (-0.12, -0.5), (-0.17, -0.3)])
    return [extrude(chest, 0.2, PLAIN, -0.1).turned(QUARTER, TURN_X).turned(QUARTER, (0.0, 0.0, 1.0))]


def limb(length: float, upper: float, lower: float) -> list[Part]:
    """Build an arm's part that hangs down from its joint at the origin."""
    profile = [(0.0, -length - lower), (lower, -length), (upper * 0.9, -length / 2), (upper, 0.0), (0.0, upper)]
    return [revolve(profile, PLAIN, 24)]


def hand() -> list[Part]:
    """Build a palm with four fingers and a thumb, hanging down from the wrist at the origin."""
    fingers = [rod((0, y, -0.09), (0, y, -0.17), 0.009, PLAIN, 10) for y in (-0.03, -0.01, 0.01, 0.03)]
    return [
        box((0.03, 0.09, 0.09), (0, 0, -0.05), PLAIN, 0.01),
        *fingers,
        rod((0, 0, -0.05), (0.07, 0, -0.08), 0.011, PLAIN),
    ]


def truck_body() -> Part:
    """Build a pickup of flat panels, seen from the side as a triangle on a wedge; the axles' height is z = 0."""
    side = shapely.Polygon(
        [(2.7, 0.35), (2.75, -0.1), (-2.75, -0.1), (-2.8, 0.55), (-2.6, 0.6), (0.35, 1.15), (2.4, 0.45)]
    )
    for x in (-1.5, 1.5):
        side = side.difference(disc(x, 0.0, 0.52, 6))
    return extrude(side, 1.7, PLAIN, -0.85).turned(QUARTER, TURN_X)


def truck_window() -> Part:
    """Build the panes, a little wider than the body."""
    side = shapely.Polygon([(0.32, 1.06), (2.05, 0.52), (-0.9, 0.62), (-0.9, 0.86)])
    return extrude(side, 1.72, PLAIN, -0.86).turned(QUARTER, TURN_X)


def truck_wheel() -> list[Part]:
    """Build a wheel of radius 0.4175 along z."""
    tyre = [(0.26, -0.14), (0.40, -0.14), (0.4175, -0.11), (0.4175, 0.11), (0.40, 0.14), (0.26, 0.14)]
    hub = [(0.0, -0.10), (0.27, -0.12), (0.27, 0.12), (0.0, 0.10)]
    return [revolve([*tyre, tyre[0]], PLAIN, 48), revolve(hub, PLAIN, 8)]


def _save(parts: Sequence[Part], path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    mesh = trimesh.util.concatenate([part.mesh for part in parts])
    path.write_bytes(trimesh.exchange.stl.export_stl(mesh))


if __name__ == "__main__":
    main()
