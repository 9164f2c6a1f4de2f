"""The command that writes the motions of the State Lattice planner."""

import json
from xml.etree import ElementTree

import pytest

from daidalos.navigation.planners.state_lattice import read_lattice
from daidalos.nodes.nav2_smac_planner import generate_motion_primitives


@pytest.fixture
def run(monkeypatch, tmp_path):
    def run(*arguments):
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr("sys.argv", ["generate_motion_primitives", *arguments])
        return generate_motion_primitives.main()

    return run


def test_motions_are_written_and_drawn(run, tmp_path, capsys):
    (tmp_path / "config.json").write_text(json.dumps({"motion_model": "omni", "turning_radius": 0.3}))
    assert run("--config", "config.json", "--output", "motions.json", "--visualizations", "pictures") == 0
    lattice = read_lattice(tmp_path / "motions.json")
    assert (lattice.motion_model, lattice.turning_radius) == ("omni", 0.3)
    content = json.loads((tmp_path / "motions.json").read_text())
    assert content["lattice_metadata"]["number_of_trajectories"] == len(content["primitives"])
    assert content["lattice_metadata"]["stopping_threshold"] == 5
    assert [one["trajectory_id"] for one in content["primitives"]] == list(range(len(content["primitives"])))
    starts = [one["start_angle_index"] for one in content["primitives"]]
    assert starts == sorted(starts)
    drawn = ElementTree.parse(tmp_path / "pictures" / "all_trajectories.svg")
    assert len(drawn.findall(".//{*}polyline")) == len(content["primitives"])
    assert f"{len(content['primitives'])} motions at 16 headings are in motions.json" in capsys.readouterr().out


def test_the_file_is_called_output_json(run, tmp_path):
    assert run() == 0
    assert read_lattice(tmp_path / "output.json").turning_radius == 0.5


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "config.json: cannot be read: No such file"),
        ("{", "config.json:1: is not valid JSON"),
        ("[]", "config.json: must be an object"),
        (
            '{"turning_radus": 1}',
            "config.json: parameter 'turning_radus' is not declared; did you mean 'turning_radius'",
        ),
        ('{"num_of_headings": 12}', "config.json: parameter 'num_of_headings' must be a multiple of 8, got 12"),
    ],
)
def test_a_wrong_configuration_is_refused(run, tmp_path, capsys, content, message):
    if content is not None:
        (tmp_path / "config.json").write_text(content)
    assert run("--config", "config.json") == 2
    printed = capsys.readouterr().err
    assert message in printed
    assert printed.count("\n") == 1
    assert not (tmp_path / "output.json").exists()


def test_a_file_that_cannot_be_written_is_told(run, capsys):
    assert run("--output", "no/folder/motions.json") == 2
    assert "error: cannot write 'no/folder/motions.json': No such file" in capsys.readouterr().err
