// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HandEyeMotions.h"

#include "RigidTransform.h"

namespace handeye
{

namespace
{

/// The rotation vector, |v| <= pi.
Eigen::Vector3d logarithm(const Eigen::Matrix3d& rotation)
{
  const Eigen::AngleAxisd turn{ Eigen::Quaterniond(rotation) };
  return turn.angle() * turn.axis();
}

Eigen::Vector3d cameraTurn(const HandEyeMotion& motion)
{
  return logarithm(motion.camera.linear());
}

/// The translation, once the rotation is known:  (R_C - I) t = R t_M - t_C  for all motions (Tsai and Lenz eq. 15, Park and Martin
/// eq. 21, Horaud and Dornaika eq. 8).
Eigen::Vector3d solveTranslation(const std::vector<HandEyeMotion>& motions, const Eigen::Matrix3d& rotation)
{
  const Eigen::Index count = Eigen::Index(motions.size());
  Eigen::MatrixXd left(3 * count, 3);
  Eigen::VectorXd right(3 * count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const HandEyeMotion& motion = motions[std::size_t(i)];
    left.middleRows<3>(3 * i) = motion.camera.linear() - Eigen::Matrix3d::Identity();
    right.segment<3>(3 * i) = rotation * motion.marker.translation() - motion.camera.translation();
  }
  return left.colPivHouseholderQr().solve(right);
}

Eigen::Isometry3d compose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation)
{
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = rotation;
  transform.translation() = translation;
  return transform;
}

/// The smallest right singular vectors of a tall matrix, the very smallest last.
Eigen::MatrixXd rightSingularVectors(const Eigen::MatrixXd& matrix)
{
  const Eigen::Index columns = matrix.cols();
  Eigen::MatrixXd square = matrix;
  if (matrix.rows() > columns)
  {
    square = Eigen::HouseholderQR<Eigen::MatrixXd>(matrix).matrixQR().topRows(columns).triangularView<Eigen::Upper>();
  }
  return Eigen::JacobiSVD<Eigen::MatrixXd>(square, Eigen::ComputeFullV).matrixV();
}

/// A unit quaternion of positive real part as (w, x, y, z), and the dual part  t q / 2.
struct DualQuaternion
{
  Eigen::Vector4d real;
  Eigen::Vector4d dual;
};

Eigen::Vector4d product(const Eigen::Vector4d& a, const Eigen::Vector4d& b)
{
  Eigen::Vector4d c;
  c << a(0) * b(0) - a.tail<3>().dot(b.tail<3>()), a(0) * b.tail<3>() + b(0) * a.tail<3>() + a.tail<3>().cross(b.tail<3>());
  return c;
}

Eigen::Vector4d toVector(const Eigen::Matrix3d& rotation)
{
  const Eigen::Quaterniond quaternion(rotation);
  const Eigen::Vector4d vector(quaternion.w(), quaternion.x(), quaternion.y(), quaternion.z());
  return vector(0) < 0 ? -vector : vector;
}

DualQuaternion toDual(const Eigen::Isometry3d& transform, double unitMm)
{
  DualQuaternion result;
  result.real = toVector(transform.linear());
  Eigen::Vector4d translation;
  translation << 0, transform.translation() / unitMm;
  result.dual = product(translation, result.real) / 2;
  return result;
}

/// Ratios l1 : l2 with  a l1^2 + b l1 l2 + c l2^2 = 0, as unit vectors.
std::vector<Eigen::Vector2d> homogeneousRoots(double a, double b, double c)
{
  const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  const double q = -(b + (b < 0 ? -root : root)) / 2;
  std::vector<Eigen::Vector2d> roots;
  for (const Eigen::Vector2d& ratio : { Eigen::Vector2d(q, a), Eigen::Vector2d(c, q) })
  {
    if (ratio.norm() > 0)
    {
      roots.push_back(ratio.normalized());
    }
  }
  return roots;
}

/// Left and right multiplication by a pure quaternion (Horaud and Dornaika, sec. 4.1).
Eigen::Matrix4d multiplication(const Eigen::Vector3d& vector, bool fromLeft)
{
  Eigen::Matrix4d matrix;
  matrix << 0, -vector.transpose(), vector, (fromLeft ? 1 : -1) * skew(vector);
  return matrix;
}

}  // namespace

