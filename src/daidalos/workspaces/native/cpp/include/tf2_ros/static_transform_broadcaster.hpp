// Publisher of transforms that do not change.
#ifndef TF2_ROS__STATIC_TRANSFORM_BROADCASTER_HPP_
#define TF2_ROS__STATIC_TRANSFORM_BROADCASTER_HPP_

#include <memory>
#include <vector>

#include "tf2_ros/transform_broadcaster.hpp"

namespace tf2_ros
{
/// Publishes on /tf_static for a node; whoever comes later hears all that was sent.
class StaticTransformBroadcaster
{
public:
  template<typename NodeT>
  explicit StaticTransformBroadcaster(NodeT && node, const rclcpp::QoS & qos = rclcpp::QoS(1).transient_local())
  : publisher_(TransformBroadcaster::dereference(node).template create_publisher<tf2_msgs::msg::TFMessage>(
        "/tf_static", qos)) {}

  void sendTransform(const geometry_msgs::msg::TransformStamped & transform)
  {
    sendTransform(std::vector<geometry_msgs::msg::TransformStamped>{transform});
  }
  void sendTransform(const std::vector<geometry_msgs::msg::TransformStamped> & transforms)
  {
    for (const auto & each : transforms) {
      bool is_known = false;
      for (auto & known : message_.transforms) {
        if (known.child_frame_id == each.child_frame_id) {
          known = each;
          is_known = true;
        }
      }
      if (!is_known) {
        message_.transforms.push_back(each);
      }
    }
    publisher_->publish(message_);
  }

private:
  std::shared_ptr<rclcpp::Publisher<tf2_msgs::msg::TFMessage>> publisher_;
  tf2_msgs::msg::TFMessage message_;
};
}  // namespace tf2_ros
#endif
