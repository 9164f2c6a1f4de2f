"""Makes the meshes of `turtlebot3_description`: `python tools/make_turtlebot3_meshes.py`."""

from __future__ import annotations

import math
from pathlib import Path

import shapely
from mesh_kit import Paint, Part, box, disc, extrude, revolve, rod, rounded_rectangle, save, slot
from shapely import affinity

MESHES = Path(__file__).parent.parent / "src/daidalos/share/turtlebot3_description/meshes"

PLATE = Paint("plate", (0.24, 0.25, 0.28), 0.25)
POST = Paint("post", (0.78, 0.66, 0.36), 0.7)
MOTOR = Paint("motor", (0.10, 0.11, 0.12), 0.3)
BOARD = Paint("board", (0.05, 0.42, 0.33), 0.3)
COMPUTER = Paint("computer", (0.10, 0.36, 0.20), 0.3)
CHIP = Paint("chip", (0.08, 0.08, 0.09), 0.5)
METAL = Paint("metal", (0.75, 0.76, 0.78), 0.8)
BATTERY = Paint("battery", (0.88, 0.42, 0.10), 0.25)
CABLE = Paint("cable", (0.80, 0.14, 0.12), 0.2)
TYRE = Paint("tyre", (0.06, 0.06, 0.065), 0.08)
RIM = Paint("rim", (0.92, 0.93, 0.94), 0.5)
LIDAR = Paint("lidar", (0.13, 0.14, 0.15), 0.4)
WINDOW = Paint("window", (0.02, 0.05, 0.10), 0.9)
GLOW = Paint("glow", (0.15, 0.60, 0.95), 0.6)


def main() -> None:
    """Write every mesh."""
    MESHES.mkdir(parents=True, exist_ok=True)
    save(waffle_plate(), MESHES / "waffle_plate.dae")
    save(waffle_body(), MESHES / "waffle_body.dae")
    save(burger_plate(), MESHES / "burger_plate.dae")
    save(burger_body(), MESHES / "burger_body.dae")
    save(wheel(), MESHES / "wheel.dae")
    save(lidar(), MESHES / "lidar.dae")
    save(camera(), MESHES / "camera.dae")


def waffle_plate() -> list[Part]:
    """Build one layer: the lattice of holes that gave the robot its name. Its middle is the mesh's origin."""
    outline = rounded_rectangle(0.266, 0.266, 0.03)
    for side in (-1, 1):  # wheel wells
        well = rounded_rectangle(0.082, 0.03, 0.006, 3)
        outline = outline.difference(affinity.translate(well, 0.064, side * 0.133))
    window = rounded_rectangle(0.0145, 0.0145, 0.003, 1)
    holes = [
        affinity.translate(window, x * 0.024, y * 0.024) if (x + y) % 2 else disc(x * 0.024, y * 0.024, 0.004, 2)
        for x in range(-5, 6)
        for y in range(-5, 6)
        if math.hypot(x, y) < 6.4
    ]
    outline = _pierced(outline, holes)
    return [extrude(outline, 0.004, PLATE, -0.002)]


def waffle_body() -> list[Part]:
    """Build what stands between the plates at 4, 47 and 90 mm, in the frame of `base_link`."""
    parts = []
    for x in (-0.180, -0.118, -0.010, 0.052):
        for y in (-0.112, 0.112):
            if (x, abs(y)) != (-0.010, 0.112):
                parts += [_post(x, y, 0.006, 0.045), _post(x, y, 0.049, 0.088)]
    parts += _drive(track=0.133)
    parts += _casters(-0.177, 0.064)
    parts += [
        box((0.110, 0.050, 0.030), (-0.110, 0.0, 0.022), BATTERY, 0.006),
        box((0.012, 0.046, 0.0305), (-0.068, 0.0, 0.022), CHIP, 0.002),
        *_board(-0.105, 0.045, 0.055, BOARD, 0.100, 0.070),
        *_board(-0.105, -0.050, 0.055, COMPUTER, 0.085, 0.056),
        rod((-0.060, 0.010, 0.030), (-0.060, 0.030, 0.056), 0.0018, CABLE, 8),
        rod((-0.064, 0.016, 0.030), (-0.064, 0.036, 0.056), 0.0018, CHIP, 8),
    ]
    # The lidar's stand on the top plate.
    stand = rounded_rectangle(0.074, 0.074, 0.012)
    parts.append(extrude(affinity.translate(stand, -0.064, 0.0), 0.006, LIDAR, 0.092))
    return parts


