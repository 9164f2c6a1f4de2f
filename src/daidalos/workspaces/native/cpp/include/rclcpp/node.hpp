// Nodes.
#ifndef RCLCPP__NODE_HPP_
#define RCLCPP__NODE_HPP_

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daidalos/node_core.hpp"
#include "rclcpp/client.hpp"
#include "rclcpp/publisher.hpp"
#include "rclcpp/service.hpp"
#include "rclcpp/subscription.hpp"

namespace daidalos
{
/// The part of nodes that makes publishers and the like; lifecycle nodes have it, too.
class NodeInterface
{
public:
  using OnSetParametersCallbackHandle = rclcpp::node_interfaces::OnSetParametersCallbackHandle;
  using PreSetParametersCallbackHandle = OnSetParametersCallbackHandle;
  using PostSetParametersCallbackHandle = OnSetParametersCallbackHandle;
  using OnParametersSetCallbackType = SetParametersCallback;

  NodeInterface(const std::string & name, const std::string & name_space, const rclcpp::NodeOptions & options)
  : core_(std::make_shared<NodeCore>(name, name_space, options)) {core_->start();}
  virtual ~NodeInterface() = default;

  const char * get_name() const {return core_->get_name();}
  const char * get_namespace() const {return core_->get_namespace();}
  const char * get_effective_namespace() const {return core_->get_namespace();}
  const char * get_fully_qualified_name() const {return core_->get_fully_qualified_name();}
  rclcpp::Logger get_logger() const {return core_->get_logger();}
  rclcpp::Clock::SharedPtr get_clock() {return core_->get_clock();}
  rclcpp::Clock::ConstSharedPtr get_clock() const {return core_->get_clock();}
  rclcpp::Time now() const {return core_->get_clock()->now();}
  const rclcpp::NodeOptions & get_node_options() const {return core_->options();}

  // Publishers, subscriptions, timers, services and clients.

  template<typename MessageT, typename Options = rclcpp::PublisherOptions>
  std::shared_ptr<rclcpp::Publisher<MessageT>> create_publisher(
    const std::string & topic, const rclcpp::QoS & qos, const Options & = Options())
  {
    return std::make_shared<rclcpp::Publisher<MessageT>>(*core_, topic, qos);
  }
  template<typename MessageT, typename F, typename Options = rclcpp::SubscriptionOptions>
  std::shared_ptr<rclcpp::Subscription<MessageT>> create_subscription(
    const std::string & topic, const rclcpp::QoS & qos, F && callback, const Options & options = Options())
  {
    auto made = std::make_shared<rclcpp::Subscription<MessageT>>(topic, qos, std::forward<F>(callback));
    made->open(*core_, core_->group_or_default(options.callback_group));
    return made;
  }
  template<typename Rep, typename Period, typename F>
  rclcpp::TimerBase::SharedPtr create_wall_timer(
    std::chrono::duration<Rep, Period> period, F callback, rclcpp::CallbackGroup::SharedPtr group = nullptr,
    bool autostart = true)
  {
    return timer(std::make_shared<rclcpp::Clock>(RCL_STEADY_TIME), period, std::move(callback), group, autostart);
  }
  template<typename Rep, typename Period, typename F>
  rclcpp::TimerBase::SharedPtr create_timer(
    std::chrono::duration<Rep, Period> period, F callback, rclcpp::CallbackGroup::SharedPtr group = nullptr,
    bool autostart = true)
  {
    return timer(core_->get_clock(), period, std::move(callback), group, autostart);
  }
  template<typename ServiceT, typename F>
  std::shared_ptr<rclcpp::Service<ServiceT>> create_service(
    const std::string & name, F && callback, const rclcpp::QoS & qos = rclcpp::ServicesQoS(),
    rclcpp::CallbackGroup::SharedPtr group = nullptr)
  {
    auto made = std::make_shared<rclcpp::Service<ServiceT>>(name, std::decay_t<F>(std::forward<F>(callback)), qos);
    made->open(*core_, core_->group_or_default(group));
    return made;
  }
  template<typename ServiceT>
  std::shared_ptr<rclcpp::Client<ServiceT>> create_client(
    const std::string & name, const rclcpp::QoS & qos = rclcpp::ServicesQoS(),
    rclcpp::CallbackGroup::SharedPtr group = nullptr)
  {
    auto made = std::make_shared<rclcpp::Client<ServiceT>>(name, qos);
    made->open(*core_, core_->group_or_default(group));
    return made;
  }
  rclcpp::CallbackGroup::SharedPtr create_callback_group(
    rclcpp::CallbackGroupType type, bool automatically_add_to_executor_with_node = true)
  {
    return core_->create_callback_group(type, automatically_add_to_executor_with_node);
  }
  void for_each_callback_group(const std::function<void (rclcpp::CallbackGroup::SharedPtr)> & function)
  {
    for (const auto & group : core_->groups()) {
      function(group);
    }
  }

