"""Scenarios as YAML: what is read, and what is said of mistakes."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.errors import UserError
from daidalos.testing.documents import STEPS, read_scenario
from daidalos.testing.steps import Performance

GOOD = """\
name: a good one
timeout: 30
seed: 7
parameters: {speed: 0.2, who: waffle}
world: arena
robots:
  - {model: waffle, x: 1}
always:
  - {topic: /scan, field: "ranges[0]", above: 0.1}
steps:
  - drive: {robot: $(var who), linear: $(var speed)}
  - wait: 2
  - kill: talker
  - eventually: {topic: "/$(var who)/odom", field: pose.pose.position.x, above: 0.3, within: 5}
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "one.scenario.yaml"
    path.write_text(text)
    return path


def test_a_scenario_is_read_with_its_parameters(tmp_path: Path) -> None:
    document = read_scenario(write(tmp_path, GOOD), {"speed": 0.4})
    assert (document.name, document.timeout, document.seed, document.world) == ("a good one", 30.0, 7, "arena")
    drive, wait, kill, eventually = document.steps
    assert drive.values == {"robot": "waffle", "linear": 0.4}
    assert (wait.values, kill.values) == ({"seconds": 2.0}, {"node": "talker"})
    assert (eventually.values["topic"], eventually.line) == ("/waffle/odom", 14)
    assert [step.kind for step in document.setting] == ["spawn"]


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("timeout: 30", "timout: 30", "2: a scenario has no 'timout'; did you mean 'timeout'?"),
        ("timeout: 30", "timeout: soon", "2: 'timeout' should be a number, got 'soon'"),
        ("seed: 7", "seed: 7.5", "3: 'seed' should be a whole number, got 7.5"),
        ("- drive:", "- drve:", "11: there is no step 'drve'; did you mean 'drive'?"),
        ("linear:", "liner:", "11: the step 'drive' has no 'liner'; did you mean 'linear'?"),
        ("$(var speed)", "$(var sped)", "11: there is no parameter 'sped'; did you mean 'speed'?"),
        (", within: 5", "", "14: the step 'eventually' needs 'within'"),
        ("- wait: 2", "- wait", "10: expected a step: one key, such as 'drive' or 'eventually'"),
        ("{model: waffle, x: 1}", "waffle", "6: expected mappings below 'robots'"),
        ("seed: 7", "seed: 7\nseed: 8", "4: 'seed' is given twice"),
        ("steps:", "steps: [", "11: expected the node content, but found '-'"),
    ],
)
def test_a_mistake_is_named_with_its_line(tmp_path: Path, old: str, new: str, problem: str) -> None:
    assert GOOD.count(old) == 1
    path = write(tmp_path, GOOD.replace(old, new))
    with pytest.raises(UserError) as caught:
        read_scenario(path)
    assert str(caught.value).startswith(f"{path}:{problem}")


def test_files_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="No such file"):
        read_scenario(tmp_path / "none.yaml")
    with pytest.raises(UserError, match="expected a mapping"):
        read_scenario(write(tmp_path, "- 1"))
    with pytest.raises(UserError, match="expected 'steps'"):
        read_scenario(write(tmp_path, "name: nothing"))
    with pytest.raises(UserError, match="no parameter 'sped'; did you mean 'speed'"):
        read_scenario(write(tmp_path, GOOD), {"sped": 1})


def test_every_step_can_be_performed() -> None:
    assert [kind for kind in STEPS if not callable(getattr(Performance, f"_{kind}", None))] == []


@given(st.text(alphabet="abcs:-{}[]$(var )\n\"'0123456789 ", max_size=60))
def test_any_text_is_a_scenario_or_a_mistake_of_one_line(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    path = write(tmp_path_factory.mktemp("x"), f"name: x\nsteps:\n  - {text}\n")
    problem = ""
    try:
        read_scenario(path)
    except UserError as error:
        problem = str(error)
    assert len(problem.splitlines()) <= 1
