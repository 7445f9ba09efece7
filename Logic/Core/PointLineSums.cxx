// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PointLineSums.h"

#include "WideVectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace handeye
{

namespace
{

/// Pairs of a block; a multiple of the widest vector.
constexpr int Block = 16;
/// Numbers that are added up side by side.
constexpr int Lanes = 4;
constexpr int Entries = 6;
constexpr int Monomials = 10;

using Column = double[Block];

/// Points and directions of a block, side by side.
struct PairBlock
{
  alignas(64) Column point[3];
  alignas(64) Column direction[3];
};

inline void load(const PointLinePair* pairs, PairBlock& block)
{
  for (int k = 0; k < Block; ++k)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      block.point[axis][k] = pairs[k].point_Points.data()[axis];
      block.direction[axis][k] = pairs[k].direction_Lines.data()[axis];
    }
  }
}

/// The pairs in full blocks: the last one is filled up with its first pair.
class Blocks
{
public:
  explicit Blocks(const std::vector<PointLinePair>& pairs)
    : pairs_(pairs)
    , fullCount_(pairs.size() / Block * Block)
  {
    if (fullCount_ < pairs.size())
    {
      std::fill(std::copy(pairs.begin() + std::ptrdiff_t(fullCount_), pairs.end(), last_.begin()), last_.end(), pairs[fullCount_]);
    }
  }

  std::size_t pairCount() const { return pairs_.size(); }
  /// Of the block that begins with this pair.
  const PointLinePair* at(std::size_t first) const { return first < fullCount_ ? &pairs_[first] : last_.data(); }
  int countAt(std::size_t first) const { return int(std::min(pairs_.size() - first, std::size_t(Block))); }

private:
  const std::vector<PointLinePair>& pairs_;
  std::size_t fullCount_;
  std::array<PointLinePair, Block> last_;
};

/// Zero if two points are the same, bit by bit.
inline std::uint64_t difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  std::uint64_t bitsA[3], bitsB[3];
  std::memcpy(bitsA, a.data(), sizeof(bitsA));
  std::memcpy(bitsB, b.data(), sizeof(bitsB));
  return (bitsA[0] ^ bitsB[0]) | (bitsA[1] ^ bitsB[1]) | (bitsA[2] ^ bitsB[2]);
}

struct RawSums
{
  alignas(64) double products[Monomials][Entries][Lanes] = {};
  alignas(64) Column poison = {};  ///< stays zero while all numbers are finite
  alignas(64) Column lowest = {};  ///< of all weights and squared lengths
  std::uint64_t otherOrigin = 0;   ///< stays zero while all origins are the same

  RawSums() { std::fill(std::begin(lowest), std::end(lowest), std::numeric_limits<double>::infinity()); }
};

/// Inlined into the loop over the blocks, so that it is compiled for the same processors.
inline void addProducts(
  const Column (&monomial)[Monomials], const Column (&projector)[Entries], double (&products)[Monomials][Entries][Lanes])
{
  for (int m = 0; m < Monomials; ++m)
  {
    for (int e = 0; e < Entries; ++e)
    {
      for (int lane = 0; lane < Lanes; ++lane)
      {
        double sum = 0;
        for (int k = lane; k < Block; k += Lanes)
        {
          sum += monomial[m][k] * projector[e][k];
        }
        products[m][e][lane] += sum;
      }
    }
  }
}

