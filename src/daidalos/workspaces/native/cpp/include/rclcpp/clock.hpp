// Clocks.
#ifndef RCLCPP__CLOCK_HPP_
#define RCLCPP__CLOCK_HPP_

#include <atomic>
#include <functional>
#include <mutex>
#include <vector>

#include "rclcpp/macros.hpp"
#include "rclcpp/time.hpp"

namespace rclcpp
{
/// Clock: system, steady, or a node's, which follows /clock while its parameter use_sim_time is true.
class Clock
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(Clock)
  explicit Clock(rcl_clock_type_t type = RCL_SYSTEM_TIME) : type_(type) {}

  Time now() const;
  rcl_clock_type_t get_clock_type() const noexcept {return type_;}
  bool ros_time_is_active() const {return simulated_;}
  bool started() const {return !simulated_ || simulated_ns_ != 0;}
  /// Sleep until a time of this clock; false when the context was shut down first.
  bool sleep_until(Time until);
  bool sleep_for(Duration length) {return sleep_until(now() + length);}

  /// Called when simulated time is switched on or off and when it advances.
  void set_simulated(bool active, std::int64_t ns);
  void on_change(std::function<void()> wake);

private:
  rcl_clock_type_t type_;
  std::atomic<bool> simulated_{false};
  std::atomic<std::int64_t> simulated_ns_{0};
  std::mutex mutex_;
  std::vector<std::function<void()>> wakes_;
};
}  // namespace rclcpp
#endif
