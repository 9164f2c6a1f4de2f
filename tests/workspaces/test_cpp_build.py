"""C++ packages: built by colcon, and their nodes in the graph with Python's."""

import os
import subprocess
from pathlib import Path

import pytest

from cpp_packages import need_compiler, share_library
from daidalos.interfaces.codec import codec_of
from terminals import Terminal, environment

from . import packages

pytestmark = [pytest.mark.slow, pytest.mark.timeout(400)]

NODE = """
#include "own_msgs/msg/reading.hpp"
#include "own_msgs/srv/scale.hpp"
#include "parts/limit.hpp"
#include "rclcpp/rclcpp.hpp"

class Sensor : public rclcpp::Node
{
public:
  Sensor() : Node("sensor")
  {
    rcl_interfaces::msg::ParameterDescriptor range;
    range.floating_point_range.resize(1);
    range.floating_point_range[0].from_value = 0.0;
    range.floating_point_range[0].to_value = 10.0;
    factor_ = declare_parameter("factor", 2.0, range);
    handle_ = add_on_set_parameters_callback([this](const std::vector<rclcpp::Parameter> & all) {
      rcl_interfaces::msg::SetParametersResult result;
      result.successful = all.at(0).get_name() != "factor" || all.at(0).as_double() != 7.0;
      result.reason = result.successful ? "" : "not seven";
      if (result.successful && all.at(0).get_name() == "factor") {factor_ = all.at(0).as_double();}
      return result;
    });
    publisher_ = create_publisher<own_msgs::msg::Reading>("out", rclcpp::QoS(10).transient_local());
    subscription_ = create_subscription<own_msgs::msg::Reading>("in", 10,
      [this](own_msgs::msg::Reading::UniquePtr message, const rclcpp::MessageInfo & info) {
        message->values.push_back(factor_ * limit(message->values.at(0)));
        message->name += info.get_rmw_message_info().source_timestamp > 0 ? " stamped" : " unstamped";
        publisher_->publish(std::move(message));
      });
    service_ = create_service<own_msgs::srv::Scale>("scale",
      [this](own_msgs::srv::Scale::Request::SharedPtr request, own_msgs::srv::Scale::Response::SharedPtr response) {
        response->result = request->value * factor_;
      });
  }
  double factor_;
  OnSetParametersCallbackHandle::SharedPtr handle_;
  rclcpp::Publisher<own_msgs::msg::Reading>::SharedPtr publisher_;
  rclcpp::Subscription<own_msgs::msg::Reading>::SharedPtr subscription_;
  rclcpp::Service<own_msgs::srv::Scale>::SharedPtr service_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<Sensor>();
  RCLCPP_INFO_STREAM(node->get_logger(), "ready with " << node->factor_);
  rclcpp::spin(node);
  rclcpp::shutdown();
}
"""

FRAMES = """
#include "rclcpp_components/register_node_macro.hpp"
#include "tf2_geometry_msgs/tf2_geometry_msgs.hpp"
#include "tf2_ros/buffer.h"
#include "tf2_ros/static_transform_broadcaster.h"
#include "tf2_ros/transform_broadcaster.h"
#include "tf2_ros/transform_listener.h"

namespace frames
{
class Frames : public rclcpp::Node
{
public:
  explicit Frames(const rclcpp::NodeOptions & options)
  : Node("frames", options), buffer_(get_clock()), listener_(buffer_), moving_(this), fixed_(*this)
  {
    fixed_.sendTransform(make("base", "laser", 0.0, 0.2, 0.0));
    timer_ = create_wall_timer(std::chrono::milliseconds(20), [this] {
      moving_.sendTransform(make("odom", "base", 1.0, 2.0, TF2SIMD_PI / 2));
    });
    report_ = create_wall_timer(std::chrono::milliseconds(100), [this] {
      geometry_msgs::msg::PointStamped point;
      point.header.frame_id = "laser";
      point.point.x = 3.0;
      try {
        const auto seen = buffer_.transform(point, "tool", tf2::durationFromSec(5.0));
        RCLCPP_INFO(get_logger(), "seen at %.3f %.3f", seen.point.x, seen.point.y);
        buffer_.lookupTransform("tool", "nowhere", tf2::TimePointZero);
      } catch (const tf2::LookupException & error) {
        RCLCPP_INFO(get_logger(), "lookup: %s", error.what());
      } catch (const tf2::TransformException & error) {
        RCLCPP_INFO(get_logger(), "other: %s", error.what());
      }
    });
  }

private:
  geometry_msgs::msg::TransformStamped make(
    const std::string & parent, const std::string & child, double x, double y, double yaw)
  {
    geometry_msgs::msg::TransformStamped made;
    made.header.stamp = now();
    made.header.frame_id = parent;
    made.child_frame_id = child;
    made.transform.translation.x = x;
    made.transform.translation.y = y;
    tf2::Quaternion rotation;
    rotation.setRPY(0.0, 0.0, yaw);
    made.transform.rotation = tf2::toMsg(rotation);
    return made;
  }
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  tf2_ros::TransformBroadcaster moving_;
  tf2_ros::StaticTransformBroadcaster fixed_;
  rclcpp::TimerBase::SharedPtr timer_, report_;
};
}  // namespace frames

RCLCPP_COMPONENTS_REGISTER_NODE(frames::Frames)
"""