std::vector<HandEyeMotion> motionsOf(const std::vector<HandEyePoses>& views, double minimumTurnRad)
{
  std::vector<HandEyeMotion> motions;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    for (std::size_t j = i + 1; j < views.size(); ++j)
    {
      HandEyeMotion motion;
      motion.from = int(i);
      motion.to = int(j);
      motion.camera = views[j].boardToCamera * views[i].boardToCamera.inverse();
      motion.marker = views[j].markerToTracker.inverse() * views[i].markerToTracker;
      motion.turn_Marker = logarithm(motion.marker.linear());
      const double turns[] = { motion.turn_Marker.norm(), cameraTurn(motion).norm() };
      if (std::min(turns[0], turns[1]) >= minimumTurnRad && std::max(turns[0], turns[1]) <= EIGEN_PI - minimumTurnRad)
      {
        motions.push_back(motion);
      }
    }
  }
  return motions;
}

double axisSpreadRad(const std::vector<HandEyeMotion>& motions)
{
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const HandEyeMotion& motion : motions)
  {
    scatter += motion.turn_Marker * motion.turn_Marker.transpose();
  }
  const Eigen::Vector3d sizes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues().cwiseMax(0);
  return sizes(2) > 0 ? std::atan(std::sqrt(sizes(1) / sizes(2))) : 0;
}

std::vector<HandEyeMotion> selectMotions(const std::vector<HandEyeMotion>& motions, int count)
{
  std::vector<HandEyeMotion> selected;
  std::vector<bool> isTaken(motions.size(), false);
  Eigen::Matrix3d information = 1e-3 * Eigen::Matrix3d::Identity();
  while (int(selected.size()) < std::min(count, int(motions.size())))
  {
    const Eigen::Matrix3d uncertainty = information.inverse();
    std::size_t best = motions.size();
    double most = -1;
    for (std::size_t i = 0; i < motions.size(); ++i)
    {
      const double gain = motions[i].turn_Marker.dot(uncertainty * motions[i].turn_Marker);
      if (!isTaken[i] && gain > most)
      {
        most = gain;
        best = i;
      }
    }
    isTaken[best] = true;
    selected.push_back(motions[best]);
    information += motions[best].turn_Marker * motions[best].turn_Marker.transpose();
  }
  return selected;
}

/// Tsai and Lenz: A = camera, B = marker;  P = 2 sin(angle / 2) axis;  skew(P_A + P_B) P' = P_B - P_A (eq. 12),
/// P = 2 P' / sqrt(1 + |P'|^2) (eq. 14).  P' has no bound where X turns by pi; B is therefore turned by half a turn about one of
/// its axes first, whichever makes X turn least.
Eigen::Isometry3d solveTsai(const std::vector<HandEyeMotion>& motions)
{
  const auto modified = [](const Eigen::Vector3d& turn) -> Eigen::Vector3d
  { return 2 * std::sin(turn.norm() / 2) * turn.normalized(); };
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double least = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d halfTurns[] = { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } };
  for (const Eigen::Vector3d& halfTurn : halfTurns)
  {
    Eigen::MatrixXd left(3 * Eigen::Index(motions.size()), 3);
    Eigen::VectorXd right(left.rows());
    for (std::size_t i = 0; i < motions.size(); ++i)
    {
      const Eigen::Vector3d a = modified(cameraTurn(motions[i]));
      const Eigen::Vector3d b = modified(halfTurn.asDiagonal() * motions[i].turn_Marker);
      left.middleRows<3>(3 * Eigen::Index(i)) = skew(a + b);
      right.segment<3>(3 * Eigen::Index(i)) = b - a;
    }
    const Eigen::Vector3d tangent = left.colPivHouseholderQr().solve(right);
    if (tangent.norm() < least)
    {
      least = tangent.norm();
      const Eigen::Vector3d p = 2 * tangent / std::sqrt(1 + tangent.squaredNorm());
      const Eigen::Matrix3d turned = (1 - p.squaredNorm() / 2) * Eigen::Matrix3d::Identity() +
        (p * p.transpose() + std::sqrt(4 - p.squaredNorm()) * skew(p)) / 2;  // eq. 10
      rotation = turned * halfTurn.asDiagonal();
    }
  }
  rotation = nearestRotation(rotation);
  return compose(rotation, solveTranslation(motions, rotation));
}

