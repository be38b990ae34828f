#pragma once
/// Shape: n rest points with named attributes and, if it has any, faces. A still is a Sequence of one frame.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/attribute.h"

namespace sinew {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Index = std::uint32_t;  ///< a point, face, node: at most 2^32 - 2 of each

/// What a reader keeps of its file beyond points and attributes (bytes, layout, comments), so that its writer can give
/// everything else back untouched. Only the io file that made it looks inside.
struct FileContent {
  virtual ~FileContent() = default;
};

/// Part of a scan set: points [first, first + count) came from one file, with this rigid pose.
struct Part {
  std::string path;  ///< as written in the set's file
  Index first = 0, count = 0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< world = rotation * own + translation
  Vec3 translation = Vec3::Zero();
  std::shared_ptr<const FileContent> content;  ///< of the part's own file
};

/// Polygons over the points, any number of corners (CSR): face f has corners points[offsets[f]] ..
/// points[offsets[f+1]-1].
struct Faces {
  std::vector<Index> offsets{0};
  std::vector<Index> points;

  std::size_t size() const { return offsets.size() - 1; }
  bool empty() const { return size() == 0; }
  std::span<const Index> operator[](std::size_t f) const {
    return {points.data() + offsets[f], offsets[f + 1] - offsets[f]};
  }
  void add(std::span<const Index> corners) {
    points.insert(points.end(), corners.begin(), corners.end());
    offsets.push_back(static_cast<Index>(points.size()));
  }
};

/// Four points of positive volume: (p1 - p0) x (p2 - p0) . (p3 - p0) > 0.
using Tet = std::array<Index, 4>;

struct Shape {
  /// Subtracted from the file's coordinates, exactly (choose_origin), so that float keeps 1 mm at 5,400,000 m.
  Vec3 origin = Vec3::Zero();
  /// n rest points relative to `origin`, in the file's unit. A point that is not finite is kept and never bent.
  std::vector<Vec3> positions;
  Type position_type = Type::Float32;  ///< the file's: Float32 or Float64
  std::vector<Attribute> attributes;   ///< in the file's order
  Faces faces;
  std::vector<Tet> tets;                       ///< of a solid mesh, over the same points; otherwise empty
  std::vector<Part> parts;                     ///< of a scan set, in order; otherwise empty
  std::shared_ptr<const FileContent> content;  ///< of the file; null for a shape made by a program
  std::vector<std::string> notes;              ///< what the reader dropped or found odd, one sentence with a count each

  std::size_t size() const { return positions.size(); }
  Attribute* find(const std::string& name);
  const Attribute* find(const std::string& name) const;
};

/// An origin for points with these bounds: zero in each coordinate whose values are not far from zero compared with
/// their extent, otherwise a value near the centre such that x - origin and (x - origin) + origin are exact for every x
/// within the bounds (Sterbenz: min and max lie within [origin/2, 2 origin]).
Vec3 choose_origin(const Vec3& min, const Vec3& max);

/// Moves `shape.positions` from the file's coordinates to an origin of choose_origin; call once, origin zero before.
void set_origin(Shape& shape);

/// Frames of one thing that moves. `load` reads a frame when it is asked for; it throws InputError.
struct Sequence {
  std::vector<int> frames{1};  ///< frame numbers, ascending
  double rate = 24;            ///< frames a second
  std::function<std::shared_ptr<const Shape>(int frame)> load;
};

/// A sequence of one frame, number 1.
Sequence still(std::shared_ptr<const Shape> shape);

/// "point cloud", "scan set", "solid mesh" (tets), "mesh" (faces that share points) or "polygon soup" (faces that share
/// none).
const char* representation(const Shape& shape);

}  // namespace sinew
