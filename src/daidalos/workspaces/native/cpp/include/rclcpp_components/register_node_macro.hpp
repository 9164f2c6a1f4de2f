// Registration of nodes as components.
#ifndef RCLCPP_COMPONENTS__REGISTER_NODE_MACRO_HPP_
#define RCLCPP_COMPONENTS__REGISTER_NODE_MACRO_HPP_

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "rclcpp/rclcpp.hpp"

namespace rclcpp_components
{
/// What a program that runs a component as a node needs of it.
struct MadeNode
{
  std::shared_ptr<void> node;
  std::shared_ptr<daidalos::NodeCore> base;
};
using Factory = std::function<MadeNode (const rclcpp::NodeOptions &)>;

/// Makers of the components of this program and its libraries, by their class names.
std::map<std::string, Factory> & factories();

template<typename NodeT>
struct Registration
{
  explicit Registration(const char * name)
  {
    factories()[name] = [](const rclcpp::NodeOptions & options) {
        auto node = std::make_shared<NodeT>(options);
        return MadeNode{node, node->get_node_base_interface()};
      };
  }
};
}  // namespace rclcpp_components

#define RCLCPP_COMPONENTS_REGISTER_NODE(NodeClass) \
  RCLCPP_COMPONENTS_REGISTER_NODE_(NodeClass, __COUNTER__)
#define RCLCPP_COMPONENTS_REGISTER_NODE_(NodeClass, number) \
  static const rclcpp_components::Registration<NodeClass> \
  RCLCPP_STRING_JOIN(daidalos_component_, number)(#NodeClass);
#endif
