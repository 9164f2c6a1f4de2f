"""Fleets of runs: plans, results on the disk, reports, and the processes that carry them out."""

import os
from dataclasses import replace
from pathlib import Path

import pytest

from daidalos.common.errors import UserError
from daidalos.testing.fleet import run_fleet
from daidalos.testing.journal import Journal, Record, read_records
from daidalos.testing.plan import Plan, Variation
from daidalos.testing.report import comparison, summary, write_report

SCENARIO = """\
name: the talker talks
parameters: {within: 5, word: World}
steps:
  - run: {package: demo_nodes_py, executable: talker}
  - eventually: {topic: /chatter, field: data, equals: "Hello $(var word): 2", within: $(var within)}
"""


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    path = tmp_path / "talker.scenario.yaml"
    path.write_text(SCENARIO)
    return path


def test_variations_are_read_and_drawn_from_the_seed_alone(scenario: Path) -> None:
    variations = tuple(map(Variation.parse, ("friction=0.2..1.0", "count=1..3", "kind=a,b,1.5,true")))
    plan = Plan(scenario, 50, 7, variations)
    runs = plan.runs()
    assert runs[:20] == replace(plan, count=20).runs()
    assert [run.seed for run in runs[:3]] == [7, 8, 9]
    frictions = [run.parameters["friction"] for run in runs]
    assert min(frictions) >= 0.2
    assert max(frictions) <= 1.0
    assert len(set(frictions)) == 50
    assert {run.parameters["count"] for run in runs} == {1, 2, 3}
    assert {run.parameters["kind"] for run in runs} == {"a", "b", 1.5, True}
    for wrong in ("friction", "=1", "friction=", "friction=1..0", "friction=a..b"):
        with pytest.raises(UserError, match="expected"):
            Variation.parse(wrong)


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals")
def test_a_fleet_goes_on_where_it_was_ended(scenario: Path, tmp_path: Path) -> None:
    plan = Plan(scenario, 4, 4, (Variation.parse("within=2,4"),))
    folder = tmp_path / "results"

    class Ended(Exception):
        pass

    def end(record: Record) -> None:
        raise Ended

    with Journal(folder, plan) as journal, pytest.raises(Ended):
        run_fleet(plan, journal, 1, end)
    assert len(read_records(folder)) == 1
    with (folder / "runs.jsonl").open("a") as file:
        file.write('{"number": 3, "se')  # as a kill leaves it
    seen: list[int] = []
    with Journal(folder, plan) as journal:
        run_fleet(plan, journal, 1, lambda record: seen.append(record.number))
        table = journal.write_parquet()
    assert seen == [1, 2, 3]
    records = read_records(folder)
    assert [record.passed for record in records] == [run.parameters["within"] == 4 for run in plan.runs()]
    assert {record.simulated_s for record in records} == {2.0, 3.0}
    failed = next(record for record in records if not record.passed)
    assert f"{scenario}:5: /chatter data should be 'Hello World: 2' within 2 s" in failed.message
    assert (folder / failed.folder / "failure.png").is_file()
    pyarrow = pytest.importorskip("pyarrow.parquet")
    rows = pyarrow.read_table(table).to_pylist()
    assert [(row["seed"], row["parameter.within"]) for row in rows] == [
        (run.seed, run.parameters["within"]) for run in plan.runs()
    ]
    write_report(tmp_path / "report.html", "talker", records, folder, records)
    page = (tmp_path / "report.html").read_text()
    assert "data:image/png;base64" in page
    assert f"daidalos scenario run talker --seed {failed.seed} --set within=2" in page


def test_results_of_another_plan_are_refused(scenario: Path, tmp_path: Path) -> None:
    plan = Plan(scenario, 4)
    with Journal(tmp_path / "results", plan):
        pass
    with Journal(tmp_path / "results", replace(plan, count=9)):
        pass
    with pytest.raises(UserError, match=r"has the results of another plan \(seed differ\)"):
        Journal(tmp_path / "results", replace(plan, seed=1))
    scenario.write_text(SCENARIO + "\n")
    with pytest.raises(UserError, match=r"\(sha256 differ\)"):
        Journal(tmp_path / "results", plan)
    with pytest.raises(UserError, match="there are no results of a fleet"):
        read_records(tmp_path)
    wrong = Plan(scenario, 1, 0, (Variation.parse("wihtin=1..2"),))
    journal = Journal(tmp_path / "wrong", wrong)
    with pytest.raises(UserError, match="no parameter 'wihtin'; did you mean 'within'"):
        run_fleet(wrong, journal, 1, lambda record: None)


def test_the_summary_and_the_comparison(tmp_path: Path) -> None:
    good = [Record(k, k, {"f": 0.1 * k}, k > 1, "", 5.0, 0.1, {"time_s": 10.0 + k}) for k in range(40)]
    bad = [replace(record, passed=record.number % 2 == 0, metrics={"time_s": 30.0 + record.number}) for record in good]
    assert summary(good) == "38 of 40 runs passed: 95.0%, with 95 % confidence 83.5% to 98.6%"
    assert summary([]).startswith("0 of 0 runs passed")
    rows = {name: p for name, _, _, p in comparison(good, bad)}
    assert rows["success"] < 1e-4
    assert rows["time_s, median"] < 1e-4
    assert [p for *_, p in comparison(good, good)] == pytest.approx([1.0] * 3)
    write_report(tmp_path / "report.html", "<title>", good, tmp_path, bad)
    page = (tmp_path / "report.html").read_text()
    assert "&lt;title&gt;" in page
    assert "3.12 to 3.9" in page
