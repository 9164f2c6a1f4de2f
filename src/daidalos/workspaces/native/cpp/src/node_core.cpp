#include "daidalos/node_core.hpp"

#include "daidalos/cdr.hpp"
#include "rclcpp/node.hpp"
#include "rclcpp/utilities.hpp"

namespace daidalos
{
namespace
{
template<typename MessageT>
Value encoded(const MessageT & message)
{
  Blob blob;
  encode(message, blob.data);
  return blob;
}

template<typename MessageT>
MessageT decoded(const Value & value)
{
  MessageT message;
  decode(value.bytes(), message);
  return message;
}

rclcpp::Parameter parameter_of(const Value & value)
{
  return rclcpp::Parameter::from_parameter_msg(decoded<rcl_interfaces::msg::Parameter>(value));
}

List encoded_list(const std::vector<rclcpp::Parameter> & parameters)
{
  List list;
  for (const auto & parameter : parameters) {
    list.push_back(encoded(parameter.to_parameter_msg()));
  }
  return list;
}

/// The node's Python callbacks (parameter services and time), run by the node's executor.
class Upkeep : public Entity
{
public:
  explicit Upkeep(Object node) : node_(std::move(node)) {}
  bool run() override
  {
    daidalos::call(node_, "run_ready");
    return false;
  }

private:
  Object node_;
};
}  // namespace

NodeCore::NodeCore(const std::string & name, const std::string & name_space, const rclcpp::NodeOptions & options)
: options_(options), clock_(std::make_shared<rclcpp::Clock>(RCL_ROS_TIME))
{
  if (!rclcpp::ok()) {
    throw rclcpp::exceptions::RCLError("failed to initialize rcl node: rclcpp::init() was not called, or shut down since");
  }
  List arguments;
  for (const auto & argument : options.arguments()) {
    arguments.emplace_back(argument);
  }
  try {
    node_ = daidalos::call(
      door(), "Node", {
        name, name_space, arguments, options.use_global_arguments(), options.enable_rosout(),
        options.start_parameter_services(), encoded_list(options.parameter_overrides()),
        options.allow_undeclared_parameters(), options.automatically_declare_parameters_from_overrides(),
        options.enable_logger_service()}).object();
  } catch (const PythonError & error) {
    rethrow(error);
  }
  const List names = call("names").list();
  name_ = names.at(0).text();
  namespace_ = names.at(1).text();
  full_name_ = names.at(2).text();
  logger_ = rclcpp::Logger(names.at(3).text());
  default_group_ = create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive);
}

void NodeCore::start()
{
  upkeep_ = std::make_shared<Upkeep>(node_);
  upkeep_->join(default_group_);
  std::weak_ptr<Entity> upkeep = upkeep_;
  std::weak_ptr<rclcpp::Clock> clock = clock_;
  call("watch", {
      callback([upkeep](List) {
        if (const auto held = upkeep.lock()) {
          held->notify();
        }
        return Value();
      }),
      callback([clock](List arguments) {
        if (const auto held = clock.lock()) {
          held->set_simulated(arguments.at(0).boolean(), arguments.at(1).integer());
        }
        return Value();
      })});
}

NodeCore::~NodeCore()
{
  try {
    daidalos::call(node_, "destroy");
  } catch (const PythonError &) {  // the graph is left at the end of the process anyway
  }
}

Value NodeCore::call(const char * method, const List & arguments) const
{
  try {
    return daidalos::call(node_, method, arguments);
  } catch (const PythonError & error) {
    rethrow(error);
  }
}

rclcpp::CallbackGroup::SharedPtr NodeCore::create_callback_group(rclcpp::CallbackGroupType type, bool automatic)
{
  auto group = std::make_shared<rclcpp::CallbackGroup>(type, automatic);
  std::shared_ptr<ReadyQueue> queue;
  {
    std::lock_guard<std::mutex> lock(mutex_);
    groups_.push_back(group);
    queue = queue_.lock();
  }
  if (queue && automatic) {
    group->attach(queue);
  }
  return group;
}

std::vector<rclcpp::CallbackGroup::SharedPtr> NodeCore::groups()
{
  std::lock_guard<std::mutex> lock(mutex_);
  std::vector<rclcpp::CallbackGroup::SharedPtr> found;
  for (const auto & held : groups_) {
    if (auto group = held.lock()) {
      found.push_back(std::move(group));
    }
  }
  return found;
}

bool NodeCore::owns(const rclcpp::CallbackGroup::SharedPtr & group)
{
  for (const auto & own : groups()) {
    if (own == group) {
      return true;
    }
  }
  return false;
}

rclcpp::CallbackGroup::SharedPtr NodeCore::group_or_default(const rclcpp::CallbackGroup::SharedPtr & group)
{
  if (group && !owns(group)) {
    throw std::runtime_error("Cannot create what is not of the node: its callback group is of another node.");
  }
  return group ? group : default_group_;
}

std::shared_ptr<ReadyQueue> NodeCore::queue() const
{
  std::lock_guard<std::mutex> lock(mutex_);
  return queue_.lock();
}

