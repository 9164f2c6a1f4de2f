"""Commands that open the studio: what they print, and that they end."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import aiohttp
import pytest

import daidalos
from nodes.terminal import Terminal, until_node, until_shown

pytestmark = pytest.mark.slow

RVIZ = str(Path(daidalos.__file__).parent / "share/turtle_tf2_py/rviz/turtle_rviz.rviz")


@pytest.mark.parametrize(
    ("words", "query", "node"),
    [
        (("rqt_graph", "rqt_graph"), "?panel=graph", "/rqt_gui_py_node_\\d+"),
        (("rqt_console", "rqt_console"), "?panel=log", "/rqt_gui_py_node_\\d+"),
        (("rqt_controller_manager", "rqt_controller_manager"), "?panel=controllers", "/rqt_gui_py_node_\\d+"),
        (("rqt_plot", "rqt_plot"), "?panel=plot", "/rqt_gui_py_node_\\d+"),
        (("rqt_image_view", "rqt_image_view"), "?panel=image", "/rqt_gui_py_node_\\d+"),
        (("rqt_reconfigure", "rqt_reconfigure"), "?panel=parameters", "/rqt_gui_py_node_\\d+"),
        (("rqt_topic", "rqt_topic"), "?panel=topics", "/rqt_gui_py_node_\\d+"),
        (("rqt_publisher", "rqt_publisher"), "?panel=publish", "/rqt_gui_py_node_\\d+"),
        (("rqt_service_caller", "rqt_service_caller"), "?panel=service", "/rqt_gui_py_node_\\d+"),
        (("rqt_gui", "rqt_gui"), "?panel=plugins", "/rqt_gui_py_node_\\d+"),
        (("rqt", "rqt", "-s", "rqt_graph.ros_graph.RosGraph"), "?panel=graph", "/rqt_gui_py_node_\\d+"),
        (("rviz2", "rviz2", "-f", "world"), "?panel=scene&fixed_frame=world", "/rviz"),
        (("rviz2", "rviz2", "-d", RVIZ), "?panel=scene&layout=turtle_rviz.rviz", "/rviz"),
        (("plotjuggler", "plotjuggler", "-n"), "?panel=plot", "/plotjuggler"),
    ],
)
def test_command(words: tuple[str, ...], query: str, node: str, domain: int) -> None:
    with Terminal("run", *words, domain=domain) as program:
        address = program.wait_for("^window: http://localhost:")[0].split()[1]
        assert address.partition("/?")[2] == query.removeprefix("?")
        shown = until_node("^/", domain=domain)
        assert re.fullmatch(node, shown)
        assert program.interrupt() == 0
        assert "rror" not in program.text


async def _status(address: str) -> int:
    async with aiohttp.ClientSession() as session, session.get(address) as response:
        return response.status


def test_the_page_is_served_at_the_address(domain: int) -> None:
    import asyncio

    with Terminal("run", "rqt_graph", "rqt_graph", "--port", "0", domain=domain) as program:
        address = program.wait_for("^window: ")[0].split()[1]
        assert asyncio.run(_status(address)) == 200
        assert program.terminate() == 0


def test_a_browser_is_opened_where_there_is_one(domain: int, tmp_path: Path) -> None:
    opened, browser = tmp_path / "opened", tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$1" > {opened}.part && mv {opened}.part {opened}\n')
    browser.chmod(0o755)
    environment = os.environ | {"ROS_DOMAIN_ID": str(domain), "BROWSER": f"{browser} %s"}
    command = [sys.executable, "-m", "daidalos.cli.ros2", "run", "rqt_console", "rqt_console"]
    with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True) as program:
        try:
            address = next(line for line in program.stderr if line.startswith("window: ")).split()[1]
            with Terminal("topic", "list", domain=domain) as other:  # time for the browser
                assert other.wait(30) == 0
            assert opened.read_text().strip() == address
        finally:
            program.terminate()


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("rviz2", "rviz2", "-d", "missing.rviz"), "there is no file 'missing.rviz'"),
        (("rviz2", "rviz2", "-d", __file__), "test_studio_commands.py:1: not YAML"),
        (("plotjuggler", "plotjuggler", "-l", RVIZ), "turtle_rviz.rviz:1: not well-formed XML"),
        (
            ("rqt", "rqt", "-s", "rqt_coffee"),
            "there is no plugin 'rqt_coffee'; there are: rqt_console, rqt_controller_manager, rqt_graph",
        ),
    ],
)
def test_mistakes_are_named(words: tuple[str, ...], error: str, domain: int) -> None:
    with Terminal("run", *words, domain=domain) as program:
        assert program.wait(30) == 2
        assert error in program.text


def test_a_window_leaves_no_traces_in_the_graph(domain: int) -> None:
    with Terminal("run", "turtlesim", "turtlesim_node", domain=domain) as simulator:
        simulator.wait_for("^window: ")
        assert until_node("^/turtlesim", domain=domain) == "/turtlesim"
        assert until_shown("/turtle1/pose", "topic", "list", domain=domain).splitlines() == [
            "/parameter_events",
            "/rosout",
            "/turtle1/cmd_vel",
            "/turtle1/color_sensor",
            "/turtle1/pose",
        ]
        assert simulator.interrupt() == 0
