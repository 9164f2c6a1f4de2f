// Executors.
#ifndef RCLCPP__EXECUTOR_HPP_
#define RCLCPP__EXECUTOR_HPP_

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include "daidalos/node_core.hpp"
#include "rclcpp/future_return_code.hpp"
#include "rclcpp/utilities.hpp"

namespace rclcpp
{
class Node;

struct ExecutorOptions
{
  Context::SharedPtr context;
  std::size_t max_conditions = 0;
};

/// Runs the callbacks of nodes. What becomes ready queues itself; nothing is polled.
class Executor
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS_NOT_COPYABLE(Executor)
  using NodePtr = std::shared_ptr<daidalos::NodeCore>;
  explicit Executor(const ExecutorOptions & options = ExecutorOptions());
  virtual ~Executor();

  virtual void spin() = 0;
  virtual void add_node(NodePtr node, bool notify = true);
  virtual void remove_node(NodePtr node, bool notify = true);
  template<typename NodeT>
  auto add_node(const std::shared_ptr<NodeT> & node, bool notify = true) -> decltype(node->get_node_base_interface(), void())
  {
    add_node(node->get_node_base_interface(), notify);
  }
  template<typename NodeT>
  auto remove_node(const std::shared_ptr<NodeT> & node, bool notify = true)
  -> decltype(node->get_node_base_interface(), void())
  {
    remove_node(node->get_node_base_interface(), notify);
  }
  void add_callback_group(CallbackGroup::SharedPtr group, NodePtr node, bool notify = true);
  void remove_callback_group(CallbackGroup::SharedPtr group, bool notify = true);

  template<typename Rep = std::int64_t, typename Period = std::milli>
  void spin_once(std::chrono::duration<Rep, Period> timeout = std::chrono::duration<Rep, Period>(-1))
  {
    spin_once_for(std::chrono::duration_cast<std::chrono::nanoseconds>(timeout));
  }
  void spin_some(std::chrono::nanoseconds max_duration = std::chrono::nanoseconds(0));
  void spin_all(std::chrono::nanoseconds max_duration);
  template<typename NodeT>
  void spin_node_some(const std::shared_ptr<NodeT> & node) {with_node(node, [this] {spin_some();});}
  template<typename NodeT, typename Rep = std::int64_t, typename Period = std::milli>
  void spin_node_once(
    const std::shared_ptr<NodeT> & node,
    std::chrono::duration<Rep, Period> timeout = std::chrono::duration<Rep, Period>(-1))
  {
    with_node(node, [&] {spin_once(timeout);});
  }
  template<typename FutureT, typename Rep = std::int64_t, typename Period = std::milli>
  FutureReturnCode spin_until_future_complete(
    const FutureT & future, std::chrono::duration<Rep, Period> timeout = std::chrono::duration<Rep, Period>(-1))
  {
    const auto limit = std::chrono::duration_cast<std::chrono::nanoseconds>(timeout);
    const auto end = std::chrono::steady_clock::now() + limit;
    while (future.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      const auto left = end - std::chrono::steady_clock::now();
      if (limit.count() >= 0 && left.count() <= 0) {
        return FutureReturnCode::TIMEOUT;
      }
      if (cancelled_.exchange(false) || !rclcpp::ok()) {
        return FutureReturnCode::INTERRUPTED;
      }
      // A future may also be finished by another thread, which wakes nobody.
      const std::chrono::nanoseconds step = std::chrono::milliseconds(10);
      spin_once_for(limit.count() < 0 ? step : std::min<std::chrono::nanoseconds>(step, left));
    }
    return FutureReturnCode::SUCCESS;
  }
  virtual void cancel();
  bool is_spinning() {return spinning_;}

protected:
  /// Wait for what is ready, and run it; false when time ran out, at cancel() and at shutdown.
  bool run_next(std::chrono::nanoseconds timeout);
  void spin_once_for(std::chrono::nanoseconds timeout);
  void spin_until_cancelled();
  std::atomic<bool> spinning_{false};
  std::atomic<bool> cancelled_{false};

private:
  template<typename NodeT, typename F>
  void with_node(const std::shared_ptr<NodeT> & node, F run)
  {
    add_node(node);
    run();
    remove_node(node);
  }
  std::shared_ptr<daidalos::ReadyQueue> queue_;
  std::mutex mutex_;
  std::vector<std::weak_ptr<daidalos::NodeCore>> nodes_;
  std::vector<CallbackGroup::WeakPtr> groups_;
};
}  // namespace rclcpp
#endif
