"""Telegrams of KUKA RSI: what the robot sends each cycle (`Rob`), and what is answered (`Sen`), as XML.

Positions are in mm and degrees, as in the telegrams. `RIst` and `RSol` are the actual and the set pose, `AIPos` and
`ASPos` the actual and the set angles of the axes; `RKorr` corrects the pose and `AK` the axes. The `IPOC` of an answer
must be that of the telegram it answers.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

POSE = ("X", "Y", "Z", "A", "B", "C")
AXES = ("A1", "A2", "A3", "A4", "A5", "A6")
EXTERNAL_AXES = ("E1", "E2", "E3", "E4", "E5", "E6")
MAX_BYTES = 8192
"""Longer datagrams are refused; those of a controller with all channels have less than half of it."""
MAX_IPOC = 2**63 - 1

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*\Z")
_KEY = re.compile(r"[A-Za-z0-9_-]+\Z")
_NUMBERED = re.compile(rb'(?<=\s)(?=[0-9][A-Za-z0-9_-]*=")')
"""Where an attribute begins with a digit, as channels such as `GPIO.01` do, which XML itself does not know."""
_MARK = "_."
_INTEGER = re.compile(r"\s*[0-9]{1,19}\s*\Z")


class TelegramError(ValueError):
    """A datagram that is no telegram, or values that no telegram can hold."""


@dataclass(frozen=True)
class Telegram:
    """A telegram.

    Attributes
    ----------
    kind : str
        `Rob` from the robot, `Sen` to it.
    sender : str
        Its `Type`: `KUKA`, or the name of the sensor in the controller's configuration.
    ipoc : int
        Time stamp of the cycle [ms].
    groups : mapping
        Numbers with a name and a key, such as `RIst` and `X`.
    values : mapping
        Numbers without a key, such as `Stop`.
    """

    kind: Literal["Rob", "Sen"]
    sender: str
    ipoc: int
    groups: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)

    @property
    def delay(self) -> int:
        """Answers in a row that came too late, as the robot counts them."""
        return int(self.groups.get("Delay", {}).get("D", 0.0))


def encode(telegram: Telegram) -> bytes:
    """Return the XML of a telegram, on one line.

    Raises
    ------
    TelegramError
        Where a number is not finite, or a name is none of XML.
    """
    parts = [f"<{telegram.kind} Type={quoteattr(telegram.sender)}>"]
    for name, group in telegram.groups.items():
        numbers = "".join(f' {_name(key, _KEY)}="{_text(value, f"{name}.{key}")}"' for key, value in group.items())
        parts.append(f"<{_name(name)}{numbers}/>")
    parts += [f"<{_name(name)}>{_text(value, name)}</{name}>" for name, value in telegram.values.items()]
    if not 0 <= telegram.ipoc <= MAX_IPOC:
        raise TelegramError(f"IPOC is {telegram.ipoc}, but must be 0 to {MAX_IPOC}")
    return "".join([*parts, f"<IPOC>{telegram.ipoc}</IPOC></{telegram.kind}>"]).encode()


def decode(data: bytes, kind: Literal["Rob", "Sen"]) -> Telegram:
    """Return the telegram of a datagram. Texts, such as those for the operator, are left out.

    Raises
    ------
    TelegramError
        Where it is not XML, not of this kind, has no IPOC, or a number in it is not finite.
    """
    data = data.rstrip(b"\0")
    if len(data) > MAX_BYTES:
        raise TelegramError(f"is {len(data)} bytes long, but {MAX_BYTES} are allowed")
    if b"<!" in data:
        raise TelegramError("holds a declaration, which telegrams do not have")
    try:
        root = ElementTree.fromstring(_NUMBERED.sub(_MARK.encode(), data))
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise TelegramError(f"is not well-formed XML: {error}") from None
    if root.tag != kind:
        raise TelegramError(f"is <{root.tag}>, but <{kind}> is expected")
    groups: dict[str, dict[str, float]] = {}
    values: dict[str, float] = {}
    ipoc = None
    for child in root:
        text = (child.text or "").strip()
        if child.tag == "IPOC":
            if ipoc is not None or not _INTEGER.match(text) or int(text) > MAX_IPOC:
                raise TelegramError(f"IPOC is '{text[:40]}', but one integer from 0 is expected")
            ipoc = int(text)
        elif child.attrib:
            keys = {key.removeprefix(_MARK): value for key, value in child.attrib.items()}
            groups[child.tag] = {key: _number(value, f"{child.tag}.{key}") for key, value in keys.items()}
        elif _is_number(text):
            values[child.tag] = _number(text, child.tag)
    if ipoc is None:
        raise TelegramError("has no IPOC")
    return Telegram(kind, root.get("Type") or root.get("TYPE") or "", ipoc, groups, values)


def _name(name: str, allowed: re.Pattern[str] = _NAME) -> str:
    if not allowed.match(name):
        raise TelegramError(f"'{name}' is no name of an element")
    return name


def _text(value: float, name: str) -> str:
    if not math.isfinite(value):
        raise TelegramError(f"{name} is {value}, but must be finite")
    return str(int(value)) if value == int(value) and name in _WHOLE else f"{value:.6f}"


_WHOLE = {"Delay.D", "Stop"}
"""Written without a decimal point, as controllers expect integers and truth values."""


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _number(text: str, name: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise TelegramError(f"{name} is '{text[:40]}', but a finite number is expected")
    return value
