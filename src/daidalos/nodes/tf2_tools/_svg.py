"""Output of a drawing as SVG."""

from __future__ import annotations

from xml.sax.saxutils import escape

from daidalos.nodes.tf2_tools._tree_picture import Picture


def to_svg(picture: Picture) -> str:
    """Return the document."""
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{picture.width:.0f}" height="{picture.height:.0f}" '
        f'viewBox="0 0 {picture.width:.1f} {picture.height:.1f}" font-family="Helvetica, Arial, sans-serif">',
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
        '<path d="M0 0L8 4L0 8z" fill="#56657a"/></marker></defs>',
        '<rect width="100%" height="100%" fill="#fff"/>',
    ]
    lines += [
        f'<path d="M{arrow.x1:.1f} {arrow.y1:.1f}V{arrow.rail:.1f}H{arrow.x2:.1f}V{arrow.y2:.1f}" fill="none" '
        'stroke="#56657a" marker-end="url(#tip)"/>'
        for arrow in picture.arrows
    ]
    lines += [
        f'<rect x="{box.x - box.width / 2:.1f}" y="{box.y - box.height / 2:.1f}" width="{box.width:.1f}" '
        f'height="{box.height:.1f}" rx="{box.height / 2:.1f}" fill="#eef3fa" stroke="#3f5f8f"/>'
        for box in picture.boxes
    ]
    lines += [
        f'<text x="{text.x:.1f}" y="{text.y:.1f}" font-size="{text.size:g}"'
        f"{' text-anchor=' + chr(34) + 'middle' + chr(34) if text.centred else ''}>{escape(text.content)}</text>"
        for text in picture.texts
    ]
    return "\n".join([*lines, "</svg>", ""])
