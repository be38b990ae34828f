#include "deformers/tet_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "deformers/polygon_ears.h"
#include "deformers/tet_surface_edges.h"
#include "engine/geometry/error.h"

namespace sinew {

namespace {

/// The same vertex for points in the same place, numbered in the order of the points; only corners of faces have one.
struct Welded {
  std::vector<Index> of_point;
  std::size_t joined = 0;  ///< points that share the vertex of one before
};

Welded weld(const Shape& shape, TetSurface& surface) {
  std::vector<Index> used = shape.faces.points;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto key = [&](Index i) {
    const Vec3& p = shape.positions[i];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::vector<Index> order = used;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tuple_cat(key(a), std::tuple(a)) < std::tuple_cat(key(b), std::tuple(b));
  });
  std::vector<Index> first(shape.size(), TetSurface::no_face);
  for (std::size_t k = 0; k < order.size(); ++k)
    first[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? first[order[k - 1]] : order[k];
  Welded welded{std::vector<Index>(shape.size(), TetSurface::no_face), 0};
  for (const Index i : used) {
    if (first[i] == i) {
      welded.of_point[i] = static_cast<Index>(surface.vertices.size());
      surface.vertices.push_back(shape.positions[i]);
      surface.points.push_back(i);
    } else {
      welded.of_point[i] = welded.of_point[first[i]];
      ++welded.joined;
    }
  }
  return welded;
}

void check_corners(const Shape& shape) {
  if (shape.faces.empty()) throw InputError("expected faces that close around a solid, found a shape without faces");
  std::vector<Index> infinite;
  for (std::size_t f = 0; f < shape.faces.size(); ++f)
    for (const Index corner : shape.faces[f]) {
      if (corner >= shape.size())
        throw InputError("expected faces over " + counted(shape.size(), "point", "points") + ", found point " +
                         std::to_string(corner) + " in face " + std::to_string(f));
      if (!shape.positions[corner].allFinite() && (infinite.empty() || infinite.back() != f))
        infinite.push_back(static_cast<Index>(f));
    }
  if (!infinite.empty())
    throw InputError("expected faces with finite points, found others in " + counted(infinite.size(), "face", "faces") +
                     ": " + list_text(infinite));
}

/// Faces as triangles over the vertices; returns how many faces were left out because they have fewer than three
/// corners in different places.
std::size_t cut_faces(const Shape& shape, const Welded& welded, TetSurface& surface) {
  std::size_t without_area = 0;
  std::vector<Index> corners;
  std::vector<Vec3> places;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    corners.clear();
    for (const Index point : shape.faces[f])
      if (corners.empty() || corners.back() != welded.of_point[point]) corners.push_back(welded.of_point[point]);
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    std::size_t whole = 0;
    places.clear();
    for (const Index corner : corners) places.push_back(surface.vertices[corner]);
    if (corners.size() >= 3)
      for (const Triangle& t : polygon_ears(places)) {
        const Triangle triangle{corners[t[0]], corners[t[1]], corners[t[2]]};
        if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
        surface.triangles.push_back(triangle);
        surface.faces.push_back(static_cast<Index>(f));
        ++whole;
      }
    without_area += whole == 0;
  }
  return without_area;
}

/// Triangles given more than once, whichever way round, are kept once; returns how many were left out.
std::size_t drop_duplicates(TetSurface& surface) {
  const auto key = [&](Index t) {
    Triangle corners = surface.triangles[t];
    std::sort(corners.begin(), corners.end());
    return std::pair(corners, t);
  };
  std::vector<std::pair<Triangle, Index>> keys;
  for (Index t = 0; t < surface.triangles.size(); ++t) keys.push_back(key(t));
  std::sort(keys.begin(), keys.end());
  std::vector<char> twice(keys.size(), 0);
  for (std::size_t k = 1; k < keys.size(); ++k) twice[keys[k].second] = keys[k].first == keys[k - 1].first;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < twice.size(); ++t) {
    if (twice[t]) continue;
    surface.triangles[kept] = surface.triangles[t];
    surface.faces[kept++] = surface.faces[t];
  }
  surface.triangles.resize(kept);
  surface.faces.resize(kept);
  return twice.size() - kept;
}

/// Throws where all vertices lie on one line or in one plane, to a billionth of their extent.
void check_extent(const TetSurface& surface) {
  const std::vector<Vec3>& p = surface.vertices;
  const auto farthest = [&](const auto& distance) {
    return *std::max_element(p.begin(), p.end(),
                             [&](const Vec3& a, const Vec3& b) { return distance(a) < distance(b); });
  };
  if (surface.triangles.empty())
    throw InputError("expected faces that close around a solid, found faces that have no area");
  if (p.size() < 4)
    throw InputError("expected faces that close around a solid, found " + counted(p.size(), "corner", "corners") +
                     " in different places");
  const Vec3 b = farthest([&](const Vec3& q) { return (q - p[0]).norm(); });
  const double extent = (b - p[0]).norm();
  if (!(extent < 1e100) || !(extent > 1e-100))
    throw InputError("expected faces of a size between 1e-100 and 1e100, found " + number_text(extent));
  const Vec3 along = (b - p[0]) / extent;
  const Vec3 c = farthest([&](const Vec3& q) { return (q - p[0]).cross(along).norm(); });
  const Vec3 across = (c - p[0]).cross(along);
  if (!(across.norm() > 1e-9 * extent))
    throw InputError("expected faces that close around a solid, found that all lie on one line");
  const Vec3 normal = across.normalized();
  const Vec3 d = farthest([&](const Vec3& q) { return std::abs((q - p[0]).dot(normal)); });
  if (!(std::abs((d - p[0]).dot(normal)) > 1e-9 * extent))
    throw InputError("expected faces that close around a solid, found that all lie in one plane");
}

