"""The registry of live sessions: who is in it, who has died, where sockets lie."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import pytest

from daidalos.transport.environment import EnvironmentVariableError
from daidalos.transport.registry import Peer, Registry, runtime_folder

PROGRAM = """
import sys
from pathlib import Path
from daidalos.transport.registry import Peer, Registry
registry = Registry(3, Path(sys.argv[1]))
registry.register(Peer("ab" * 16, ("tcp/127.0.0.1:9",)))
registry.socket_of("ab" * 16).touch()
print("ready", flush=True)
sys.stdin.read()
"""


@pytest.fixture
def registry(tmp_path: Path) -> Registry:
    return Registry(3, tmp_path)


def peers(registry: Registry) -> list[Peer]:
    with registry.locked():
        return registry.peers()


def test_a_session_is_seen_by_others_and_not_by_itself(registry, tmp_path):
    peer = Peer("cd" * 16, ("unixsock-stream/a", "tcp/b"))
    registry.register(peer)
    assert peers(registry) == []
    assert peers(Registry(3, tmp_path)) == [peer]
    assert peers(Registry(4, tmp_path)) == []
    assert peers(Registry(3, tmp_path, family="cyclonedds")) == []
    registry.unregister()
    assert peers(Registry(3, tmp_path)) == []
    registry.unregister()


def test_a_process_that_is_killed_leaves_nothing(registry, tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout.readline() == "ready\n"
        assert peers(registry) == [Peer("ab" * 16, ("tcp/127.0.0.1:9",))]
    finally:
        process.kill()
        process.communicate()
    assert peers(registry) == []
    assert [path.name for path in registry.folder.iterdir()] == ["registry.lock"]


def test_an_entry_that_is_half_written_is_passed_over(registry, tmp_path):
    other = Registry(3, tmp_path)
    other.register(Peer("ef" * 16, ()))
    (registry.folder / f"{'ef' * 16}.json").write_text('["tcp/')
    assert peers(registry) == []
    other.unregister()


def test_one_at_a_time(registry, tmp_path):
    entered = threading.Event()

    def enter() -> None:
        with Registry(3, tmp_path).locked():
            entered.set()

    with registry.locked():
        thread = threading.Thread(target=enter)
        thread.start()
        assert not entered.wait(0.1)
    assert entered.wait(5.0)
    thread.join()


def test_the_runtime_folder_is_the_users_own(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    assert runtime_folder() == tmp_path / "daidalos"
    assert runtime_folder().stat().st_mode & 0o077 == 0
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "missing"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    assert runtime_folder().parent == tmp_path


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such permissions")
def test_folders_and_files_are_the_users_alone(tmp_path):
    registry = Registry(3, tmp_path)
    registry.register(Peer("aa", ("unixsock/x",)))
    with registry.locked():
        made = list(tmp_path.rglob("*"))
    assert {path.stat().st_mode & 0o777 for path in made if path.is_dir()} == {0o700}
    assert {path.stat().st_mode & 0o777 for path in made if path.is_file()} == {0o600}
    registry.unregister()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such permissions")
def test_a_runtime_folder_that_others_could_read_or_own_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "daidalos").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(EnvironmentVariableError, match=r"is a link.*XDG_RUNTIME_DIR"):
        runtime_folder()
    (tmp_path / "daidalos").unlink()
    (tmp_path / "daidalos").mkdir(mode=0o755)
    assert runtime_folder().stat().st_mode & 0o777 == 0o700
    monkeypatch.setattr("os.getuid", lambda: 12345)
    with pytest.raises(EnvironmentVariableError, match="belongs to another user"):
        runtime_folder()
