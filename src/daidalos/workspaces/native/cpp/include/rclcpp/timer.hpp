// Timers.
#ifndef RCLCPP__TIMER_HPP_
#define RCLCPP__TIMER_HPP_

#include <atomic>
#include <chrono>
#include <functional>

#include "rclcpp/callback_group.hpp"
#include "rclcpp/clock.hpp"

namespace rclcpp
{
/// Function called once per period of a clock; periods that were missed are skipped.
class TimerBase : public std::enable_shared_from_this<TimerBase>
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(TimerBase)
  TimerBase(
    Clock::SharedPtr clock, std::chrono::nanoseconds period, std::function<void(TimerBase &)> callback,
    bool autostart = true);

  void cancel();
  bool is_canceled() {return canceled_;}
  void reset();
  bool is_ready() {return !canceled_ && time_until_trigger().count() <= 0;}
  std::chrono::nanoseconds time_until_trigger();
  std::chrono::nanoseconds period() const {return std::chrono::nanoseconds(period_ns_);}
  bool is_steady() {return clock_->get_clock_type() == RCL_STEADY_TIME;}
  Clock::SharedPtr get_clock() const {return clock_;}

  // The executor's side.
  bool waits_for_simulation() const {return clock_->ros_time_is_active();}
  /// Set the next deadline, when due; false when another thread did.
  bool begin();
  void execute_callback() {callback_(*this);}
  void join(const CallbackGroup::SharedPtr & group);
  CallbackGroup::SharedPtr group() const {return group_.lock();}

private:
  Clock::SharedPtr clock_;
  const std::int64_t period_ns_;
  std::function<void(TimerBase &)> callback_;
  std::atomic<std::int64_t> next_ns_;
  std::atomic<bool> canceled_;
  CallbackGroup::WeakPtr group_;
};

template<typename FunctorT, typename = void>
class GenericTimer : public TimerBase
{
public:
  using TimerBase::TimerBase;
};
template<typename FunctorT>
using WallTimer = GenericTimer<FunctorT>;
}  // namespace rclcpp
#endif
