"""The translation of launch files of ROS 1 to those of ROS 2, element by element."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator

from .._reader import LocatedElement
from .packages import DROPPED_OPTIONS, INCLUDES, NODES, PROGRAMS, NodeMapping, ros2_program
from .rosbag import VERBS

_OLD_TEXT = re.compile(r"\$\((find|arg|optenv)\s")
_FOUND_FILE = re.compile(r"^\s*\$\(find\s+(\S+?)\s*\)/(.*?)\s*$", re.DOTALL)
_SUBSTITUTION = re.compile(r"\$\(([^()]*)\)")
_EVAL = re.compile(r"^\s*\$\(eval\s+(.*)\)\s*$", re.DOTALL)
_SPECIAL_IN_EXPRESSION = r"[\\\"'$()]"
_CONDITIONS = ("if", "unless")
_PARAMETER_TYPES = {"str": "str", "string": "str", "int": "int", "double": "float", "bool": "bool", "boolean": "bool"}


def is_ros1(root: LocatedElement) -> bool:
    """Return whether a launch file is one of ROS 1: by elements and attributes that ROS 2 does not have."""
    return any(_is_old(element, root) for element in root.iter()) or any(
        child.tag == "arg" and "value" in child.attrib for child in root
    )


def _is_old(element: LocatedElement, root: LocatedElement) -> bool:
    if element.tag in ("rosparam", "machine", "test"):
        return True
    if element.tag == "node" and "type" in element.attrib and "exec" not in element.attrib:
        return True
    if element.tag == "param" and {"command", "textfile", "binfile"} & set(element.attrib):
        return True
    if element.tag == "group" and "ns" in element.attrib:
        return True
    if element.tag in ("launch", "group") and any(child.tag in ("param", "remap", "env") for child in element):
        return True
    return any(_OLD_TEXT.search(value) for value in element.attrib.values())


def translate(root: LocatedElement) -> LocatedElement:
    """Return the launch file of ROS 2 that does what one of ROS 1 did, and log what was translated."""
    from launch.logging import get_logger

    translator = _Translator()
    translated = translator.translate_children(root, _like(root, "launch"))
    logger = get_logger("launch.ros1")
    file = root.location[0] or "the launch file"
    changes = "; ".join(dict.fromkeys(translator.changes))
    logger.info(f"{file} is one of ROS 1 and was translated{': ' if changes else ''}{changes}")
    for note in dict.fromkeys(translator.notes):
        logger.warning(note)
    return translated


def translate_text(text: str) -> str:
    """Return a text of ROS 1 with the substitutions of ROS 2."""
    return _Translator().text(text)


class _Translator:
    """Translator of elements, with the changes and notes for the user."""

    def __init__(self) -> None:
        self.changes: list[str] = []
        self.notes: list[str] = []

    def note(self, element: LocatedElement, text: str) -> None:
        file, line = element.location
        place = f"{file}:{line}: " if file else ""
        self.notes.append(f"{place}{text}")

    # Containers -------------------------------------------------------------------------------------

    def translate_children(self, old: LocatedElement, new: LocatedElement) -> LocatedElement:
        for child in _parameters_first(list(old)):
            new.extend(self.translate(child))
        return new

    def translate(self, old: LocatedElement) -> Iterator[LocatedElement]:
        method = getattr(self, f"translate_{old.tag}", None)
        if method is None:
            yield old
        else:
            yield from method(old)

    def translate_group(self, old: LocatedElement) -> Iterator[LocatedElement]:
        group = _like(old, "group", self.conditions(old))
        if "ns" in old.attrib:
            group.append(_like(old, "push_ros_namespace", {"namespace": self.text(old.attrib["ns"])}))
        yield self.translate_children(old, group)

    def translate_include(self, old: LocatedElement) -> Iterator[LocatedElement]:
        found = _FOUND_FILE.match(old.attrib.get("file", ""))
        mapping = None if found is None else INCLUDES.get((found[1], found[2]))
        attributes = self.conditions(old)
        if "file" in old.attrib:
            attributes["file"] = self.text(old.attrib["file"])
        if found is not None and mapping is not None:
            attributes["file"] = f"$(find-pkg-share {mapping.package})/{mapping.path}"
            self.changes.append(f"{found[1]}/{found[2]} -> {mapping.package}/{mapping.path}")
        if old.attrib.get("pass_all_args") in ("true", "1"):
            attributes["pass_all_args"] = "true"
        include = _like(old, "ros1:include", attributes)
        for argument in old.iter("arg"):
            given = argument.attrib.get("name", "")
            name = given if mapping is None else mapping.arguments.get(given, given)
            if name is not None:
                value = argument.attrib.get("value", argument.attrib.get("default", ""))
                include.append(_like(argument, "arg", {"name": name, "value": self.text(value)}))
        variables = [new for child in old.iter("env") for new in self.translate_env(child)]
        yield from self.in_namespace(old, [*variables, include])

    def in_namespace(self, old: LocatedElement, entities: list[LocatedElement]) -> Iterator[LocatedElement]:
        if "ns" not in old.attrib:
            yield from entities
            return
        group = _like(old, "group", self.conditions(old))
        group.append(_like(old, "push_ros_namespace", {"namespace": self.text(old.attrib["ns"])}))
        group.extend(entities)
        yield group

    # Settings ---------------------------------------------------------------------------------------

    def translate_arg(self, old: LocatedElement) -> Iterator[LocatedElement]:
        attributes = {"name": old.attrib.get("name", ""), **self.conditions(old)}
        if "value" in old.attrib:
            yield _like(old, "let", {**attributes, "value": self.text(old.attrib["value"])})
            return
        if "default" in old.attrib:
            attributes["default"] = self.text(old.attrib["default"])
        if "doc" in old.attrib:
            attributes["description"] = _escape(old.attrib["doc"])
        yield _like(old, "arg", attributes)

    def translate_env(self, old: LocatedElement) -> Iterator[LocatedElement]:
        yield _like(old, "set_env", self.pair(old, "name", "value"))

    def translate_remap(self, old: LocatedElement) -> Iterator[LocatedElement]:
        yield _like(old, "set_remap", self.pair(old, "from", "to"))

    def translate_param(self, old: LocatedElement) -> Iterator[LocatedElement]:
        attributes = self.parameter(old, NodeMapping("", ""))
        if attributes is not None:
            self.changes.append("parameters for all nodes -> set for the nodes that follow")
            yield _like(old, "ros1:param", attributes)

    def translate_rosparam(self, old: LocatedElement) -> Iterator[LocatedElement]:
        attributes = self.parameter_file(old)
        if attributes is not None:
            yield _like(old, "ros1:rosparam", attributes)

    def translate_machine(self, old: LocatedElement) -> Iterator[LocatedElement]:
        self.note(old, f"the element '{old.tag}' was left out: all nodes run on this machine")
        return iter(())

    def translate_test(self, old: LocatedElement) -> Iterator[LocatedElement]:
        self.note(old, "the element 'test' was left out: tests are run by launch_testing")
        return iter(())

    # Nodes ------------------------------------------------------------------------------------------

    def translate_node(self, old: LocatedElement) -> Iterator[LocatedElement]:
        package, executable = old.attrib.get("pkg", ""), old.attrib.get("type", "")
        mapping = NODES.get((package, executable)) or NodeMapping(package, ros2_program(package, executable))
        if (package, executable) != (mapping.package, mapping.executable):
            note = f" ({mapping.note})" if mapping.note else ""
            self.changes.append(f"node {package}/{executable} -> {mapping.package}/{mapping.executable}{note}")
        attributes = {"pkg": mapping.package, "exec": mapping.executable, **self.node_attributes(old)}
        if package == "rosbag" and executable in VERBS:
            attributes["rosbag"] = executable
            self.changes.append(f"node rosbag/{executable} -> ros2 bag {executable}")
        arguments = old.attrib.get("args", "")
        parameters: dict[str, str] = {}
        if mapping.arguments is not None:
            arguments, parameters = mapping.arguments(arguments)
        if arguments.strip():
            attributes["command_line"] = self.text(arguments)
        node = _like(old, "ros1:node", attributes)
        node.extend(
            _like(old, "param", {"name": name, "value": self.text(value)}) for name, value in parameters.items()
        )
        for child in old:
            node.extend(self.translate_in_node(child, mapping))
        yield node

    def node_attributes(self, old: LocatedElement) -> dict[str, str]:
        attributes = self.conditions(old)
        for name, new_name in (
            ("name", "name"),
            ("ns", "namespace"),
            ("output", "output"),
            ("respawn", "respawn"),
            ("respawn_delay", "respawn_delay"),
            ("launch-prefix", "launch-prefix"),
        ):
            if name in old.attrib:
                attributes[new_name] = self.text(old.attrib[name])
        if old.attrib.get("required", "").lower() in ("true", "1"):
            attributes["on_exit"] = "shutdown"
        return attributes

    def translate_in_node(self, old: LocatedElement, mapping: NodeMapping) -> Iterator[LocatedElement]:
        if old.tag == "param":
            attributes = self.parameter(old, mapping)
            if attributes is not None:
                yield _like(old, "param", attributes)
        elif old.tag == "rosparam":
            attributes = self.parameter_file(old)
            if attributes is not None:
                yield _like(old, "rosparam", attributes)
        elif old.tag == "remap":
            yield _like(old, "remap", self.pair(old, "from", "to"))
        elif old.tag == "env":
            yield _like(old, "env", self.pair(old, "name", "value"))
        else:
            yield old

    # Parameters -------------------------------------------------------------------------------------

    def parameter(self, old: LocatedElement, mapping: NodeMapping) -> dict[str, str] | None:
        """Return the attributes of a parameter today, None for one that is left out."""
        name = old.attrib.get("name", "").lstrip("~").strip("/")
        new_name = mapping.parameters.get(name, name)
        if new_name is None:
            self.changes.append(f"parameter {name} is of no use any more")
            return None
        if new_name != name:
            self.changes.append(f"parameter {name} -> {new_name}")
        attributes = {"name": new_name.replace("/", "."), **self.conditions(old)}
        if "command" in old.attrib:
            self.changes.append("<param command> -> $(command)")
            command = self.text(self.command(old.attrib["command"]), in_quotes=True)
            return {**attributes, "value": f'$(command "{command}" warn)', "type": "str"}
        if "textfile" in old.attrib:
            file = self.text(old.attrib["textfile"], in_quotes=True)
            return {**attributes, "value": f'$(file-content "{file}")', "type": "str"}
        if "binfile" in old.attrib:
            self.note(old, f"the parameter '{name}' was left out: there are no binary parameters any more")
            return None
        if "value" in old.attrib:
            value = old.attrib["value"]
            attributes["value"] = self.text(mapping.values.get(new_name, {}).get(value, value))
        if old.attrib.get("type") in _PARAMETER_TYPES:
            attributes["type"] = _PARAMETER_TYPES[old.attrib["type"]]
        return attributes

    def command(self, command: str) -> str:
        """Call programs by their names, and drop options that they do not have any more."""
        for (package, path), program in PROGRAMS.items():
            pattern = rf"\$\(find\s+{re.escape(package)}\s*\)/{re.escape(path)}(?=\s|$)"
            command, count = re.subn(pattern, program, command)
            if count:
                for option in DROPPED_OPTIONS.get(program, ()):
                    command = re.sub(rf"\s{re.escape(option)}(?=\s|$)", "", command)
        return command

    def parameter_file(self, old: LocatedElement) -> dict[str, str] | None:
        command = old.attrib.get("command", "load")
        if command != "load":
            self.note(old, f"'rosparam {command}' was left out: parameters belong to their nodes")
            return None
        attributes = self.conditions(old)
        namespace = [old.attrib.get("ns", "").strip("~/"), old.attrib.get("param", "").strip("~/")]
        attributes["ns"] = self.text("/".join(part for part in namespace if part))
        substitutes = old.attrib.get("subst_value", "").lower() in ("true", "1")
        if substitutes:
            attributes["subst_value"] = "true"
        if "file" in old.attrib:
            self.changes.append("<rosparam file> -> parameter file")
            attributes["file"] = self.text(old.attrib["file"])
        else:
            text = textwrap.dedent(old.text or "").strip("\n")
            attributes["yaml"] = self.text(text) if substitutes else _escape(text, r"[\\$]")
        return {name: value for name, value in attributes.items() if value}

    # Texts ------------------------------------------------------------------------------------------

    def conditions(self, old: LocatedElement) -> dict[str, str]:
        return {name: self.text(old.attrib[name]) for name in _CONDITIONS if name in old.attrib}

    def pair(self, old: LocatedElement, first: str, second: str) -> dict[str, str]:
        found = {name: self.text(old.attrib[name]) for name in (first, second) if name in old.attrib}
        return {**found, **self.conditions(old)}

    def text(self, old: str, *, in_quotes: bool = False) -> str:
        """Return a text with the substitutions of ROS 2, which may be meant to stand in double quotes."""
        special = r'[\\"]' if in_quotes else r"[\\]"
        expression = _EVAL.match(old)
        if expression is not None:
            self.changes.append("$(eval) with the arguments as variables")
            return f'$(ros1-eval "{_escape(" ".join(expression[1].split()), _SPECIAL_IN_EXPRESSION)}")'
        pieces = []
        end = 0
        for match in _SUBSTITUTION.finditer(old):
            pieces += [_escape(old[end : match.start()], special), self.substitution(match[1])]
            end = match.end()
        return "".join([*pieces, _escape(old[end:], special)])

    def substitution(self, old: str) -> str:
        name, _, rest = old.strip().partition(" ")
        rest = rest.strip()
        if name == "find":
            self.changes.append("$(find) -> $(find-pkg-share)")
            return f"$(find-pkg-share {rest})"
        if name == "arg":
            return f"$(var {rest})"
        if name == "optenv":
            variable, _, default = rest.partition(" ")
            return f"$(env {variable} '{default.strip()}')"
        return f"$({name} {rest})" if rest else f"$({name})"


def _parameters_first(children: list[LocatedElement]) -> list[LocatedElement]:
    """Sort parameters before the nodes beside them, as ROS 1 set them all before it started any node.

    None is put before an argument, which it may need.
    """
    ordered: list[LocatedElement] = []
    for child in children:
        place = len(ordered)
        if child.tag in ("param", "rosparam"):
            while place and ordered[place - 1].tag not in ("arg", "param", "rosparam"):
                place -= 1
        ordered.insert(place, child)
    return ordered


def _like(old: LocatedElement, tag: str, attributes: dict[str, str] | None = None) -> LocatedElement:
    """Return an element at the place of another one."""
    element = LocatedElement(tag, attributes or {})
    element.location = old.location
    return element


def _escape(text: str, special: str = r"[\\]") -> str:
    """Return a text with backslashes before all characters that are special."""
    return re.sub(special, lambda match: "\\" + match[0], text)
