"""Factory of the sensors and plugins in a model's description."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from daidalos.common.errors import Location
from daidalos.common.extensions import ExtensionError, find
from daidalos.description.link import Plugin as PluginDescription
from daidalos.description.link import Sensor as SensorDescription
from daidalos.description.world import Model, World
from daidalos.simulation.contracts import Component, ComponentContext, LibraryPlugin, Plugin, Sensor, SensorPlugin
from daidalos.simulation.directional_friction import DirectionalFriction, directed_surfaces
from daidalos.simulation.errors import AbsentPartError
from daidalos.simulation.extensions import PLUGINS, SENSORS
from daidalos.simulation.libraries import is_built_in, library_of
from daidalos.simulation.persistent_forces import PersistentForces, check_persistent_forces, persistent_forces
from daidalos.simulation.plugin_parameters import COMMON_PARAMETERS, ReadElement
from daidalos.simulation.wind import LIBRARIES as WIND_LIBRARIES
from daidalos.simulation.wind import Wind, windy_links


def make_components(model: Model, context: Callable[[str], ComponentContext]) -> list[Component]:
    """Create a model's components, plugins before sensors.

    Parameters
    ----------
    model : Model
    context : callable
        Called with a component's name in the model, returns its context.

    Returns
    -------
    list of Component
        What is not known is left out with a warning.

    Raises
    ------
    DescriptionError
        When a plugin or sensor is known and its parameters are wrong.
    """
    components: list[Component] = []
    if directed_surfaces(model):
        components.append(DirectionalFriction(context("friction")))
    first = context("pushes")
    if persistent_forces(model, first.world):
        components.append(PersistentForces(first))
    if windy_links(model, first.world):
        components.append(Wind(context("wind")))
    for plugin in model.plugins:
        if model.links:
            components += _plugin(plugin, context(plugin.name))
        elif not is_built_in(plugin):
            context(plugin.name).warn(f"{plugin.element.where}: plugin {plugin.name!r} has no links, left out")
    for link, joint, sensor in _sensors(model):
        components += _sensor(sensor, link, joint, context(f"{joint or link}::{sensor.name}"))
    return components


def check_world_plugins(world: World, warn: Callable[[str], None]) -> None:
    """Warn of a world's plugins that have no effect there; supported ones are built in."""
    check_persistent_forces(world, warn)
    for plugin in world.plugins:
        if is_built_in(plugin) or library_of(plugin) in WIND_LIBRARIES:
            continue
        cls = _plugin_class(plugin, warn)
        if cls is not None:
            home = "sensor" if issubclass(cls, SensorPlugin) else "model"
            warn(f"{plugin.element.where}: plugin {plugin.name!r} belongs inside a <{home}>, left out")


def _plugin(plugin: PluginDescription, context: ComponentContext) -> Iterator[Component]:
    if is_built_in(plugin):
        return
    cls = _plugin_class(plugin, context.warn)
    if cls is None:
        return
    if not issubclass(cls, Plugin):
        context.warn(f"{plugin.element.where}: plugin {plugin.name!r} belongs inside a <sensor>, left out")
    else:
        element = ReadElement(plugin.element)
        try:
            yield from cls.make(replace(plugin, element=element), context)
        except AbsentPartError as problem:
            context.warn(f"{problem}; the plugin is left out")
            return
        _warn_of_unread(plugin, element, cls, context)


def _sensors(model: Model) -> Iterator[tuple[str, str, SensorDescription]]:
    """Yield each sensor with its link and its joint."""
    for link in model.links.values():
        for sensor in link.sensors:
            yield link.name, "", sensor
    for joint in model.joints.values():
        for sensor in joint.sensors:
            yield joint.child, joint.name, sensor


def _sensor(description: SensorDescription, link: str, joint: str, context: ComponentContext) -> Iterator[Component]:
    try:
        cls = find(SENSORS, description.type, asked_by=_location(description))
    except ExtensionError as error:
        context.warn(f"{error} (left out)")
        return
    make = partial(cls, description, replace(context, link=link, joint=joint))
    spoken_for = [sensor for plugin in description.plugins for sensor in _spoken_for(make, plugin, context)]
    yield from spoken_for or (make(),)


def _spoken_for(make: Callable[[], Sensor], plugin: PluginDescription, context: ComponentContext) -> Iterator[Sensor]:
    """Create a sensor configured by a plugin; all plugins of a sensor publish the same measurement."""
    if is_built_in(plugin):
        return
    cls = _plugin_class(plugin, context.warn)
    if cls is None:
        return
    if issubclass(cls, SensorPlugin):
        element = ReadElement(plugin.element)
        sensor = make()
        cls(replace(plugin, element=element), context).configure(sensor)
        _warn_of_unread(plugin, element, cls, context)
        yield sensor
    else:
        context.warn(f"{plugin.element.where}: plugin {plugin.name!r} does not belong inside a <sensor>")


def _warn_of_unread(
    plugin: PluginDescription, element: ReadElement, cls: type[LibraryPlugin], context: ComponentContext
) -> None:
    """Warn of parameters that no code reads; user-defined plugins may read theirs at any time."""
    unread = element.unread((*COMMON_PARAMETERS, *cls.unused)) if cls.names else ()
    if unread:
        where = f"{plugin.element.where}: plugin {plugin.name!r} ({plugin.filename})"
        context.warn(f"{where} does not use {', '.join(unread)}")


def _plugin_class(plugin: PluginDescription, warn: Callable[[str], None]) -> type[LibraryPlugin] | None:
    """Return the class of a plugin; warn and return None if none is available."""
    try:
        return find(PLUGINS, library_of(plugin), asked_by=_location(plugin))
    except ExtensionError as error:
        warn(f"{error} (left out)")
        return None


def _location(description: PluginDescription | SensorDescription) -> Location:
    element = description.element
    return Location(element.source or None, element.line or None, description.name)
