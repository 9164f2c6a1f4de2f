// Rigid transforms.
#ifndef TF2__LINEARMATH__TRANSFORM_HPP_
#define TF2__LINEARMATH__TRANSFORM_HPP_

#include "tf2/LinearMath/Matrix3x3.hpp"

namespace tf2
{
/// Rotation, then translation.
class Transform
{
public:
  Transform() = default;
  explicit Transform(const Quaternion & rotation, const Vector3 & origin = Vector3())
  : basis_(rotation), origin_(origin) {}
  explicit Transform(const Matrix3x3 & basis, const Vector3 & origin = Vector3()) : basis_(basis), origin_(origin) {}
  static Transform getIdentity() {return Transform();}

  const Vector3 & getOrigin() const {return origin_;}
  Vector3 & getOrigin() {return origin_;}
  const Matrix3x3 & getBasis() const {return basis_;}
  Matrix3x3 & getBasis() {return basis_;}
  Quaternion getRotation() const
  {
    Quaternion q;
    basis_.getRotation(q);
    return q;
  }
  void setOrigin(const Vector3 & origin) {origin_ = origin;}
  void setBasis(const Matrix3x3 & basis) {basis_ = basis;}
  void setRotation(const Quaternion & q) {basis_.setRotation(q);}
  void setIdentity() {*this = Transform();}

  Transform inverse() const
  {
    const Matrix3x3 back = basis_.transpose();
    return Transform(back, -(back * origin_));
  }
  Vector3 operator*(const Vector3 & v) const {return basis_ * v + origin_;}
  Vector3 operator()(const Vector3 & v) const {return *this * v;}
  Quaternion operator*(const Quaternion & q) const {return getRotation() * q;}
  Transform operator*(const Transform & o) const {return Transform(basis_ * o.basis_, *this * o.origin_);}
  Transform & operator*=(const Transform & o) {return *this = *this * o;}
  Transform inverseTimes(const Transform & o) const {return inverse() * o;}

private:
  Matrix3x3 basis_;
  Vector3 origin_;
};
}  // namespace tf2
#endif
