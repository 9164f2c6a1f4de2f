"""Splitting in another process: the same parts, whatever happens to that process."""

import threading

import pytest
import trimesh

from daidalos.description.meshes import TriangleMesh
from daidalos.simulation.conversion import splitting
from daidalos.simulation.conversion.convex import split_pieces
from daidalos.simulation.conversion.decomposition import Cancelled
from daidalos.simulation.conversion.splitting import SplittingProcess


@pytest.fixture
def pieces():
    ring = trimesh.creation.torus(1.0, 0.2, 8, 6)
    return [TriangleMesh(ring.vertices, ring.faces)]


@pytest.fixture
def splitter():
    splitter = SplittingProcess()
    yield splitter
    splitter.close()


def as_lists(parts):
    return [[(part.vertices.tolist(), part.faces.tolist()) for part in piece] for piece in parts]


@pytest.mark.slow
def test_another_process_splits_as_this_one(splitter, pieces, monkeypatch):
    expected = as_lists(split_pieces(pieces, lambda: False))
    monkeypatch.setattr(splitting, "split_pieces", None)  # what is not used here
    assert as_lists(splitter.split(pieces)) == expected
    assert as_lists(splitter.split(pieces * 2)) == expected * 2


@pytest.mark.slow
def test_a_killed_process_is_replaced_by_this_one(splitter, pieces):
    expected = as_lists(splitter.split(pieces))
    splitter._process.kill()
    splitter._process.wait()
    assert as_lists(splitter.split(pieces)) == expected


def test_a_program_that_cannot_start_is_replaced_by_this_one(splitter, pieces, monkeypatch):
    monkeypatch.setattr(splitting.sys, "executable", "/no/such/python")
    assert as_lists(splitter.split(pieces)) == as_lists(split_pieces(pieces, lambda: False))


@pytest.mark.slow
def test_closing_ends_the_process_and_the_wait_for_it(splitter, pieces):
    splitter.split(pieces)
    ended = threading.Event()

    def split():
        with pytest.raises(Cancelled):
            splitter.split(pieces * 10_000)
        ended.set()

    thread = threading.Thread(target=split)
    thread.start()
    splitter.close()
    assert ended.wait(60.0)
    thread.join()
    assert splitter._process.returncode is not None
