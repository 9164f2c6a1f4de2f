// Rotations as matrices.
#ifndef TF2__LINEARMATH__MATRIX3X3_HPP_
#define TF2__LINEARMATH__MATRIX3X3_HPP_

#include <algorithm>
#include <cmath>

#include "tf2/LinearMath/Quaternion.hpp"

namespace tf2
{
/// Matrix of three rows.
class Matrix3x3
{
public:
  Matrix3x3() = default;
  explicit Matrix3x3(const Quaternion & q) {setRotation(q);}
  Matrix3x3(
    tf2Scalar xx, tf2Scalar xy, tf2Scalar xz, tf2Scalar yx, tf2Scalar yy, tf2Scalar yz, tf2Scalar zx, tf2Scalar zy,
    tf2Scalar zz)
  : rows_{{xx, xy, xz}, {yx, yy, yz}, {zx, zy, zz}} {}
  static Matrix3x3 getIdentity() {return {1, 0, 0, 0, 1, 0, 0, 0, 1};}

  Vector3 & operator[](int i) {return rows_[i];}
  const Vector3 & operator[](int i) const {return rows_[i];}
  const Vector3 & getRow(int i) const {return rows_[i];}
  Vector3 getColumn(int i) const {return {rows_[0][i], rows_[1][i], rows_[2][i]};}
  void setIdentity() {*this = getIdentity();}
  void setValue(
    tf2Scalar xx, tf2Scalar xy, tf2Scalar xz, tf2Scalar yx, tf2Scalar yy, tf2Scalar yz, tf2Scalar zx, tf2Scalar zy,
    tf2Scalar zz)
  {
    *this = Matrix3x3(xx, xy, xz, yx, yy, yz, zx, zy, zz);
  }

  void setRotation(const Quaternion & q)
  {
    const Quaternion u = q.normalized();
    const Vector3 x = quatRotate(u, {1, 0, 0}), y = quatRotate(u, {0, 1, 0}), z = quatRotate(u, {0, 0, 1});
    *this = Matrix3x3(x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z());
  }
  /// Store the rotation in a quaternion, from the largest of its components (Shepperd 1978).
  void getRotation(Quaternion & q) const
  {
    const auto & m = rows_;
    const tf2Scalar trace = m[0][0] + m[1][1] + m[2][2];
    if (trace > 0.0) {
      const tf2Scalar s = 2.0 * std::sqrt(trace + 1.0);
      q = Quaternion((m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, s / 4.0);
      return;
    }
    const int i = m[1][1] > m[0][0] ? (m[2][2] > m[1][1] ? 2 : 1) : (m[2][2] > m[0][0] ? 2 : 0);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const tf2Scalar s = 2.0 * std::sqrt(m[i][i] - m[j][j] - m[k][k] + 1.0);
    q[i] = s / 4.0;
    q[j] = (m[j][i] + m[i][j]) / s;
    q[k] = (m[k][i] + m[i][k]) / s;
    q[3] = (m[k][j] - m[j][k]) / s;
  }
  void setRPY(tf2Scalar roll, tf2Scalar pitch, tf2Scalar yaw)
  {
    Quaternion q;
    q.setRPY(roll, pitch, yaw);
    setRotation(q);
  }
  void setEulerYPR(tf2Scalar yaw, tf2Scalar pitch, tf2Scalar roll) {setRPY(roll, pitch, yaw);}
  /// Store the angles [rad] about the fixed axes X, Y, Z; roll is 0 where the pitch is a right angle.
  void getRPY(tf2Scalar & roll, tf2Scalar & pitch, tf2Scalar & yaw, unsigned int = 1) const
  {
    const auto & m = rows_;
    pitch = std::asin(std::clamp(-m[2][0], -1.0, 1.0));
    if (std::abs(m[2][0]) < 1.0 - 1e-12) {
      roll = std::atan2(m[2][1], m[2][2]);
      yaw = std::atan2(m[1][0], m[0][0]);
    } else {
      roll = 0.0;
      yaw = std::atan2(-m[0][1], m[1][1]);
    }
  }
  void getEulerYPR(tf2Scalar & yaw, tf2Scalar & pitch, tf2Scalar & roll, unsigned int = 1) const
  {
    getRPY(roll, pitch, yaw);
  }
  Matrix3x3 transpose() const
  {
    const auto & m = rows_;
    return {m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1], m[0][2], m[1][2], m[2][2]};
  }
  Vector3 operator*(const Vector3 & v) const {return {rows_[0].dot(v), rows_[1].dot(v), rows_[2].dot(v)};}
  Matrix3x3 operator*(const Matrix3x3 & o) const
  {
    const Matrix3x3 t = o.transpose();
    Matrix3x3 made;
    for (int i = 0; i < 3; ++i) {
      made[i] = Vector3(rows_[i].dot(t[0]), rows_[i].dot(t[1]), rows_[i].dot(t[2]));
    }
    return made;
  }

private:
  Vector3 rows_[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};
}  // namespace tf2
#endif
