import pytest

from daidalos.bags.compression import Compression
from daidalos.bags.metadata import read_metadata
from daidalos.bags.reader import BagReader
from daidalos.cli.ros2.program import run

from .conftest import SECOND, write_bag


@pytest.fixture
def bag(capsys, tmp_path, monkeypatch):
    """Run ``ros2 bag`` here; returns its exit status, output and errors."""
    monkeypatch.chdir(tmp_path)

    def call(*words):
        try:
            status = run(["bag", *words])
        except SystemExit as ended:
            status = ended.code
        said = capsys.readouterr()
        assert "Traceback" not in said.err
        return status, said.out, said.err

    return call


def test_information(bag, tmp_path):
    write_bag(tmp_path / "a", 250, max_duration_ns=SECOND, compression=Compression("FILE", "zstd"))
    status, out, err = bag("info", "a")
    assert (status, err) == (0, "")
    assert out.startswith("\nFiles:             a_0.mcap.zstd\n                   a_1.mcap.zstd\n")
    assert "\nDuration:          2.490000000s\n" in out
    assert out.endswith("Service:           0\nService information: \n")
    _, out, _ = bag("info", "a/a_1.mcap.zstd", "-v")
    assert "Count: 101 | Size Contribution: 1.2 KiB | Serialization Format: cdr" in out
    _, out, err = bag("info", "-t", "-v", "a")
    assert "The '-t' parameter will be ignored" in err
    assert "Size Contribution" in out


def test_information_about_what_others_wrote(bag, shared_data):
    status, out, _ = bag("info", str(shared_data / "slam" / "intel"), "--sort", "count")
    assert status == 0
    assert "ROS Distro:        rosbags\nDuration:          2650.863199949s\n" in out
    assert "Messages:          2731\n" in out
    assert out.index("/odom |") < out.index("/scan |") < out.index("/tf |") < out.index("/tf_static |")


def test_conversion(bag, tmp_path):
    write_bag(tmp_path / "a", 10)
    write_bag(tmp_path / "b", 10, storage="sqlite3", period_ns=7_000_000)
    (tmp_path / "out.yaml").write_text("output_bags:\n- {uri: joined, storage_id: sqlite3, all: true}\n")
    assert bag("convert", "-i", "a", "-i", "b", "sqlite3", "-o", "out.yaml") == (0, "", "")
    with BagReader(tmp_path / "joined") as joined:
        times = [message.received_ns for message in joined.messages()]
    assert times == sorted([SECOND + k * 10_000_000 for k in range(10)] + [SECOND + k * 7_000_000 for k in range(10)])
    status, _, err = bag("convert", "-i", "a", "-o", "out.yaml")
    assert status == 1
    assert err == "[ERROR] [ros2bag]: joined: already exists; a bag is not written over another\n"


def test_reindexing(bag, tmp_path):
    folder = write_bag(tmp_path / "a", 10)
    before = read_metadata(folder)
    (folder / "metadata.yaml").unlink()
    status, out, err = bag("reindex", "a")
    assert (status, out) == (0, "")
    assert "[rosbag2_cpp]: Beginning reindexing bag in directory: a\n" in err
    assert read_metadata(folder) == before


def test_lists(bag):
    assert bag("list", "storage") == (0, "mcap\nsqlite3\n", "")
    assert bag("list", "compression")[1] == bag("list", "decompression")[1] == "zstd\n"
    status, out, _ = bag("list", "converter", "--verbose")
    assert status == 0
    assert out.startswith("available converter plugins are:\nname: cdr_converter\n\t")