/// Adds up w V times the products of the coordinates relative to `centre`.
HANDEYE_WIDE_VECTORS void addBlocks(const Blocks& pairs, const Eigen::Vector3d& centre, RawSums& sums)
{
  const Eigen::Vector3d origin = pairs.at(0)->origin_Lines;
  const double cx = centre.x(), cy = centre.y(), cz = centre.z();
  PairBlock block;
  alignas(64) Column weights;
  alignas(64) Column projector[Entries];
  alignas(64) Column monomial[Monomials];
  for (std::size_t first = 0; first < pairs.pairCount(); first += Block)
  {
    const PointLinePair* source = pairs.at(first);
    load(source, block);
    for (int k = 0; k < Block; ++k)
    {
      weights[k] = source[k].weight;
      sums.otherOrigin |= difference(source[k].origin_Lines, origin);
    }
    for (int k = 0; k < Block; ++k)
    {
      const double dx = block.direction[0][k], dy = block.direction[1][k], dz = block.direction[2][k];
      const double squaredLength = dx * dx + dy * dy + dz * dz, weight = weights[k];
      const double smaller = weight < squaredLength ? weight : squaredLength;
      sums.lowest[k] = smaller < sums.lowest[k] ? smaller : sums.lowest[k];
      // A product with zero is zero unless a number is infinite or none.
      sums.poison[k] += 0 * (block.point[0][k] + block.point[1][k] + block.point[2][k] + squaredLength + weight);
    }
    for (int k = pairs.countAt(first); k < Block; ++k)
    {
      weights[k] = 0;
    }
    for (int k = 0; k < Block; ++k)
    {
      const double dx = block.direction[0][k], dy = block.direction[1][k], dz = block.direction[2][k];
      const double xx = dx * dx, yy = dy * dy, zz = dz * dz, scale = weights[k] / (xx + yy + zz);
      projector[0][k] = scale * (yy + zz);
      projector[1][k] = -scale * dx * dy;
      projector[2][k] = -scale * dx * dz;
      projector[3][k] = scale * (xx + zz);
      projector[4][k] = -scale * dy * dz;
      projector[5][k] = scale * (xx + yy);
      const double x = block.point[0][k] - cx, y = block.point[1][k] - cy, z = block.point[2][k] - cz;
      monomial[0][k] = 1;
      monomial[1][k] = x;
      monomial[2][k] = y;
      monomial[3][k] = z;
      monomial[4][k] = x * x;
      monomial[5][k] = x * y;
      monomial[6][k] = x * z;
      monomial[7][k] = y * y;
      monomial[8][k] = y * z;
      monomial[9][k] = z * z;
    }
    addProducts(monomial, projector, sums.products);
  }
}

/// Squared distances of moved points to their lines and, by its sign, the side of the origin on which they lie.
HANDEYE_WIDE_VECTORS void measureBlock(
  const PointLinePair* source, const Eigen::Isometry3d& pointsToLines, bool haveCommonOrigin, Column& square, Column& along)
{
  const Eigen::Matrix3d rotation = pointsToLines.linear();
  const Eigen::Vector3d translation = pointsToLines.translation();
  PairBlock block;
  load(source, block);
  alignas(64) Column shifts[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int k = 0; k < Block; ++k)
    {
      shifts[axis][k] = translation[axis] - source[haveCommonOrigin ? 0 : k].origin_Lines[axis];
    }
  }
  for (int k = 0; k < Block; ++k)
  {
    const double px = block.point[0][k], py = block.point[1][k], pz = block.point[2][k];
    const double x = rotation(0, 0) * px + rotation(0, 1) * py + rotation(0, 2) * pz + shifts[0][k];
    const double y = rotation(1, 0) * px + rotation(1, 1) * py + rotation(1, 2) * pz + shifts[1][k];
    const double z = rotation(2, 0) * px + rotation(2, 1) * py + rotation(2, 2) * pz + shifts[2][k];
    const double dx = block.direction[0][k], dy = block.direction[1][k], dz = block.direction[2][k];
    const double cx = y * dz - z * dy, cy = z * dx - x * dz, cz = x * dy - y * dx;
    square[k] = (cx * cx + cy * cy + cz * cz) / (dx * dx + dy * dy + dz * dz);
    along[k] = dx * x + dy * y + dz * z;
  }
}

/// @throws std::invalid_argument, naming the pair, if there is a bad one
void check(const std::vector<PointLinePair>& pairs)
{
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    const PointLinePair& pair = pairs[i];
    const double squaredLength = pair.direction_Lines.squaredNorm();
    const double sum = pair.point_Points.sum() + pair.origin_Lines.sum() + squaredLength + pair.weight;
    if (!(std::isfinite(sum) && squaredLength > 0 && pair.weight > 0))
    {
      throw std::invalid_argument("point and line " + std::to_string(i + 1) +
        ": finite numbers, a direction that is not zero and a positive weight are expected");
    }
  }
}

