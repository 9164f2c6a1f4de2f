// Tree of frames for nodes: looked up by ROS times, with waiting.
#ifndef TF2_ROS__BUFFER_HPP_
#define TF2_ROS__BUFFER_HPP_

#include <memory>
#include <string>

#include "rclcpp/rclcpp.hpp"
#include "tf2/buffer_core.hpp"
#include "tf2/convert.hpp"

namespace tf2_ros
{
inline tf2::TimePoint fromRclcpp(const rclcpp::Time & time)
{
  return tf2::TimePoint(std::chrono::nanoseconds(time.nanoseconds()));
}
inline tf2::Duration fromRclcpp(const rclcpp::Duration & length)
{
  return std::chrono::nanoseconds(length.nanoseconds());
}
inline rclcpp::Time toRclcpp(const tf2::TimePoint & time)
{
  return rclcpp::Time(time.time_since_epoch().count(), RCL_ROS_TIME);
}
inline builtin_interfaces::msg::Time toMsg(const tf2::TimePoint & time) {return toRclcpp(time);}
inline tf2::TimePoint fromMsg(const builtin_interfaces::msg::Time & time) {return fromRclcpp(rclcpp::Time(time));}

/// Tree of frames; a TransformListener fills it. Waiting is by real time.
class Buffer : public tf2::BufferCore
{
public:
  using SharedPtr = std::shared_ptr<Buffer>;
  explicit Buffer(
    rclcpp::Clock::SharedPtr clock, tf2::Duration cache_time = tf2::BUFFER_CORE_DEFAULT_CACHE_TIME)
  : BufferCore(cache_time), clock_(std::move(clock)) {}

  using tf2::BufferCore::canTransform;
  using tf2::BufferCore::lookupTransform;

  /// Return a transform as BufferCore does, after waiting for it for at most `timeout`.
  geometry_msgs::msg::TransformStamped lookupTransform(
    const std::string & target, const std::string & source, const tf2::TimePoint & time, tf2::Duration timeout) const
  {
    canTransform(target, source, time, timeout);
    return lookupTransform(target, source, time);
  }
  geometry_msgs::msg::TransformStamped lookupTransform(
    const std::string & target, const std::string & source, const rclcpp::Time & time,
    const rclcpp::Duration & timeout = rclcpp::Duration::from_nanoseconds(0)) const
  {
    return lookupTransform(target, source, fromRclcpp(time), fromRclcpp(timeout));
  }

  bool canTransform(
    const std::string & target, const std::string & source, const tf2::TimePoint & time, tf2::Duration timeout,
    std::string * error = nullptr) const
  {
    return wait(timeout, [&] {return canTransform(target, source, time, error) || !rclcpp::ok();}) && rclcpp::ok();
  }
  bool canTransform(
    const std::string & target, const std::string & source, const rclcpp::Time & time,
    const rclcpp::Duration & timeout = rclcpp::Duration::from_nanoseconds(0), std::string * error = nullptr) const
  {
    return canTransform(target, source, fromRclcpp(time), fromRclcpp(timeout), error);
  }

  /// Return a message with a header in another frame, at the message's time.
  template<class T>
  T transform(const T & in, const std::string & target, tf2::Duration timeout = tf2::Duration::zero()) const
  {
    T out = in;
    tf2::doTransform(in, out, lookupTransform(target, tf2::getFrameId(in), tf2::getTimestamp(in), timeout));
    return out;
  }
  template<class T>
  T & transform(
    const T & in, T & out, const std::string & target, tf2::Duration timeout = tf2::Duration::zero()) const
  {
    return out = transform(in, target, timeout);
  }

  rclcpp::Clock::SharedPtr getClock() const {return clock_;}
  void setUsingDedicatedThread(bool) {}

private:
  rclcpp::Clock::SharedPtr clock_;
};
}  // namespace tf2_ros
#endif
