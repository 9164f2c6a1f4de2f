// What a node consists of; all of upstream's node interfaces are this class.
#ifndef DAIDALOS__NODE_CORE_HPP_
#define DAIDALOS__NODE_CORE_HPP_

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daidalos/bridge.hpp"
#include "rcl_interfaces/msg/list_parameters_result.hpp"
#include "rcl_interfaces/msg/parameter_descriptor.hpp"
#include "rcl_interfaces/msg/set_parameters_result.hpp"
#include "rclcpp/callback_group.hpp"
#include "rclcpp/context.hpp"
#include "rclcpp/logger.hpp"
#include "rclcpp/node_options.hpp"
#include "rclcpp/parameter.hpp"
#include "rclcpp/qos.hpp"
#include "rclcpp/timer.hpp"

namespace rclcpp::node_interfaces
{
/// Handles of parameter callbacks: the callback is removed with the last reference.
struct OnSetParametersCallbackHandle
{
  RCLCPP_SHARED_PTR_DEFINITIONS(OnSetParametersCallbackHandle)
  std::shared_ptr<void> registration;
};
using PreSetParametersCallbackHandle = OnSetParametersCallbackHandle;
using PostSetParametersCallbackHandle = OnSetParametersCallbackHandle;
}  // namespace rclcpp::node_interfaces

namespace daidalos
{
using SetParametersCallback =
  std::function<rcl_interfaces::msg::SetParametersResult(const std::vector<rclcpp::Parameter> &)>;

/// Throw a Python exception as the one that upstream throws.
[[noreturn]] void rethrow(const PythonError & error);

/// A node: its place in the graph, its parameters, clock and callback groups.
class NodeCore : public std::enable_shared_from_this<NodeCore>
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS_NOT_COPYABLE(NodeCore)
  NodeCore(const std::string & name, const std::string & name_space, const rclcpp::NodeOptions & options);
  ~NodeCore();
  /// Second step of the construction, which needs a shared pointer.
  void start();

  const char * get_name() const {return name_.c_str();}
  const char * get_namespace() const {return namespace_.c_str();}
  const char * get_fully_qualified_name() const {return full_name_.c_str();}
  rclcpp::Logger get_logger() const {return logger_;}
  const char * get_logger_name() const {return logger_.get_name();}
  rclcpp::Clock::SharedPtr get_clock() const {return clock_;}
  rclcpp::Context::SharedPtr get_context() const {return rclcpp::contexts::get_global_default_context();}
  const rclcpp::NodeOptions & options() const {return options_;}
  /// Call a method of the Python side; its exceptions are upstream's.
  Value call(const char * method, const List & arguments = {}) const;

  rclcpp::CallbackGroup::SharedPtr create_callback_group(rclcpp::CallbackGroupType type, bool automatic = true);
  rclcpp::CallbackGroup::SharedPtr get_default_callback_group() const {return default_group_;}
  std::vector<rclcpp::CallbackGroup::SharedPtr> groups();
  bool owns(const rclcpp::CallbackGroup::SharedPtr & group);
  /// The given group, or the default one for null.
  rclcpp::CallbackGroup::SharedPtr group_or_default(const rclcpp::CallbackGroup::SharedPtr & group);
  void add_timer(const rclcpp::TimerBase::SharedPtr & timer, const rclcpp::CallbackGroup::SharedPtr & group)
  {
    timer->join(group_or_default(group));
  }
  std::shared_ptr<ReadyQueue> queue() const;
  void set_queue(const std::shared_ptr<ReadyQueue> & queue);

  // Parameters.
  rclcpp::ParameterValue declare_parameter(
    const std::string & name, const rclcpp::ParameterValue & value,
    const rcl_interfaces::msg::ParameterDescriptor & descriptor, bool ignore_override);
  void undeclare_parameter(const std::string & name);
  bool has_parameter(const std::string & name) const;
  rclcpp::Parameter get_parameter(const std::string & name) const;
  bool get_parameter(const std::string & name, rclcpp::Parameter & parameter) const;
  std::map<std::string, rclcpp::Parameter> get_parameters_by_prefix(const std::string & prefix) const;
  std::vector<rcl_interfaces::msg::SetParametersResult> set_parameters(
    const std::vector<rclcpp::Parameter> & parameters);
  rcl_interfaces::msg::SetParametersResult set_parameters_atomically(
    const std::vector<rclcpp::Parameter> & parameters);
  rcl_interfaces::msg::ParameterDescriptor describe_parameter(const std::string & name) const;
  rcl_interfaces::msg::ListParametersResult list_parameters(
    const std::vector<std::string> & prefixes, std::uint64_t depth) const;
  std::shared_ptr<rclcpp::node_interfaces::OnSetParametersCallbackHandle> add_parameters_callback(
    const char * kind, SetParametersCallback callback);

private:
  const rclcpp::NodeOptions options_;
  Object node_;
  std::string name_;
  std::string namespace_;
  std::string full_name_;
  rclcpp::Logger logger_;
  rclcpp::Clock::SharedPtr clock_;
  rclcpp::CallbackGroup::SharedPtr default_group_;
  mutable std::mutex mutex_;
  std::vector<rclcpp::CallbackGroup::WeakPtr> groups_;
  std::weak_ptr<ReadyQueue> queue_;
  std::shared_ptr<Entity> upkeep_;
};
}  // namespace daidalos

namespace rclcpp::node_interfaces
{
using NodeBaseInterface = daidalos::NodeCore;
using NodeClockInterface = daidalos::NodeCore;
using NodeGraphInterface = daidalos::NodeCore;
using NodeLoggingInterface = daidalos::NodeCore;
using NodeParametersInterface = daidalos::NodeCore;
using NodeServicesInterface = daidalos::NodeCore;
using NodeTimersInterface = daidalos::NodeCore;
using NodeTopicsInterface = daidalos::NodeCore;
using NodeWaitablesInterface = daidalos::NodeCore;
using NodeTimeSourceInterface = daidalos::NodeCore;
}  // namespace rclcpp::node_interfaces
#endif
