"""Fleets of runs on a cluster of Ray that is started here."""

import os
import socket
from pathlib import Path

import psutil
import pytest

from daidalos.common.errors import UserError
from daidalos.testing.cluster import run_on_cluster
from daidalos.testing.fleet import run_fleet
from daidalos.testing.journal import Journal, Record, read_records
from daidalos.testing.plan import Plan, Variation
from testing.test_fleet import SCENARIO

ray = pytest.importorskip("ray", reason="the extra 'cluster' is not installed")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals"),
]


def without_times(records: list[Record]) -> list[dict[str, object]]:
    return [{key: value for key, value in vars(record).items() if key != "real_s"} for record in records]


def test_results_are_those_of_this_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("talker.scenario.yaml").write_text(SCENARIO)
    plan = Plan(Path("talker.scenario.yaml"), 4, 4, (Variation.parse("within=2,4"),))
    for folder, address in (("here", None), ("cluster", "local")):
        with Journal(Path(folder), plan) as journal:
            run_fleet(plan, journal, 2, lambda record: None, address)
    records = read_records(Path("cluster"))
    assert without_times(records) == without_times(read_records(Path("here")))
    failed = next(record for record in records if not record.passed)
    assert (Path("cluster") / failed.folder / "failure.png").is_file()


def test_a_lost_worker_is_replaced_and_a_fault_is_told_in_one_line(tmp_path: Path) -> None:
    plan = Plan(tmp_path / "talker.scenario.yaml", 2)
    plan.scenario.write_text(SCENARIO)
    results = run_on_cluster(plan.scenario, plan.runs(), tmp_path, "local", 1)
    assert next(results).number == 0
    (worker,) = (one for one in psutil.Process().children(recursive=True) if "ClusterWorker" in " ".join(one.cmdline()))
    worker.kill()
    worker.wait(60.0)
    assert [(record.number, record.passed) for record in results] == [(1, True)]
    missing = tmp_path / "missing.scenario.yaml"
    with pytest.raises(UserError, match=r"cannot carry out run 0: .*missing\.scenario\.yaml"):
        list(run_on_cluster(missing, plan.runs(), tmp_path, "local", 1))


def test_a_cluster_that_is_not_there_is_named(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    with pytest.raises(UserError, match=f"no cluster of Ray at '127.0.0.1:{port}' that can be used"):
        next(run_on_cluster(tmp_path / "a.scenario.yaml", Plan(tmp_path, 1).runs(), tmp_path, f"127.0.0.1:{port}", 1))
