#pragma once
/// Closed shapes, and ways to spoil them, for tests of tets.

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

inline void add_face(Shape& shape, std::vector<Index> corners) {
  shape.faces.add(corners);
}

/// Corner i is at bit 0 of i along x, bit 1 along y, bit 2 along z; faces 0 to 5: -z, +z, -y, +y, -x, +x.
inline Shape box(const Vec3& low = Vec3::Zero(), const Vec3& high = Vec3::Ones()) {
  Shape shape;
  for (int i = 0; i < 8; ++i)
    shape.positions.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  for (const auto& quad : std::vector<std::array<Index, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    shape.faces.add(quad);
  return shape;
}

inline Shape tetrahedron() {
  Shape shape;
  shape.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& t : std::vector<std::array<Index, 3>>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
    shape.faces.add(t);
  return shape;
}

/// columns x rows points at place(u, v), u and v from 0, joined to a grid of triangles; wrapped around in u, and in v.
inline Shape grid(Index columns, Index rows, bool around_u, bool around_v,
                  const std::function<Vec3(double, double)>& place) {
  Shape shape;
  for (Index v = 0; v < rows; ++v)
    for (Index u = 0; u < columns; ++u)
      shape.positions.push_back(place(static_cast<double>(u) / (around_u ? columns : columns - 1),
                                      static_cast<double>(v) / (around_v ? rows : rows - 1)));
  for (Index v = 0; v + (around_v ? 0 : 1) < rows; ++v)
    for (Index u = 0; u + (around_u ? 0 : 1) < columns; ++u) {
      const Index right = (u + 1) % columns, up = (v + 1) % rows;
      add_face(shape, {v * columns + u, v * columns + right, up * columns + right});
      add_face(shape, {v * columns + u, up * columns + right, up * columns + u});
    }
  return shape;
}

inline Shape torus(Index columns = 48, Index rows = 24, double large = 1, double small = 0.4) {
  return grid(columns, rows, true, true, [=](double u, double v) {
    const double a = 2 * M_PI * u, b = 2 * M_PI * v, r = large + small * std::cos(b);
    return Vec3(r * std::cos(a), r * std::sin(a), small * std::sin(b));
  });
}

/// Rings between two poles.
inline Shape sphere(const Vec3& centre = Vec3::Zero(), double radius = 1, Index columns = 32, Index rows = 15) {
  Shape shape = grid(columns, rows, true, false, [=](double u, double v) {
    const double a = 2 * M_PI * u, b = M_PI * (v * (rows - 1) + 1) / (rows + 1);
    return Vec3(centre + radius * Vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b)));
  });
  const Index low = static_cast<Index>(shape.size()), high = low + 1;
  shape.positions.emplace_back(centre - radius * Vec3::UnitZ());
  shape.positions.emplace_back(centre + radius * Vec3::UnitZ());
  for (Index u = 0; u < columns; ++u) {
    const Index right = (u + 1) % columns, top = (rows - 1) * columns;
    add_face(shape, {low, right, u});
    add_face(shape, {high, top + u, top + right});
  }
  return shape;
}

/// Both, points of the second after those of the first.
inline Shape both(Shape a, const Shape& b) {
  const auto first = static_cast<Index>(a.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (std::size_t f = 0; f < b.faces.size(); ++f) {
    std::vector<Index> corners(b.faces[f].begin(), b.faces[f].end());
    for (Index& corner : corners) corner += first;
    a.faces.add(corners);
  }
  return a;
}

/// Only faces that `keep` wants, wound the other way where `turn` wants.
inline Shape with_faces(const Shape& shape, const std::function<bool(std::size_t)>& keep,
                        const std::function<bool(std::size_t)>& turn = {}) {
  Shape result = shape;
  result.faces = {};
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    std::vector<Index> corners(shape.faces[f].begin(), shape.faces[f].end());
    if (turn && turn(f)) corners.assign(shape.faces[f].rbegin(), shape.faces[f].rend());
    if (keep(f)) result.faces.add(corners);
  }
  return result;
}

inline Shape inside_out(const Shape& shape) {
  return with_faces(
      shape, [](std::size_t) { return true; }, [](std::size_t) { return true; });
}

/// Each face with points of its own.
inline Shape soup(const Shape& shape) {
  Shape result;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    std::vector<Index> corners;
    for (const Index corner : shape.faces[f]) {
      corners.push_back(static_cast<Index>(result.size()));
      result.positions.push_back(shape.positions[corner]);
    }
    result.faces.add(corners);
  }
  return result;
}

inline Shape moved(Shape shape, const std::function<Vec3(const Vec3&)>& to) {
  for (Vec3& p : shape.positions) p = to(p);
  return shape;
}

}  // namespace sinew
