"""Colours of Gazebo's named materials; the values are our own, chosen by their names."""

from __future__ import annotations

from daidalos.description.link import Rgba

_COLORS: dict[str, tuple[float, ...]] = {
    "Grey": (0.68, 0.68, 0.68),
    "Gray": (0.68, 0.68, 0.68),
    "DarkGrey": (0.18, 0.18, 0.19),
    "DarkGray": (0.18, 0.18, 0.19),
    "LightGrey": (0.83, 0.83, 0.83),
    "FlatBlack": (0.08, 0.08, 0.08),
    "Black": (0.02, 0.02, 0.02),
    "White": (0.96, 0.96, 0.96),
    "Red": (0.9, 0.05, 0.05),
    "RedBright": (0.87, 0.1, 0.1),
    "DarkRed": (0.45, 0.03, 0.03),
    "Green": (0.05, 0.8, 0.05),
    "DarkGreen": (0.02, 0.4, 0.05),
    "Blue": (0.05, 0.1, 0.9),
    "SkyBlue": (0.13, 0.44, 0.7),
    "DarkBlue": (0.02, 0.04, 0.45),
    "Yellow": (0.95, 0.9, 0.05),
    "DarkYellow": (0.7, 0.65, 0.02),
    "ZincYellow": (0.97, 0.95, 0.22),
    "Gold": (0.83, 0.66, 0.15),
    "Orange": (0.98, 0.5, 0.04),
    "DarkOrange": (0.8, 0.36, 0.02),
    "Purple": (0.6, 0.05, 0.75),
    "DarkMagenta": (0.5, 0.0, 0.5),
    "Turquoise": (0.05, 0.8, 0.78),
    "Indigo": (0.28, 0.03, 0.5),
    "Pink": (0.96, 0.62, 0.7),
    "Brown": (0.45, 0.27, 0.1),
    "Bricks": (0.6, 0.28, 0.2),
    "Wood": (0.68, 0.49, 0.3),
    "WoodFloor": (0.7, 0.52, 0.32),
    "WoodPallet": (0.72, 0.56, 0.36),
    "CeilingTiled": (0.85, 0.85, 0.82),
    "Grass": (0.27, 0.5, 0.18),
    "Road": (0.25, 0.25, 0.26),
    "Residential": (0.3, 0.3, 0.31),
    "Asphalt": (0.22, 0.22, 0.23),
    "Gravel": (0.5, 0.48, 0.44),
    "Kitchen": (0.8, 0.76, 0.68),
    "PaintedWall": (0.87, 0.84, 0.76),
    "WallCeiling": (0.88, 0.87, 0.85),
    "PioneerBody": (0.75, 0.06, 0.08),
    "Pioneer2Body": (0.85, 0.1, 0.08),
    "PR2": (0.8, 0.8, 0.8),
    "Chrome": (0.78, 0.79, 0.82),
    "Eye": (0.95, 0.95, 0.95),
    "Footway": (0.66, 0.64, 0.6),
    "Motorway": (0.27, 0.27, 0.28),
    "Wheel": (0.1, 0.1, 0.1),
    "LightBlueLaser": (0.5, 0.6, 0.95, 0.4),
    "BlueLaser": (0.1, 0.2, 0.95, 0.4),
    "OrangeTransparent": (0.98, 0.5, 0.04, 0.4),
    "RedTransparent": (0.9, 0.05, 0.05, 0.5),
    "GreenTransparent": (0.05, 0.8, 0.05, 0.5),
    "BlueTransparent": (0.05, 0.1, 0.9, 0.5),
    "YellowTransparent": (0.95, 0.9, 0.05, 0.5),
    "DarkMagentaTransparent": (0.5, 0.0, 0.5, 0.5),
    "GreyTransparent": (0.68, 0.68, 0.68, 0.5),
    "BlackTransparent": (0.02, 0.02, 0.02, 0.5),
    "RedGlow": (0.95, 0.1, 0.1),
    "GreenGlow": (0.1, 0.95, 0.15),
    "BlueGlow": (0.15, 0.2, 0.98),
    "YellowGlow": (0.98, 0.95, 0.2),
    "PurpleGlow": (0.7, 0.15, 0.9),
    "TurquoiseGlow": (0.1, 0.9, 0.88),
    "WhiteGlow": (1.0, 1.0, 1.0),
}


def named_color(name: str) -> Rgba | None:
    """Return the colour of ``Gazebo/Name``; None for an unknown name."""
    color = _COLORS.get(name.removeprefix("Gazebo/"))
    if color is None:
        return None
    red, green, blue, *alpha = color
    return red, green, blue, alpha[0] if alpha else 1.0
