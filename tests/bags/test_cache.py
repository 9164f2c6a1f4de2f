import statistics
import threading
import time

import pytest

from daidalos.bags.cache import SnapshotBuffer, WriterThread
from daidalos.bags.errors import BagError
from daidalos.bags.metadata import read_metadata
from daidalos.bags.writer import BagWriter

from .records import NUMBER, TEXT, messages, read_independently, received


def bag(folder):
    writer = BagWriter(folder)
    for topic in (TEXT, NUMBER):
        writer.add_topic(topic)
    return writer


def fail(error):
    raise AssertionError(error)


@pytest.mark.slow
def test_everything_arrives_in_order(tmp_path):
    writer = bag(tmp_path / "bag")
    thread = WriterThread(writer, 0, fail)
    for message in messages(5000):
        thread.write(message)
    thread.close()
    writer.close()
    assert thread.lost.total() == 0
    assert read_independently(tmp_path / "bag") == received(messages(5000))


@pytest.mark.timing
def test_a_message_is_in_the_file_within_a_tenth_of_a_second(tmp_path):
    writer = bag(tmp_path / "bag")
    thread = WriterThread(writer, 0, fail)
    waits = []
    for message in messages(5):
        begun, before = time.monotonic(), _bytes_in(tmp_path / "bag")
        thread.write(message)
        while _bytes_in(tmp_path / "bag") == before:
            assert time.monotonic() - begun < 10
            time.sleep(0.002)
        waits.append(time.monotonic() - begun)
    thread.close()
    writer.close()
    assert statistics.median(waits) < 0.1


def _bytes_in(folder):
    return sum(path.stat().st_size for path in folder.iterdir())


def test_work_is_done_after_what_came_before(tmp_path):
    writer = bag(tmp_path / "bag")
    thread = WriterThread(writer, 0, fail)
    for message in messages(10):
        thread.write(message)
    thread.call(writer.split)
    for message in messages(10):
        thread.write(message)
    thread.close()
    writer.close()
    assert [file.message_count for file in read_metadata(tmp_path / "bag").files] == [10, 10]


def test_what_there_is_no_room_for_is_counted(tmp_path):
    writer = bag(tmp_path / "bag")
    thread = WriterThread(writer, 2000, fail)
    hold, held = threading.Event(), threading.Event()
    waiter = threading.Thread(target=lambda: thread.call(lambda: (held.set(), hold.wait())))
    waiter.start()
    held.wait()
    for message in messages(100):
        thread.write(message)
    hold.set()
    waiter.join()
    thread.close()
    writer.close()
    assert 0 < writer.message_count < 100
    assert thread.lost.total() == 100 - writer.message_count
    assert set(thread.lost) == {"/text", "/number"}


def test_a_full_disk_is_told_once(tmp_path, monkeypatch):
    writer = bag(tmp_path / "bag")
    told = []

    def write(message):
        raise BagError(writer.folder, "cannot be written: No space left on device")

    monkeypatch.setattr(writer, "write", write)
    thread = WriterThread(writer, 0, told.append)
    for message in messages(50):
        thread.write(message)
    thread.call(lambda: None)
    for message in messages(50):
        thread.write(message)
    thread.close()
    writer.close()
    assert [str(error) for error in told] == [f"{tmp_path / 'bag'}: cannot be written: No space left on device"]


def test_a_snapshot_holds_the_last_moments(tmp_path):
    writer = bag(tmp_path / "bag")
    buffer = SnapshotBuffer(writer, 20 * 108)
    for message in messages(100):
        buffer.write(message)
    assert buffer.take()
    assert not buffer.take()
    buffer.write(messages(1)[0])
    assert buffer.take()
    buffer.close()
    writer.close()
    assert read_independently(tmp_path / "bag") == received(messages(100)[-20:] + messages(1))
    assert [file.message_count for file in read_metadata(tmp_path / "bag").files] == [20, 1]
