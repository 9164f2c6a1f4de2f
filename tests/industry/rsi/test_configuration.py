"""Ethernet configurations of KUKA RSI."""

from pathlib import Path

import pytest

from daidalos.common.errors import UserError
from daidalos.industry.rsi.configuration import Configuration, read_configuration
from daidalos.interfaces.library import BUILT_IN

FILE = BUILT_IN / "kr500_2mt_description/config/rsi/seam_servo.xml"


def changed(tmp_path: Path, old: str, new: str) -> Configuration:
    text = FILE.read_text()
    assert old in text
    (tmp_path / "rsi.xml").write_text(text.replace(old, new))
    return read_configuration(tmp_path / "rsi.xml")


def test_the_built_in_file() -> None:
    found = read_configuration(FILE)
    assert (found.port, found.sensor, found.only_send) == (59152, "ImFree", False)
    assert [(one.name, one.key) for one in found.sent][:2] == [("RIst", "X"), ("RIst", "Y")]
    assert found.corrected == ("RKorr",)
    assert [(one.name, one.key, one.index, one.holds) for one in found.received][:2] == [
        ("Stop", "", 1, False),
        ("RKorr", "X", 2, False),
    ]


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("<PORT>59152</PORT>", "<PORT>0</PORT>", r"rsi.xml:5: .*1 to 65535"),
        ("<PORT>59152</PORT>", "", "<PORT> is missing"),
        ("DEF_RIst", "DEF_RIsr", r"rsi.xml:11: .*'DEF_RIsr'; did you mean 'DEF_RIst'"),
        ('INDX="3" HOLDON="0"', 'INDX="65" HOLDON="0"', "1 to 64"),
        ('INDX="3" HOLDON="0"', 'INDX="3" HOLDON="2"', "HOLDON is '2'"),
        ('RKorr.Y" TYPE="DOUBLE"', 'RKorr.Y" TYPE="FLOAT"', "TYPE is 'FLOAT'"),
        ("RKorr.Y", "RKorr.X", "'RKorr.X' is there twice"),
        ("</ROOT>", "", "not well-formed"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path: Path, old: str, new: str, reason: str) -> None:
    with pytest.raises(UserError, match=reason):
        changed(tmp_path, old, new)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"none.xml: .*No such file"):
        read_configuration(tmp_path / "none.xml")
