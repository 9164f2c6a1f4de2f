"""Loggers: levels, filters, where messages go."""

import gc
import os
from pathlib import Path

import pytest
import rclpy
import rclpy.logging
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from rclpy.clock import ROSClock
from rclpy.context import Context
from rclpy.impl.log_output import OUTPUT, Output
from rclpy.logging import LoggingSeverity, get_logger
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.time import Time

from ros.rclpy.waiting import executor_of, run_ready

FREE = {"throttle_duration_sec": 1e6}


@pytest.fixture(autouse=True)
def fresh(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    rclpy.logging.clear_config()
    yield
    rclpy.logging.clear_config()


def test_filters_count_the_calls_of_one_place() -> None:
    logger = get_logger("tested")
    assert [logger.info("message", once=True) for _ in range(3)] == [True, False, False]
    assert [logger.info("message", once=False) for _ in range(3)] == [True, True, True]
    assert [logger.info("message", skip_first=True) for _ in range(3)] == [False, True, True]
    assert [logger.info("message", skip_first=True, once=True) for _ in range(4)] == [False, True, False, False]
    assert [logger.info("message", throttle_duration_sec=1e6) for _ in range(3)] == [True, False, False]
    assert [logger.info("message", throttle_duration_sec=1e-9) for _ in range(3)] == [True, True, True]
    assert logger.info("message", once=True), "at another place"


def test_arguments_must_make_sense_and_stay() -> None:
    logger = get_logger("tested")
    with pytest.raises(TypeError, match=r"required parameter .* not specified"):
        logger.info("message", throttle_time_source_type="STEADY")
    with pytest.raises(TypeError, match="not one of the recognized"):
        logger.info("message", colour="red")
    with pytest.raises(ValueError, match="parameters cannot be changed"):
        [logger.info("message", throttle_duration_sec=span) for span in (1, 2)]
    with pytest.raises(ValueError, match="name cannot be changed"):
        [logger.info("message", name=name) for name in ("one", "other")]
    with pytest.raises(ValueError, match="severity cannot be changed"):
        [logger.log("message", severity) for severity in (LoggingSeverity.INFO, LoggingSeverity.WARN)]
    with pytest.raises(ValueError, match="empty"):
        get_logger("")
    with pytest.raises(ValueError, match="empty"):
        logger.get_child("")


def test_levels_are_inherited() -> None:
    parent, child = get_logger("parent"), get_logger("parent").get_child("child")
    assert child.name == "parent.child"
    parent.set_level(LoggingSeverity.ERROR)
    assert child.get_effective_level() == LoggingSeverity.ERROR
    assert not child.warning("too little")
    child.set_level(LoggingSeverity.DEBUG)
    assert child.debug("enough")
    assert rclpy.logging.get_logger_level("parent") == LoggingSeverity.ERROR
    assert rclpy.logging.get_logging_severity_from_string("warn") == LoggingSeverity.WARN


def test_the_console_and_the_file_get_messages(capfd: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    get_logger("tested").warning("look out")
    get_logger("tested").debug("not this")
    rclpy.logging.shutdown()
    (file,) = tmp_path.glob("*.log")
    for text in (capfd.readouterr().err, file.read_text()):
        assert text.count("\n") == 1
        assert "[WARN]" in text
        assert "[tested]: look out" in text


@pytest.mark.parametrize("by_arguments", [True, False])
@pytest.mark.parametrize("by_node", [True, False])
def test_rosout_gets_messages_where_both_want_it(
    monkeypatch: pytest.MonkeyPatch, by_arguments: bool, by_node: bool
) -> None:
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")
    context = Context()
    context.init(["program", "--ros-args", f"--{'enable' if by_arguments else 'disable'}-rosout-logs"])
    with context:
        node = Node("tested", namespace="ns", context=context, enable_rosout=by_node)
        received: list[Log] = []
        node.create_subscription(Log, "/rosout", received.append, 10)
        node.get_logger().get_child("part").error("it hurts")
        run_ready(executor_of(node))
        if not (by_arguments and by_node):
            assert received == []
            return
        (message,) = received
        assert (message.name, message.msg, message.level) == ("ns.tested.part", "it hurts", 40)
        assert message.file == __file__
        assert message.function == "test_rosout_gets_messages_where_both_want_it"


def test_rosout_has_the_qos_asked_for(graph: Context) -> None:
    node = rclpy.create_node("tested", context=graph, rosout_qos_profile=7)
    (topic,) = node.get_publishers_info_by_topic("/rosout")
    assert topic.qos_profile.durability == DurabilityPolicy.VOLATILE
    default = rclpy.create_node("other", context=graph)
    found = {one.node_name: one.qos_profile for one in default.get_publishers_info_by_topic("/rosout")}
    assert found["other"].durability == DurabilityPolicy.TRANSIENT_LOCAL


def test_levels_can_be_set_from_elsewhere(graph: Context) -> None:
    node = Node("tested", enable_logger_service=True)
    executor = executor_of(node)
    setter = node.create_client(SetLoggerLevels, "/tested/set_logger_levels")
    getter = node.create_client(GetLoggerLevels, "/tested/get_logger_levels")
    request = SetLoggerLevels.Request()
    request.levels = [rcl_level("tested", 10), rcl_level("other", 22)]
    future = setter.call_async(request)
    executor.spin_until_future_complete(future, 10)
    results = future.result().results
    assert [(one.successful, one.reason) for one in results] == [
        (True, ""),
        (False, "Failed reason: Invalid logger level."),
    ]
    future = getter.call_async(GetLoggerLevels.Request(names=["tested"]))
    executor.spin_until_future_complete(future, 10)
    assert [(one.name, one.level) for one in future.result().levels] == [("tested", 10)]
    assert OUTPUT.effective_level("tested") == LoggingSeverity.DEBUG
    node.destroy_node()


def rcl_level(name: str, level: int) -> object:
    from rcl_interfaces.msg import LoggerLevel

    return LoggerLevel(name=name, level=level)


@pytest.mark.slow
def test_the_logger_of_a_node_that_is_gone_has_no_children(graph: Context) -> None:
    node = Node("gone")
    logger = node.get_logger()
    logger.get_child("part").debug("still there")
    node.destroy_node()
    del node
    gc.collect()
    with pytest.raises(RuntimeError, match="node is destroyed"):
        logger.get_child("part")


def test_a_clock_at_zero_throttles() -> None:
    clock = ROSClock()
    clock._set_ros_time_is_active(True)
    logger, logged = get_logger("tested"), []
    for seconds in range(5):
        clock.set_ros_time_override(Time(seconds=seconds, clock_type=clock.clock_type))
        logged.append(logger.info("message", throttle_duration_sec=2, throttle_time_source_type=clock))
    assert logged == [False, False, True, False, True]


def test_source_files_are_relative_to_where_they_are_imported_from_if_wanted() -> None:
    output = Output()
    assert output.source_file(rclpy.__file__) == rclpy.__file__
    output.relative_sources = True
    assert output.source_file(rclpy.__file__) == "rclpy/__init__.py"
    assert output.source_file(os.path.abspath("/no folder of imports/program.py")) == "program.py"
