// What an executor waits on.
#ifndef READY_QUEUE_HPP_
#define READY_QUEUE_HPP_

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "rclcpp/callback_group.hpp"
#include "rclcpp/timer.hpp"

namespace daidalos
{
/// Ready entities, and the timers of the groups that an executor runs.
class ReadyQueue
{
public:
  /// What to run next; both are null when there is nothing.
  struct Work
  {
    std::shared_ptr<Entity> entity;
    rclcpp::TimerBase::SharedPtr timer;
    rclcpp::CallbackGroup::SharedPtr group;
  };
  using Deadline = std::chrono::steady_clock::time_point;

  void push(const std::shared_ptr<Entity> & entity);
  void add(const rclcpp::TimerBase::SharedPtr & timer);
  void remove(const rclcpp::CallbackGroup::SharedPtr & group);
  /// Let whoever waits look again.
  void wake();
  /// Let whoever waits return with nothing.
  void interrupt();
  /// Return what is ready, its group reserved; wait for it until a deadline.
  Work next(Deadline deadline);

private:
  Work ready(Deadline & until);
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<Entity>> entities_;
  std::vector<std::weak_ptr<rclcpp::TimerBase>> timers_;
  std::uint64_t interrupts_ = 0;
};
}  // namespace daidalos

#endif
