"""Files of elasticity: what is read, written, and refused."""

import numpy as np
import pytest
import yaml

from daidalos.common.documents import DocumentError
from daidalos.industry.elasticity.elasticity_file import read_elasticity, write_elasticity
from description.robots import SHARE

FILE = SHARE / "kr500_2mt_description/config/elasticity.yaml"


def test_published_values_are_read_in_si_units():
    found = read_elasticity(FILE, "kr500_2mt")
    np.testing.assert_allclose(found.stiffness, [2.3e6, 8.6e6, 2.8e6, 3.0e6, 0.2e6, 0.9e6])
    assert np.degrees(found.backlash[0]) * 60 == pytest.approx(5.01)
    assert found.mass.sum() == 1495


def test_what_is_written_is_read_again(tmp_path):
    found = read_elasticity(FILE, "kr500_2mt")
    sources = dict.fromkeys(found.uncertainty, "a test")
    write_elasticity(tmp_path / "mine.yaml", "kr500_2mt", found, sources)
    again = read_elasticity(tmp_path / "mine.yaml", "kr500_2mt")
    for name in found.uncertainty:
        np.testing.assert_allclose(getattr(again, name), getattr(found, name), rtol=1e-5)
    with pytest.raises(FileExistsError):
        write_elasticity(tmp_path / "mine.yaml", "kr500_2mt", found, sources)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: c.pop("stiffness"), "has no 'stiffness'"),
        (lambda c: c.update(stifness=1), "there is no quantity 'stifness'; did you mean 'stiffness'"),
        (lambda c: c.update(robot="irb120"), "is for the robot 'irb120', not for 'kr500_2mt'"),
        (lambda c: c["stiffness"].update(unit="Nmm"), "'stiffness' is in 'Nmm', but must be in Nm/rad or kNm/rad"),
        (lambda c: c["stiffness"].update(value=[1] * 5), "'stiffness.value' must be six finite numbers"),
        (lambda c: c["stiffness"].update(value=[1, 1, 0, 1, 1, 1]), "'stiffness' of axis 3 must be greater than 0"),
        (lambda c: c["mass"].update(value=[1, 1, float("nan"), 1, 1, 1]), "'mass.value' must be six finite numbers"),
        (lambda c: c["backlash"].update(value=[-1, 1, 1, 1, 1, 1]), "'backlash' of axis 1 must be 0 or greater"),
        (lambda c: c["backlash"].pop("source"), "'backlash' must be a mapping with unit, value, uncertainty, source"),
        (lambda c: c["mass"].update(uncertainty=[-1] * 6), "'mass.uncertainty' must not be negative"),
    ],
)
def test_what_is_wrong_is_named(change, message, tmp_path):
    content = yaml.safe_load(FILE.read_text())
    change(content)
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(content))
    with pytest.raises(DocumentError, match=message.replace("(", r"\(")):
        read_elasticity(tmp_path / "mine.yaml", "kr500_2mt")