  // Parameters.

  rclcpp::ParameterValue declare_parameter(
    const std::string & name, const rclcpp::ParameterValue & value,
    const rcl_interfaces::msg::ParameterDescriptor & descriptor = {}, bool ignore_override = false)
  {
    return core_->declare_parameter(name, value, descriptor, ignore_override);
  }
  rclcpp::ParameterValue declare_parameter(
    const std::string & name, rclcpp::ParameterType type, rcl_interfaces::msg::ParameterDescriptor descriptor = {},
    bool ignore_override = false)
  {
    descriptor.type = type;
    return core_->declare_parameter(name, rclcpp::ParameterValue(), descriptor, ignore_override);
  }
  template<typename T, std::enable_if_t<!std::is_same<std::decay_t<T>, rclcpp::ParameterType>::value &&
    !std::is_same<std::decay_t<T>, rclcpp::ParameterValue>::value, int> = 0>
  auto declare_parameter(
    const std::string & name, const T & value, const rcl_interfaces::msg::ParameterDescriptor & descriptor = {},
    bool ignore_override = false)
  {
    const auto found = core_->declare_parameter(name, rclcpp::ParameterValue(value), descriptor, ignore_override);
    if constexpr (std::is_convertible<T, std::string>::value) {
      return found.template get<std::string>();
    } else {
      return found.template get<T>();
    }
  }
  template<typename T>
  T declare_parameter(
    const std::string & name, rcl_interfaces::msg::ParameterDescriptor descriptor = {}, bool ignore_override = false)
  {
    descriptor.type = rclcpp::ParameterValue(T{}).get_type();
    return core_->declare_parameter(name, rclcpp::ParameterValue(), descriptor, ignore_override).template get<T>();
  }
  template<typename T>
  std::vector<T> declare_parameters(
    const std::string & prefix, const std::map<std::string, T> & parameters, bool ignore_overrides = false)
  {
    std::vector<T> values;
    for (const auto & [name, value] : parameters) {
      values.push_back(declare_parameter(prefix.empty() ? name : prefix + "." + name, value, {}, ignore_overrides));
    }
    return values;
  }
  void undeclare_parameter(const std::string & name) {core_->undeclare_parameter(name);}
  bool has_parameter(const std::string & name) const {return core_->has_parameter(name);}
  rclcpp::Parameter get_parameter(const std::string & name) const {return core_->get_parameter(name);}
  bool get_parameter(const std::string & name, rclcpp::Parameter & parameter) const
  {
    return core_->get_parameter(name, parameter);
  }
  template<typename T>
  bool get_parameter(const std::string & name, T & value) const
  {
    rclcpp::Parameter parameter;
    const bool found = core_->get_parameter(name, parameter);
    if (found) {
      value = parameter.get_value<T>();
    }
    return found;
  }
  template<typename T>
  bool get_parameter_or(const std::string & name, T & value, const T & alternative) const
  {
    const bool found = get_parameter(name, value);
    if (!found) {
      value = alternative;
    }
    return found;
  }
  template<typename T>
  T get_parameter_or(const std::string & name, const T & alternative) const
  {
    T value{};
    get_parameter_or(name, value, alternative);
    return value;
  }
  std::vector<rclcpp::Parameter> get_parameters(const std::vector<std::string> & names) const
  {
    std::vector<rclcpp::Parameter> found;
    for (const auto & name : names) {
      found.push_back(get_parameter(name));
    }
    return found;
  }
  template<typename T>
  bool get_parameters(const std::string & prefix, std::map<std::string, T> & values) const
  {
    const auto found = core_->get_parameters_by_prefix(prefix);
    for (const auto & [name, parameter] : found) {
      values[name] = parameter.template get_value<T>();
    }
    return !found.empty();
  }
  rcl_interfaces::msg::SetParametersResult set_parameter(const rclcpp::Parameter & parameter)
  {
    return core_->set_parameters_atomically({parameter});
  }
  std::vector<rcl_interfaces::msg::SetParametersResult> set_parameters(
    const std::vector<rclcpp::Parameter> & parameters)
  {
    return core_->set_parameters(parameters);
  }
  rcl_interfaces::msg::SetParametersResult set_parameters_atomically(
    const std::vector<rclcpp::Parameter> & parameters)
  {
    return core_->set_parameters_atomically(parameters);
  }
  rcl_interfaces::msg::ParameterDescriptor describe_parameter(const std::string & name) const
  {
    return core_->describe_parameter(name);
  }
  std::vector<std::uint8_t> get_parameter_types(const std::vector<std::string> & names) const
  {
    std::vector<std::uint8_t> types;
    for (const auto & name : names) {
      types.push_back(get_parameter(name).get_type());
    }
    return types;
  }
  rcl_interfaces::msg::ListParametersResult list_parameters(
    const std::vector<std::string> & prefixes, std::uint64_t depth) const
  {
    return core_->list_parameters(prefixes, depth);
  }
  OnSetParametersCallbackHandle::SharedPtr add_on_set_parameters_callback(SetParametersCallback callback)
  {
    return core_->add_parameters_callback("on_set", std::move(callback));
  }
  OnSetParametersCallbackHandle::SharedPtr add_post_set_parameters_callback(
    std::function<void (const std::vector<rclcpp::Parameter> &)> callback)
  {
    return core_->add_parameters_callback(
      "post_set", [callback](const std::vector<rclcpp::Parameter> & parameters) {
        callback(parameters);
        return rcl_interfaces::msg::SetParametersResult();
      });
  }
  void remove_on_set_parameters_callback(const OnSetParametersCallbackHandle * handle)
  {
    const_cast<OnSetParametersCallbackHandle *>(handle)->registration.reset();
  }
  void remove_post_set_parameters_callback(const OnSetParametersCallbackHandle * handle)
  {
    remove_on_set_parameters_callback(handle);
  }

