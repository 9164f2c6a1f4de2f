// Conversions between messages and other types; those of geometry_msgs are in tf2_geometry_msgs.
#ifndef TF2__CONVERT_HPP_
#define TF2__CONVERT_HPP_

#include <string>

#include "geometry_msgs/msg/transform_stamped.hpp"
#include "tf2/time.hpp"

namespace tf2
{
/// Transform `in`; each type that can be transformed has a function of its own.
template<class T>
void doTransform(const T & in, T & out, const geometry_msgs::msg::TransformStamped & transform);

template<typename T>
TimePoint getTimestamp(const T & stamped)
{
  const auto & stamp = stamped.header.stamp;
  return TimePoint(std::chrono::seconds(stamp.sec) + std::chrono::nanoseconds(stamp.nanosec));
}
template<typename T>
std::string getFrameId(const T & stamped) {return stamped.header.frame_id;}

/// Convert one type to another, by its `fromMsg`.
template<class A, class B>
void convert(const A & a, B & b) {fromMsg(a, b);}
}  // namespace tf2
#endif
