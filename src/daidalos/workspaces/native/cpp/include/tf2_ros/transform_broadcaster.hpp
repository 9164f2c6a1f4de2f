// Publisher of transforms that change.
#ifndef TF2_ROS__TRANSFORM_BROADCASTER_HPP_
#define TF2_ROS__TRANSFORM_BROADCASTER_HPP_

#include <memory>
#include <vector>

#include "geometry_msgs/msg/transform_stamped.hpp"
#include "rclcpp/rclcpp.hpp"
#include "tf2_msgs/msg/tf_message.hpp"

namespace tf2_ros
{
/// Publishes on /tf for a node, which may be given as itself, by reference or by pointer.
class TransformBroadcaster
{
public:
  template<typename NodeT>
  explicit TransformBroadcaster(NodeT && node, const rclcpp::QoS & qos = rclcpp::QoS(100))
  : publisher_(dereference(node).template create_publisher<tf2_msgs::msg::TFMessage>("/tf", qos)) {}

  void sendTransform(const geometry_msgs::msg::TransformStamped & transform)
  {
    sendTransform(std::vector<geometry_msgs::msg::TransformStamped>{transform});
  }
  void sendTransform(const std::vector<geometry_msgs::msg::TransformStamped> & transforms)
  {
    tf2_msgs::msg::TFMessage message;
    message.transforms = transforms;
    publisher_->publish(message);
  }

  template<typename NodeT>
  static auto & dereference(NodeT & node)
  {
    if constexpr (std::is_base_of<daidalos::NodeInterface, NodeT>::value) {
      return node;
    } else {
      return *node;
    }
  }

private:
  std::shared_ptr<rclcpp::Publisher<tf2_msgs::msg::TFMessage>> publisher_;
};
}  // namespace tf2_ros
#endif