ROTATIONS = """
#include <cstdio>

#include "tf2/LinearMath/Transform.h"
#include "tf2/buffer_core.h"
#include "tf2/utils.h"

geometry_msgs::msg::TransformStamped sample(double stamp, const tf2::Transform & transform)
{
  geometry_msgs::msg::TransformStamped made;
  made.header.stamp.sec = static_cast<int>(stamp);
  made.header.stamp.nanosec = static_cast<unsigned>((stamp - made.header.stamp.sec) * 1e9);
  made.header.frame_id = "a";
  made.child_frame_id = "b";
  const tf2::Quaternion q = transform.getRotation();
  made.transform.translation.x = transform.getOrigin().x();
  made.transform.rotation.x = q.x();
  made.transform.rotation.y = q.y();
  made.transform.rotation.z = q.z();
  made.transform.rotation.w = q.w();
  return made;
}

int main()
{
  double r, p, y;
  while (std::scanf("%lf %lf %lf", &r, &p, &y) == 3) {
    tf2::Quaternion q;
    q.setRPY(r, p, y);
    const tf2::Transform pose(q, tf2::Vector3(1, 2, 3));
    double roll, pitch, yaw;
    pose.getBasis().getRPY(roll, pitch, yaw);
    const tf2::Vector3 back = pose.inverse() * (pose * tf2::Vector3(r, p, y));
    tf2::BufferCore buffer;
    buffer.setTransform(sample(1.0, tf2::Transform()), "");
    buffer.setTransform(sample(2.0, pose), "");
    const auto half = buffer.lookupTransform("a", "b", tf2::timeFromSec(1.5)).transform;
    std::printf(
      "%.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g\\n", q.x(), q.y(),
      q.z(), q.w(), roll, pitch, yaw, back.x(), back.y(), back.z(), half.translation.x, half.rotation.x,
      half.rotation.y, half.rotation.z, half.rotation.w);
  }
}
"""