void check_volume(const TetSurface& surface) {
  Vec3 low = surface.vertices[0], high = low;
  for (const Vec3& p : surface.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  double area = 0;
  for (const Triangle& t : surface.triangles)
    area +=
        (surface.vertices[t[1]] - surface.vertices[t[0]]).cross(surface.vertices[t[2]] - surface.vertices[t[0]]).norm();
  if (!(std::abs(enclosed_volume(surface)) > 1e-12 * area * (high - low).norm()))
    throw InputError("expected faces that close around a solid, found that they enclose no volume");
}

/// Leaves out vertices of no triangle (of faces that were left out).
void drop_unused(TetSurface& surface) {
  std::vector<Index> number(surface.vertices.size(), TetSurface::no_face);
  for (const Triangle& t : surface.triangles)
    for (const Index v : t) number[v] = 0;
  Index kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] != 0) continue;
    surface.vertices[kept] = surface.vertices[v];
    surface.points[kept] = surface.points[v];
    number[v] = kept++;
  }
  surface.vertices.resize(kept);
  surface.points.resize(kept);
  for (Triangle& t : surface.triangles)
    for (Index& v : t) v = number[v];
}

void note(std::vector<std::string>& notes, std::size_t count, const char* one, const char* more, const char* what) {
  if (count > 0) notes.push_back(counted(count, one, more) + " " + what);
}

}  // namespace

TetSurface closed_surface(const Shape& shape, int close_holes, std::vector<std::string>& notes) {
  check_corners(shape);
  TetSurface surface;
  const Welded welded = weld(shape, surface);
  const std::size_t without_area = cut_faces(shape, welded, surface), twice = drop_duplicates(surface);
  drop_unused(surface);
  check_extent(surface);
  check_edges(shape, surface);
  const std::size_t closed = close_holes_of(shape, close_holes, surface);
  const std::size_t turned = turn_faces(shape, surface), flat = join_flat_triangles(surface);
  check_volume(surface);
  note(notes, welded.joined, "point lies", "points lie", "on others, taken as one with them");
  note(notes, without_area, "face", "faces", "without area left out");
  note(notes, flat, "triangle", "triangles", "without area joined with neighbours");
  note(notes, twice, "triangle", "triangles", "given more than once, and used once");
  note(notes, closed, "hole", "holes", "closed");
  note(notes, turned, "triangle", "triangles", "turned to agree with neighbours");
  return surface;
}

double enclosed_volume(const TetSurface& surface) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : surface.vertices) middle += p / static_cast<double>(surface.vertices.size());
  double sum = 0;
  for (const Triangle& t : surface.triangles)
    sum +=
        (surface.vertices[t[0]] - middle).dot((surface.vertices[t[1]] - middle).cross(surface.vertices[t[2]] - middle));
  return sum / 6;
}

int winding_number(const TetSurface& surface, const Vec3& point) {
  double sum = 0;
  for (const Triangle& t : surface.triangles) {
    const Vec3 a = surface.vertices[t[0]] - point, b = surface.vertices[t[1]] - point,
               c = surface.vertices[t[2]] - point;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return static_cast<int>(std::lround(sum / (4 * M_PI)));
}

std::string counted(std::size_t count, const char* one, const char* more) {
  return std::to_string(count) + " " + (count == 1 ? one : more);
}

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

std::string place_text(const Shape& shape, const Vec3& position) {
  double extent = 0;
  for (const Vec3& p : shape.positions)
    if (p.allFinite()) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  std::string text;
  for (int k = 0; k < 3; ++k) {
    const double own = std::abs(position[k]) < 1e-9 * extent ? 0 : position[k];  // not what rounding left
    text += (k == 0 ? "(" : ", ") + number_text(own + shape.origin[k]);
  }
  return text + ")";
}

std::string list_text(const std::vector<Index>& numbers, std::size_t most) {
  std::string text;
  for (std::size_t k = 0; k < std::min(numbers.size(), most); ++k)
    text += (k == 0 ? "" : ", ") + std::to_string(numbers[k]);
  if (numbers.size() > most) text += " and " + std::to_string(numbers.size() - most) + " more";
  return text;
}

std::string faces_text(const TetSurface& surface, const std::vector<Index>& triangles) {
  std::vector<Index> faces;
  for (const Index t : triangles) faces.push_back(surface.faces[t]);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  const bool closing = !faces.empty() && faces.back() == TetSurface::no_face;
  if (closing) faces.pop_back();
  const std::string closes = closing ? "what closes holes" : "";
  if (faces.empty()) return closes;
  return counted(faces.size(), "face", "faces") + ": " + list_text(faces) + (closing ? " and " + closes : "");
}

}  // namespace sinew
