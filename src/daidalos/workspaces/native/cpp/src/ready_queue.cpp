#include "ready_queue.hpp"

#include <algorithm>

namespace daidalos
{
void ReadyQueue::push(const std::shared_ptr<Entity> & entity)
{
  {
    std::lock_guard<std::mutex> lock(mutex_);
    if (entity->queued_.exchange(true)) {
      return;
    }
    entities_.push_back(entity);
  }
  changed_.notify_one();
}

void ReadyQueue::add(const rclcpp::TimerBase::SharedPtr & timer)
{
  {
    std::lock_guard<std::mutex> lock(mutex_);
    timers_.push_back(timer);
  }
  changed_.notify_all();
}

void ReadyQueue::remove(const rclcpp::CallbackGroup::SharedPtr & group)
{
  std::lock_guard<std::mutex> lock(mutex_);
  const auto gone = [&](const std::shared_ptr<Entity> & entity) {
      if (entity->group() != group) {
        return false;
      }
      entity->queued_ = false;
      return true;
    };
  entities_.erase(std::remove_if(entities_.begin(), entities_.end(), gone), entities_.end());
  const auto of_group = [&](const std::weak_ptr<rclcpp::TimerBase> & held) {
      const auto timer = held.lock();
      return !timer || timer->group() == group;
    };
  timers_.erase(std::remove_if(timers_.begin(), timers_.end(), of_group), timers_.end());
}

void ReadyQueue::wake()
{
  {std::lock_guard<std::mutex> lock(mutex_);}
  changed_.notify_all();
}

void ReadyQueue::interrupt()
{
  {
    std::lock_guard<std::mutex> lock(mutex_);
    ++interrupts_;
  }
  changed_.notify_all();
}

ReadyQueue::Work ReadyQueue::ready(Deadline & until)
{
  for (auto held = timers_.begin(); held != timers_.end(); ) {
    const auto timer = held->lock();
    if (!timer) {
      held = timers_.erase(held);
      continue;
    }
    ++held;
    if (timer->is_canceled()) {
      continue;
    }
    const auto left = timer->time_until_trigger();
    const auto group = timer->group();
    if (left.count() > 0) {
      if (!timer->waits_for_simulation()) {
        until = std::min(until, std::chrono::steady_clock::now() + left);
      }
    } else if (group && group->try_begin()) {
      if (timer->begin()) {
        return {nullptr, timer, group};
      }
      group->end();
    }
  }
  for (auto at = entities_.begin(); at != entities_.end(); ) {
    const auto entity = *at;
    const auto group = entity->group();
    if (group && !group->try_begin()) {
      ++at;
      continue;
    }
    entities_.erase(at);
    entity->queued_ = false;
    if (group) {
      return {entity, nullptr, group};
    }
    at = entities_.begin();
  }
  return {};
}

ReadyQueue::Work ReadyQueue::next(Deadline deadline)
{
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t interrupts = interrupts_;
  while (true) {
    Deadline until = deadline;
    Work work = ready(until);
    if (work.entity || work.timer) {
      return work;
    }
    if (interrupts_ != interrupts || std::chrono::steady_clock::now() >= deadline) {
      return {};
    }
    if (until == Deadline::max()) {
      changed_.wait(lock);
    } else {
      changed_.wait_until(lock, until);
    }
  }
}

void Entity::notify()
{
  ready_ = true;
  if (const auto group = group_.lock()) {
    if (const auto queue = group->queue()) {
      queue->push(shared_from_this());
    }
  }
}

void Entity::join(const std::shared_ptr<rclcpp::CallbackGroup> & group)
{
  group_ = group;
  group->add(shared_from_this());
}
}  // namespace daidalos

