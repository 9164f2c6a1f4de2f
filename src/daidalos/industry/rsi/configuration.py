"""Ethernet configuration of KUKA RSI: the XML file on the controller that says what it sends, receives, and where to.

<ROOT><CONFIG><IP_NUMBER/><PORT/><SENTYPE/><ONLYSEND/></CONFIG>
  <SEND><ELEMENTS><ELEMENT TAG="DEF_RIst" TYPE="DOUBLE" INDX="INTERNAL"/>...</ELEMENTS></SEND>
  <RECEIVE><ELEMENTS><ELEMENT TAG="RKorr.X" TYPE="DOUBLE" INDX="1" HOLDON="0"/>...</ELEMENTS></RECEIVE></ROOT>
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from daidalos.common.documents import DocumentError, read_text
from daidalos.common.suggestions import hint
from daidalos.description.markup import Element, parse_markup
from daidalos.industry.rsi.telegrams import AXES, EXTERNAL_AXES, POSE

INTERNAL_GROUPS = {
    "DEF_RIst": ("RIst", POSE),
    "DEF_RSol": ("RSol", POSE),
    "DEF_AIPos": ("AIPos", AXES),
    "DEF_ASPos": ("ASPos", AXES),
    "DEF_EIPos": ("EIPos", EXTERNAL_AXES),
    "DEF_ESPos": ("ESPos", EXTERNAL_AXES),
    "DEF_MACur": ("MACur", AXES),
    "DEF_MECur": ("MECur", EXTERNAL_AXES),
    "DEF_Delay": ("Delay", ("D",)),
}
"""What the controller itself knows: tag in the file, and name and keys in the telegram."""
TECHNOLOGY = ("DEF_Tech.C1", "DEF_Tech.C2", "DEF_Tech.C3", "DEF_Tech.T1", "DEF_Tech.T2", "DEF_Tech.T3")
"""Values of technology packages, which a program may send; the simulated controller does not."""
TYPES = ("BOOL", "STRING", "LONG", "DOUBLE")
MAX_CHANNEL = 64


@dataclass(frozen=True)
class Channel:
    """A value that the controller sends or receives.

    Attributes
    ----------
    name, key : str
        In the telegram; the key is empty where the value has an element of its own.
    type : str
        One of `TYPES`.
    index : int or None
        Of the signal in the signal flow, from 1; None for what the controller itself knows.
    holds : bool
        Whether the last value counts when an answer is lost (HOLDON); 0 otherwise.
    """

    name: str
    key: str
    type: str
    index: int | None
    holds: bool = False


@dataclass(frozen=True)
class Configuration:
    """An Ethernet configuration.

    Attributes
    ----------
    address : str
        Of the computer that answers (IP_NUMBER).
    port : int
        Its port.
    sensor : str
        `Type` of the answers (SENTYPE).
    only_send : bool
        Whether the controller expects no answers.
    sent, received : tuple of Channel
    """

    address: str
    port: int
    sensor: str
    only_send: bool
    sent: tuple[Channel, ...]
    received: tuple[Channel, ...]

    @property
    def corrected(self) -> tuple[str, ...]:
        """What can be corrected: `RKorr`, `AK` or both."""
        names = dict.fromkeys(channel.name for channel in self.received)
        return tuple(name for name in names if name in ("RKorr", "AK"))


def read_configuration(path: Path) -> Configuration:
    """Return the configuration of a file.

    Raises
    ------
    UserError
        Where the file is not valid, with its line.
    """
    try:
        text = read_text(path)
    except OSError as error:
        raise DocumentError(f"cannot be read: {error.strerror}", str(path)) from None
    root = parse_markup(text, str(path))
    if root.tag != "ROOT":
        raise root.error("the document should be <ROOT> with <CONFIG>, <SEND> and <RECEIVE>")
    config = root.require("CONFIG")
    port = config.require("PORT")
    if not 1 <= port.number() <= 65535 or port.number() != int(port.number()):
        raise port.error(f"should be an integer from 1 to 65535, got '{port.text.strip()}'")
    return Configuration(
        config.require("IP_NUMBER").text.strip(),
        int(port.number()),
        config.text_of("SENTYPE", default="ImFree"),
        config.flag_of("ONLYSEND", default=False),
        _channels(root, "SEND"),
        _channels(root, "RECEIVE"),
    )


def _channels(root: Element, section: str) -> tuple[Channel, ...]:
    found = root.first(section)
    elements = [] if found is None else found.require("ELEMENTS").all("ELEMENT")
    out: list[Channel] = []
    for element in elements:
        for channel in _channel(element, section):
            if any((channel.name, channel.key) == (other.name, other.key) for other in out):
                raise element.error(f"'{element.attribute('TAG')}' is there twice")
            out.append(channel)
    return tuple(out)


def _channel(element: Element, section: str) -> list[Channel]:
    """Return the channels of an element: several for a group that the controller knows."""
    tag, kind, index = element.attribute("TAG"), element.attribute("TYPE"), element.attribute("INDX")
    if kind not in TYPES:
        raise element.error(f"TYPE is '{kind}'{hint(kind, TYPES)}")
    if index == "INTERNAL":
        if tag in TECHNOLOGY:
            return []
        if section != "SEND" or tag not in INTERNAL_GROUPS:
            raise element.error(f"the controller itself does not know '{tag}'{hint(tag, INTERNAL_GROUPS)}")
        name, keys = INTERNAL_GROUPS[tag]
        return [Channel(name, key, kind, None) for key in keys]
    if not index.isdecimal() or not 1 <= int(index) <= MAX_CHANNEL:
        raise element.error(f"INDX is '{index}', but INTERNAL or an integer from 1 to {MAX_CHANNEL} is expected")
    held = element.attribute("HOLDON", "0")
    if held not in ("0", "1"):
        raise element.error(f"HOLDON is '{held}', but 0 or 1 is expected")
    name, _, key = tag.partition(".")
    return [Channel(name, key, kind, int(index), held == "1")]
