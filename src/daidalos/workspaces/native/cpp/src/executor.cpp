#include "rclcpp/executors.hpp"

#include <algorithm>
#include <exception>
#include <thread>

#include "ready_queue.hpp"

namespace rclcpp
{
using daidalos::ReadyQueue;
using SteadyClock = std::chrono::steady_clock;

namespace
{
ReadyQueue::Deadline deadline_after(std::chrono::nanoseconds timeout)
{
  const auto now = SteadyClock::now();
  return timeout.count() < 0 || timeout > ReadyQueue::Deadline::max() - now ? ReadyQueue::Deadline::max() : now + timeout;
}

/// Run what was taken from the queue, and let its group go, whatever the callback throws.
void run(const ReadyQueue::Work & work, ReadyQueue & queue)
{
  struct End
  {
    const ReadyQueue::Work & work;
    ReadyQueue & queue;
    ~End()
    {
      work.group->end();
      if (work.group->type() == CallbackGroupType::MutuallyExclusive) {
        queue.wake();
      }
    }
  } end{work, queue};
  if (work.timer) {
    work.timer->execute_callback();
  } else if (work.entity->run()) {
    work.entity->notify();
  }
}
}  // namespace

Executor::Executor(const ExecutorOptions &) : queue_(std::make_shared<ReadyQueue>())
{
  std::weak_ptr<ReadyQueue> held = queue_;
  contexts::get_global_default_context()->wake_at_shutdown(held, [held] {
      if (const auto queue = held.lock()) {
        queue->interrupt();
      }
    });
}

Executor::~Executor()
{
  for (const auto & held : nodes_) {
    if (const auto node = held.lock()) {
      node->set_queue(nullptr);
    }
  }
  for (const auto & held : groups_) {
    if (const auto group = held.lock()) {
      group->detach(queue_);
    }
  }
}

void Executor::add_node(NodePtr node, bool)
{
  if (node->queue()) {
    throw std::runtime_error("Node '" + std::string(node->get_fully_qualified_name()) +
            "' has already been added to an executor.");
  }
  {
    std::lock_guard<std::mutex> lock(mutex_);
    nodes_.push_back(node);
  }
  node->set_queue(queue_);
}

void Executor::remove_node(NodePtr node, bool)
{
  if (node->queue() != queue_) {
    throw std::runtime_error("Node '" + std::string(node->get_fully_qualified_name()) +
            "' needs to be associated with this executor.");
  }
  node->set_queue(nullptr);
  std::lock_guard<std::mutex> lock(mutex_);
  const auto same = [&](const auto & held) {return held.expired() || held.lock() == node;};
  nodes_.erase(std::remove_if(nodes_.begin(), nodes_.end(), same), nodes_.end());
}

void Executor::add_callback_group(CallbackGroup::SharedPtr group, NodePtr, bool)
{
  if (group->queue()) {
    throw std::runtime_error("Callback group has already been added to an executor.");
  }
  {
    std::lock_guard<std::mutex> lock(mutex_);
    groups_.push_back(group);
  }
  group->attach(queue_);
}

void Executor::remove_callback_group(CallbackGroup::SharedPtr group, bool) {group->detach(queue_);}

bool Executor::run_next(std::chrono::nanoseconds timeout)
{
  const auto work = queue_->next(deadline_after(timeout));
  if (!work.group) {
    return false;
  }
  run(work, *queue_);
  return true;
}

void Executor::spin_once_for(std::chrono::nanoseconds timeout)
{
  if (rclcpp::ok()) {
    run_next(timeout);
  }
}

void Executor::spin_some(std::chrono::nanoseconds max_duration)
{
  spin_all(max_duration);
}

void Executor::spin_all(std::chrono::nanoseconds max_duration)
{
  if (max_duration.count() < 0) {
    throw std::invalid_argument("max_duration must be greater than or equal to 0");
  }
  const auto end = SteadyClock::now() + max_duration;
  while (rclcpp::ok() && !cancelled_ && run_next(std::chrono::nanoseconds(0))) {
    if (max_duration.count() > 0 && SteadyClock::now() >= end) {
      break;
    }
  }
  cancelled_ = false;
}

void Executor::spin_until_cancelled()
{
  if (spinning_.exchange(true)) {
    throw std::runtime_error("spin() called while already spinning");
  }
  struct Stop
  {
    std::atomic<bool> & spinning;
    ~Stop() {spinning = false;}
  } stop{spinning_};
  while (rclcpp::ok() && !cancelled_) {
    run_next(std::chrono::nanoseconds(-1));
  }
  cancelled_ = false;
}

void Executor::cancel()
{
  cancelled_ = true;
  queue_->interrupt();
}

namespace executors
{
MultiThreadedExecutor::MultiThreadedExecutor(
  const ExecutorOptions & options, std::size_t number_of_threads, bool, std::chrono::nanoseconds)
: Executor(options),
  threads_(number_of_threads > 0 ? number_of_threads : std::max(2u, std::thread::hardware_concurrency()))
{
}

void MultiThreadedExecutor::spin()
{
  if (spinning_.exchange(true)) {
    throw std::runtime_error("spin() called while already spinning");
  }
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
      try {
        while (rclcpp::ok() && !cancelled_) {
          run_next(std::chrono::nanoseconds(-1));
        }
      } catch (...) {
        std::lock_guard<std::mutex> lock(mutex);
        error = std::current_exception();
        cancel();
      }
    };
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < threads_; ++i) {
    threads.emplace_back(work);
  }
  work();
  for (auto & thread : threads) {
    thread.join();
  }
  spinning_ = cancelled_ = false;
  if (error) {
    std::rethrow_exception(error);
  }
}
}  // namespace executors
}  // namespace rclcpp
