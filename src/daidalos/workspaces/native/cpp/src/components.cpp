// Components: the makers of nodes that libraries register.
#include "rclcpp_components/register_node_macro.hpp"

namespace rclcpp_components
{
std::map<std::string, Factory> & factories()
{
  static std::map<std::string, Factory> all;
  return all;
}
}  // namespace rclcpp_components
