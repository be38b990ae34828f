#pragma once
/// What the tests of file formats share: files as strings, the sentence of a refusal, and checks of a round trip.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/error.h"
#include "engine/io/io.h"

namespace sinew::io {

using ReadFunction = Shape (*)(const std::string&, std::vector<std::byte>, const ReadOptions&);
using WriteFunction = std::vector<std::byte> (*)(const std::string&, const Shape&, WriteReport&);

inline std::vector<std::byte> bytes_of(std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

inline std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline std::string text_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Reads as io::read does: the origin is set.
inline Shape read_text(ReadFunction read, std::string_view text, const std::string& path = "test") {
  Shape shape = read(path, bytes_of(text), {});
  set_origin(shape);
  return shape;
}

inline std::string write_text(WriteFunction write, const Shape& shape) {
  WriteReport report;
  return text_of(write("test", shape, report));
}

inline std::vector<std::string> lost(WriteFunction write, const Shape& shape) {
  WriteReport report;
  write("test", shape, report);
  return report.lost;
}

/// The sentence with which f refuses; "done" where it does not.
template <class F>
std::string sentence_of(F&& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "done";
}

/// The sentence with which the reader refuses the text; "read" where it does not.
inline std::string refusal(ReadFunction read, std::string_view text, const std::string& path = "test") {
  try {
    read(path, bytes_of(text), {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

/// What holds of every shape that a reader returns.
inline void expect_sound(const Shape& shape, const std::string& path) {
  EXPECT_TRUE(shape.position_type == Type::Float32 || shape.position_type == Type::Float64) << path;
  ASSERT_FALSE(shape.faces.offsets.empty()) << path;
  EXPECT_EQ(shape.faces.offsets.front(), 0u) << path;
  EXPECT_EQ(shape.faces.offsets.back(), shape.faces.points.size()) << path;
  EXPECT_TRUE(std::is_sorted(shape.faces.offsets.begin(), shape.faces.offsets.end())) << path;
  for (const Index p : shape.faces.points) ASSERT_LT(p, shape.size()) << path;
  for (const Tet& tet : shape.tets)
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_LT(tet[c], shape.size()) << path;
      for (std::size_t d = 0; d < c; ++d) ASSERT_NE(tet[c], tet[d]) << path;
    }
  for (const Attribute& attribute : shape.attributes) {
    ASSERT_GT(attribute.components, 0) << path;
    EXPECT_EQ(attribute.fields.size(), static_cast<std::size_t>(attribute.components)) << path << ' ' << attribute.name;
    EXPECT_EQ(attribute.values.size() % attribute.row_size(), 0u) << path << ' ' << attribute.name;
    if (attribute.per_point()) {
      EXPECT_EQ(attribute.count(), shape.size()) << path << ' ' << attribute.name;
      continue;
    }
    ASSERT_EQ(attribute.point_offsets.size(), attribute.count() + 1) << path << ' ' << attribute.name;
    EXPECT_TRUE(std::is_sorted(attribute.point_offsets.begin(), attribute.point_offsets.end())) << path;
    EXPECT_EQ(attribute.point_offsets.back(), attribute.points.size()) << path;
    for (const Index p : attribute.points) ASSERT_LT(p, shape.size()) << path;
  }
}

/// Either a refusal that names the file, or a sound shape that is written back byte for byte. For damaged files.
inline void expect_refused_or_exact(ReadFunction read, WriteFunction write, const std::string& path) {
  const std::string text = text_of_file(path);
  try {
    const Shape shape = read_text(read, text, path);
    expect_sound(shape, path);
    EXPECT_TRUE(write_text(write, shape) == text) << path;
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with(path)) << error.what();
    EXPECT_NE(std::string_view(error.what()).find(": expected "), std::string_view::npos) << error.what();
  }
}

/// A good file: sound, written back byte for byte, and after some points were moved the file that was written holds
/// those points to half a millimetre of a metre or a float's precision, and all others exactly as before.
inline void expect_exact(ReadFunction read, WriteFunction write, const std::string& path) {
  const std::string text = text_of_file(path);
  const Shape before = read_text(read, text, path);
  expect_sound(before, path);
  ASSERT_GT(before.size(), 0u) << path;
  ASSERT_TRUE(write_text(write, before) == text) << path;
  Shape moved = before;
  for (std::size_t i = 0; i < moved.size(); i += 7) moved.positions[i] += Vec3(0.123456789, -1.0 / 3, 2);
  const Shape after = read_text(read, write_text(write, moved), path);
  ASSERT_EQ(after.size(), before.size()) << path;
  EXPECT_EQ(after.faces.points, before.faces.points) << path;
  EXPECT_EQ(after.tets, before.tets) << path;
  // A text file with moved points can need doubles where floats did before, so that others are compared as floats.
  const bool as_float = before.position_type == Type::Float32;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!moved.positions[i].allFinite()) continue;
    const Vec3 now = after.positions[i] + after.origin, wanted = moved.positions[i] + moved.origin;
    const double tolerance = as_float ? 1e-7 * wanted.norm() : 1e-15 * wanted.norm();
    ASSERT_LE((now - wanted).norm(), tolerance) << path << " point " << i;
  }
}

}  // namespace sinew::io
