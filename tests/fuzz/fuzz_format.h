#pragma once
/// The body of the fuzz targets: any bytes are refused with an InputError, or read to a shape that is written back, can
/// be moved and written, and can be written as if it came from another format. All of it is read again.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/geometry/check.h"
#include "engine/geometry/error.h"
#include "engine/io/io.h"

namespace sinew::io {

using ReadFunction = Shape (*)(const std::string&, std::vector<std::byte>, const ReadOptions&);
using WriteFunction = std::vector<std::byte> (*)(const std::string&, const Shape&, WriteReport&);

inline void check_sound(const Shape& shape) {
  CHECK(shape.faces.offsets.front() == 0 && shape.faces.offsets.back() == shape.faces.points.size());
  for (const Index p : shape.faces.points) CHECK(p < shape.size(), p);
  for (const Tet& tet : shape.tets)
    for (std::size_t c = 0; c < 4; ++c) {
      CHECK(tet[c] < shape.size(), tet[c]);
      for (std::size_t d = 0; d < c; ++d) CHECK(tet[c] != tet[d], tet[c]);
    }
  for (const Attribute& attribute : shape.attributes) {
    CHECK(attribute.components > 0 && attribute.fields.size() == static_cast<std::size_t>(attribute.components));
    if (attribute.per_point()) {
      CHECK(attribute.values.size() == shape.size() * attribute.row_size(), attribute.name);
      continue;
    }
    CHECK(attribute.point_offsets.size() == attribute.count() + 1, attribute.name);
    CHECK(attribute.point_offsets.back() == attribute.points.size(), attribute.name);
    for (const Index p : attribute.points) CHECK(p < shape.size(), p);
  }
}

/// Reads what a writer gave: it has as many points and faces.
inline Shape read_again(ReadFunction read, WriteFunction write, const Shape& shape) {
  WriteReport report;
  Shape again = read("again", write("again", shape, report), {});
  check_sound(again);
  set_origin(again);
  CHECK(again.size() == shape.size(), again.size(), shape.size());
  return again;
}

inline void fuzz_format(ReadFunction read, WriteFunction write, std::span<const std::uint8_t> data) {
  const auto bytes = std::as_bytes(data);
  Shape shape;
  try {
    shape = read("fuzz", {bytes.begin(), bytes.end()}, {});
  } catch (const InputError&) {
    return;
  }
  check_sound(shape);
  set_origin(shape);
  WriteReport report;
  const std::vector<std::byte> same = write("fuzz", shape, report);
  CHECK(std::equal(same.begin(), same.end(), bytes.begin(), bytes.end()), same.size(), bytes.size());
  if (shape.size() == 0) return;

  Shape moved = shape;
  for (std::size_t i = 0; i < moved.size(); i += 2) moved.positions[i] += Vec3(0.1, -1000.0 / 3, 1e7);
  const Shape again = read_again(read, write, moved);
  CHECK(again.faces.offsets == shape.faces.offsets && again.faces.points == shape.faces.points);
  CHECK(again.tets == shape.tets);
  CHECK(again.attributes.size() == shape.attributes.size());

  moved.content = nullptr;
  read_again(read, write, moved);
}

}  // namespace sinew::io
