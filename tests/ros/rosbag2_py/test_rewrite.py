import pytest
import rosbag2_py
from rosbag2_py import StorageOptions, bag_rewrite

from .conftest import SECOND, write_chatter


def outputs(tmp_path, text):
    path = tmp_path / "out.yaml"
    path.write_text(text)
    return str(path)


def test_what_a_file_asks_for(tmp_path):
    uri = write_chatter(tmp_path / "bag", 100)
    text = f"""
output_bags:
- uri: {tmp_path}/sqlite
  storage_id: sqlite3
  all: true
- uri: {tmp_path}/small
  storage_preset_profile: zstd_small
  compression_mode: file
  compression_format: zstd
  max_bagfile_duration: 1
  all_topics: true
- uri: {tmp_path}/part
  topics: [/chatter]
  start_time_ns: {SECOND + 10_000_000}
  end_time_ns: {SECOND + 20_000_000}
  custom_data: {{from: there}}
- uri: {tmp_path}/nothing
  topics: [/other]
"""
    seen = []
    assert bag_rewrite([StorageOptions(uri)], outputs(tmp_path, text), lambda *one: seen.append(one)) == []
    assert seen[-1] == (100, 100)
    read = rosbag2_py.MetadataIo().read_metadata
    assert (read(f"{tmp_path}/sqlite").storage_identifier, read(f"{tmp_path}/sqlite").message_count) == ("sqlite3", 100)
    assert read(f"{tmp_path}/small").relative_file_paths == ["small_0.mcap.zstd"]
    assert (read(f"{tmp_path}/part").message_count, read(f"{tmp_path}/part").custom_data) == (2, {"from": "there"})
    assert read(f"{tmp_path}/nothing").topics_with_message_count == []


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "expected a list 'output_bags'"),
        ("output_bags: []", "expected a list 'output_bags'"),
        ("output_bags: [", "not valid YAML: line 1, column 15"),
        ("output_bags: [{storage_id: mcap}]", r"output_bags\[0\]: uri is missing"),
        ("output_bags: [{uri: a, storage: mcap}]", r"output_bags\[0\].storage: unknown; there are: all"),
        ("output_bags: [{uri: a, topics: /b}]", r"output_bags\[0\].topics: expected a list, found '/b'"),
        ("output_bags: [{uri: a, max_bagfile_size: big}]", "expected a whole number, found 'big'"),
        ("output_bags: [{uri: a, all: 1}]", "expected true or false, found 1"),
    ],
)
def test_files_that_are_not_understood(tmp_path, text, fault):
    uri = write_chatter(tmp_path / "bag", 1)
    with pytest.raises(RuntimeError, match=fault) as raised:
        bag_rewrite([StorageOptions(uri)], outputs(tmp_path, text))
    assert "out.yaml" in str(raised.value)


def test_a_file_that_is_missing(tmp_path):
    with pytest.raises(RuntimeError, match=r"out\.yaml: cannot be read"):
        bag_rewrite([], str(tmp_path / "out.yaml"))
