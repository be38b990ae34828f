#include "engine/io/ply_generic.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "engine/geometry/error.h"
#include "engine/io/ply_vertices.h"
#include "engine/io/text.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

/// The names by which programs that read PLY know the components.
std::vector<std::string> standard_fields(const Attribute& attribute) {
  const auto components = static_cast<std::size_t>(attribute.components);
  const bool complete = attribute.fields.size() == components;
  if (complete && is_ply_group(attribute.fields, attribute.kind)) return attribute.fields;
  if (attribute.kind == Kind::Normal && components == 3) return {"nx", "ny", "nz"};
  if (attribute.kind == Kind::Color && components == 3) return {"red", "green", "blue"};
  if (attribute.kind == Kind::Color && components == 4) return {"red", "green", "blue", "alpha"};
  if (attribute.kind == Kind::Velocity && components == 3) return {"vx", "vy", "vz"};
  if (complete) return attribute.fields;
  if (components == 1) return {attribute.name};
  std::vector<std::string> fields;
  for (std::size_t c = 0; c < components; ++c) fields.push_back(attribute.name + "_" + std::to_string(c));
  return fields;
}

/// A word that no other property of the points has.
std::string free_word(std::string name, std::unordered_set<std::string>& taken) {
  for (char& c : name)
    if (TextCursor::is_blank(c) || TextCursor::is_end(c)) c = '_';
  if (name.empty()) name = "value";
  while (!taken.insert(name).second) name += '_';
  return name;
}

/// 64-bit integers as doubles, if they all are one.
bool fits_double(const Attribute& attribute) {
  const std::size_t n = attribute.count() * static_cast<std::size_t>(attribute.components);
  constexpr std::uint64_t largest = std::uint64_t{1} << 53;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t x = load<std::uint64_t>(attribute.values.data() + i * sizeof(x), false);
    if (attribute.type == Type::Int64 && (x >> 63) != 0) x = std::uint64_t{0} - x;
    if (x > largest) return false;
  }
  return true;
}

Attribute as_double(const Attribute& attribute) {
  Attribute out = attribute;
  out.type = Type::Float64;
  const int components = attribute.components;
  out.values.resize(attribute.count() * out.row_size());
  for (std::size_t i = 0; i < attribute.count(); ++i)
    for (int c = 0; c < components; ++c) out.set_number(i, c, attribute.number(i, c));
  return out;
}

/// The attributes that PLY can hold, one value a point, with free field names.
std::vector<Attribute> writable(const Shape& shape, WriteReport& report) {
  std::vector<Attribute> out;
  std::unordered_set<std::string> taken{"x", "y", "z"};
  for (const Attribute& attribute : shape.attributes) {
    Attribute a = one_a_point(attribute, shape.size());
    if (a.count() != shape.size()) {
      report.lost.push_back("PLY cannot hold the attribute " + sinew::quoted(attribute.name) +
                            ": its values do not belong to one point each.");
      continue;
    }
    if (ply_name_of(a.type) == nullptr) {
      if (!fits_double(a)) {
        report.lost.push_back("PLY cannot hold the attribute " + sinew::quoted(attribute.name) +
                              ": integers beyond 2^53.");
        continue;
      }
      a = as_double(a);
    }
    a.fields = standard_fields(attribute);
    for (std::string& field : a.fields) field = free_word(field, taken);
    out.push_back(std::move(a));
  }
  return out;
}

void append(std::vector<std::byte>& out, const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  out.insert(out.end(), begin, begin + text.size());
}

template <class T>
void append(std::vector<std::byte>& out, T x) {
  std::byte bytes[sizeof(T)];
  store(bytes, x, std::endian::native != std::endian::little);
  out.insert(out.end(), bytes, bytes + sizeof(T));
}

std::string header_of(const Shape& shape, const std::vector<Attribute>& attributes, bool long_faces) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(shape.size()) + "\n";
  const auto property = [&header](Type type, const std::string& name) {
    header += std::string("property ") + ply_name_of(type) + " " + name + "\n";
  };
  for (const char* name : {"x", "y", "z"}) property(shape.position_type, name);
  for (const Attribute& attribute : attributes)
    for (const std::string& field : attribute.fields) property(attribute.type, field);
  if (!shape.faces.empty()) {
    header += "element face " + std::to_string(shape.faces.size()) + "\nproperty list ";
    header += long_faces ? "int" : "uchar";
    // Most programs read int, which holds any index but those of more than 2^31 points.
    header += shape.size() > std::size_t{1} << 31 ? " uint" : " int";
    header += " vertex_indices\n";
  }
  return header + "end_header\n";
}

void append_points(std::vector<std::byte>& out, const Shape& shape, const std::vector<Attribute>& attributes) {
  constexpr bool swap = std::endian::native != std::endian::little;
  std::size_t stride = 3 * size_of(shape.position_type);
  for (const Attribute& attribute : attributes) stride += attribute.row_size();
  const std::size_t begin = out.size();
  out.resize(begin + shape.size() * stride);
  std::byte* at = out.data() + begin;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      with_type(shape.position_type, [&](auto t) {
        store(at, rounded<decltype(t)>(shape.positions[i][c] + shape.origin[c]), swap);
        at += sizeof(t);
      });
    for (const Attribute& attribute : attributes) {
      const std::size_t size = size_of(attribute.type), row = attribute.row_size();
      std::memcpy(at, attribute.values.data() + i * row, row);
      if constexpr (swap)
        for (std::byte* value = at; value < at + row; value += size) std::reverse(value, value + size);
      at += row;
    }
  }
}

void append_faces(std::vector<std::byte>& out, const Faces& faces, bool long_faces) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corners = faces[f];
    if (long_faces) {
      append(out, static_cast<std::uint32_t>(corners.size()));
    } else {
      append(out, static_cast<std::uint8_t>(corners.size()));
    }
    for (const Index corner : corners) append(out, corner);
  }
}

}  // namespace

Attribute one_a_point(const Attribute& attribute, std::size_t n) {
  if (attribute.per_point()) return attribute;
  Attribute out = attribute;
  out.values.assign(n * attribute.row_size(), std::byte{0});
  out.point_offsets.clear();
  out.points.clear();
  const std::size_t row = attribute.row_size();
  std::vector<bool> has(n, false);
  bool good = attribute.points.size() == n;
  for (std::size_t v = 0; good && v + 1 < attribute.point_offsets.size(); ++v)
    for (std::size_t e = attribute.point_offsets[v]; good && e < attribute.point_offsets[v + 1]; ++e) {
      const std::uint32_t point = attribute.points[e];
      good = !has[point];
      has[point] = true;
      std::memcpy(out.values.data() + point * row, attribute.values.data() + v * row, row);
    }
  if (!good) out.values.clear();
  return out;
}

std::vector<std::byte> new_ply(const Shape& shape, WriteReport& report) {
  const std::vector<Attribute> attributes = writable(shape, report);
  bool long_faces = false;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) long_faces = long_faces || shape.faces[f].size() > 255;
  if (!shape.parts.empty())
    report.lost.push_back("PLY cannot hold the division into " + std::to_string(shape.parts.size()) +
                          " scans and their poses.");
  std::vector<std::byte> out;
  append(out, header_of(shape, attributes, long_faces));
  append_points(out, shape, attributes);
  append_faces(out, shape.faces, long_faces);
  return out;
}

}  // namespace sinew::io
