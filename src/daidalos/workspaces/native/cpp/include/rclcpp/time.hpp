// Points in time, each of one kind of clock.
#ifndef RCLCPP__TIME_HPP_
#define RCLCPP__TIME_HPP_

#include <stdexcept>

#include "builtin_interfaces/msg/time.hpp"
#include "rclcpp/duration.hpp"

enum rcl_clock_type_t {RCL_CLOCK_UNINITIALIZED = 0, RCL_ROS_TIME, RCL_SYSTEM_TIME, RCL_STEADY_TIME};

namespace rclcpp
{
/// Nanoseconds since the epoch of a clock. Times of two kinds of clocks are not compared: that throws.
class Time
{
public:
  Time(std::int32_t seconds, std::uint32_t nanoseconds, rcl_clock_type_t type = RCL_SYSTEM_TIME)
  : Time(seconds * 1000000000LL + nanoseconds, type)
  {
    if (seconds < 0) {
      throw std::runtime_error("cannot store a negative time point in rclcpp::Time");
    }
  }
  explicit Time(std::int64_t nanoseconds = 0, rcl_clock_type_t type = RCL_SYSTEM_TIME)
  : ns_(nanoseconds), type_(type) {}
  Time(const builtin_interfaces::msg::Time & message, rcl_clock_type_t type = RCL_ROS_TIME)  // NOLINT
  : Time(message.sec, message.nanosec, type) {}

  static Time max(rcl_clock_type_t type = RCL_SYSTEM_TIME)
  {
    return Time(std::numeric_limits<std::int32_t>::max(), 999999999, type);
  }

  std::int64_t nanoseconds() const {return ns_;}
  double seconds() const {return static_cast<double>(ns_) / 1e9;}
  rcl_clock_type_t get_clock_type() const {return type_;}
  operator builtin_interfaces::msg::Time() const  // NOLINT
  {
    builtin_interfaces::msg::Time message;
    message.sec = static_cast<std::int32_t>(ns_ / 1000000000);
    message.nanosec = static_cast<std::uint32_t>(ns_ % 1000000000);
    return message;
  }
  Time & operator=(const builtin_interfaces::msg::Time & message) {return *this = Time(message);}

  bool operator==(const Time & other) const {return ns_ == same(other).ns_;}
  bool operator!=(const Time & other) const {return ns_ != same(other).ns_;}
  bool operator<(const Time & other) const {return ns_ < same(other).ns_;}
  bool operator<=(const Time & other) const {return ns_ <= same(other).ns_;}
  bool operator>(const Time & other) const {return ns_ > same(other).ns_;}
  bool operator>=(const Time & other) const {return ns_ >= same(other).ns_;}
  Time operator+(const Duration & length) const {return Time(ns_ + length.nanoseconds(), type_);}
  Time operator-(const Duration & length) const {return Time(ns_ - length.nanoseconds(), type_);}
  Duration operator-(const Time & other) const {return Duration::from_nanoseconds(ns_ - same(other).ns_);}
  Time & operator+=(const Duration & length) {ns_ += length.nanoseconds(); return *this;}
  Time & operator-=(const Duration & length) {ns_ -= length.nanoseconds(); return *this;}

private:
  const Time & same(const Time & other) const
  {
    if (type_ != other.type_) {
      throw std::runtime_error("can't compare times with different time sources");
    }
    return other;
  }
  std::int64_t ns_;
  rcl_clock_type_t type_;
};

inline Time operator+(const Duration & length, const Time & time) {return time + length;}
}  // namespace rclcpp
#endif
