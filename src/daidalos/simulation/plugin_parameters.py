"""Parameters of plugins in files, and which of them were read."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from daidalos.common.suggestions import near
from daidalos.description.link import Plugin as Description
from daidalos.description.markup import Element
from daidalos.simulation.errors import AbsentPartError
from daidalos.simulation.libraries import library_of
from daidalos.simulation.topics import absolute_topic, join_namespaces

if TYPE_CHECKING:
    from daidalos.simulation.contracts import ComponentContext

COMMON_PARAMETERS = ("alwaysOn", "always_on", "rosDebugLevel", "debug", "robotParam", "latch")
"""Parameters of many libraries that mean nothing here."""


class ReadElement(Element):
    """Element of a plugin that records which of its children were read.

    Parameters
    ----------
    element : Element
    """

    __slots__ = ("_read_tags",)

    def __init__(self, element: Element) -> None:
        super().__init__(element.tag, element.attributes, element.text, element.children, element.source, element.line)
        self._read_tags: set[str] = set()

    def first(self, *tags: str) -> Element | None:
        """Implement `Element.first`."""
        self._read_tags.update(tags)
        return super().first(*tags)

    def all(self, *tags: str) -> list[Element]:
        """Implement `Element.all`."""
        self._read_tags.update(tags)
        return super().all(*tags)

    def unread(self, unused: Iterable[str] = ()) -> list[str]:
        """Return the tags that were not read, each with the tag that it may be a misspelling of."""
        known = self._read_tags | set(unused)
        tags = dict.fromkeys(child.tag for child in self.children if child.tag not in known)
        return [
            f"<{tag}>" + "".join(f" (did you mean <{one}>?)" for one in near(tag, self._read_tags)[:1]) for tag in tags
        ]


class PluginParameters:
    """Parameters of a plugin, in ROS 1's camelCase or ROS 2's snake_case.

    Parameters
    ----------
    description : daidalos.description.link.Plugin
    context : ComponentContext
    """

    def __init__(self, description: Description, context: ComponentContext) -> None:
        self.element: Element = description.element
        self.context = context
        self.library = library_of(description)
        self.scope = description.scope
        ros = self.element.first("ros") or Element("ros")
        inner = ros.text_of("namespace", default=self.element.text_of("robotNamespace", "robot_namespace"))
        self.namespace = join_namespaces(context.namespace, inner)
        self._remappings: dict[str, str] = {}
        for remapping in ros.all("remapping", "argument"):
            name, separator, target = remapping.text.strip().rpartition(" ")[2].partition(":=")
            if separator:
                self._remappings[name.strip()] = target.strip()

    def topic(self, name: str) -> str:
        """Return the absolute topic of a name, remapped by ``<ros><remapping>``.

        A private name (``~/out``) that is not remapped lies below the plugin's own name.
        """
        bare = name.removeprefix("~/")
        for written in (name, f"~/{bare}", bare):
            if written in self._remappings:
                return absolute_topic(self._remappings[written].removeprefix("~/"), self.namespace)
        own = self.element.attribute("name", "") if name.startswith("~/") else ""
        return absolute_topic(f"{own}/{bare}" if own else bare, self.namespace)

    def is_remapped(self, name: str) -> bool:
        """Return whether ``<ros><remapping>`` contains a name, private or not."""
        return any(written in self._remappings for written in (name, f"~/{name}"))

    def scoped(self, name: str) -> str:
        """Return the model's name of a link or joint that a nested model's plugin refers to."""
        return f"{self.scope}::{name}" if self.scope and name else name

    def require_joint(self, *tags: str, default: str = "") -> str:
        """Return the model's name of the moving joint that a parameter names.

        Raises
        ------
        AbsentPartError
            When the model has no such joint, or it can not move.
        """
        element = self.element.first(*tags) or self.element
        name = self.element.text_of(*tags, default=default)
        if not name:
            raise AbsentPartError(f"<{tags[-1]}> is missing", element)
        return self.context.require_joint(self.scoped(name), element)

    def require_joints(self, *tags: str) -> tuple[str, ...]:
        """Return the model's names of the moving joints that repeated parameters name, at least one."""
        elements = self.element.all(*tags)
        if not elements:
            raise AbsentPartError(f"<{tags[-1]}> is missing", self.element)
        return tuple(self.context.require_joint(self.scoped(e.text.strip()), e) for e in elements)

    def require_link(self, *tags: str, default: str = "") -> str:
        """Return the model's name of the link that a parameter names.

        Raises
        ------
        AbsentPartError
            When the model has no such link.
        """
        name = self.scoped(self.element.text_of(*tags, default=default))
        return self.context.require_link(name, self.element.first(*tags) or self.element)
