import threading

import pytest
import trimesh

from daidalos.description import sdf
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Mesh
from daidalos.description.meshes import load_mesh
from daidalos.simulation import Simulation
from daidalos.simulation.conversion import preparation
from daidalos.simulation.conversion.convex import content_key, convex_parts
from daidalos.simulation.conversion.preparation import prepare_meshes
from daidalos.simulation.errors import SimulationError


@pytest.fixture
def rings(tmp_path, monkeypatch):
    """World of three static rings of different sizes, a broken mesh, and an empty cache."""
    monkeypatch.setenv("DAIDALOS_CACHE", str(tmp_path / "cache"))
    trimesh.creation.torus(1.0, 0.2, 16, 8).export(tmp_path / "ring.stl")
    (tmp_path / "broken.stl").write_text("nothing")
    shapes = [f"ring.stl</uri><scale>{s} {s} {s}</scale>" for s in (1, 2, 3)] + ["broken.stl</uri>"]
    models = "".join(
        f"<model name='m{i}'><static>1</static><link name='l'><collision name='c'><geometry><mesh><uri>{shape}</mesh>"
        "</geometry></collision></link></model>"
        for i, shape in enumerate(shapes)
    )
    return sdf.parse(f"<sdf version='1.9'><world name='w'>{models}</world></sdf>", str(tmp_path / "w.sdf"))


@pytest.mark.slow
def test_what_is_prepared_is_what_is_used(rings, monkeypatch):
    prepared = prepare_meshes(rings.models)
    shape = rings.models[1].links["l"].collisions[0].geometry
    assert isinstance(shape, Mesh)
    mesh = load_mesh(shape)
    parts, concave = prepared[content_key(mesh), True]
    assert concave
    assert [part.vertices.tolist() for part in parts] == [
        part.vertices.tolist() for part in convex_parts(mesh, content_key(mesh), True)[0]
    ]
    assert len(prepared) == 3
    monkeypatch.setattr("daidalos.simulation.conversion.assets.convex_parts", None)
    simulation = Simulation(rings, warn=lambda line: None)
    assert simulation.physics.model.ngeom == sum(len(parts) + 1 for parts, _ in prepared.values())
    assert "broken.stl" in simulation.warnings[0]


@pytest.mark.slow
def test_progress_is_reported(rings, monkeypatch):
    monkeypatch.setattr(preparation, "REPORT_DELAY", 0.0)
    monkeypatch.setattr(preparation, "_CHECK_PERIOD", 1e-3)
    reports = []
    prepare_meshes(rings.models, lambda *report: reports.append(report))
    assert reports[0] == (0, 4)
    assert reports == sorted(reports)


def test_an_interrupt_ends_the_work(rings, monkeypatch, tmp_path):
    monkeypatch.setattr(preparation, "REPORT_DELAY", 0.0)
    monkeypatch.setattr(preparation, "_CHECK_PERIOD", 1e-3)

    def interrupt(done, count):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        prepare_meshes(rings.models, interrupt)
    assert not list((tmp_path / "cache").rglob("*.*"))


def test_a_request_to_end_ends_the_work(rings, monkeypatch):
    monkeypatch.setattr(preparation, "_CHECK_PERIOD", 1e-3)
    asked = iter([False, True])
    with pytest.raises(SimulationError, match="cancelled"):
        prepare_meshes(rings.models, is_cancelled=lambda: next(asked))


def test_a_mesh_that_is_still_read_is_abandoned(rings, monkeypatch):
    monkeypatch.setattr(preparation, "_CHECK_PERIOD", 1e-3)
    reading, release = threading.Event(), threading.Event()

    def read(shape):
        reading.set()
        release.wait()
        raise DescriptionError("read too late")

    monkeypatch.setattr(preparation, "triangles_of", read)
    with pytest.raises(SimulationError, match="cancelled"):
        prepare_meshes(rings.models, is_cancelled=reading.is_set)
    assert not release.is_set()
    workers = [thread for thread in threading.enumerate() if thread.name.startswith("meshes_")]
    assert workers
    assert all(thread.daemon for thread in workers)  # the end of the process does not wait for them
    release.set()
    for thread in workers:
        thread.join()


@pytest.mark.slow
def test_spawning_reports_progress_and_takes_what_is_prepared(rings, monkeypatch):
    monkeypatch.setattr(preparation, "REPORT_DELAY", 0.0)
    monkeypatch.setattr(preparation, "_CHECK_PERIOD", 1e-3)
    reports = []
    simulation = Simulation(progress=lambda *report: reports.append(report))
    ring, other = rings.models[:2]
    simulation.spawn(ring)
    assert reports[0] == (0, 1)
    prepared = prepare_meshes([other])
    monkeypatch.setattr("daidalos.simulation.conversion.assets.convex_parts", None)
    simulation.spawn(other, meshes=prepared)
    assert simulation.models == ("m0", "m1")