bool mayBeBad(const RawSums& sums, const Eigen::Vector3d& origin)
{
  double poison = 0, lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < Block; ++k)
  {
    poison += sums.poison[k];
    lowest = std::min(lowest, sums.lowest[k]);
  }
  return !(poison == 0 && lowest > 0 && sums.otherOrigin == 0 && origin.allFinite());
}

/// The trace of V is 2.
double weightIn(const PointLineSums& sums, int monomial)
{
  return 0.5 * (sums.products(0, monomial) + sums.products(3, monomial) + sums.products(5, monomial));
}

/// From the products of x to those of x - shift.
void moveCentre(const Eigen::Vector3d& shift, PointLineSums& sums)
{
  const Eigen::Matrix<double, Entries, 4> old = sums.products.leftCols<4>();
  for (int a = 0, monomial = 4; a < 3; ++a)
  {
    sums.products.col(1 + a) -= shift[a] * old.col(0);
    for (int b = a; b < 3; ++b, ++monomial)
    {
      sums.products.col(monomial) += shift[a] * shift[b] * old.col(0) - shift[a] * old.col(1 + b) - shift[b] * old.col(1 + a);
    }
  }
}

}  // namespace

PointLineSums sumPairs(const std::vector<PointLinePair>& pairs)
{
  // Points further from their centre than this many times their spread are summed up again, about the centre: what is left of sums
  // about the mean of the first block would be rounding.
  constexpr double farSquared = 1e6;
  PointLineSums sums;
  if (pairs.empty())
  {
    return sums;
  }
  const Blocks blocks(pairs);
  const int firstCount = blocks.countAt(0);
  for (int k = 0; k < firstCount; ++k)
  {
    sums.centroid_Points += pairs[std::size_t(k)].point_Points / firstCount;
  }
  for (bool isAgain = false; true; isAgain = true)
  {
    RawSums raw;
    addBlocks(blocks, sums.centroid_Points, raw);
    if (!isAgain && mayBeBad(raw, pairs.front().origin_Lines))
    {
      check(pairs);
    }
    for (int monomial = 0; monomial < Monomials; ++monomial)
    {
      for (int entry = 0; entry < Entries; ++entry)
      {
        const double* lanes = raw.products[monomial][entry];
        sums.products(entry, monomial) = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
      }
    }
    sums.hasCommonOrigin = raw.otherOrigin == 0;
    sums.totalWeight = weightIn(sums, 0);
    const double weight = std::max(sums.totalWeight, 1e-300);
    const Eigen::Vector3d shift = Eigen::Vector3d(weightIn(sums, 1), weightIn(sums, 2), weightIn(sums, 3)) / weight;
    sums.centroid_Points += shift;
    moveCentre(shift, sums);
    const double squaredSpread = (weightIn(sums, 4) + weightIn(sums, 7) + weightIn(sums, 9)) / weight;
    if (isAgain || !(shift.squaredNorm() > farSquared * squaredSpread))
    {
      return sums;
    }
  }
}

PointLineDistances measureDistances(const std::vector<PointLinePair>& pairs, const Eigen::Isometry3d& pointsToLines,
  bool haveCommonOrigin, std::vector<double>& distancesMm)
{
  PointLineDistances distances;
  const Blocks blocks(pairs);
  for (std::size_t first = 0; first < pairs.size(); first += Block)
  {
    const int count = blocks.countAt(first);
    alignas(64) Column square, along;
    measureBlock(blocks.at(first), pointsToLines, haveCommonOrigin, square, along);
    int inFront = 0;
    for (int k = 0; k < count; ++k)
    {
      distances.squaresMm2 += square[k];
      inFront += along[k] > 0 ? 1 : 0;
    }
    distances.inFront += std::size_t(inFront);
    Eigen::Map<Eigen::ArrayXd>(distancesMm.data() + first, count) = Eigen::Map<const Eigen::ArrayXd>(square, count).sqrt();
  }
  return distances;
}

}  // namespace handeye
