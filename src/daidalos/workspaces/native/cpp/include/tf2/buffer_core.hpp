// Tree of frames over time.
#ifndef TF2__BUFFER_CORE_HPP_
#define TF2__BUFFER_CORE_HPP_

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "geometry_msgs/msg/transform_stamped.hpp"
#include "tf2/LinearMath/Transform.hpp"
#include "tf2/exceptions.hpp"
#include "tf2/time.hpp"

namespace tf2
{
constexpr Duration BUFFER_CORE_DEFAULT_CACHE_TIME = std::chrono::seconds(10);

/// Transforms between frames as they were received, looked up at a time; between two samples they are interpolated.
class BufferCore
{
public:
  explicit BufferCore(Duration cache_time = BUFFER_CORE_DEFAULT_CACHE_TIME) : cache_time_(cache_time) {}
  virtual ~BufferCore() = default;

  void clear()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    frames_.clear();
  }

  /// Add a sample; false where it cannot be used: no names, the frame itself as parent, not a number, or too old.
  bool setTransform(
    const geometry_msgs::msg::TransformStamped & message, const std::string & /*authority*/, bool is_static = false)
  {
    const std::string parent = strip(message.header.frame_id), child = strip(message.child_frame_id);
    const auto & t = message.transform.translation;
    const auto & r = message.transform.rotation;
    const Quaternion q(r.x, r.y, r.z, r.w);
    if (parent.empty() || child.empty() || parent == child || !std::isfinite(t.x + t.y + t.z) ||
      !(std::abs(q.length2() - 1.0) < 1e-2))
    {
      return false;
    }
    const TimePoint stamp(
      std::chrono::seconds(message.header.stamp.sec) + std::chrono::nanoseconds(message.header.stamp.nanosec));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      Frame & frame = frames_[child];
      frames_[parent];
      if (!insert(frame, {stamp, parent, q.normalized(), Vector3(t.x, t.y, t.z)}, is_static)) {
        return false;
      }
    }
    changed_.notify_all();
    return true;
  }

  /// Return the pose of the source frame in the target frame, at a time; TimePointZero: the latest that all share.
  geometry_msgs::msg::TransformStamped lookupTransform(
    const std::string & target, const std::string & source, const TimePoint & time) const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return lookup(strip(target), strip(source), time);
  }
  /// Return the pose of the source frame at one time in the target frame at another, by a frame that does not move.
  geometry_msgs::msg::TransformStamped lookupTransform(
    const std::string & target, const TimePoint & target_time, const std::string & source,
    const TimePoint & source_time, const std::string & fixed) const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto to_fixed = pose(lookup(strip(fixed), strip(source), source_time));
    const auto to_target = lookup(strip(target), strip(fixed), target_time);
    return message(strip(target), strip(source), stamp_of(to_target), pose(to_target) * to_fixed);
  }

  bool canTransform(
    const std::string & target, const std::string & source, const TimePoint & time, std::string * error = nullptr) const
  {
    try {
      lookupTransform(target, source, time);
      return true;
    } catch (const TransformException & why) {
      if (error) {
        *error = why.what();
      }
      return false;
    }
  }

  std::vector<std::string> getAllFrameNames() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<std::string> names;
    for (const auto & [name, frame] : frames_) {
      (void)frame;
      names.push_back(name);
    }
    return names;
  }
  std::string allFramesAsString() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::ostringstream text;
    for (const auto & [name, frame] : frames_) {
      if (!frame.samples.empty()) {
        text << "Frame " << name << " exists with parent " << frame.samples.back().parent << ".\n";
      }
    }
    return text.str();
  }

protected:
  /// Wait until a condition holds or a limit is over; it is tried again whenever a transform has come.
  template<typename ConditionT>
  bool wait(Duration limit, ConditionT holds) const
  {
    const auto end = std::chrono::steady_clock::now() + limit;
    // A transform may come between the try and the wait: so it is tried at least every 10 ms.
    while (!holds()) {
      std::unique_lock<std::mutex> lock(mutex_);
      if (std::chrono::steady_clock::now() >= end) {
        return false;
      }
      changed_.wait_for(lock, std::chrono::milliseconds(10));
    }
    return true;
  }

