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
