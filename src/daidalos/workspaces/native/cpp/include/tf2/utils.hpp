// Angles of orientations.
#ifndef TF2__UTILS_HPP_
#define TF2__UTILS_HPP_

#include "geometry_msgs/msg/quaternion.hpp"
#include "geometry_msgs/msg/quaternion_stamped.hpp"
#include "tf2/LinearMath/Matrix3x3.hpp"

namespace tf2
{
namespace impl
{
inline Quaternion toQuaternion(const Quaternion & q) {return q;}
inline Quaternion toQuaternion(const geometry_msgs::msg::Quaternion & q) {return {q.x, q.y, q.z, q.w};}
inline Quaternion toQuaternion(const geometry_msgs::msg::QuaternionStamped & q) {return toQuaternion(q.quaternion);}
}  // namespace impl

/// Store the angles [rad] of an orientation: yaw about Z, then pitch about Y, then roll about X.
template<class A>
void getEulerYPR(const A & orientation, double & yaw, double & pitch, double & roll)
{
  Matrix3x3(impl::toQuaternion(orientation)).getRPY(roll, pitch, yaw);
}

/// Return the yaw of an orientation [rad].
template<class A>
double getYaw(const A & orientation)
{
  double yaw, pitch, roll;
  getEulerYPR(orientation, yaw, pitch, roll);
  return yaw;
}
}  // namespace tf2
#endif
