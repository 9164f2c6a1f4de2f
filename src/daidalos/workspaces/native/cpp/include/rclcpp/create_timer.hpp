// Timers on a clock of one's choice.
#ifndef RCLCPP__CREATE_TIMER_HPP_
#define RCLCPP__CREATE_TIMER_HPP_

#include "rclcpp/node.hpp"

namespace rclcpp
{
template<typename NodeT, typename F>
TimerBase::SharedPtr create_timer(
  NodeT node, Clock::SharedPtr clock, Duration period, F callback, CallbackGroup::SharedPtr group = nullptr,
  bool autostart = true)
{
  auto made = std::make_shared<GenericTimer<F>>(
    clock, period.to_chrono<std::chrono::nanoseconds>(), [callback](TimerBase &) mutable {callback();}, autostart);
  node->get_node_timers_interface()->add_timer(made, group);
  return made;
}
}  // namespace rclcpp
#endif
