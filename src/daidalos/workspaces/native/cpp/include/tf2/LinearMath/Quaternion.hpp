// Rotations as unit quaternions.
#ifndef TF2__LINEARMATH__QUATERNION_HPP_
#define TF2__LINEARMATH__QUATERNION_HPP_

#include <algorithm>
#include <cmath>

#include "tf2/LinearMath/Vector3.hpp"

namespace tf2
{
/// Quaternion x, y, z, w; not normalised by itself.
class Quaternion
{
public:
  Quaternion() = default;
  Quaternion(tf2Scalar x, tf2Scalar y, tf2Scalar z, tf2Scalar w) : m_floats{x, y, z, w} {}
  Quaternion(const Vector3 & axis, tf2Scalar angle) {setRotation(axis, angle);}
  static Quaternion getIdentity() {return {0.0, 0.0, 0.0, 1.0};}

  tf2Scalar x() const {return m_floats[0];}
  tf2Scalar y() const {return m_floats[1];}
  tf2Scalar z() const {return m_floats[2];}
  tf2Scalar w() const {return m_floats[3];}
  tf2Scalar getX() const {return x();}
  tf2Scalar getY() const {return y();}
  tf2Scalar getZ() const {return z();}
  tf2Scalar getW() const {return w();}
  void setX(tf2Scalar x) {m_floats[0] = x;}
  void setY(tf2Scalar y) {m_floats[1] = y;}
  void setZ(tf2Scalar z) {m_floats[2] = z;}
  void setW(tf2Scalar w) {m_floats[3] = w;}
  void setValue(tf2Scalar x, tf2Scalar y, tf2Scalar z, tf2Scalar w) {*this = Quaternion(x, y, z, w);}
  tf2Scalar & operator[](int i) {return m_floats[i];}
  const tf2Scalar & operator[](int i) const {return m_floats[i];}

  /// Set a rotation by an angle [rad] about an axis.
  void setRotation(const Vector3 & axis, tf2Scalar angle)
  {
    const tf2Scalar s = std::sin(angle / 2) / axis.length();
    *this = Quaternion(axis.x() * s, axis.y() * s, axis.z() * s, std::cos(angle / 2));
  }
  /// Set a rotation by angles [rad] about the fixed axes X (roll), Y (pitch) and Z (yaw), in this order.
  void setRPY(tf2Scalar roll, tf2Scalar pitch, tf2Scalar yaw)
  {
    const Vector3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
    *this = Quaternion(z, yaw) * Quaternion(y, pitch) * Quaternion(x, roll);
  }
  /// Set a rotation by angles [rad] about Z (yaw), the new Y (pitch) and the new X (roll).
  void setEulerZYX(tf2Scalar yaw, tf2Scalar pitch, tf2Scalar roll) {setRPY(roll, pitch, yaw);}

  Quaternion operator-() const {return {-x(), -y(), -z(), -w()};}
  Quaternion & operator+=(const Quaternion & o)
  {
    return *this = Quaternion(x() + o.x(), y() + o.y(), z() + o.z(), w() + o.w());
  }
  Quaternion & operator-=(const Quaternion & o) {return *this += -o;}
  Quaternion & operator*=(tf2Scalar s) {return *this = Quaternion(x() * s, y() * s, z() * s, w() * s);}
  Quaternion & operator/=(tf2Scalar s) {return *this *= 1.0 / s;}
  Quaternion operator*(const Quaternion & o) const
  {
    return {
      w() * o.x() + x() * o.w() + y() * o.z() - z() * o.y(),
      w() * o.y() + y() * o.w() + z() * o.x() - x() * o.z(),
      w() * o.z() + z() * o.w() + x() * o.y() - y() * o.x(),
      w() * o.w() - x() * o.x() - y() * o.y() - z() * o.z()};
  }
  Quaternion & operator*=(const Quaternion & o) {return *this = *this * o;}
  bool operator==(const Quaternion & o) const
  {
    return x() == o.x() && y() == o.y() && z() == o.z() && w() == o.w();
  }
  bool operator!=(const Quaternion & o) const {return !(*this == o);}

  tf2Scalar dot(const Quaternion & o) const {return x() * o.x() + y() * o.y() + z() * o.z() + w() * o.w();}
  tf2Scalar length2() const {return dot(*this);}
  tf2Scalar length() const {return std::sqrt(length2());}
  Quaternion & normalize() {return *this /= length();}
  Quaternion normalized() const {return Quaternion(*this).normalize();}
  Quaternion inverse() const {return {-x(), -y(), -z(), w()};}
  tf2Scalar getAngle() const {return 2.0 * std::acos(std::clamp(w(), -1.0, 1.0));}
  Vector3 getAxis() const
  {
    const tf2Scalar s = std::sqrt(std::max(0.0, 1.0 - w() * w()));
    return s < 1e-9 ? Vector3(1.0, 0.0, 0.0) : Vector3(x() / s, y() / s, z() / s);
  }
  /// Return half of the angle between two rotations [rad].
  tf2Scalar angle(const Quaternion & o) const
  {
    return std::acos(std::clamp(dot(o) / std::sqrt(length2() * o.length2()), -1.0, 1.0));
  }
  /// Return the angle of the rotation between two rotations, on the shorter way [rad].
  tf2Scalar angleShortestPath(const Quaternion & o) const
  {
    return 2.0 * std::acos(std::min(1.0, std::abs(dot(o)) / std::sqrt(length2() * o.length2())));
  }
  /// Interpolate on the shorter way: this rotation where t is 0, the other where it is 1.
  Quaternion slerp(const Quaternion & o, tf2Scalar t) const
  {
    const tf2Scalar sign = dot(o) < 0 ? -1.0 : 1.0;
    const tf2Scalar theta = angleShortestPath(o) / 2.0;
    tf2Scalar a = 1.0 - t, b = t;
    if (theta > 1e-9) {
      a = std::sin((1.0 - t) * theta) / std::sin(theta);
      b = std::sin(t * theta) / std::sin(theta);
    }
    b *= sign;
    return {a * x() + b * o.x(), a * y() + b * o.y(), a * z() + b * o.z(), a * w() + b * o.w()};
  }

private:
  tf2Scalar m_floats[4] = {0.0, 0.0, 0.0, 1.0};
};

inline Quaternion operator+(Quaternion a, const Quaternion & b) {return a += b;}
inline Quaternion operator-(Quaternion a, const Quaternion & b) {return a -= b;}
inline Quaternion operator*(Quaternion a, tf2Scalar s) {return a *= s;}
inline Quaternion operator/(Quaternion a, tf2Scalar s) {return a /= s;}
inline Quaternion inverse(const Quaternion & q) {return q.inverse();}
inline Quaternion slerp(const Quaternion & a, const Quaternion & b, tf2Scalar t) {return a.slerp(b, t);}
inline tf2Scalar length(const Quaternion & q) {return q.length();}
inline tf2Scalar angleShortestPath(const Quaternion & a, const Quaternion & b) {return a.angleShortestPath(b);}

/// Rotate a vector.
inline Vector3 quatRotate(const Quaternion & q, const Vector3 & v)
{
  const Vector3 u(q.x(), q.y(), q.z()), t = 2.0 * u.cross(v);
  return v + q.w() * t + u.cross(t);
}
}  // namespace tf2
#endif
