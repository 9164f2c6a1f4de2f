"""Plugin container layer: layers that are combined with each other first, and then with those below."""

from collections.abc import Mapping
from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter, per_name
from daidalos.navigation.contracts import Input, Layer, NavigationContext, Output
from daidalos.navigation.costmap.costmap import NO_INFORMATION, Bounds, Costmap, Window
from daidalos.navigation.costmap.layers.obstacle_layer import combine
from daidalos.navigation.costmap.voxels import VoxelGrid
from daidalos.navigation.extensions import COSTMAP_LAYERS


@dataclass(frozen=True)
class ContainedLayerParameters(Parameters):
    """Parameter that chooses a contained layer; its own parameters stand beside it."""

    plugin: str = parameter("", "Class of the layer.", read_only=True)


@dataclass(frozen=True)
class PluginContainerLayerParameters(Parameters):
    """Parameters of the layer, by their Nav2 names."""

    enabled: bool = parameter(True, "Whether the layer is used.")
    plugins: tuple[str, ...] = parameter((), "Names of the layers, the lowest first.", unique=True, read_only=True)
    layers: Mapping[str, ContainedLayerParameters] = per_name(ContainedLayerParameters, by="plugins", at="")
    combination_method: int = parameter(
        1,
        "How costs are combined with those of layers below: 0 overwrites, 1 takes the largest, 2 takes the largest "
        "and leaves unknown cells unknown.",
        choices=(0, 1, 2),
    )


class PluginContainerLayer(Layer):
    """Layer of layers with a costmap of their own, such as a sensor's obstacles with an inflation of theirs."""

    names = ("nav2_costmap_2d::PluginContainerLayer",)
    clearable = True
    Parameters = PluginContainerLayerParameters
    parameters: PluginContainerLayerParameters

    def __init__(
        self, parameters: PluginContainerLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._layers: tuple[Layer, ...] = tuple(
            self.context.make(COSTMAP_LAYERS, self.parameters.layers[name].plugin, f"{name}.plugin", name)
            for name in self.parameters.plugins
        )
        self._costmap: Costmap | None = None

    @property
    def contained(self) -> tuple[Layer, ...]:
        """Implement `Layer.contained`."""
        return self._layers

    @property
    def _used(self) -> tuple[Layer, ...]:
        return tuple(layer for layer in self._layers if layer.enabled)

    @property
    def voxels(self) -> VoxelGrid | None:
        """Implement `Layer.voxels` by the first of the layers that has some."""
        return next((layer.voxels for layer in self._used if layer.voxels is not None), None)

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `Layer.inputs` by those of all layers."""
        return tuple(one for layer in self._layers for one in layer.inputs)

    @property
    def outputs(self) -> tuple[Output, ...]:
        """Implement `Layer.outputs` by those of all layers."""
        return tuple(one for layer in self._layers for one in layer.outputs)

    def missing_input(self, now: float) -> str:
        """Return what the first of the layers that lacks something lacks."""
        return next((missing for layer in self._used if (missing := layer.missing_input(now))), "")

    def age_of_input(self, now: float) -> float:
        """Implement `Layer.age_of_input` by the oldest of all layers."""
        return max((layer.age_of_input(now) for layer in self._used), default=0.0)

    @property
    def extent(self) -> Costmap | None:
        """Costmap of the first of the layers that has a size."""
        return next((layer.extent for layer in self._layers if layer.extent is not None), None)

    def match_size(self, costmap: Costmap) -> None:
        """Take over the size of the costmap, as all layers do."""
        self._costmap = Costmap.filled(
            costmap.width, costmap.height, costmap.resolution, costmap.origin, NO_INFORMATION
        )
        for layer in self._layers:
            layer.match_size(self._costmap)

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Return the bounds of the area that the layers ask for."""
        for layer in self._used:
            bounds = layer.update_bounds(robot_pose, now, bounds)
        return bounds

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Combine the layers with each other, and then with what is below."""
        if self._costmap is None:
            return
        own = self._costmap.costs[window.slices]
        own[:] = NO_INFORMATION
        for layer in self._used:
            layer.update_costs(self._costmap, window)
        combine(costmap.costs[window.slices], own, self.parameters.combination_method)

    def cost_at_distance(self, distance: float) -> int:
        """Return the largest cost that any of the layers gives a cell at a distance [m] from an obstacle."""
        return max((layer.cost_at_distance(distance) for layer in self._layers), default=0)

    def clear(self, keep: Window, *, inside: bool) -> None:
        """Clear those of the layers that can be cleared."""
        for layer in self._layers:
            if layer.clearable:
                layer.clear(keep, inside=inside)
