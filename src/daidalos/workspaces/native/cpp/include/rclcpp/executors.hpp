// The executors, and functions that run one node.
#ifndef RCLCPP__EXECUTORS_HPP_
#define RCLCPP__EXECUTORS_HPP_

#include "rclcpp/executor.hpp"

namespace rclcpp
{
namespace executors
{
class SingleThreadedExecutor : public Executor
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(SingleThreadedExecutor)
  using Executor::Executor;
  void spin() override {spin_until_cancelled();}
};
/// Upstream's variants differ in how they wait; ours never collects entities anew.
class StaticSingleThreadedExecutor : public SingleThreadedExecutor
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(StaticSingleThreadedExecutor)
  using SingleThreadedExecutor::SingleThreadedExecutor;
};
class MultiThreadedExecutor : public Executor
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(MultiThreadedExecutor)
  explicit MultiThreadedExecutor(
    const ExecutorOptions & options = ExecutorOptions(), std::size_t number_of_threads = 0,
    bool yield_before_execute = false, std::chrono::nanoseconds timeout = std::chrono::nanoseconds(-1));
  void spin() override;
  std::size_t get_number_of_threads() {return threads_;}

private:
  std::size_t threads_;
};
template<typename NodeT, typename FutureT, typename Rep = std::int64_t, typename Period = std::milli>
FutureReturnCode spin_node_until_future_complete(
  Executor & executor, const std::shared_ptr<NodeT> & node, const FutureT & future,
  std::chrono::duration<Rep, Period> timeout = std::chrono::duration<Rep, Period>(-1))
{
  executor.add_node(node);
  const auto code = executor.spin_until_future_complete(future, timeout);
  executor.remove_node(node);
  return code;
}
}  // namespace executors
namespace experimental::executors
{
class EventsExecutor : public rclcpp::executors::SingleThreadedExecutor
{
public:
  RCLCPP_SMART_PTR_DEFINITIONS(EventsExecutor)
  using SingleThreadedExecutor::SingleThreadedExecutor;
};
}  // namespace experimental::executors

template<typename NodeT>
void spin(const std::shared_ptr<NodeT> & node)
{
  executors::SingleThreadedExecutor executor;
  executor.add_node(node);
  executor.spin();
  executor.remove_node(node);
}
template<typename NodeT>
void spin_some(const std::shared_ptr<NodeT> & node)
{
  executors::SingleThreadedExecutor executor;
  executor.spin_node_some(node);
}
template<typename NodeT>
void spin_all(const std::shared_ptr<NodeT> & node, std::chrono::nanoseconds max_duration)
{
  executors::SingleThreadedExecutor executor;
  executor.add_node(node);
  executor.spin_all(max_duration);
  executor.remove_node(node);
}
template<typename NodeT, typename FutureT, typename Rep = std::int64_t, typename Period = std::milli>
FutureReturnCode spin_until_future_complete(
  const std::shared_ptr<NodeT> & node, const FutureT & future,
  std::chrono::duration<Rep, Period> timeout = std::chrono::duration<Rep, Period>(-1))
{
  executors::SingleThreadedExecutor executor;
  return executors::spin_node_until_future_complete(executor, node, future, timeout);
}
}  // namespace rclcpp
#endif