void NodeCore::set_queue(const std::shared_ptr<ReadyQueue> & queue)
{
  const auto before = this->queue();
  {
    std::lock_guard<std::mutex> lock(mutex_);
    queue_ = queue;
  }
  for (const auto & group : groups()) {
    if (before && group->automatically_add_to_executor_with_node()) {
      group->detach(before);
    }
    if (queue && group->automatically_add_to_executor_with_node() && !group->queue()) {
      group->attach(queue);
    }
  }
}

rclcpp::ParameterValue NodeCore::declare_parameter(
  const std::string & name, const rclcpp::ParameterValue & value,
  const rcl_interfaces::msg::ParameterDescriptor & descriptor, bool ignore_override)
{
  return parameter_of(call("declare_parameter", {
             encoded(rclcpp::Parameter(name, value).to_parameter_msg()), encoded(descriptor),
             ignore_override})).get_parameter_value();
}

void NodeCore::undeclare_parameter(const std::string & name) {call("undeclare_parameter", {name});}

bool NodeCore::has_parameter(const std::string & name) const {return call("has_parameter", {name}).boolean();}

rclcpp::Parameter NodeCore::get_parameter(const std::string & name) const
{
  return parameter_of(call("get_parameter", {name}));
}

bool NodeCore::get_parameter(const std::string & name, rclcpp::Parameter & parameter) const
{
  const auto found = call("get_parameter_if_set", {name});
  if (found.none()) {
    return false;
  }
  parameter = parameter_of(found);
  return true;
}

std::map<std::string, rclcpp::Parameter> NodeCore::get_parameters_by_prefix(const std::string & prefix) const
{
  std::map<std::string, rclcpp::Parameter> found;
  const Value parameters = call("get_parameters_by_prefix", {prefix});
  for (const auto & item : parameters.list()) {
    const auto parameter = parameter_of(item);
    const auto & name = parameter.get_name();
    found[prefix.empty() ? name : name.substr(prefix.size() + 1)] = parameter;
  }
  return found;
}

std::vector<rcl_interfaces::msg::SetParametersResult> NodeCore::set_parameters(
  const std::vector<rclcpp::Parameter> & parameters)
{
  std::vector<rcl_interfaces::msg::SetParametersResult> results;
  const Value answers = call("set_parameters", {encoded_list(parameters)});
  for (const auto & item : answers.list()) {
    results.push_back(decoded<rcl_interfaces::msg::SetParametersResult>(item));
  }
  return results;
}

rcl_interfaces::msg::SetParametersResult NodeCore::set_parameters_atomically(
  const std::vector<rclcpp::Parameter> & parameters)
{
  return decoded<rcl_interfaces::msg::SetParametersResult>(
    call("set_parameters_atomically", {encoded_list(parameters)}));
}

rcl_interfaces::msg::ParameterDescriptor NodeCore::describe_parameter(const std::string & name) const
{
  return decoded<rcl_interfaces::msg::ParameterDescriptor>(call("describe_parameter", {name}));
}

rcl_interfaces::msg::ListParametersResult NodeCore::list_parameters(
  const std::vector<std::string> & prefixes, std::uint64_t depth) const
{
  List list(prefixes.begin(), prefixes.end());
  return decoded<rcl_interfaces::msg::ListParametersResult>(
    call("list_parameters", {list, static_cast<std::int64_t>(depth)}));
}

std::shared_ptr<rclcpp::node_interfaces::OnSetParametersCallbackHandle> NodeCore::add_parameters_callback(
  const char * kind, SetParametersCallback function)
{
  const Object token = call("add_parameters_callback", {kind, callback([function](List arguments) {
        std::vector<rclcpp::Parameter> parameters;
        for (const auto & item : arguments.at(0).list()) {
          parameters.push_back(parameter_of(item));
        }
        return encoded(function(parameters));
      })}).object();
  auto handle = std::make_shared<rclcpp::node_interfaces::OnSetParametersCallbackHandle>();
  handle->registration = std::shared_ptr<void>(nullptr, [token](void *) {
        try {
          daidalos::call(token, "remove");
        } catch (const PythonError &) {  // the node is gone
        }
      });
  return handle;
}

std::vector<std::string> NodeInterface::get_node_names() const
{
  std::vector<std::string> names;
  const Value found = core_->call("get_node_names");
  for (const auto & name : found.list()) {
    names.push_back(name.text());
  }
  return names;
}

namespace
{
std::map<std::string, std::vector<std::string>> types_by_name(const Value & pairs)
{
  std::map<std::string, std::vector<std::string>> found;
  for (const auto & pair : pairs.list()) {
    for (const auto & type : pair.list().at(1).list()) {
      found[pair.list().at(0).text()].push_back(type.text());
    }
  }
  return found;
}
}  // namespace

std::map<std::string, std::vector<std::string>> NodeInterface::get_topic_names_and_types() const
{
  return types_by_name(core_->call("get_topic_names_and_types"));
}

std::map<std::string, std::vector<std::string>> NodeInterface::get_service_names_and_types() const
{
  return types_by_name(core_->call("get_service_names_and_types"));
}

std::size_t NodeInterface::count_publishers(const std::string & topic) const
{
  return static_cast<std::size_t>(core_->call("count_publishers", {topic}).integer());
}

std::size_t NodeInterface::count_subscribers(const std::string & topic) const
{
  return static_cast<std::size_t>(core_->call("count_subscribers", {topic}).integer());
}
}  // namespace daidalos