/// Park and Martin: alpha = log A, beta = log B, alpha = R beta; R = (M^T M)^(-1/2) M^T with M = sum beta alpha^T (eq. 18). By the
/// singular value decomposition, so that turns about only two axes are enough.
Eigen::Isometry3d solvePark(const std::vector<HandEyeMotion>& motions)
{
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const HandEyeMotion& motion : motions)
  {
    sum += cameraTurn(motion) * motion.turn_Marker.transpose();
  }
  const Eigen::Matrix3d rotation = nearestRotation(sum);
  return compose(rotation, solveTranslation(motions, rotation));
}

/// Horaud and Dornaika: the unit quaternion that minimises  sum |v_A q - q v_B|^2, v being the unit axes: the eigenvector of the
/// smallest eigenvalue of sum (L(v_A) - R(v_B))^T (L(v_A) - R(v_B)).
Eigen::Isometry3d solveHoraud(const std::vector<HandEyeMotion>& motions)
{
  Eigen::MatrixXd rows(4 * Eigen::Index(motions.size()), 4);
  for (std::size_t i = 0; i < motions.size(); ++i)
  {
    rows.middleRows<4>(4 * Eigen::Index(i)) =
      multiplication(cameraTurn(motions[i]).normalized(), true) - multiplication(motions[i].turn_Marker.normalized(), false);
  }
  const Eigen::Vector4d q = rightSingularVectors(rows).col(3);
  const Eigen::Matrix3d rotation = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix();
  return compose(rotation, solveTranslation(motions, rotation));
}

/// Daniilidis: the six rows  [a - b, skew(a + b), 0, 0; a' - b', skew(a' + b'), a - b, skew(a + b)]  of each motion (eq. 31) hold
/// the vector parts of its dual quaternions; X lies in the space of the two smallest singular values, where  |q| = 1 and q . q' = 0
/// (eq. 33-35). Lengths are in units of the motions' own, so that millimetres or metres make no difference.
Eigen::Isometry3d solveDaniilidis(const std::vector<HandEyeMotion>& motions)
{
  double squares = 0;
  for (const HandEyeMotion& motion : motions)
  {
    squares += motion.camera.translation().squaredNorm() / double(motions.size());
  }
  const double unitMm = squares > 0 ? std::sqrt(squares) : 1;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6 * Eigen::Index(motions.size()), 8);
  for (std::size_t i = 0; i < motions.size(); ++i)
  {
    const DualQuaternion a = toDual(motions[i].camera, unitMm), b = toDual(motions[i].marker, unitMm);
    auto block = rows.middleRows<6>(6 * Eigen::Index(i));
    block.topLeftCorner<3, 1>() = (a.real - b.real).tail<3>();
    block.block<3, 3>(0, 1) = skew((a.real + b.real).tail<3>());
    block.block<3, 4>(3, 4) = block.topLeftCorner<3, 4>();
    block.block<3, 1>(3, 0) = (a.dual - b.dual).tail<3>();
    block.block<3, 3>(3, 1) = skew((a.dual + b.dual).tail<3>());
  }
  const Eigen::MatrixXd vectors = rightSingularVectors(rows);
  const Eigen::Vector4d u1 = vectors.col(6).head<4>(), v1 = vectors.col(6).tail<4>();
  const Eigen::Vector4d u2 = vectors.col(7).head<4>(), v2 = vectors.col(7).tail<4>();
  Eigen::Vector4d real = Eigen::Vector4d::Zero(), dual = real;
  for (const Eigen::Vector2d& ratio : homogeneousRoots(u1.dot(v1), u1.dot(v2) + u2.dot(v1), u2.dot(v2)))
  {
    const Eigen::Vector4d candidate = ratio(0) * u1 + ratio(1) * u2;
    if (candidate.norm() > real.norm())
    {
      real = candidate;
      dual = ratio(0) * v1 + ratio(1) * v2;
    }
  }
  dual /= real.norm();
  real.normalize();
  Eigen::Vector4d conjugate = -real;
  conjugate(0) = real(0);
  const Eigen::Vector4d translation = 2 * unitMm * product(dual, conjugate);
  return compose(Eigen::Quaterniond(real(0), real(1), real(2), real(3)).toRotationMatrix(), translation.tail<3>());
}

}  // namespace handeye
