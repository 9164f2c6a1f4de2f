"""The plugin of pytest in processes of its own: what it reports, keeps and costs."""

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from daidalos.bags.reader import BagReader

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals")

TESTS = """
import os
import pytest

@pytest.fixture
def broken():
    yield
    assert os.environ["NUMBER"] == "5"

@pytest.mark.scenario(timeout=20, seed=1)
def test_values(nodes, topic, broken):
    print("printed by the test")
    nodes.run("demo_nodes_py", "talker")
    topic("/chatter").map(lambda message: int(message.data.split()[-1])).eventually(above=5, within=4)

@pytest.mark.scenario(timeout=3)
def test_too_long(clock):
    clock.sleep(100)

@pytest.mark.scenario
def test_later(nodes, topic, clock):
    nodes.run("demo_nodes_py", "talker")
    topic("/chatter").field("data").never(lambda text: text.endswith("1"))
    clock.sleep(2.5)
    assert False

@pytest.mark.scenario(time_out=3)
def test_mark():
    pass

@pytest.mark.scenario
def test_end():
    os._exit(7)

@pytest.mark.scenario
def test_skipped():
    pytest.skip("not today")
"""

YAML = """\
name: the talker talks
steps:
  - run: {package: demo_nodes_py, executable: talker}
  - eventually: {topic: /chatter, field: data, equals: "Hello World: 2", within: 5}
  - eventually: {topic: /chater, field: data, equals: "", within: 1}
"""


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"NUMBER": "5", "ROS_HOME": str(folder)}
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_failures_are_reported_with_values_bag_and_picture(tmp_path: Path) -> None:
    (tmp_path / "test_it.py").write_text(TESTS)
    (tmp_path / "talker.scenario.yaml").write_text(YAML)
    (tmp_path / "other.yaml").write_text("a: 1")
    result = run(tmp_path, "-n", "2", "--junitxml=report.xml", "-W", "error", ".")
    output = result.stdout
    assert result.returncode == 1
    assert "6 failed, 1 skipped" in output, output
    assert "printed by the test" in output
    assert "/chatter <lambda> should be above 5 within 4 s (from 0.000 s to 4.000 s), but was" in output
    assert "nearest: 2 at 3.000 s" in output
    assert "the scenario has not ended within 3 simulated seconds" in output
    assert "/chatter data should never be as the function requires, but at 2.000 s it was Hello World: 1" in output
    assert "the mark 'scenario' has no 'time_out'; did you mean 'timeout'?" in output
    assert "the process of the scenario ended with status 7 before the test had ended" in output
    assert "talker.scenario.yaml:5: /chater data: no value came within 1 s" in output
    assert "nothing publishes '/chater'; did you mean '/chatter'?" in output
    kept = tmp_path / "scenario-results" / "test_it.py-test_values"
    assert f"daidalos scenario show {kept.relative_to(tmp_path)}" in output
    assert (kept / "failure.png").read_bytes().startswith(b"\x89PNG")
    with BagReader(kept / "bag") as bag:
        assert "/chatter" in bag.topics
    cases = {case.get("name"): case for case in ElementTree.parse(tmp_path / "report.xml").iter("testcase")}
    assert len(cases) == 7
    assert cases["test_values"].find("failure") is not None
    properties = {one.get("name"): one.get("value") for one in cases["test_values"].iter("property")}
    assert properties["simulated_s"] == "4.0"


@pytest.mark.slow
def test_nothing_is_imported_where_there_is_no_scenario(tmp_path: Path) -> None:
    (tmp_path / "test_it.py").write_text(
        "import sys\n"
        "def test_it():\n"
        "    loaded = {name for name in sys.modules if name.startswith(('daidalos.', 'rclpy', 'numpy'))}\n"
        "    assert loaded == {'daidalos.testing', 'daidalos.testing.plugin'}\n"
    )
    result = run(tmp_path, "-p", "no:launch", "-p", "no:launch_ros", "-p", "no:launch_pytest", ".")
    assert result.returncode == 0, result.stdout


@pytest.mark.slow
def test_scenarios_run_from_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "talker.yaml").write_text(
        YAML.replace("/chater", "/chatter").replace('""', '"Hello World: 3"').replace("n: 1", "n: 2")
    )
    (tmp_path / "wrong.yaml").write_text(YAML.replace("eventually", "eventualy"))
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "scenario", "run"]
    result = subprocess.run(
        [*command, "talker.yaml", "--seed", "4"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert result.stdout.startswith("passed  the talker talks  (seed 4, time_s 4)"), result.stderr
    assert result.returncode == 0
    result = subprocess.run(
        [*command, "talker.yaml", "wrong.yaml"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr.endswith("wrong.yaml:4: there is no step 'eventualy'; did you mean 'eventually'?\n")
