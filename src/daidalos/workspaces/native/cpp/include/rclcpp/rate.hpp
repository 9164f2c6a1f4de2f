// Loops with a fixed period.
#ifndef RCLCPP__RATE_HPP_
#define RCLCPP__RATE_HPP_

#include <stdexcept>

#include "rclcpp/clock.hpp"

namespace rclcpp
{
class RateBase
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(RateBase)
  virtual ~RateBase() = default;
  virtual bool sleep() = 0;
  virtual void reset() = 0;
};

/// Sleep for the rest of each period of a clock.
class Rate : public RateBase
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(Rate)
  explicit Rate(double hertz, Clock::SharedPtr clock = std::make_shared<Clock>(RCL_SYSTEM_TIME))
  : clock_(std::move(clock)), period_(Duration::from_seconds(1.0 / hertz)), last_(clock_->now())
  {
    if (!(hertz > 0)) {
      throw std::invalid_argument("rate must be greater than 0");
    }
  }
  explicit Rate(const Duration & period, Clock::SharedPtr clock = std::make_shared<Clock>(RCL_SYSTEM_TIME))
  : clock_(std::move(clock)), period_(period), last_(clock_->now())
  {
    if (period_.nanoseconds() <= 0) {
      throw std::invalid_argument("period must be greater than 0");
    }
  }

  bool sleep() override
  {
    const Time now = clock_->now();
    Time next = last_ + period_;
    if (now < last_) {  // the clock was set back
      next = now + period_;
    }
    last_ += period_;
    if (next <= now) {
      if (now > next + period_) {
        last_ = now;
      }
      return false;
    }
    return clock_->sleep_until(next);
  }
  void reset() override {last_ = clock_->now();}
  std::chrono::nanoseconds period() const {return period_.to_chrono<std::chrono::nanoseconds>();}
  rcl_clock_type_t get_type() const {return clock_->get_clock_type();}

private:
  Clock::SharedPtr clock_;
  Duration period_;
  Time last_;
};

class WallRate : public Rate
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(WallRate)
  explicit WallRate(double hertz) : Rate(hertz, std::make_shared<Clock>(RCL_STEADY_TIME)) {}
  explicit WallRate(const Duration & period) : Rate(period, std::make_shared<Clock>(RCL_STEADY_TIME)) {}
};

class ROSRate : public Rate
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(ROSRate)
  explicit ROSRate(double hertz) : Rate(hertz, std::make_shared<Clock>(RCL_ROS_TIME)) {}
  explicit ROSRate(const Duration & period) : Rate(period, std::make_shared<Clock>(RCL_ROS_TIME)) {}
};
}  // namespace rclcpp
#endif
