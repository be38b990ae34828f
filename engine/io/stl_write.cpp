#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/io/stl.h"
#include "engine/io/stl_content.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

constexpr bool swap = std::endian::native != std::endian::little;

/// Three points of its own for each facet, in order, and a normal each: what read_stl makes.
bool is_soup(const Shape& shape) {
  if (shape.size() != 3 * shape.faces.size() || shape.faces.points.size() != shape.size()) return false;
  for (std::size_t f = 0; f <= shape.faces.size(); ++f)
    if (shape.faces.offsets[f] != 3 * f) return false;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape.faces.points[i] != i) return false;
  if (shape.attributes.size() != 1) return false;
  const Attribute& normal = shape.attributes[0];
  return normal.kind == Kind::Normal && normal.components == 3 && !is_integer(normal.type) &&
         normal.count() == shape.faces.size() && normal.points == shape.faces.points &&
         normal.point_offsets == shape.faces.offsets;
}

std::size_t facets_of(const std::string& path, const StlContent& content) {
  if (content.binary) return stl_count(content.bytes);
  StlText text(path, content.bytes);
  std::size_t count = 0;
  for (StlText::Facet facet; text.next(facet);) ++count;
  return count;
}

std::vector<std::byte> patched_binary(const StlContent& content, const Shape& shape) {
  std::vector<std::byte> out = content.bytes;
  const Attribute& normal = shape.attributes[0];
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    std::byte* at = out.data() + stl_header + f * stl_facet;
    for (std::size_t c = 0; c < 3; ++c)
      store(at + 4 * c, load<std::uint32_t>(normal.values.data() + (3 * f + c) * sizeof(float), false), swap);
    for (std::size_t c = 0; c < 9; ++c) {
      std::byte* number = at + 12 + 4 * c;
      const auto axis = static_cast<int>(c % 3);
      const double now = shape.positions[3 * f + c / 3][axis], origin = shape.origin[axis];
      if (!same_coordinate(static_cast<double>(load<float>(number, swap)), origin, now))
        store(number, static_cast<float>(now + origin), swap);
    }
  }
  return out;
}

std::vector<std::byte> patched_text(const std::string& path, const StlContent& content, const Shape& shape) {
  TextPatch patch(content.bytes);
  StlText text(path, content.bytes);
  const Attribute& normal = shape.attributes[0];
  StlText::Facet facet;
  for (std::size_t f = 0; text.next(facet); ++f)
    for (std::size_t c = 0; c < 12; ++c) {
      const auto axis = static_cast<int>(c % 3);
      if (c < 3) {
        patch.set(facet[c], normal.number(f, axis), normal.type);
      } else {
        patch.set(facet[c], shape.positions[3 * f + c / 3 - 1][axis], shape.position_type, shape.origin[axis]);
      }
    }
  return patch.finish();
}

struct Triangles {
  std::vector<std::array<Index, 3>> corners;
  std::size_t polygons = 0;  ///< that were cut
};

Triangles triangles_of(const Faces& faces) {
  Triangles out;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corners = faces[f];
    for (std::size_t c = 2; c < corners.size(); ++c) out.corners.push_back({corners[0], corners[c - 1], corners[c]});
    if (corners.size() > 3) ++out.polygons;
  }
  return out;
}

void report_losses(const Shape& shape, const Triangles& triangles, WriteReport& report) {
  const auto lose = [&report](const std::string& what) { report.lost.push_back("STL cannot hold " + what + "."); };
  if (triangles.polygons > 0)
    lose(counted(triangles.polygons, "face", "faces") + " of more than 3 corners: cut into triangles");
  std::vector<bool> used(shape.size(), false);
  std::size_t shared = 0;
  for (const Index p : shape.faces.points) {
    shared += used[p] ? 1 : 0;
    used[p] = true;
  }
  if (shared > 0) lose("points that faces share: each triangle has its own");
  const auto loose = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  if (loose > 0) lose(counted(loose, "point", "points") + " of no face");
  report_lost_precision("STL", shape, report);
  const Attribute* normal = shape.find("normal");
  const bool of_facets = normal != nullptr && !normal->per_point();
  report_lost_attributes("STL", shape, of_facets ? std::vector<std::string>{"normal"} : std::vector<std::string>{},
                         report);
}

std::vector<std::byte> new_stl(const std::string& path, const Shape& shape, WriteReport& report) {
  if (shape.faces.empty())
    throw file_error(path, "a shape with faces for STL", counted(shape.size(), "point", "points") + " without any");
  const Triangles triangles = triangles_of(shape.faces);
  if (triangles.corners.size() > std::numeric_limits<std::uint32_t>::max())
    throw file_error(path, "at most 4294967295 triangles for STL", std::to_string(triangles.corners.size()));
  report_losses(shape, triangles, report);
  static constexpr std::string_view title = "Binary STL";
  std::vector<std::byte> out(stl_header + stl_facet * triangles.corners.size());
  std::memcpy(out.data(), title.data(), title.size());
  store(out.data() + stl_header - 4, static_cast<std::uint32_t>(triangles.corners.size()), swap);
  std::byte* at = out.data() + stl_header;
  const auto put = [&at](const Vec3& p) {
    for (int c = 0; c < 3; ++c, at += sizeof(float)) store(at, static_cast<float>(p[c]), swap);
  };
  for (const auto& corners : triangles.corners) {
    const Vec3 &a = shape.positions[corners[0]], &b = shape.positions[corners[1]], &c = shape.positions[corners[2]];
    const Vec3 area = (b - a).cross(c - a);
    const double length = area.norm();
    put(length > 0 && std::isfinite(length) ? Vec3(area / length) : Vec3(0, 0, 0));
    for (const Index corner : corners) put(shape.positions[corner] + shape.origin);
    at += sizeof(std::uint16_t);
  }
  return out;
}

}  // namespace

std::vector<std::byte> write_stl(const std::string& path, const Shape& shape, WriteReport& report) {
  const auto* content = dynamic_cast<const StlContent*>(shape.content.get());
  if (content == nullptr || !is_soup(shape) || facets_of(path, *content) != shape.faces.size() ||
      (content->binary && shape.attributes[0].type != Type::Float32))
    return new_stl(path, shape, report);
  return content->binary ? patched_binary(*content, shape) : patched_text(path, *content, shape);
}

}  // namespace sinew::io
