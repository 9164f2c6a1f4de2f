"""Colours by name or as ``#rrggbb``."""

from __future__ import annotations

from daidalos.industry.assistance.device import DeviceError


def parse_rgb(color: str, default: tuple[int, int, int] = (255, 255, 255)) -> tuple[int, int, int]:
    """Return red, green and blue from 0 to 255 of a CSS colour; a default where it is empty.

    Raises
    ------
    DeviceError
        When it is no colour.
    """
    from PIL import ImageColor

    if not color:
        return default
    try:
        red, green, blue = ImageColor.getrgb(color)[:3]
    except ValueError:
        raise DeviceError(f"'{color}' is no colour; expected #rrggbb or a name such as red") from None
    return red, green, blue
