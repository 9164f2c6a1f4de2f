from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin

from daidalos.common import pose2
from daidalos.mapping.errors import LogError
from daidalos.mapping.log import read_log

from .bags import MOUNT, write_bag


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
@pytest.mark.parametrize("single_file", [False, True])
def test_bags_are_read_whole(tmp_path: Path, storage: StoragePlugin, single_file: bool) -> None:
    true = write_bag(tmp_path / "bag", storage=storage)
    path = next((tmp_path / "bag").glob("*.mcap" if storage is StoragePlugin.MCAP else "*.db3"))
    log = read_log(path if single_file else tmp_path / "bag")
    assert len(log.scans) == len(log.stamps_ns) == len(log.odometry) == len(true)
    assert log.stamps_ns[:3].tolist() == [1_000_000_000, 1_200_000_000, 1_400_000_000]
    assert log.scans[0].sensor_pose == pytest.approx(MOUNT)
    assert log.scans[0].ranges.dtype == np.float32
    assert log.odometry[0] == pytest.approx(true[0])
    assert (log.scan_topic, log.odometry_source) == ("/scan", "/odom")


def test_odometry_may_come_from_transforms(tmp_path: Path) -> None:
    write_bag(tmp_path / "messages")
    write_bag(tmp_path / "transforms", odometry=False, moving_transforms=True)
    messages, transforms = read_log(tmp_path / "messages"), read_log(tmp_path / "transforms")
    assert transforms.odometry_source == "/tf odom -> base_link"
    assert pose2.between(messages.odometry, transforms.odometry) == pytest.approx(
        np.zeros_like(messages.odometry), abs=1e-9
    )


def test_without_transforms_the_scanner_sits_at_the_base(tmp_path: Path) -> None:
    write_bag(tmp_path / "bag", mounted=False)
    assert read_log(tmp_path / "bag").scans[0].sensor_pose == (0.0, 0.0, 0.0)


def test_a_topic_can_be_named(tmp_path: Path) -> None:
    write_bag(tmp_path / "bag", scan_topics=("/front", "/back"))
    assert read_log(tmp_path / "bag", scan_topic="/back", odom_topic="/odom").scan_topic == "/back"
    with pytest.raises(LogError, match="several topics of type sensor_msgs/msg/LaserScan, name one: /back, /front"):
        read_log(tmp_path / "bag")
    with pytest.raises(LogError, match="no topic /side of type sensor_msgs/msg/LaserScan: the bag has /back"):
        read_log(tmp_path / "bag", scan_topic="/side")
    with pytest.raises(LogError, match="no topic /front of type nav_msgs/msg/Odometry: it is sensor_msgs"):
        read_log(tmp_path / "bag", scan_topic="/back", odom_topic="/front")


def test_what_is_missing_is_named(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"gone: no such file or folder"):
        read_log(tmp_path / "gone")
    write_bag(tmp_path / "scanless", scan_topics=())
    with pytest.raises(LogError, match=r"scanless: no scans: expected a topic of type .*, found /odom \(nav_msgs"):
        read_log(tmp_path / "scanless")
    write_bag(tmp_path / "lost", odometry=False)
    with pytest.raises(LogError, match=r"lost: no odometry: expected a topic of type nav_msgs/msg/Odometry or"):
        read_log(tmp_path / "lost")


def test_damaged_bags_are_named(tmp_path: Path) -> None:
    write_bag(tmp_path / "bag")
    content = next((tmp_path / "bag").glob("*.mcap")).read_bytes()
    rng = np.random.default_rng(0)
    for k, damaged in enumerate(
        [b"", b"not a bag", content[:1000], content[: len(content) // 2], bytes(rng.bytes(5000))]
    ):
        path = tmp_path / f"damaged{k}.mcap"
        path.write_bytes(damaged)
        with pytest.raises(LogError, match=rf"damaged{k}\.mcap: not a readable bag: ") as caught:
            read_log(path)
        assert "\n" not in str(caught.value)
    (tmp_path / "folder").mkdir()
    with pytest.raises(LogError, match="folder: not a readable bag"):
        read_log(tmp_path / "folder")
    (tmp_path / "folder" / "metadata.yaml").write_text("rosbag2_bagfile_information: {version: 9}")
    with pytest.raises(LogError, match="folder: not a readable bag"):
        read_log(tmp_path / "folder")