RECODE = """
#include <iostream>
#include <iterator>

#include "rclcpp/rclcpp.hpp"
#include "test_msgs/msg/arrays.hpp"
#include "test_msgs/msg/bounded_sequences.hpp"
#include "test_msgs/msg/defaults.hpp"
#include "test_msgs/msg/empty.hpp"
#include "test_msgs/msg/unbounded_sequences.hpp"
#include "test_msgs/msg/w_strings.hpp"

template<typename MessageT>
void recode(const std::string & data)
{
  MessageT message;
  rclcpp::SerializedMessage in(data), out;
  rclcpp::Serialization<MessageT> serialization;
  if (!data.empty()) {
    serialization.deserialize_message(&in, &message);
  }
  serialization.serialize_message(&message, &out);
  std::cout << out.bytes();
}

int main(int, char ** argv)
{
  const std::string type = argv[1], data{std::istreambuf_iterator<char>(std::cin), {}};
  try {
    if (type == "Arrays") {recode<test_msgs::msg::Arrays>(data);}
    if (type == "BoundedSequences") {recode<test_msgs::msg::BoundedSequences>(data);}
    if (type == "Defaults") {recode<test_msgs::msg::Defaults>(data);}
    if (type == "Empty") {recode<test_msgs::msg::Empty>(data);}
    if (type == "UnboundedSequences") {recode<test_msgs::msg::UnboundedSequences>(data);}
    if (type == "WStrings") {recode<test_msgs::msg::WStrings>(data);}
  } catch (const std::exception & error) {
    std::cerr << error.what();
    return 3;
  }
}
"""


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """A built workspace: messages, a library, and nodes that use both."""
    need_compiler()
    home = tmp_path_factory.mktemp("cpp")
    share_library(home)
    source = home / "ws" / "src"
    packages.cmake_package(
        source,
        "own_msgs",
        "find_package(rosidl_default_generators REQUIRED)\n"
        'rosidl_generate_interfaces(${PROJECT_NAME} "msg/Reading.msg" "srv/Scale.srv")',
        {
            "msg/Reading.msg": "string name\nfloat64[] values\nuint8 KIND=3\n",
            "srv/Scale.srv": "float64 value\n---\nfloat64 result\n",
        },
        packages.INTERFACES_XML,
    )
    packages.cmake_package(
        source,
        "parts",
        """
        add_library(parts SHARED src/limit.cpp)
        target_include_directories(parts PUBLIC
          $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
        find_package(rclcpp REQUIRED)
        ament_target_dependencies(parts rclcpp)
        install(DIRECTORY include/ DESTINATION include)
        install(TARGETS parts EXPORT export_parts LIBRARY DESTINATION lib)
        ament_export_targets(export_parts)
        ament_export_dependencies(rclcpp)
        """,
        {
            "include/parts/limit.hpp": "#pragma once\ndouble limit(double value);\n",
            "src/limit.cpp": '#include "parts/limit.hpp"\n#include "rclcpp/rclcpp.hpp"\n'
            "double limit(double value) { return value > 5.0 ? 5.0 : value; }\n",
        },
        "<depend>rclcpp</depend>",
    )
    packages.cmake_package(
        source,
        "cell",
        """
        foreach(name rclcpp own_msgs parts test_msgs)
          find_package(${name} REQUIRED)
        endforeach()
        add_executable(sensor src/sensor.cpp)
        target_link_libraries(sensor rclcpp::rclcpp own_msgs::own_msgs__rosidl_typesupport_cpp parts::parts)
        add_executable(recode src/recode.cpp)
        target_link_libraries(recode rclcpp::rclcpp ${test_msgs_TARGETS})
        install(TARGETS sensor recode DESTINATION lib/${PROJECT_NAME})
        """,
        {"src/sensor.cpp": NODE, "src/recode.cpp": RECODE},
        "<depend>rclcpp</depend><depend>own_msgs</depend><depend>parts</depend><depend>test_msgs</depend>",
    )
    packages.cmake_package(
        source,
        "frames",
        """
        foreach(name rclcpp rclcpp_components tf2 tf2_ros tf2_geometry_msgs)
          find_package(${name} REQUIRED)
        endforeach()
        add_library(frames_component SHARED src/frames.cpp)
        ament_target_dependencies(frames_component class_loader rclcpp rclcpp_components tf2_ros tf2_geometry_msgs)
        rclcpp_components_register_node(frames_component PLUGIN "frames::Frames" EXECUTABLE frames)
        add_executable(rotations src/rotations.cpp)
        target_link_libraries(rotations tf2::tf2)
        install(TARGETS frames_component LIBRARY DESTINATION lib)
        install(TARGETS rotations DESTINATION lib/${PROJECT_NAME})
        """,
        {"src/frames.cpp": FRAMES, "src/rotations.cpp": ROTATIONS},
        "<depend>rclcpp</depend><depend>rclcpp_components</depend><depend>tf2_ros</depend>"
        "<depend>tf2_geometry_msgs</depend>",
    )
    terminal = Terminal(environment(1, home), home / "ws")
    try:
        printed = terminal.run("colcon build", timeout_s=300)
        assert terminal.status == 0, printed
        assert "left out" not in printed
    finally:
        terminal.close()
    return home


@pytest.fixture
def terminal(workspace, domain):
    """Opens terminals in which the workspace has been sourced."""
    opened = []

    def open_one():
        one = Terminal(environment(domain, workspace), workspace / "ws")
        one.run("source install/setup.bash")
        opened.append(one)
        return one

    yield open_one
    for one in opened:
        one.close()


def test_a_node_takes_part_in_the_graph(terminal):
    first, second = terminal(), terminal()
    first.start("ros2 run cell sensor --ros-args -r __ns:=/lab -r in:=readings -p factor:=3.0")
    first.wait_for("ready with 3", timeout_s=60)
    assert second.run("ros2 node list").strip() == "/lab/sensor"
    assert "/lab/readings [own_msgs/msg/Reading]" in second.run("ros2 topic list -t")
    message = "'{name: a, values: [9.5]}'"
    second.run(f"ros2 topic pub --once -w 1 /lab/readings own_msgs/msg/Reading {message}")
    heard = second.run("ros2 topic echo --once --qos-durability transient_local --qos-reliability reliable /lab/out")
    assert heard.split() == ["name:", "a", "stamped", "values:", "-", "9.5", "-", "15.0", "---"]
    answer = second.run("ros2 service call /lab/scale own_msgs/srv/Scale '{value: 2.5}'")
    assert "result=7.5" in answer
    assert "not seven" in second.run("ros2 param set /lab/sensor factor 7.0")
    assert "Set parameter successful" in second.run("ros2 param set /lab/sensor factor 4.0")
    assert "Setting parameter failed" in second.run("ros2 param set /lab/sensor factor 11.0")
    assert "result=10.0" in second.run("ros2 service call /lab/scale own_msgs/srv/Scale '{value: 2.5}'")