def burger_plate() -> list[Part]:
    """Build one layer of the burger; its middle is the mesh's origin."""
    outline = rounded_rectangle(0.138, 0.138, 0.028)
    for side in (-1, 1):
        well = rounded_rectangle(0.080, 0.026, 0.005, 3)
        outline = outline.difference(affinity.translate(well, 0.032, side * 0.071))
    holes = [slot(0.0, y, 0.060, 0.006) for y in (-0.030, -0.015, 0.0, 0.015, 0.030)]
    holes += [disc(x, y, 0.0035, 2) for x in (-0.055, 0.052) for y in (-0.03, 0.0, 0.03)]
    return [extrude(_pierced(outline, holes), 0.004, PLATE, -0.002)]


def burger_body() -> list[Part]:
    """Build what stands between the burger's plates at 4, 48, 92 and 136 mm, in the frame of `base_link`."""
    parts = []
    for bottom in (0.006, 0.050, 0.094):
        for x in (-0.085, 0.018):
            parts += [_post(x, y, bottom, bottom + 0.040) for y in (-0.050, 0.050)]
    parts += _drive(track=0.071)
    parts += [revolve(_ball(0.005), METAL, 16).moved(-0.081, 0.0, -0.004)]
    parts += [box((0.012, 0.016, 0.008), (-0.081, 0.0, 0.001), MOTOR, 0.002)]
    parts += [
        box((0.088, 0.046, 0.028), (-0.032, 0.0, 0.066), BATTERY, 0.006),
        *_board(-0.032, 0.0, 0.100, BOARD, 0.100, 0.070),
        rod((0.006, 0.010, 0.070), (0.012, 0.020, 0.102), 0.0018, CABLE, 8),
    ]
    stand = rounded_rectangle(0.074, 0.074, 0.012)
    parts.append(extrude(affinity.translate(stand, -0.032, 0.0), 0.010, LIDAR, 0.138))
    return parts


def wheel() -> list[Part]:
    """Build a wheel of radius 33 mm and width 18 mm about the z axis."""
    half = 0.009
    profile = [
        (0.0245, -half + 0.001),
        (0.0300, -half),
        (0.0320, -half + 0.0015),
        (0.0326, 0.0),
        (0.0320, half - 0.0015),
        (0.0300, half),
        (0.0245, half - 0.001),
        (0.0245, -half + 0.001),
    ]
    parts = [revolve(profile, TYRE, 48)]
    blocks = 24
    for side in (-1, 1):
        for number in range(blocks):
            angle = 2 * math.pi * (number + 0.25 * (1 + side)) / blocks
            block = box((0.0020, 0.0038, half - 0.0020), (0.0320, 0.0, side * half * 0.48), TYRE)
            parts.append(block.turned(angle, (0, 0, 1)))
    spokes = disc(0, 0, 0.0248, 12)
    windows = [
        affinity.rotate(
            shapely.Polygon([(0.009, -0.0030), (0.0200, -0.0072), (0.0200, 0.0072), (0.009, 0.0030)]),
            number * 72,
            origin=(0, 0),
        ).buffer(0.0012, quad_segs=2)
        for number in range(5)
    ]
    parts.append(extrude(_pierced(spokes, windows, 0.001), 0.013, RIM, -0.0065))
    for side in (-1, 1):
        hub = revolve([(0.0, 0.0), (0.0072, 0.0), (0.0060, 0.0022), (0.0, 0.0026)], METAL, 24)
        hub = hub.moved(z=0.0062) if side > 0 else hub.moved(z=0.0062).turned(math.pi, (1, 0, 0))
        parts.append(hub)
    return parts


