"""SDF's ``<material>``: colours, textures and the names of Gazebo's material scripts."""

from __future__ import annotations

from daidalos.description.link import Material, Rgba
from daidalos.description.markup import Element
from daidalos.description.named_colors import named_color
from daidalos.description.sdf.context import Context
from daidalos.description.sdf.ogre_materials import OgreMaterial, find_material


def read_material(element: Element | None, context: Context) -> Material | None:
    """Read a material; return None without one."""
    if element is None:
        return None
    script = element.first("script") or Element("script")
    name = script.text_of("name", default=element.text.strip())
    named, texture = named_color(name), _texture(element)
    scripted = _scripted(script, name, context)
    color = scripted.diffuse or scripted.ambient or named
    return Material(
        name=name,
        color=read_color(element, "diffuse") or color,
        ambient=read_color(element, "ambient") or color,
        specular=read_color(element, "specular"),
        emissive=read_color(element, "emissive") or scripted.emissive,
        texture=texture or ("" if scripted.texture is None else scripted.texture.name),
        texture_path=context.find(texture) if texture else scripted.texture,
    )


def read_color(element: Element, tag: str) -> Rgba | None:
    """Read a colour of three or four numbers; return None without one."""
    child = element.first(tag)
    if child is None or not child.text.strip():
        return None
    if len(child.text.replace(",", " ").split()) == 3:
        red, green, blue = child.vector(3)
        return red, green, blue, 1.0
    red, green, blue, alpha = child.vector(4)
    return red, green, blue, alpha


def _scripted(script: Element, name: str, context: Context) -> OgreMaterial:
    """Find a material in the scripts that the element names."""
    found = [path for uri in script.all("uri") if (path := context.find(uri.text.strip())) is not None]
    return find_material(name, found) or OgreMaterial()


def _texture(element: Element) -> str:
    pbr = element.first("pbr") or Element("pbr")
    workflow = pbr.first("metal", "specular")
    return "" if workflow is None else workflow.text_of("albedo_map")