def recode(workspace: Path, type_name: str, data: bytes) -> bytes:
    """Return what the C++ program makes of a message's bytes; the default message for none."""
    program = workspace / "ws/install/cell/lib/cell/recode"
    libraries = os.pathsep.join(str(path) for path in (workspace / "ws/install").glob("*/lib"))
    done = subprocess.run(
        [program, type_name], input=data, capture_output=True, check=False, env={"LD_LIBRARY_PATH": libraries}
    )
    assert done.returncode in (0, 3), done.stderr
    if done.returncode == 3:
        raise ValueError(done.stderr.decode())
    return done.stdout


TYPES = ("Arrays", "BoundedSequences", "Defaults", "Empty", "UnboundedSequences", "WStrings")


@pytest.mark.parametrize("name", TYPES)
def test_both_languages_have_the_same_bytes(workspace, name):
    import test_msgs.msg

    message = getattr(test_msgs.msg, name)()
    if name == "UnboundedSequences":
        message.bool_values = [True, False, True]
        message.float64_values = [1.5, -2.25]
        message.string_values = ["", "gr\u00fcn"]
        message.uint64_values = [2**64 - 1]
        message.basic_types_values = [test_msgs.msg.BasicTypes(int8_value=-3, uint32_value=7)] * 2
    codec = codec_of(type(message), 2)
    assert recode(workspace, name, b"") == codec.encode(type(message)())
    assert recode(workspace, name, codec.encode(message)) == codec.encode(message)


@pytest.mark.parametrize("cut", [2, 5, 8, 30])
def test_a_message_cut_short_is_refused(workspace, cut):
    import test_msgs.msg

    data = codec_of(test_msgs.msg.Arrays, 2).encode(test_msgs.msg.Arrays())
    with pytest.raises(ValueError, match=r"too early|no header|larger than"):
        recode(workspace, "Arrays", data[:cut])


def test_a_length_larger_than_the_message_takes_no_memory(workspace):
    with pytest.raises(ValueError, match="larger than the message"):
        recode(workspace, "UnboundedSequences", b"\0\1\0\0" + b"\xff" * 64)


def test_a_component_shares_transforms_with_python(terminal):
    first, second = terminal(), terminal()
    first.start("ros2 run frames frames")
    # The component waits for a frame that a Python node publishes.
    second.run("sleep 1")
    second.start("ros2 run tf2_ros static_transform_publisher --x 1 --y 4 --frame-id odom --child-frame-id tool")
    first.wait_for(r"seen at -0.200 1.000", timeout_s=60)
    first.wait_for(r'lookup: "nowhere" passed to lookupTransform argument does not exist', timeout_s=60)
    third = terminal()
    third.start("ros2 run tf2_ros tf2_echo odom laser")
    third.wait_for(r"Translation: \[0\.800, 2\.000, 0\.000\]", timeout_s=60)
    third.wait_for(r"RPY \(degree\) \[0\.000, -?0\.000, 90\.000\]", timeout_s=60)


def test_rotations_agree_with_scipy(workspace):
    import numpy as np
    from scipy.spatial.transform import Rotation, Slerp

    angles = np.random.default_rng(5).uniform(-1.0, 1.0, (40, 3)) * [np.pi, 1.5, np.pi]
    text = "\n".join(" ".join(map(repr, row)) for row in angles.tolist())
    program = workspace / "ws/install/frames/lib/frames/rotations"
    done = subprocess.run([program], input=text, capture_output=True, text=True, check=True)
    found = np.array([[float(word) for word in line.split()] for line in done.stdout.splitlines()])
    assert found.shape == (40, 15)
    for row, rpy in zip(found, angles, strict=True):
        wanted = Rotation.from_euler("xyz", rpy)
        assert abs(np.dot(row[:4], wanted.as_quat())) == pytest.approx(1.0, abs=1e-9)
        assert row[4:7] == pytest.approx(rpy, abs=1e-9)
        assert row[7:10] == pytest.approx(rpy, abs=1e-9)
        half = Slerp([0.0, 1.0], Rotation.concatenate([Rotation.identity(), wanted]))(0.5)
        assert row[10] == pytest.approx(0.5)
        assert abs(np.dot(row[11:], half.as_quat())) == pytest.approx(1.0, abs=1e-9)
