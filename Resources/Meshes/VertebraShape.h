// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause

/// The shape of a lumbar vertebra (L2-like) as an implicit surface: negative inside the bone, positive outside.
///
/// Frame `Model`, in mm: x to the patient's right, y anterior, z superior (RAS); the origin is the body's centre.
/// Each part is a section swept through a few stations, placed by hand from textbook dimensions; the parts are joined by
/// smooth unions, whose radius is the fillet. Values are first-order distances (value over gradient), good near the
/// surface, which is all that a contour needs. Pure functions: any number of threads may call them.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace vertebra
{
struct Vec
{
  double x = 0.0, y = 0.0, z = 0.0;
};
inline Vec operator+(const Vec& a, const Vec& b)
{
  return { a.x + b.x, a.y + b.y, a.z + b.z };
}
inline Vec operator-(const Vec& a, const Vec& b)
{
  return { a.x - b.x, a.y - b.y, a.z - b.z };
}
inline Vec operator*(double s, const Vec& a)
{
  return { s * a.x, s * a.y, s * a.z };
}
inline double dot(const Vec& a, const Vec& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec cross(const Vec& a, const Vec& b)
{
  return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}
inline Vec normalized(const Vec& a)
{
  return (1.0 / std::sqrt(dot(a, a))) * a;
}

/// Smooth Boolean operations; `fillet` (mm) is the width of the band in which the two surfaces blend.
inline double unite(double a, double b, double fillet)
{
  const double h = std::max(fillet - std::abs(a - b), 0.0) / fillet;
  return std::min(a, b) - h * h * h * fillet / 6.0;
}
inline double intersect(double a, double b, double fillet)
{
  return -unite(-a, -b, fillet);
}
inline double subtract(double a, double b, double fillet)
{
  return -unite(-a, b, fillet);
}

/// 0 below `from`, 1 above `to`, smooth between.
inline double smoothStep(double from, double to, double value)
{
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Value noise in [-1, 1] with features of about `wavelength` mm; the same on every machine.
inline double noise(const Vec& p, double wavelength, std::uint32_t seed)
{
  const auto lattice = [seed](int i, int j, int k)
  {
    const auto word = [](int n) { return static_cast<std::uint32_t>(n); };
    std::uint32_t h = seed * 0x9E3779B9u + word(i) * 0x85EBCA6Bu + word(j) * 0xC2B2AE35u + word(k) * 0x27D4EB2Fu;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return static_cast<double>((h ^ (h >> 15)) & 0xFFFFFFu) / 8388607.5 - 1.0;
  };
  const Vec q = (1.0 / wavelength) * p;
  const int i = static_cast<int>(std::floor(q.x));
  const int j = static_cast<int>(std::floor(q.y));
  const int k = static_cast<int>(std::floor(q.z));
  const double tx = smoothStep(0, 1, q.x - i), ty = smoothStep(0, 1, q.y - j), tz = smoothStep(0, 1, q.z - k);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const int a = corner & 1, b = (corner >> 1) & 1, c = corner >> 2;
    sum += (a ? tx : 1 - tx) * (b ? ty : 1 - ty) * (c ? tz : 1 - tz) * lattice(i + a, j + b, k + c);
  }
  return sum;
}

/// One place along a bony process: where its axis passes, and half its section's sizes along u and v.
struct Station
{
  Vec centre;
  double halfU, halfV;
};

/// A section swept along a smooth curve through stations. Along a segment of direction w the section's axes are v = w x u
/// and u made perpendicular to w. `Round` sections are ellipses; `Plate` ones are squarer (fourth powers), as laminae are.
class Sweep
{
public:
  enum class Section
  {
    Round,
    Plate
  };

  Sweep(Section section, const Vec& u, std::initializer_list<Station> stations)
    : plate(section == Section::Plate)
  {
    constexpr int pieces = 10;  // straight pieces a station: fewer leave visible rings on the bone
    const std::vector<Station> given(stations);
    const int last = static_cast<int>(given.size()) - 1;
    Station from = given.front();
    for (int i = 1; i <= last * pieces; ++i)
    {
      const int k = (i - 1) / pieces;
      const Station to = interpolate(given[std::max(k - 1, 0)], given[k], given[k + 1], given[std::min(k + 2, last)],
        static_cast<double>(i - k * pieces) / pieces);
      const Vec axis = to.centre - from.centre;
      const Vec w = normalized(axis), v = normalized(cross(w, u));
      this->segments.push_back({ from, to, cross(v, w), v, w, std::sqrt(dot(axis, axis)) });
      from = to;
    }
  }

  double distance(const Vec& p) const
  {
    double nearest = 1e3;
    for (const Segment& segment : this->segments)
    {
      nearest = std::min(nearest, this->distanceTo(segment, p));
    }
    return nearest;
  }

private:
  struct Segment
  {
    Station from, to;
    Vec u, v, w;
    double length;
  };

  /// Catmull-Rom: the smooth curve from `b` (t = 0) to `c` (t = 1).
  static Station interpolate(const Station& a, const Station& b, const Station& c, const Station& d, double t)
  {
    const double t2 = t * t, t3 = t2 * t;
    const double wa = 0.5 * (2 * t2 - t3 - t), wb = 0.5 * (2 - 5 * t2 + 3 * t3);
    const double wc = 0.5 * (t + 4 * t2 - 3 * t3), wd = 0.5 * (t3 - t2);
    return { wa * a.centre + wb * b.centre + (wc * c.centre + wd * d.centre),
      wa * a.halfU + wb * b.halfU + wc * c.halfU + wd * d.halfU, wa * a.halfV + wb * b.halfV + wc * c.halfV + wd * d.halfV };
  }

  double distanceTo(const Segment& s, const Vec& p) const
  {
    const double along = std::clamp(dot(p - s.from.centre, s.w), 0.0, s.length);
    const double t = along / s.length;
    const Vec offset = p - s.from.centre - along * s.w;
    const double halfU = s.from.halfU + t * (s.to.halfU - s.from.halfU);
    const double halfV = s.from.halfV + t * (s.to.halfV - s.from.halfV);
    const double half[3] = { halfU, halfV, std::min(halfU, halfV) };  // the ends are rounded
    const double local[3] = { dot(offset, s.u), dot(offset, s.v), dot(offset, s.w) };
    double sum = 0.0, slope = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const double r = local[i] / half[i], power = this->plate ? r * r * r : r;
      sum += power * r;
      slope += power * power / (half[i] * half[i]);
    }
    if (slope < 1e-12)
    {
      return -half[2];
    }
    // value k = sum^(1/n), gradient sqrt(slope) * k^(1 - n)
    const double k = this->plate ? std::sqrt(std::sqrt(sum)) : std::sqrt(sum);
    return (k - 1.0) * (this->plate ? k * k * k : k) / std::sqrt(slope);
  }

  bool plate;
  std::vector<Segment> segments;
};

/// The vertebral body: a kidney-shaped section, narrower at mid-height, between two concave endplates with a rim.
inline double body(const Vec& p)
{
  constexpr double halfWidth = 22.5, halfDepth = 16.5;
  constexpr double hilumRadius = 17.0;  // the back wall's hollow, which the canal runs along
  // A little higher in front than behind, for the lumbar lordosis.
  const double halfHeight = 14.0 + 0.5 * p.y / halfDepth;
  const double t = std::min(std::abs(p.z - 0.4) / halfHeight, 1.0);
  const double waist = std::pow(1.0 - std::pow(t, 2.2), 1.25);
  const double x = p.x / (1.0 - 0.135 * waist);
  const double y = p.y / (1.0 - (p.y > 0 ? 0.14 : 0.05) * waist);
  const double n = y > 0 ? 2.25 : 2.9;  // round in front, squarer behind
  const double rx = std::abs(x) / halfWidth, ry = std::abs(y) / halfDepth;
  const double k = std::pow(std::pow(rx, n) + std::pow(ry, n), 1.0 / n);
  const double slope = std::hypot(std::pow(rx / (k + 1e-9), n - 1) / halfWidth, std::pow(ry / (k + 1e-9), n - 1) / halfDepth);
  double side = k < 0.05 ? -halfDepth : (k - 1.0) / slope;
  side -= 0.7 * std::exp(-std::pow((std::abs(p.z - 0.4) - halfHeight + 3.0) / 2.2, 2));  // the rims' lip
  side = subtract(side, std::hypot(p.x, y + halfDepth + hilumRadius - 2.2) - hilumRadius, 7.0);
  const double dish = smoothStep(2.5, 12.5, -side);
  const double endplates = std::max(p.z - halfHeight + 1.8 * dish, -p.z - halfHeight + 2.3 * dish);
  return intersect(side, endplates, 3.0);
}

/// The canal's rounded triangle, base on the body and apex between the laminae; it deepens downwards as laminae slope.
inline double canal(const Vec& p)
{
  const double x = std::sqrt(p.x * p.x + 3.0);
  const double base = p.y + 14.2 + 0.016 * p.x * p.x;
  const double flank = 0.76 * x - 0.65 * (p.y - 0.10 * p.z) - 21.1;
  return intersect(intersect(base, flank, 4.0), x - 11.7, 5.0);
}

/// The parts that grow from the body, those in pairs on the right side (x > 0).
struct Processes
{
  using Section = Sweep::Section;

  Sweep pedicle{ Section::Round, { 1, 0, 0 },
    { { { 14.8, -7, 4.6 }, 5.4, 8.4 }, { { 15.6, -18.5, 4.4 }, 4.2, 6.8 }, { { 16.4, -27, 3.5 }, 4.8, 7.4 } } };
  Sweep pars{ Section::Round, { 0.50, -0.82, 0.28 },
    { { { 15.5, -29.5, 5 }, 3.9, 5.8 }, { { 13.2, -33.5, -3 }, 3.5, 5.2 }, { { 11.4, -37, -10 }, 3.4, 5.0 } } };
  Sweep lamina{ Section::Plate, { 0.46, -0.83, 0.33 },
    { { { 13.0, -30.0, -2.0 }, 3.6, 7.6 }, { { 6.5, -33.0, -5.5 }, 4.2, 9.6 }, { { 0.5, -35.8, -7 }, 4.4, 10.0 } } };
  Sweep spinous{ Section::Plate, { 1, 0, 0 },
    { { { 0, -36, -5 }, 4.8, 9.4 }, { { 0, -45, -7.2 }, 2.9, 8.2 }, { { 0, -53, -8.6 }, 2.3, 8.8 }, { { 0, -58, -9.5 }, 2.6, 8.8 },
      { { 0, -62, -10.5 }, 2.9, 6.0 } } };
  Sweep spinousEdge{ Section::Round, { 1, 0, 0 },
    { { { 0, -56.5, -1.8 }, 2.0, 2.0 }, { { 0, -61.2, -4.2 }, 2.9, 2.5 }, { { 0, -63.2, -10 }, 3.5, 2.8 },
      { { 0, -62.0, -16 }, 4.1, 3.2 }, { { 0, -57.0, -18.2 }, 3.3, 2.8 }, { { 0, -46, -14.5 }, 2.4, 2.2 } } };
  Sweep transverse{ Section::Round, { 0, 0, 1 },
    { { { 17.0, -25.5, 2.5 }, 6.8, 4.6 }, { { 24, -29, 1.2 }, 4.6, 3.1 }, { { 32, -32, 0.8 }, 3.9, 2.2 },
      { { 37.5, -34.5, 1.6 }, 4.4, 2.7 }, { { 40, -36, 2.2 }, 3.2, 2.4 } } };
  Sweep accessory{ Section::Round, { 1, 0, 0 }, { { { 20.0, -30, -1.5 }, 2.6, 2.6 }, { { 21.0, -33, -3.2 }, 1.7, 1.7 } } };
  Sweep superior{ Section::Round, { 0.8, 0.6, 0 },
    { { { 16.6, -28.5, 2 }, 4.8, 6.8 }, { { 17.6, -31, 11 }, 5.0, 7.4 }, { { 17.6, -32, 17 }, 4.2, 6.6 },
      { { 17.2, -32.2, 20.5 }, 2.4, 3.6 } } };
  Sweep superiorFacet{ Section::Round, { 1, 0, 0 }, { { { 8.6, -37.8, 15.5 }, 8.5, 8.5 }, { { 8.0, -37.8, 34 }, 8.5, 8.5 } } };
  Sweep mammillary{ Section::Round, { 1, 0, 0 }, { { { 19.5, -33.5, 5 }, 3.4, 3.4 }, { { 20.6, -37.2, 12 }, 3.0, 3.0 } } };
  Sweep inferior{ Section::Round, { 0.82, 0.57, 0 },
    { { { 9.4, -36.0, -7 }, 4.8, 5.6 }, { { 10.4, -38.6, -14.5 }, 5.0, 6.2 }, { { 11.2, -39.3, -20.5 }, 4.3, 5.6 },
      { { 11.4, -39.0, -23.8 }, 2.6, 3.4 } } };
};

/// The bone. `q` below is the point mirrored to the right side: parts in pairs are described once.
inline double vertebra(const Vec& p_Model)
{
  static const Processes part;

  // A slow bending of space makes left and right differ, as they do in people.
  const Vec bend{ noise(p_Model, 27, 1), noise(p_Model, 27, 2), noise(p_Model, 27, 3) };
  const Vec ripple{ noise(p_Model, 11, 6), noise(p_Model, 11, 7), noise(p_Model, 11, 8) };
  const Vec p = p_Model + 0.9 * bend + 0.45 * ripple;
  const Vec q{ std::sqrt(p.x * p.x + 0.5), p.y, p.z };

  double superiorProcess = unite(part.superior.distance(q), part.mammillary.distance(q), 3.0);
  superiorProcess = subtract(superiorProcess, part.superiorFacet.distance(q), 1.2);
  const double inferiorFacet = std::hypot(q.x - 7.6, q.y + 41.0) - 7.8;
  const double inferiorProcess = intersect(part.inferior.distance(q), inferiorFacet, 1.5);

  double arch = unite(part.lamina.distance(q), part.pars.distance(q), 5.0);
  arch = unite(arch, part.spinous.distance(p), 7.0);
  arch = unite(arch, part.spinousEdge.distance(p), 3.0);
  arch = unite(arch, inferiorProcess, 6.0);
  arch = unite(arch, unite(part.transverse.distance(q), part.accessory.distance(q), 3.0), 5.0);
  double bone = unite(body(p), part.pedicle.distance(q), 7.0);
  bone = unite(bone, arch, 5.0);
  bone = subtract(bone, canal(p), 2.5);
  bone = unite(bone, superiorProcess, 4.0);

  const Vec basivertebral{ p.x / 4.0, (p.y + 14.6) / 2.4, (p.z + 0.5) / 2.2 };
  bone = subtract(bone, 2.0 * (std::sqrt(dot(basivertebral, basivertebral)) - 1.0), 1.5);
  // Bone is not polished: a millimetre-scale relief.
  return bone + 0.28 * noise(p_Model, 7.0, 4) + 0.14 * noise(p_Model, 3.2, 5);
}
}  // namespace vertebra