def lidar() -> list[Part]:
    """Build a spinning lidar; the origin is in the middle of its window, where the rays start."""
    base = affinity.translate(rounded_rectangle(0.070, 0.070, 0.020), 0.0, 0.0)
    return [
        extrude(base, 0.008, LIDAR, -0.0245),
        revolve([(0.0, -0.0165), (0.0340, -0.0165), (0.0345, -0.0080), (0.0, -0.0080)], LIDAR, 48),
        revolve([(0.0, -0.0080), (0.0325, -0.0080), (0.0325, 0.0080), (0.0, 0.0080)], WINDOW, 48),
        revolve([(0.0, 0.0080), (0.0345, 0.0080), (0.0345, 0.0130), (0.0310, 0.0155), (0.0, 0.0160)], LIDAR, 48),
        revolve([(0.0180, 0.0157), (0.0200, 0.0157), (0.0200, 0.0163), (0.0180, 0.0163), (0.0180, 0.0157)], GLOW),
    ]


def camera() -> list[Part]:
    """Build a bar with four eyes; the origin is on the plate below the right eye, which looks along x."""
    bar = extrude(rounded_rectangle(0.146, 0.018, 0.008), 0.012, METAL, -0.006)
    parts = [
        _upright(bar).moved(y=0.065, z=0.011),
        box((0.016, 0.030, 0.004), (0.0, 0.065, 0.0), CHIP, 0.003),
    ]
    for y, radius in ((0.0, 0.0058), (0.035, 0.0040), (0.095, 0.0040), (0.130, 0.0058)):
        profile = [(0.0, 0.0), (radius, 0.0), (radius, 0.0025), (radius * 0.7, 0.0030), (0.0, 0.0020)]
        parts.append(revolve(profile, WINDOW, 24).turned(math.pi / 2, (0, 1, 0)).moved(0.0055, y, 0.011))
    return parts


def _upright(part: Part) -> Part:
    """Turn a part that lies in x-y with its height along z: x to y, y to z, z to x."""
    return part.turned(math.pi / 2, (1, 0, 0)).turned(math.pi / 2, (0, 0, 1))


def _pierced(outline: shapely.Polygon, holes: list[shapely.Polygon], border: float = 0.004) -> shapely.Polygon:
    """Cut the holes that leave a border to the outline."""
    rim = outline.buffer(-border)
    return outline.difference(shapely.union_all([hole for hole in holes if rim.contains(hole)]))


def _post(x: float, y: float, bottom: float, top: float) -> Part:
    """Build a hexagonal spacer."""
    return revolve([(0.0, bottom), (0.0036, bottom), (0.0036, top), (0.0, top)], POST, 6).moved(x, y)


def _drive(track: float) -> list[Part]:
    """Build two servo motors between the lower plates, their shafts towards the wheels."""
    parts = []
    for side in (-1, 1):
        y = side * (track - 0.030)
        parts += [
            box((0.046, 0.034, 0.034), (0.0, y, 0.025), MOTOR, 0.004),
            box((0.020, 0.0345, 0.0345), (-0.006, y, 0.025), CHIP, 0.003),
            rod((0.0, y, 0.023), (0.0, side * (track + 0.004), 0.023), 0.006, METAL, 20),
        ]
    return parts


def _casters(x: float, y: float) -> list[Part]:
    parts = []
    for side in (-1, 1):
        parts += [
            box((0.026, 0.020, 0.007), (x, side * y, -0.0005), MOTOR, 0.004),
            revolve(_ball(0.005), METAL, 16).moved(x, side * y, -0.004),
        ]
    return parts


def _ball(radius: float) -> list[tuple[float, float]]:
    steps = 8
    return [(radius * math.sin(math.pi * i / steps), -radius * math.cos(math.pi * i / steps)) for i in range(steps + 1)]


def _board(x: float, y: float, z: float, paint: Paint, width: float, depth: float) -> list[Part]:
    """Build a circuit board with chips, a socket strip and connectors."""
    parts = [
        box((width, depth, 0.0016), (x, y, z), paint, 0.003),
        box((0.016, 0.016, 0.003), (x + 0.010, y + 0.004, z + 0.002), CHIP),
        box((0.010, 0.012, 0.002), (x - 0.018, y - 0.010, z + 0.0015), CHIP),
    ]
    for number in range(2):
        center = (x - width / 2 + 0.008, y - 0.012 + 0.022 * number, z + 0.008)
        parts.append(box((0.016, 0.014, 0.014), center, METAL))
    pins = (width * 0.6, 0.005, 0.006)
    parts.append(box(pins, (x, y + depth / 2 - 0.005, z + 0.003), CHIP))
    return parts


if __name__ == "__main__":
    main()