@pytest.mark.parametrize(
    ("words", "status", "fault"),
    [
        ("info nowhere", 2, "argument bag_path: Bag path 'nowhere' does not exist!"),
        ("play nowhere", 2, "argument bag_path: Bag path 'nowhere' does not exist!"),
        ("info empty.mcap", 1, "[ERROR] [ros2bag]: empty.mcap: the file is empty, expected a bag (MCAP or sqlite3)"),
        ("play empty.mcap", 1, "[ERROR] [ros2bag]: empty.mcap: the file is empty, expected a bag (MCAP or sqlite3)"),
        ("info text.db3", 1, "[ERROR] [ros2bag]: text.db3: not a bag: it begins with 68 65 6c 6c 6f"),
        ("info folder", 1, "[ERROR] [ros2bag]: folder: not a bag: it holds no file that ends in .mcap or .db3"),
        ("info broken", 1, "[ERROR] [ros2bag]: broken/metadata.yaml: not valid YAML: line 2, column 1"),
        (
            "info old.bag",
            1,
            "[ERROR] [ros2bag]: old.bag: is a bag of ROS 1; convert it with 'rosbags-convert --src old.bag",
        ),
        ("play", 1, "[ERROR] [ros2bag]: Expected a bag to play: bag_path or --input"),
        ("play a -i a", 1, "[ERROR] [ros2bag]: Only one of bag_path (with --storage) and --input may be given."),
        ("play -i a -i nowhere mcap", 1, "[ERROR] [ros2bag]: Bag path 'nowhere' does not exist!"),
        ("play -i a leveldb", 1, "Unknown storage ID 'leveldb', options are: mcap, sqlite3"),
        ("burst folder", 1, "[ERROR] [ros2bag]: folder: not a bag"),
        ("reindex folder", 1, "[ERROR] [ros2bag]: folder: not a bag"),
        ("reindex empty.mcap", 1, "[ERROR] [ros2bag]: Must specify a bag directory"),
        ("play a --rate 0", 2, "argument -r/--rate: 0 is not in the valid range (> 0.0)"),
        ("play a --rate fast", 2, "argument -r/--rate: fast is not the valid type (float)"),
        ("play a --clock -3", 2, "argument --clock: -3 is not in the valid range (> 0.0)"),
        ("play a --regex (", 1, "[ERROR] [ros2bag]: invalid regular expression '(': missing ), unterminated"),
        ("play a -m chatter", 1, "[ERROR] [ros2bag]: --remap: 'chatter' is not a remapping rule"),
        ("play a --playback-until-sec 1 --playback-until-nsec 1", 2, "not allowed with argument"),
        ("play a --qos-profile-overrides-path none.yaml", 2, "can't open 'none.yaml': there is no such file"),
        ("play a --qos-profile-overrides-path qos.yaml", 1, "Unexpected key `reliabilty` for QoS profile"),
        ("record", 1, "[ERROR] [ros2bag]: Need to specify at least one option out of --all, --all-topics"),
        ("record -a -o a", 1, "[ERROR] [ros2bag]: Output folder 'a' already exists."),
        ("record -a -s leveldb", 2, "invalid choice: 'leveldb'"),
        ("record --regex ( -o x", 1, "[ERROR] [ros2bag]: invalid regular expression '('"),
        ("record --topics /a --exclude-regex b", 1, "--exclude-regex argument requires either --all, --all-topics"),
        ("record --topics /a --exclude-topics b", 1, "--exclude-topics argument requires either --all"),
        ("record --topics /a --exclude-topic-types b", 1, "--exclude-topic-types argument requires either --all"),
        ("record --topics /a --exclude-services b", 1, "--exclude-services argument requires either --all"),
        ("record -a --use-sim-time --no-discovery", 1, "are incompatible settings"),
        ("record -a --compression-format zstd", 1, "Cannot specify compression format without a compression mode."),
        ("record -a --compression-mode file", 1, "Cannot specify compression mode without a compression format."),
        ("record -a --custom-data a", 1, "--custom-data: 'a' is not a pair; expected such as key=value"),
        ("record -a --snapshot-mode --max-cache-size 0", 1, "In snapshot mode, the max_cache_size"),
        ("record -a -b -1", 2, "Value -1 is less than zero."),
        ("convert -i a -o none.yaml", 2, "can't open 'none.yaml': there is no such file"),
        ("convert -i a mcap x -o qos.yaml", 1, "--input expects 1 or 2 arguments, 3 provided"),
        ("convert -i a leveldb -o qos.yaml", 1, "Unknown storage ID 'leveldb', options are: mcap, sqlite3"),
        ("convert -i a -o qos.yaml", 1, "qos.yaml: expected a list 'output_bags'"),
        ("list plugins", 2, "invalid choice: 'plugins'"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(bag, tmp_path, words, status, fault):
    write_bag(tmp_path / "a", 1)
    (tmp_path / "empty.mcap").touch()
    (tmp_path / "text.db3").write_text("hello, this is no bag")
    (tmp_path / "old.bag").write_text("#ROSBAG V2.0")
    (tmp_path / "folder").mkdir()
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "metadata.yaml").write_text("a: [\n")
    (tmp_path / "qos.yaml").write_text("/chatter:\n  reliabilty: best_effort\n")
    before = sorted(path.name for path in tmp_path.iterdir())
    ended, _, err = bag(*words.split())
    assert ended == status
    assert fault in err
    assert sorted(path.name for path in tmp_path.iterdir()) == before
