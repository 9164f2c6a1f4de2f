// Subscriber of transforms, which fills a buffer.
#ifndef TF2_ROS__TRANSFORM_LISTENER_HPP_
#define TF2_ROS__TRANSFORM_LISTENER_HPP_

#include <atomic>
#include <cstdio>
#include <memory>
#include <thread>

#include "rclcpp/rclcpp.hpp"
#include "tf2/buffer_core.hpp"
#include "tf2_msgs/msg/tf_message.hpp"

namespace tf2_ros
{
/// Listens to /tf and /tf_static by a node of its own, in a thread of its own, so that callbacks may wait for transforms.
class TransformListener
{
public:
  explicit TransformListener(tf2::BufferCore & buffer, bool /*spin_thread*/ = true) : buffer_(buffer) {start();}
  template<typename NodeT, typename ... Args>
  TransformListener(tf2::BufferCore & buffer, NodeT && /*node*/, bool /*spin_thread*/ = true, Args && ...)
  : buffer_(buffer) {start();}
  TransformListener(const TransformListener &) = delete;
  TransformListener & operator=(const TransformListener &) = delete;
  ~TransformListener()
  {
    executor_->cancel();
    thread_.join();
  }

private:
  void start()
  {
    static std::atomic<unsigned> number{0};
    char name[64];
    std::snprintf(
      name, sizeof(name), "transform_listener_impl_%zx_%u", std::hash<std::thread::id>()(std::this_thread::get_id()),
      number++);
    rclcpp::NodeOptions options;
    options.use_global_arguments(false).start_parameter_services(false).start_parameter_event_publisher(false);
    node_ = std::make_shared<rclcpp::Node>(name, options);
    subscriptions_[0] = node_->create_subscription<tf2_msgs::msg::TFMessage>(
      "/tf", rclcpp::QoS(100), [this](const tf2_msgs::msg::TFMessage & message) {take(message, false);});
    subscriptions_[1] = node_->create_subscription<tf2_msgs::msg::TFMessage>(
      "/tf_static", rclcpp::QoS(100).transient_local(),
      [this](const tf2_msgs::msg::TFMessage & message) {take(message, true);});
    executor_ = std::make_unique<rclcpp::executors::SingleThreadedExecutor>();
    executor_->add_node(node_);
    thread_ = std::thread([this] {executor_->spin();});
  }
  void take(const tf2_msgs::msg::TFMessage & message, bool is_static)
  {
    for (const auto & each : message.transforms) {
      if (!buffer_.setTransform(each, "", is_static)) {
        RCLCPP_WARN_STREAM(
          node_->get_logger(), "a transform of frame '" << each.child_frame_id << "' in '" << each.header.frame_id
                                                       << "' is not valid, or older than what is kept");
      }
    }
  }

  tf2::BufferCore & buffer_;
  rclcpp::Node::SharedPtr node_;
  rclcpp::Subscription<tf2_msgs::msg::TFMessage>::SharedPtr subscriptions_[2];
  std::unique_ptr<rclcpp::executors::SingleThreadedExecutor> executor_;
  std::thread thread_;
};
}  // namespace tf2_ros
#endif
