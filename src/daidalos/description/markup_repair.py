"""Correction of malformed XML that TinyXML, the parser of Gazebo and of urdfdom, reads nevertheless."""

from __future__ import annotations

import re

_MARKUP = re.compile(
    rb"""(?P<comment><!--(?P<remark>.*?)-->)
    | (?P<verbatim><!\[CDATA\[.*?\]\]>|<\?.*?\?>|<!DOCTYPE[^>\[]*(?:\[.*?\])?\s*>)
    | <(?P<tag>[A-Za-z_][^\s<>/="']*)(?P<attributes>(?:\s(?:"[^"]*"|'[^']*'|[^"'>])*?)?)(?P<end>/?)>
    | (?P<ampersand>&(?!(?:amp|lt|gt|quot|apos|\#\d+|\#x[0-9A-Fa-f]+);))""",
    re.DOTALL | re.VERBOSE,
)
_ATTRIBUTE = re.compile(
    rb"""(?P<gap>\s*)(?P<key>[A-Za-z_][^\s=<>"']*)\s*=\s*(?:"(?P<double>[^"]*)"|'(?P<single>[^']*)'|(?P<bare>[^\s"'<>]+))""",
    re.DOTALL,
)
_BARE_AMPERSAND = re.compile(rb"&(?!(?:amp|lt|gt|quot|apos|#\d+|#x[0-9A-Fa-f]+);)")


def repair(document: bytes) -> bytes:
    """Return a document with what TinyXML tolerates written as XML demands.

    These are ``--`` inside comments, attribute values without quotation marks or with ``<``, repeated attributes of
    an element (the first counts), ampersands that begin no known entity, and bytes that are not UTF-8 (read as
    Latin-1). Lines keep their numbers.
    """
    return _MARKUP.sub(_repaired, _as_utf8(document))


def _as_utf8(document: bytes) -> bytes:
    try:
        document.decode()
    except UnicodeDecodeError:
        return document.decode("latin-1").encode()
    return document


def _repaired(found: re.Match[bytes]) -> bytes:
    if found["comment"] is not None:
        return b"<!--" + b"\n" * found["remark"].count(b"\n") + b"-->"
    if found["ampersand"] is not None:
        return b"&amp;"
    if found["tag"] is None or not found["attributes"].strip():
        return found[0]
    attributes, end = found["attributes"], found["end"]
    kept, rest = _attributes(attributes)
    # What is not an attribute stays as it is, for the parser to report.
    return b"<" + found["tag"] + kept + rest + end + b">"


def _attributes(text: bytes) -> tuple[bytes, bytes]:
    """Return the attributes of a tag in quotation marks, each once, and what follows the last of them."""
    written: list[bytes] = []
    seen: set[bytes] = set()
    position = 0
    while found := _ATTRIBUTE.match(text, position):
        position = found.end()
        value = next(found[name] for name in ("double", "single", "bare") if found[name] is not None)
        lines = b"\n" * (found[0].count(b"\n") - value.count(b"\n"))
        written.append(lines or b" ")
        if found["key"] in seen:
            written.append(b"\n" * value.count(b"\n"))
            continue
        seen.add(found["key"])
        value = _BARE_AMPERSAND.sub(b"&amp;", value).replace(b"<", b"&lt;").replace(b'"', b"&quot;")
        written.append(found["key"] + b'="' + value + b'"')
    return b"".join(written), text[position:]
