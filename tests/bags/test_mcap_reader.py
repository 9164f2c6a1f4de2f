import random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import CompressionType, Writer

from daidalos.bags.errors import BagError
from daidalos.bags.mcap_reader import McapReader
from daidalos.bags.message import BagMessage
from daidalos.bags.reader import FOREVER_NS
from daidalos.bags.storage import StorageOptions
from daidalos.bags.writer import WriterOptions
from properties import examples

from .records import messages, write

CONTENT = messages(200)
ALL = ("/text", "/number")


@pytest.fixture(scope="module", params=["none", "fastwrite", "zstd_fast"])
def file(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("mcap")
    config = folder / "settings.yaml"
    config.write_text("chunkSize: 1000\n")
    write(folder / "bag", CONTENT, WriterOptions(storage=StorageOptions(request.param, config)))
    return folder / "bag" / "bag_0.mcap"


def read(path):
    reader = McapReader(path)
    try:
        return list(reader.messages(ALL, 0, FOREVER_NS)), reader
    finally:
        reader.close()


def test_a_file_that_was_cut_off_is_read_up_to_its_last_whole_chunk(file, tmp_path):
    whole = file.read_bytes()
    data_end = len(whole) - 100
    found = set()
    for cut in {8, 9, 40, data_end, *random.Random(3).sample(range(10, data_end), 60)}:
        path = tmp_path / "cut.mcap"
        path.write_bytes(whole[:cut])
        content, reader = read(path)
        assert content == CONTENT[: len(content)]
        assert reader.message_count == len(content)
        found.add(len(content))
        assert reader.damage or len(content) == len(CONTENT)
    assert len(found) > 5


@examples(150)
@given(st.data())
def test_damage_is_told_and_never_breaks_the_reader(file, tmp_path_factory, data):
    whole = bytearray(file.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.mktemp("damaged") / "file.mcap"
    path.write_bytes(whole)
    fault, content = "", []
    try:
        content, _ = read(path)
    except BagError as error:
        fault = str(error)
    assert "\n" not in fault
    assert str(path) in fault or len(content) <= len(CONTENT)


def test_a_damaged_chunk_is_named(tmp_path):
    folder = write(tmp_path / "bag", CONTENT)
    path = folder / "bag_0.mcap"
    whole = bytearray(path.read_bytes())
    whole[2000] ^= 255
    path.write_bytes(whole)
    reader = McapReader(path)
    with pytest.raises(BagError, match=r"bag_0.mcap: the chunk at byte \d+ is damaged: its checksum is wrong"):
        list(reader.messages(ALL, 0, FOREVER_NS))
    reader.close()


@pytest.mark.parametrize("compression", list(CompressionType))
@pytest.mark.parametrize("chunking", [True, False])
def test_files_of_the_reference_implementation_in_any_order(tmp_path, compression, chunking):
    rng = random.Random(5)
    times = [rng.randrange(10**6) for _ in range(500)]
    with (tmp_path / "a.mcap").open("wb") as file:
        writer = Writer(file, chunk_size=600, compression=compression, use_chunking=chunking)
        writer.start("ros2")
        schema = writer.register_schema("std_msgs/String", "ros2msg", b"string data")
        channel = writer.register_channel("/text", "cdr", schema)
        writer.add_attachment(1, 1, "photo", "image/png", bytes(100))
        for time in times:
            writer.add_message(channel, time, b"%d" % time, time)
        writer.finish()
    content, reader = read(tmp_path / "a.mcap")
    assert [message.received_ns for message in content] == sorted(times)
    assert content[0] == BagMessage("/text", b"%d" % min(times), min(times), min(times))
    assert reader.topics["/text"].topic.type == "std_msgs/msg/String"
    assert reader.damage == ""
    with pytest.raises(BagError, match="No such file"):
        McapReader(tmp_path / "b.mcap")


def test_topics_that_are_not_wanted_are_not_even_unpacked(tmp_path, monkeypatch):
    rare = [BagMessage("/number", b"x", 1, 1)]
    many = [BagMessage("/text", bytes(1000), k, k) for k in range(2, 3000)]
    folder = write(tmp_path / "bag", rare + many)
    reader = McapReader(folder / "bag_0.mcap")
    unpacked = []
    content = reader._content
    monkeypatch.setattr(reader, "_content", lambda chunk: unpacked.append(chunk) or content(chunk))
    assert len(list(reader.messages({"/number"}, 0, FOREVER_NS))) == 1
    assert len(unpacked) == 1
    reader.close()
