"""Nodes in C++: messages received, round trips, memory of a talker, and how long builds take."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SECONDS = 5.0
ROUND_TRIPS = 3000
TALKER = """
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/string.hpp"
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("talker");
  auto publisher = node->create_publisher<std_msgs::msg::String>("chatter", 10);
  auto timer = node->create_wall_timer(std::chrono::milliseconds(100), [&] {
    std_msgs::msg::String message;
    message.data = "hello";
    publisher->publish(message);
  });
  rclcpp::spin(node);
}
"""
FLOOD = """
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/string.hpp"
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("flood");
  auto publisher = node->create_publisher<std_msgs::msg::String>("stream", rclcpp::QoS(1000));
  std_msgs::msg::String message;
  message.data = std::string(64, 'x');
  while (rclcpp::ok() && publisher->get_subscription_count() == 0) {rclcpp::sleep_for(std::chrono::milliseconds(10));}
  while (rclcpp::ok()) {publisher->publish(message);}
}
"""
SINK = """
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/string.hpp"
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("sink");
  std::uint64_t count = 0;
  auto begin = std::chrono::steady_clock::now();
  auto subscription = node->create_subscription<std_msgs::msg::String>("stream", rclcpp::QoS(1000),
    [&](const std_msgs::msg::String &) {
      if (count++ == 0) {begin = std::chrono::steady_clock::now();}
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
      if (passed.count() > SECONDS) {
        std::cout << "rate " << (count - 1) / passed.count() << std::endl;
        rclcpp::shutdown();
      }
    });
  rclcpp::spin(node);
}
""".replace("SECONDS", str(SECONDS))
ECHO = """
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/string.hpp"
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("echo");
  auto publisher = node->create_publisher<std_msgs::msg::String>("back", 10);
  auto subscription = node->create_subscription<std_msgs::msg::String>("there", 10,
    [&](const std_msgs::msg::String & message) {publisher->publish(message);});
  rclcpp::spin(node);
}
"""
PING = """
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/string.hpp"
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("ping");
  auto publisher = node->create_publisher<std_msgs::msg::String>("there", 10);
  std_msgs::msg::String message;
  message.data = std::string(64, 'x');
  std::vector<double> times;
  auto begin = std::chrono::steady_clock::now();
  auto subscription = node->create_subscription<std_msgs::msg::String>("back", 10,
    [&](const std_msgs::msg::String &) {
      const auto now = std::chrono::steady_clock::now();
      times.push_back(std::chrono::duration<double, std::micro>(now - begin).count());
      if (times.size() == COUNT) {
        std::sort(times.begin(), times.end());
        std::cout << "median " << times[times.size() / 2] << std::endl;
        rclcpp::shutdown();
        return;
      }
      begin = std::chrono::steady_clock::now();
      publisher->publish(message);
    });
  while (publisher->get_subscription_count() == 0 || subscription->get_publisher_count() == 0) {
    rclcpp::sleep_for(std::chrono::milliseconds(10));
  }
  rclcpp::sleep_for(std::chrono::milliseconds(500));
  begin = std::chrono::steady_clock::now();
  publisher->publish(message);
  rclcpp::spin(node);
}
""".replace("COUNT", str(ROUND_TRIPS))
PROGRAMS = {"talker": TALKER, "flood": FLOOD, "sink": SINK, "echo": ECHO, "ping": PING}


def run() -> dict[str, float]:
    """Measure everything."""
    with tempfile.TemporaryDirectory(prefix="dd") as text:
        folder = Path(text)
        os.environ |= {"XDG_RUNTIME_DIR": text, "ROS_DOMAIN_ID": str(60 + os.getpid() % 30)}
        os.environ["DAIDALOS_CACHE"] = str(folder / "cache")
        write_package(folder / "talkers", {"talker": TALKER})
        first = build(folder)
        (folder / "talkers/src/talker.cpp").write_text(TALKER + "\n// changed\n")
        figures = {"cpp.first_build_of_a_talker_s": first, "cpp.next_build_of_a_talker_s": build(folder)}
        write_package(folder / "talkers", PROGRAMS)
        build(folder)
        figures["cpp.talker_mb"] = talker_memory(folder)
        with running(folder, "flood"):
            figures["cpp.string_64_b_received_per_s"] = spoken(folder, "sink", "rate")
        with running(folder, "echo"):
            figures["cpp.round_trip_64_b_us"] = spoken(folder, "ping", "median")
    return figures


def write_package(folder: Path, programs: dict[str, str]) -> None:
    (folder / "src").mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(
        '<package format="3"><name>talkers</name><version>0.0.0</version><description>C++</description>'
        '<maintainer email="a@b.org">a</maintainer><license>Apache-2.0</license><depend>rclcpp</depend>'
        "<depend>std_msgs</depend><export><build_type>ament_cmake</build_type></export></package>"
    )
    lines = ["cmake_minimum_required(VERSION 3.8)", "project(talkers)"]
    lines += [f"find_package({name} REQUIRED)" for name in ("ament_cmake", "rclcpp", "std_msgs")]
    for name, text in programs.items():
        (folder / "src" / f"{name}.cpp").write_text(text)
        lines += [f"add_executable({name} src/{name}.cpp)", f"ament_target_dependencies({name} rclcpp std_msgs)"]
    lines += [f"install(TARGETS {' '.join(programs)} DESTINATION lib/talkers)", "ament_package()"]
    (folder / "CMakeLists.txt").write_text("\n".join(lines) + "\n")


def build(folder: Path) -> float:
    """Return how long ``colcon build`` takes [s]."""
    begin = time.monotonic()
    command = [str(Path(sys.executable).parent / "colcon"), "build"]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def program(folder: Path, name: str) -> str:
    return str(folder / "install/talkers/lib/talkers" / name)


@contextmanager
def running(folder: Path, name: str) -> Iterator[subprocess.Popen[bytes]]:
    process = subprocess.Popen([program(folder, name)], stderr=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()


def spoken(folder: Path, name: str, word: str) -> float:
    """Return the number that a program prints after a word."""
    done = subprocess.run([program(folder, name)], capture_output=True, text=True, check=True, timeout=120)
    found = re.search(rf"{word} ([\d.e+]+)", done.stdout)
    assert found, done.stdout + done.stderr
    return float(found[1])


def talker_memory(folder: Path) -> float:
    """Return the resident memory of a talker after three seconds [MB]."""
    with running(folder, "talker") as process:
        time.sleep(3.0)
        status = Path(f"/proc/{process.pid}/status").read_text()
    found = re.search(r"VmRSS:\s+(\d+) kB", status)
    assert found
    return int(found[1]) / 1000
