"""Seams followed in the simulated cell through RSI over UDP, and their runs as files."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from daidalos.common.errors import UserError
from daidalos.industry.rsi.configuration import read_configuration
from daidalos.industry.servoing.butt_joint import SEAMS
from daidalos.industry.servoing.experiments import CellOptions, run_in_cell
from daidalos.industry.servoing.servo_report import servo_report, servo_rows
from daidalos.industry.servoing.servo_run import ServoRun, load
from daidalos.interfaces.library import BUILT_IN

CONFIGURATION = read_configuration(BUILT_IN / "kr500_2mt_description/config/rsi/seam_servo.xml")


@pytest.fixture(scope="module")
def line() -> ServoRun:
    return run_in_cell(SEAMS["line"], "feedforward", CONFIGURATION)


def test_a_line_is_followed(line: ServoRun) -> None:
    figures = line.figures()
    assert line.is_complete
    assert figures["residual_mm"] <= 0.05
    assert figures["std_mm"] <= 0.03
    assert figures["seen_percent"] > 98.0
    assert figures["gap_mm"] == pytest.approx(0.2, abs=0.06)
    assert figures["lost"] == 0


def test_the_same_seed_is_the_same_run() -> None:
    seam = replace(SEAMS["line"], length=1e-3)
    runs = [run_in_cell(seam, "lqg", CONFIGURATION, options=CellOptions(seed=seed)) for seed in (3, 3, 4)]
    places = [run.series["lateral"] for run in runs]
    assert np.array_equal(places[0], places[1])
    assert not np.array_equal(places[0], places[2])


@pytest.mark.slow
def test_lost_answers_are_made_up_for() -> None:
    run = run_in_cell(SEAMS["line"], "feedforward", CONFIGURATION, options=CellOptions(lost=0.1))
    assert run.is_complete
    assert run.counts["lost"] > 100
    assert run.figures()["std_mm"] <= 0.04


@pytest.mark.slow
def test_a_blind_sensor_ends_the_run() -> None:
    run = run_in_cell(SEAMS["line"], "lqg", CONFIGURATION, options=CellOptions(blind=(0.02, 0.06)))
    assert not run.is_complete
    assert "no seam was seen for 1 s" in run.ended
    assert abs(float(run.series["deviation"][-1])) < 0.1e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("controller", "least", "most"),
    [("proportional", 0.14, 0.2), ("lead", 0.05, 0.1), ("feedforward", 0.0, 0.03), ("mpc", 0.0, 0.03)],
)
def test_a_curve_is_followed(controller: str, least: float, most: float) -> None:
    run = run_in_cell(replace(SEAMS["curve"], length=0.15), controller, CONFIGURATION)
    assert least <= run.figures()["std_mm"] <= most
    assert run.figures()["residual_mm"] <= 0.05
    assert bool(servo_rows(run)) == (controller in ("proportional", "lead"))


def test_runs_are_saved_loaded_and_shown(line: ServoRun, tmp_path: Path) -> None:
    line.save(tmp_path / "run.npz")
    loaded = load(tmp_path / "run.npz")
    assert loaded.figures() == line.figures()
    assert servo_report([line, loaded]).count("<svg") == 6
    with pytest.raises(UserError, match="is there already"):
        line.save(tmp_path / "run.npz")


@pytest.mark.parametrize("content", [b"", b"nothing", b"PK\x03\x04 and no more"])
def test_what_is_no_run_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "run.npz").write_bytes(content)
    with pytest.raises(UserError, match="is no run of a seam servo"):
        load(tmp_path / "run.npz")
    with pytest.raises(UserError, match="there is no such file"):
        load(tmp_path / "none.npz")