private:
  struct Sample
  {
    TimePoint stamp;
    std::string parent;
    Quaternion rotation;
    Vector3 translation;
  };
  struct Frame
  {
    bool is_static = false;
    std::deque<Sample> samples;  // by time
  };
  using Step = std::pair<std::string, const Frame *>;

  static std::string strip(const std::string & name) {return !name.empty() && name[0] == '/' ? name.substr(1) : name;}

  bool insert(Frame & frame, Sample sample, bool is_static)
  {
    auto & samples = frame.samples;
    if (is_static || frame.is_static) {
      samples.assign(1, std::move(sample));
      frame.is_static = is_static;
      return true;
    }
    if (!samples.empty() && sample.stamp + cache_time_ < samples.back().stamp) {
      return false;
    }
    auto place = samples.end();
    while (place != samples.begin() && std::prev(place)->stamp > sample.stamp) {
      --place;
    }
    if (place != samples.begin() && std::prev(place)->stamp == sample.stamp) {
      *std::prev(place) = std::move(sample);
    } else {
      samples.insert(place, std::move(sample));
    }
    while (samples.front().stamp + cache_time_ < samples.back().stamp) {
      samples.pop_front();
    }
    return true;
  }

  /// Return the frames from one to the root of its tree.
  std::vector<Step> way_up(const std::string & name) const
  {
    auto found = frames_.find(name);
    if (found == frames_.end()) {
      throw LookupException("\"" + name + "\" passed to lookupTransform argument does not exist. ");
    }
    std::vector<Step> way{{name, &found->second}};
    while (!way.back().second->samples.empty()) {
      const std::string & parent = way.back().second->samples.back().parent;
      if (way.size() > frames_.size()) {
        throw LookupException("the frames form a loop at \"" + parent + "\"");
      }
      way.emplace_back(parent, &frames_.at(parent));
    }
    return way;
  }

  geometry_msgs::msg::TransformStamped lookup(
    const std::string & target, const std::string & source, TimePoint time) const
  {
    auto up = way_up(source), down = way_up(target);
    if (up.back().first != down.back().first) {
      throw ConnectivityException(
              "Could not find a connection between '" + target + "' and '" + source +
              "' because they are not part of the same tree. Tf has two or more unconnected trees.");
    }
    while (up.size() > 1 && down.size() > 1 && up[up.size() - 2].first == down[down.size() - 2].first) {
      up.pop_back();  // what both ways share cancels out, and need not be known at this time
      down.pop_back();
    }
    if (time == TimePointZero) {
      time = latest_common(up, down);
    }
    return message(target, source, time, along(down, time).inverse() * along(up, time));
  }

  static TimePoint latest_common(const std::vector<Step> & up, const std::vector<Step> & down)
  {
    TimePoint latest = TimePoint::max();
    for (const auto * way : {&up, &down}) {
      for (std::size_t i = 0; i + 1 < way->size(); ++i) {
        const Frame & frame = *(*way)[i].second;
        if (!frame.is_static) {
          latest = std::min(latest, frame.samples.back().stamp);
        }
      }
    }
    return latest == TimePoint::max() ? TimePointZero : latest;
  }

  /// Return the pose of the first frame of a way in its last one.
  static Transform along(const std::vector<Step> & way, TimePoint time)
  {
    Transform all;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      all = at(way[i], time) * all;
    }
    return all;
  }

  static Transform at(const Step & step, TimePoint time)
  {
    const auto & samples = step.second->samples;
    if (step.second->is_static) {
      return Transform(samples.front().rotation, samples.front().translation);
    }
    if (time < samples.front().stamp || time > samples.back().stamp) {
      const bool is_future = time > samples.back().stamp;
      std::ostringstream text;
      text.precision(6);
      text << std::fixed << "Lookup would require extrapolation into the " << (is_future ? "future" : "past")
           << ".  Requested time " << timeToSec(time) << " but the " << (is_future ? "latest" : "earliest")
           << " data is at time " << timeToSec(is_future ? samples.back().stamp : samples.front().stamp)
           << ", when looking up transform from frame [" << step.first << "] to frame [" << samples.back().parent
           << "]";
      throw ExtrapolationException(text.str());
    }
    std::size_t after = samples.size() - 1;
    while (after > 0 && samples[after - 1].stamp >= time) {
      --after;
    }
    const Sample & b = samples[after];
    if (b.stamp == time || after == 0) {
      return Transform(b.rotation, b.translation);
    }
    const Sample & a = samples[after - 1];
    const double t = durationToSec(time - a.stamp) / durationToSec(b.stamp - a.stamp);
    return Transform(a.rotation.slerp(b.rotation, t), a.translation.lerp(b.translation, t));
  }

  static geometry_msgs::msg::TransformStamped message(
    const std::string & target, const std::string & source, TimePoint time, const Transform & transform)
  {
    geometry_msgs::msg::TransformStamped made;
    const auto ns = time.time_since_epoch().count();
    made.header.stamp.sec = static_cast<std::int32_t>(ns / 1000000000);
    made.header.stamp.nanosec = static_cast<std::uint32_t>(ns % 1000000000);
    made.header.frame_id = target;
    made.child_frame_id = source;
    const Vector3 & origin = transform.getOrigin();
    const Quaternion rotation = transform.getRotation();
    made.transform.translation.x = origin.x();
    made.transform.translation.y = origin.y();
    made.transform.translation.z = origin.z();
    made.transform.rotation.x = rotation.x();
    made.transform.rotation.y = rotation.y();
    made.transform.rotation.z = rotation.z();
    made.transform.rotation.w = rotation.w();
    return made;
  }
  static Transform pose(const geometry_msgs::msg::TransformStamped & m)
  {
    const auto & t = m.transform.translation;
    const auto & r = m.transform.rotation;
    return Transform(Quaternion(r.x, r.y, r.z, r.w), Vector3(t.x, t.y, t.z));
  }
  static TimePoint stamp_of(const geometry_msgs::msg::TransformStamped & m)
  {
    return TimePoint(std::chrono::seconds(m.header.stamp.sec) + std::chrono::nanoseconds(m.header.stamp.nanosec));
  }

  Duration cache_time_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::map<std::string, Frame> frames_;
};
}  // namespace tf2
#endif
