// Conversions and transforms of the messages of geometry_msgs.
#ifndef TF2_GEOMETRY_MSGS__TF2_GEOMETRY_MSGS_HPP_
#define TF2_GEOMETRY_MSGS__TF2_GEOMETRY_MSGS_HPP_

#include "geometry_msgs/msg/point_stamped.hpp"
#include "geometry_msgs/msg/pose_stamped.hpp"
#include "geometry_msgs/msg/quaternion_stamped.hpp"
#include "geometry_msgs/msg/transform_stamped.hpp"
#include "geometry_msgs/msg/vector3_stamped.hpp"
#include "tf2/LinearMath/Transform.hpp"
#include "tf2/convert.hpp"
#include "tf2/utils.hpp"

namespace tf2
{
inline geometry_msgs::msg::Vector3 toMsg(const Vector3 & in)
{
  geometry_msgs::msg::Vector3 out;
  out.x = in.x();
  out.y = in.y();
  out.z = in.z();
  return out;
}
inline geometry_msgs::msg::Quaternion toMsg(const Quaternion & in)
{
  geometry_msgs::msg::Quaternion out;
  out.x = in.x();
  out.y = in.y();
  out.z = in.z();
  out.w = in.w();
  return out;
}
inline geometry_msgs::msg::Transform toMsg(const Transform & in)
{
  geometry_msgs::msg::Transform out;
  out.translation = toMsg(in.getOrigin());
  out.rotation = toMsg(in.getRotation());
  return out;
}
inline geometry_msgs::msg::Pose & toMsg(const Transform & in, geometry_msgs::msg::Pose & out)
{
  out.position.x = in.getOrigin().x();
  out.position.y = in.getOrigin().y();
  out.position.z = in.getOrigin().z();
  out.orientation = toMsg(in.getRotation());
  return out;
}
inline geometry_msgs::msg::Point & toMsg(const Vector3 & in, geometry_msgs::msg::Point & out)
{
  out.x = in.x();
  out.y = in.y();
  out.z = in.z();
  return out;
}

inline void fromMsg(const geometry_msgs::msg::Vector3 & in, Vector3 & out) {out = Vector3(in.x, in.y, in.z);}
inline void fromMsg(const geometry_msgs::msg::Point & in, Vector3 & out) {out = Vector3(in.x, in.y, in.z);}
inline void fromMsg(const geometry_msgs::msg::Quaternion & in, Quaternion & out)
{
  out = Quaternion(in.x, in.y, in.z, in.w);
}
inline void fromMsg(const geometry_msgs::msg::Transform & in, Transform & out)
{
  out = Transform(impl::toQuaternion(in.rotation), {in.translation.x, in.translation.y, in.translation.z});
}
inline void fromMsg(const geometry_msgs::msg::Pose & in, Transform & out)
{
  out = Transform(impl::toQuaternion(in.orientation), {in.position.x, in.position.y, in.position.z});
}

namespace impl
{
inline Transform transform_of(const geometry_msgs::msg::TransformStamped & message)
{
  Transform made;
  fromMsg(message.transform, made);
  return made;
}
}  // namespace impl

template<>
inline void doTransform(
  const geometry_msgs::msg::Point & in, geometry_msgs::msg::Point & out,
  const geometry_msgs::msg::TransformStamped & transform)
{
  toMsg(impl::transform_of(transform) * Vector3(in.x, in.y, in.z), out);
}
template<>
inline void doTransform(
  const geometry_msgs::msg::Vector3 & in, geometry_msgs::msg::Vector3 & out,
  const geometry_msgs::msg::TransformStamped & transform)
{
  out = toMsg(impl::transform_of(transform).getBasis() * Vector3(in.x, in.y, in.z));
}
template<>
inline void doTransform(
  const geometry_msgs::msg::Quaternion & in, geometry_msgs::msg::Quaternion & out,
  const geometry_msgs::msg::TransformStamped & transform)
{
  out = toMsg(impl::toQuaternion(transform.transform.rotation) * impl::toQuaternion(in));
}
template<>
inline void doTransform(
  const geometry_msgs::msg::Pose & in, geometry_msgs::msg::Pose & out,
  const geometry_msgs::msg::TransformStamped & transform)
{
  Transform pose;
  fromMsg(in, pose);
  toMsg(impl::transform_of(transform) * pose, out);
}

#define DAIDALOS_TRANSFORM_STAMPED(Type, field) \
  template<> \
  inline void doTransform( \
    const geometry_msgs::msg::Type & in, geometry_msgs::msg::Type & out, \
    const geometry_msgs::msg::TransformStamped & transform) \
  { \
    doTransform(in.field, out.field, transform); \
    out.header.stamp = transform.header.stamp; \
    out.header.frame_id = transform.header.frame_id; \
  }
DAIDALOS_TRANSFORM_STAMPED(PointStamped, point)
DAIDALOS_TRANSFORM_STAMPED(Vector3Stamped, vector)
DAIDALOS_TRANSFORM_STAMPED(QuaternionStamped, quaternion)
DAIDALOS_TRANSFORM_STAMPED(PoseStamped, pose)
#undef DAIDALOS_TRANSFORM_STAMPED
}  // namespace tf2
#endif
