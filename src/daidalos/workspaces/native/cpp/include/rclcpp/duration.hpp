// Signed lengths of time.
#ifndef RCLCPP__DURATION_HPP_
#define RCLCPP__DURATION_HPP_

#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>

#include "builtin_interfaces/msg/duration.hpp"

struct rmw_time_t
{
  std::uint64_t sec;
  std::uint64_t nsec;
};
using rcl_duration_value_t = std::int64_t;
using rcl_time_point_value_t = std::int64_t;
#define RCL_S_TO_NS(seconds) ((seconds) * (1000LL * 1000LL * 1000LL))
#define RCL_MS_TO_NS(milliseconds) ((milliseconds) * (1000LL * 1000LL))
#define RCL_US_TO_NS(microseconds) ((microseconds) * 1000LL)
#define RCL_NS_TO_S(nanoseconds) ((nanoseconds) / (1000LL * 1000LL * 1000LL))
#define RCL_NS_TO_MS(nanoseconds) ((nanoseconds) / (1000LL * 1000LL))

namespace rclcpp
{
/// Signed length of time in nanoseconds.
class Duration
{
public:
  Duration() = default;
  Duration(std::int32_t seconds, std::uint32_t nanoseconds)
  : ns_(seconds * 1000000000LL + nanoseconds) {}
  explicit Duration(std::chrono::nanoseconds ns) : ns_(ns.count()) {}
  template<class Rep, class Period>
  Duration(const std::chrono::duration<Rep, Period> & length)  // NOLINT
  : ns_(std::chrono::duration_cast<std::chrono::nanoseconds>(length).count()) {}
  Duration(const builtin_interfaces::msg::Duration & message)  // NOLINT
  : ns_(message.sec * 1000000000LL + message.nanosec) {}

  static Duration from_seconds(double seconds) {return from_nanoseconds(std::llround(seconds * 1e9));}
  static Duration from_nanoseconds(std::int64_t ns) {Duration made; made.ns_ = ns; return made;}
  static Duration from_rmw_time(rmw_time_t time)
  {
    return from_nanoseconds(static_cast<std::int64_t>(time.sec * 1000000000ULL + time.nsec));
  }
  static Duration max() {return Duration(std::numeric_limits<std::int32_t>::max(), 999999999);}

  std::int64_t nanoseconds() const {return ns_;}
  double seconds() const {return static_cast<double>(ns_) / 1e9;}
  rmw_time_t to_rmw_time() const
  {
    return {static_cast<std::uint64_t>(ns_ / 1000000000), static_cast<std::uint64_t>(ns_ % 1000000000)};
  }
  template<class DurationT>
  DurationT to_chrono() const {return std::chrono::duration_cast<DurationT>(std::chrono::nanoseconds(ns_));}
  operator builtin_interfaces::msg::Duration() const  // NOLINT
  {
    builtin_interfaces::msg::Duration message;
    std::int64_t rest = ns_ % 1000000000;
    rest += rest < 0 ? 1000000000 : 0;
    message.sec = static_cast<std::int32_t>((ns_ - rest) / 1000000000);
    message.nanosec = static_cast<std::uint32_t>(rest);
    return message;
  }

  bool operator==(const Duration & other) const {return ns_ == other.ns_;}
  bool operator!=(const Duration & other) const {return ns_ != other.ns_;}
  bool operator<(const Duration & other) const {return ns_ < other.ns_;}
  bool operator<=(const Duration & other) const {return ns_ <= other.ns_;}
  bool operator>(const Duration & other) const {return ns_ > other.ns_;}
  bool operator>=(const Duration & other) const {return ns_ >= other.ns_;}
  Duration operator+(const Duration & other) const {return from_nanoseconds(ns_ + other.ns_);}
  Duration operator-(const Duration & other) const {return from_nanoseconds(ns_ - other.ns_);}
  Duration operator*(double factor) const {return from_nanoseconds(std::llround(static_cast<double>(ns_) * factor));}
  Duration & operator+=(const Duration & other) {ns_ += other.ns_; return *this;}
  Duration & operator-=(const Duration & other) {ns_ -= other.ns_; return *this;}
  Duration & operator*=(double factor) {return *this = *this * factor;}

private:
  std::int64_t ns_ = 0;
};
}  // namespace rclcpp
#endif
