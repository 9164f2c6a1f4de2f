// Vectors in three dimensions.
#ifndef TF2__LINEARMATH__VECTOR3_HPP_
#define TF2__LINEARMATH__VECTOR3_HPP_

#include <cmath>

using tf2Scalar = double;
#define TF2SIMD_PI 3.14159265358979323846

namespace tf2
{
/// Vector with the components x, y and z.
class Vector3
{
public:
  Vector3() = default;
  Vector3(tf2Scalar x, tf2Scalar y, tf2Scalar z) : m_floats{x, y, z, 0.0} {}

  tf2Scalar x() const {return m_floats[0];}
  tf2Scalar y() const {return m_floats[1];}
  tf2Scalar z() const {return m_floats[2];}
  tf2Scalar getX() const {return x();}
  tf2Scalar getY() const {return y();}
  tf2Scalar getZ() const {return z();}
  void setX(tf2Scalar x) {m_floats[0] = x;}
  void setY(tf2Scalar y) {m_floats[1] = y;}
  void setZ(tf2Scalar z) {m_floats[2] = z;}
  void setValue(tf2Scalar x, tf2Scalar y, tf2Scalar z) {*this = Vector3(x, y, z);}
  tf2Scalar & operator[](int i) {return m_floats[i];}
  const tf2Scalar & operator[](int i) const {return m_floats[i];}

  Vector3 operator-() const {return {-x(), -y(), -z()};}
  Vector3 & operator+=(const Vector3 & o) {return *this = Vector3(x() + o.x(), y() + o.y(), z() + o.z());}
  Vector3 & operator-=(const Vector3 & o) {return *this += -o;}
  Vector3 & operator*=(tf2Scalar s) {return *this = Vector3(x() * s, y() * s, z() * s);}
  Vector3 & operator/=(tf2Scalar s) {return *this *= 1.0 / s;}
  bool operator==(const Vector3 & o) const {return x() == o.x() && y() == o.y() && z() == o.z();}
  bool operator!=(const Vector3 & o) const {return !(*this == o);}

  tf2Scalar dot(const Vector3 & o) const {return x() * o.x() + y() * o.y() + z() * o.z();}
  Vector3 cross(const Vector3 & o) const
  {
    return {y() * o.z() - z() * o.y(), z() * o.x() - x() * o.z(), x() * o.y() - y() * o.x()};
  }
  tf2Scalar length2() const {return dot(*this);}
  tf2Scalar length() const {return std::sqrt(length2());}
  Vector3 & normalize() {return *this /= length();}
  Vector3 normalized() const {return Vector3(*this).normalize();}
  tf2Scalar distance(const Vector3 & o) const {return Vector3(*this).operator-=(o).length();}
  tf2Scalar distance2(const Vector3 & o) const {return Vector3(*this).operator-=(o).length2();}
  tf2Scalar angle(const Vector3 & o) const {return std::acos(dot(o) / std::sqrt(length2() * o.length2()));}
  /// Interpolate: this vector where t is 0, the other where it is 1.
  Vector3 lerp(const Vector3 & o, tf2Scalar t) const
  {
    return {x() + (o.x() - x()) * t, y() + (o.y() - y()) * t, z() + (o.z() - z()) * t};
  }

private:
  tf2Scalar m_floats[4] = {0.0, 0.0, 0.0, 0.0};
};

inline Vector3 operator+(Vector3 a, const Vector3 & b) {return a += b;}
inline Vector3 operator-(Vector3 a, const Vector3 & b) {return a -= b;}
inline Vector3 operator*(Vector3 a, tf2Scalar s) {return a *= s;}
inline Vector3 operator*(tf2Scalar s, Vector3 a) {return a *= s;}
inline Vector3 operator/(Vector3 a, tf2Scalar s) {return a /= s;}
inline tf2Scalar tf2Dot(const Vector3 & a, const Vector3 & b) {return a.dot(b);}
}  // namespace tf2
#endif