  // The graph.

  std::vector<std::string> get_node_names() const;
  std::map<std::string, std::vector<std::string>> get_topic_names_and_types() const;
  std::map<std::string, std::vector<std::string>> get_service_names_and_types() const;
  std::size_t count_publishers(const std::string & topic) const;
  std::size_t count_subscribers(const std::string & topic) const;

  // Upstream's interfaces, which are all one.

  NodeCore::SharedPtr get_node_base_interface() const {return core_;}
  NodeCore::SharedPtr get_node_clock_interface() const {return core_;}
  NodeCore::SharedPtr get_node_graph_interface() const {return core_;}
  NodeCore::SharedPtr get_node_logging_interface() const {return core_;}
  NodeCore::SharedPtr get_node_parameters_interface() const {return core_;}
  NodeCore::SharedPtr get_node_services_interface() const {return core_;}
  NodeCore::SharedPtr get_node_time_source_interface() const {return core_;}
  NodeCore::SharedPtr get_node_timers_interface() const {return core_;}
  NodeCore::SharedPtr get_node_topics_interface() const {return core_;}
  NodeCore::SharedPtr get_node_waitables_interface() const {return core_;}

protected:
  NodeCore::SharedPtr core_;

private:
  template<typename Rep, typename Period, typename F>
  rclcpp::TimerBase::SharedPtr timer(
    const rclcpp::Clock::SharedPtr & clock, std::chrono::duration<Rep, Period> period, F callback,
    const rclcpp::CallbackGroup::SharedPtr & group, bool autostart)
  {
    auto made = std::make_shared<rclcpp::WallTimer<F>>(
      clock, std::chrono::duration_cast<std::chrono::nanoseconds>(period),
      [callback](rclcpp::TimerBase & self) mutable {
        if constexpr (std::is_invocable<F &>::value) {
          (void)self;
          callback();
        } else {
          callback(self);
        }
      }, autostart);
    core_->add_timer(made, group);
    return made;
  }
};
}  // namespace daidalos

namespace rclcpp
{
class Node : public daidalos::NodeInterface, public std::enable_shared_from_this<Node>
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS_NOT_COPYABLE(Node)
  explicit Node(const std::string & name, const NodeOptions & options = NodeOptions()) : Node(name, "", options) {}
  explicit Node(const std::string & name, const std::string & name_space, const NodeOptions & options = NodeOptions())
  : NodeInterface(name, name_space, options) {}
};
}  // namespace rclcpp
#endif
