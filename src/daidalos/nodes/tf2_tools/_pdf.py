"""Output of a drawing as PDF 1.4 (ISO 32000): one page, with the Helvetica of every reader."""

from __future__ import annotations

from daidalos.nodes.tf2_tools._tree_picture import Arrow, Box, Picture, Text, text_width

_TIP = 7.0
_ROUND = 0.5523  # a quarter of a circle as a Bezier curve


def to_pdf(picture: Picture) -> bytes:
    """Return the document."""
    drawing = [
        f"1 0 0 -1 0 {picture.height:.2f} cm 0.8 w",
        "0.34 0.40 0.48 RG 0.34 0.40 0.48 rg",
        *map(_arrow, picture.arrows),
        "0.25 0.37 0.56 RG 0.93 0.95 0.98 rg",
        *map(_box, picture.boxes),
        "0 g",
        *map(_text, picture.texts),
    ]
    content = "\n".join(drawing).encode("cp1252", "replace")
    return _document(
        [
            b"<< /Type /Catalog /Pages 2 0 R >>",
            b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
            f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {picture.width:.2f} {picture.height:.2f}] "
            "/Contents 4 0 R /Resources << /Font << /F 5 0 R >> >> >>".encode(),
            f"<< /Length {len(content)} >>\nstream\n".encode() + content + b"\nendstream",
            b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
        ]
    )


def _document(objects: list[bytes]) -> bytes:
    """Assemble numbered objects with the cross-reference table."""
    content = b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n"
    places = []
    for number, each in enumerate(objects, 1):
        places.append(len(content))
        content += f"{number} 0 obj\n".encode() + each + b"\nendobj\n"
    table = "".join(f"{place:010d} 00000 n \n" for place in places)
    size = len(objects) + 1
    end = f"xref\n0 {size}\n0000000000 65535 f \n{table}trailer\n<< /Size {size} /Root 1 0 R >>\n"
    return content + f"{end}startxref\n{len(content)}\n%%EOF\n".encode()


def _arrow(arrow: Arrow) -> str:
    line = (
        f"{arrow.x1:.2f} {arrow.y1:.2f} m {arrow.x1:.2f} {arrow.rail:.2f} l "
        f"{arrow.x2:.2f} {arrow.rail:.2f} l {arrow.x2:.2f} {arrow.y2:.2f} l S"
    )
    tip = " ".join(f"{arrow.x2 + side * _TIP / 2:.2f} {arrow.y2 - _TIP:.2f} l" for side in (-1, 1))
    return f"{line} {arrow.x2:.2f} {arrow.y2:.2f} m {tip} f"


def _box(box: Box) -> str:
    """Round at both ends."""
    radius = box.height / 2
    left, right = box.x - box.width / 2 + radius, box.x + box.width / 2 - radius
    top, bottom, bow = box.y - radius, box.y + radius, _ROUND * radius
    return (
        f"{left:.2f} {top:.2f} m {right:.2f} {top:.2f} l "
        f"{right + bow:.2f} {top:.2f} {right + radius:.2f} {box.y - bow:.2f} {right + radius:.2f} {box.y:.2f} c "
        f"{right + radius:.2f} {box.y + bow:.2f} {right + bow:.2f} {bottom:.2f} {right:.2f} {bottom:.2f} c "
        f"{left:.2f} {bottom:.2f} l "
        f"{left - bow:.2f} {bottom:.2f} {left - radius:.2f} {box.y + bow:.2f} {left - radius:.2f} {box.y:.2f} c "
        f"{left - radius:.2f} {box.y - bow:.2f} {left - bow:.2f} {top:.2f} {left:.2f} {top:.2f} c b"
    )


def _text(text: Text) -> str:
    x = text.x - text_width(text.content, text.size) / 2 if text.centred else text.x
    content = text.content.replace("\\", r"\\").replace("(", r"\(").replace(")", r"\)")
    # The page is upside down, so that y points down; letters are turned back.
    return f"BT /F {text.size:g} Tf 1 0 0 -1 {x:.2f} {text.y:.2f} Tm ({content}) Tj ET"
