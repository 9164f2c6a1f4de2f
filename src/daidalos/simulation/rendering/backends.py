"""Renderer backends of cameras: software, or OpenGL on an EGL device on request."""

from __future__ import annotations

import logging
import os
from functools import cache
from typing import TYPE_CHECKING

from daidalos.simulation.rendering.optics import Pinhole
from daidalos.simulation.rendering.renderer import Renderer

if TYPE_CHECKING:
    from daidalos.simulation.rendering.gl_renderer import GlRenderer

VARIABLE = "DAIDALOS_RENDERER"

_log = logging.getLogger(__name__)


def make_renderer(pinhole: Pinhole, near: float, far: float, mask: int) -> Renderer | GlRenderer:
    """Create a camera's renderer: in software, unless the environment's ``DAIDALOS_RENDERER`` is ``egl``.

    Where there is no EGL device, one line says so and software draws. Parameters are `Renderer`'s.
    """
    wanted = os.environ.get(VARIABLE, "software")
    if wanted == "egl":
        try:
            # Needs a library that comes with an extra only.
            from daidalos.simulation.rendering.gl_renderer import GlRenderer

            return GlRenderer(pinhole, near, far, mask)
        except ImportError:
            log_once(f"{VARIABLE}=egl needs the extra daidalos[egl]; cameras are drawn in software")
        except Exception as problem:  # a driver may fail in any way
            reason = " ".join(str(problem).split()) or type(problem).__name__
            log_once(f"{VARIABLE}=egl: there is no usable EGL device ({reason}); cameras are drawn in software")
    elif wanted != "software":
        log_once(f"{VARIABLE} is {wanted!r}, expected 'software' or 'egl'; cameras are drawn in software")
    return Renderer(pinhole, near, far, mask)


@cache
def log_once(line: str) -> None:
    """Log a message once."""
    _log.warning(line)
