import shutil
import sqlite3

import pytest
from mcap.reader import make_reader

from daidalos.bags.compression import Compression
from daidalos.bags.describe import describe, reindex
from daidalos.bags.errors import BagError
from daidalos.bags.metadata import format_metadata, read_metadata
from daidalos.bags.reader import BagReader
from daidalos.bags.writer import BagWriter, WriterOptions

from .records import NUMBER, SECOND, TEXT, messages, read_independently, received, write


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
@pytest.mark.parametrize("compression", [Compression(), Compression("FILE", "zstd"), Compression("MESSAGE", "zstd")])
def test_the_description_can_be_made_anew(tmp_path, storage, compression):
    options = WriterOptions(storage, max_duration_ns=SECOND, compression=compression, custom_data={"a": "b"})
    folder = write(tmp_path / "bag", messages(1100), options)
    before = (folder / "metadata.yaml").read_text()
    (folder / "metadata.yaml").unlink()
    _, faults = reindex(folder)
    assert (folder / "metadata.yaml").read_text() == before
    assert faults == []
    assert len(read_metadata(folder).files) == 11  # bag_10 comes after bag_9


def cut_off(folder, storage):
    """Write a bag as a process does that is killed: what was flushed is there."""
    living = folder.with_name("living")
    writer = BagWriter(living, WriterOptions(storage))
    for topic in (TEXT, NUMBER):
        writer.add_topic(topic)
    for message in messages(100):
        writer.write(message)
    writer.flush()
    shutil.copytree(living, folder)
    writer.close()


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_recording_that_was_cut_off_is_completed(tmp_path, storage):
    folder = tmp_path / "bag"
    cut_off(folder, storage)
    with BagReader(folder) as bag:
        assert received(bag.messages()) == received(messages(100))
        assert "there is no metadata.yaml" in bag.notes[0]
    reindex(folder)
    assert len(list(folder.iterdir())) == 2
    with BagReader(folder) as bag:
        assert bag.notes == []
        assert received(bag.messages()) == received(messages(100))
        assert bag.metadata.ros_distro == "jazzy"
        assert bag.topics_with_definitions()["/text"] == TEXT
    assert read_independently(folder) == received(messages(100))
    if storage == "mcap":
        with (folder / "living_0.mcap").open("rb") as file:
            assert make_reader(file).get_summary().statistics.message_count == 100


def test_a_broken_file_among_good_ones_is_told(tmp_path):
    folder = write(tmp_path / "bag", messages(300), WriterOptions(max_duration_ns=SECOND))
    (folder / "metadata.yaml").unlink()
    (folder / "bag_1.mcap").write_bytes(b"")
    metadata, faults = describe(folder)
    assert [file.path for file in metadata.files] == ["bag_0.mcap", "bag_2.mcap"]
    assert faults == [f"{folder / 'bag_1.mcap'}: the file is empty, expected an MCAP file"]


def test_what_can_not_be_described(tmp_path):
    folder = write(tmp_path / "bag", messages(300), WriterOptions(max_duration_ns=SECOND))
    other = write(tmp_path / "other", messages(3), WriterOptions("sqlite3"))
    (other / "other_0.db3").rename(folder / "bag_9.db3")
    with pytest.raises(BagError, match="files of several storages: mcap, sqlite3; choose one"):
        describe(folder)
    metadata, _ = describe(folder, "sqlite3")
    assert metadata.message_count == 3
    for path in folder.glob("bag_*"):
        path.write_bytes(b"\x89MCAP0\r\n"[: 3 if path.name == "bag_0.mcap" else 0])
    with pytest.raises(BagError):
        describe(folder, "mcap")


def test_a_folder_that_can_not_be_written_keeps_its_bag(tmp_path):
    folder = tmp_path / "bag"
    cut_off(folder, "sqlite3")
    database = sqlite3.connect(folder / "living_0.db3")
    count = database.execute("SELECT count(*) FROM messages").fetchone()
    database.close()
    assert count == (100,)
    assert "message_count: 100" in format_metadata(describe(folder)[0])
