"""Meshes and terrains in MuJoCo's specification, shared between models and reference-counted."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Vector
from daidalos.description.meshes import TriangleMesh
from daidalos.description.world import Model
from daidalos.simulation.conversion.convex import content_key, convex_parts
from daidalos.simulation.conversion.preparation import PreparedMeshes, Progress, prepare_meshes

MAX_HULL_VERTICES = 64
_TERRAIN_THICKNESS = 1.0


@dataclass(frozen=True)
class Solid:
    """Mesh assets of a solid.

    Parameters
    ----------
    parts : tuple of str
        Names of convex meshes that collide.
    surface : str
        Name of the true triangles, for rays; empty when the one part has the same shape.
    """

    parts: tuple[str, ...]
    surface: str


class Assets:
    """Store of meshes in a specification, without duplicates.

    Parameters
    ----------
    spec : MjSpec
    """

    def __init__(self, spec: Any) -> None:
        self._spec = spec
        self._users: Counter[str] = Counter()
        self._taken: list[str] = []
        self._prepared: PreparedMeshes = {}

    def prepare(self, models: Iterable[Model], progress: Progress | None = None) -> None:
        """Prepare the collision meshes of models that are about to be added; see `prepare_meshes`."""
        self.take_prepared(prepare_meshes(models, progress))

    def take_prepared(self, meshes: PreparedMeshes) -> None:
        """Take collision meshes that were prepared, in place of those of before."""
        self._prepared = meshes

    def solid(self, mesh: TriangleMesh, decompose: bool) -> Solid:
        """Return the names of a mesh's convex parts and, where it differs from them, its surface.

        Parameters
        ----------
        mesh : TriangleMesh
        decompose : bool
            Split what is not convex; otherwise its hull stands for it.
        """
        key = content_key(mesh)
        parts, concave = self._prepared.get((key, decompose)) or convex_parts(mesh, key, decompose)
        kind = "part" if decompose else "hull"
        names = tuple(self._take(f"{key}:{kind}{i}", part) for i, part in enumerate(parts))
        return Solid(names, self._take(key, mesh) if concave else "")

    def terrain(self, heights: NDArray[np.float64], size: Vector) -> tuple[str, float]:
        """Return the name of a heightmap.

        Parameters
        ----------
        heights : array (rows, columns)
            0 to 1, the row with the least y first.
        size : tuple of 3 floats
            Extent in x and y, and height of 1 over 0 [m].

        Returns
        -------
        name : str
        bottom : float
            Height of its lowest point [m].
        """
        lowest, span = float(heights.min()), float(np.ptp(heights))
        digest = hashlib.sha256(heights.tobytes() + np.array(size).tobytes()).hexdigest()[:24]
        name = f"{digest}:terrain"
        if not self._users[name]:
            self._spec.add_hfield(
                name=name,
                size=[size[0] / 2, size[1] / 2, max(span * size[2], 1e-6), _TERRAIN_THICKNESS],
                nrow=heights.shape[0],
                ncol=heights.shape[1],
                userdata=((heights - lowest) / (span or 1.0)).astype(np.float32).ravel(),
            )
        self._users[name] += 1
        self._taken.append(name)
        return name, lowest * size[2]

    def taken(self) -> tuple[str, ...]:
        """Return the assets used since the last call, to be released together."""
        taken, self._taken = tuple(self._taken), []
        return taken

    def release(self, names: Iterable[str]) -> None:
        """Remove assets that are no longer used."""
        self._users.subtract(names)
        for name in [name for name, users in self._users.items() if users <= 0]:
            del self._users[name]
            find = self._spec.hfield if name.endswith(":terrain") else self._spec.mesh
            self._spec.delete(find(name))

    def _take(self, name: str, mesh: TriangleMesh) -> str:
        if not self._users[name]:
            self._spec.add_mesh(
                name=name,
                uservert=np.ascontiguousarray(mesh.vertices, dtype=np.float32).ravel(),
                userface=np.ascontiguousarray(mesh.faces, dtype=np.int32).ravel(),
                # Bodies bring their own inertia; this kind compiles for open meshes too.
                inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
                maxhullvert=MAX_HULL_VERTICES,
            )
        self._users[name] += 1
        self._taken.append(name)
        return name