namespace rclcpp
{
std::shared_ptr<daidalos::ReadyQueue> CallbackGroup::queue() const
{
  std::lock_guard<std::mutex> lock(mutex_);
  return queue_.lock();
}

void CallbackGroup::attach(const std::shared_ptr<daidalos::ReadyQueue> & queue)
{
  std::vector<std::shared_ptr<daidalos::Entity>> ready;
  std::vector<TimerBase::SharedPtr> running;
  {
    std::lock_guard<std::mutex> lock(mutex_);
    queue_ = queue;
    for (const auto & held : entities_) {
      if (auto entity = held.lock(); entity && entity->ready_) {
        ready.push_back(entity);
      }
    }
    for (const auto & held : timers_) {
      if (auto timer = held.lock()) {
        running.push_back(timer);
      }
    }
  }
  for (const auto & timer : running) {
    queue->add(timer);
  }
  for (const auto & entity : ready) {
    queue->push(entity);
  }
}

void CallbackGroup::detach(const std::shared_ptr<daidalos::ReadyQueue> & queue)
{
  {
    std::lock_guard<std::mutex> lock(mutex_);
    if (queue_.lock() != queue) {
      return;
    }
    queue_.reset();
  }
  queue->remove(shared_from_this());
}

void CallbackGroup::add(const std::shared_ptr<daidalos::Entity> & entity)
{
  std::lock_guard<std::mutex> lock(mutex_);
  const auto gone = [](const auto & held) {return held.expired();};
  entities_.erase(std::remove_if(entities_.begin(), entities_.end(), gone), entities_.end());
  entities_.push_back(entity);
}

void CallbackGroup::add(const TimerBase::SharedPtr & timer)
{
  std::shared_ptr<daidalos::ReadyQueue> queue;
  {
    std::lock_guard<std::mutex> lock(mutex_);
    const auto gone = [](const auto & held) {return held.expired();};
    timers_.erase(std::remove_if(timers_.begin(), timers_.end(), gone), timers_.end());
    timers_.push_back(timer);
    queue = queue_.lock();
  }
  if (queue) {
    queue->add(timer);
  }
}

TimerBase::TimerBase(
  Clock::SharedPtr clock, std::chrono::nanoseconds period, std::function<void(TimerBase &)> callback, bool autostart)
: clock_(std::move(clock)), period_ns_(period.count()), callback_(std::move(callback)),
  next_ns_(clock_->now().nanoseconds() + period_ns_), canceled_(!autostart)
{
  if (period_ns_ < 0) {
    throw std::invalid_argument("timer period cannot be negative");
  }
}

void TimerBase::join(const CallbackGroup::SharedPtr & group)
{
  group_ = group;
  group->add(shared_from_this());
  if (clock_->get_clock_type() == RCL_ROS_TIME) {
    std::weak_ptr<TimerBase> held = weak_from_this();
    clock_->on_change([held] {
        const auto timer = held.lock();
        if (!timer) {
          return;
        }
        const std::int64_t latest = timer->clock_->now().nanoseconds() + timer->period_ns_;
        if (timer->next_ns_ > latest) {  // time was set back
          timer->next_ns_ = latest;
        }
        const auto own = timer->group();
        if (const auto queue = own ? own->queue() : nullptr) {
          queue->wake();
        }
      });
  }
}

void TimerBase::cancel() {canceled_ = true;}

void TimerBase::reset()
{
  next_ns_ = clock_->now().nanoseconds() + period_ns_;
  canceled_ = false;
  if (const auto own = group()) {
    if (const auto queue = own->queue()) {
      queue->wake();
    }
  }
}

std::chrono::nanoseconds TimerBase::time_until_trigger()
{
  if (canceled_) {
    return std::chrono::nanoseconds::max();
  }
  return std::chrono::nanoseconds(next_ns_ - clock_->now().nanoseconds());
}

bool TimerBase::begin()
{
  const std::int64_t now = clock_->now().nanoseconds();
  std::int64_t due = next_ns_;
  if (canceled_ || due > now) {
    return false;
  }
  // Periods that passed meanwhile are skipped; the phase stays.
  const std::int64_t behind = period_ns_ > 0 ? (now - due) / period_ns_ : 0;
  return next_ns_.compare_exchange_strong(due, period_ns_ > 0 ? due + (behind + 1) * period_ns_ : now);
}
}  // namespace rclcpp
