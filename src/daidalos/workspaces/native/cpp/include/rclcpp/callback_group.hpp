// Callback groups, and what becomes ready in them.
#ifndef RCLCPP__CALLBACK_GROUP_HPP_
#define RCLCPP__CALLBACK_GROUP_HPP_

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "rclcpp/macros.hpp"

namespace rclcpp
{
class CallbackGroup;
class TimerBase;
}

namespace daidalos
{
class ReadyQueue;

/// Base of what has callbacks that run when something came in.
class Entity : public std::enable_shared_from_this<Entity>
{
public:
  virtual ~Entity() = default;
  /// Take one item and run its callback; true when there is more.
  virtual bool run() = 0;
  /// Tell the executor of the group that something is ready.
  void notify();
  void join(const std::shared_ptr<rclcpp::CallbackGroup> & group);
  std::shared_ptr<rclcpp::CallbackGroup> group() const {return group_.lock();}

private:
  friend class ReadyQueue;
  friend class rclcpp::CallbackGroup;
  std::weak_ptr<rclcpp::CallbackGroup> group_;
  std::atomic<bool> ready_{false};
  std::atomic<bool> queued_{false};
};
}  // namespace daidalos

namespace rclcpp
{
enum class CallbackGroupType {MutuallyExclusive, Reentrant};

/// Entities of which at most one runs at a time, or any number when reentrant.
class CallbackGroup : public std::enable_shared_from_this<CallbackGroup>
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(CallbackGroup)
  explicit CallbackGroup(CallbackGroupType type, bool automatically_add_to_executor_with_node = true)
  : type_(type), automatic_(automatically_add_to_executor_with_node) {}

  CallbackGroupType type() const {return type_;}
  bool automatically_add_to_executor_with_node() const {return automatic_;}

  // The executor's side.
  bool try_begin() {return type_ == CallbackGroupType::Reentrant || !busy_.exchange(true);}
  void end() {busy_ = false;}
  void attach(const std::shared_ptr<daidalos::ReadyQueue> & queue);
  void detach(const std::shared_ptr<daidalos::ReadyQueue> & queue);
  std::shared_ptr<daidalos::ReadyQueue> queue() const;
  void add(const std::shared_ptr<daidalos::Entity> & entity);
  void add(const std::shared_ptr<TimerBase> & timer);

private:
  const CallbackGroupType type_;
  const bool automatic_;
  std::atomic<bool> busy_{false};
  mutable std::mutex mutex_;
  std::weak_ptr<daidalos::ReadyQueue> queue_;
  std::vector<std::weak_ptr<daidalos::Entity>> entities_;
  std::vector<std::weak_ptr<TimerBase>> timers_;
};
}  // namespace rclcpp
#endif
