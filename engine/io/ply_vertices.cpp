#include "engine/io/ply_vertices.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "engine/io/values.h"

namespace sinew::io {

namespace {

struct Group {
  const char* name;  ///< of the attribute
  Kind kind;
  std::vector<std::string> fields;
};

/// Fields that belong together where they are all there and have the same type. Longer ones come first.
const std::vector<Group>& groups() {
  static const std::vector<Group> all{
      {"normal", Kind::Normal, {"nx", "ny", "nz"}},
      {"normal", Kind::Normal, {"normal_x", "normal_y", "normal_z"}},
      {"color", Kind::Color, {"red", "green", "blue", "alpha"}},
      {"color", Kind::Color, {"red", "green", "blue"}},
      {"color", Kind::Color, {"r", "g", "b", "a"}},
      {"color", Kind::Color, {"r", "g", "b"}},
      {"diffuse", Kind::Color, {"diffuse_red", "diffuse_green", "diffuse_blue"}},
      {"ambient", Kind::Color, {"ambient_red", "ambient_green", "ambient_blue"}},
      {"specular", Kind::Color, {"specular_red", "specular_green", "specular_blue"}},
      {"velocity", Kind::Velocity, {"vx", "vy", "vz"}},
      {"velocity", Kind::Velocity, {"velocity_x", "velocity_y", "velocity_z"}},
      {"rot", Kind::Quaternion, {"rot_0", "rot_1", "rot_2", "rot_3"}},
      {"scale", Kind::LogScale, {"scale_0", "scale_1", "scale_2"}},
      {"f_dc", Kind::SphericalHarmonics, {"f_dc_0", "f_dc_1", "f_dc_2"}},
  };
  return all;
}

bool is_id(std::string_view name) {
  static constexpr std::array<std::string_view, 18> ids{
      "id",       "point_id",       "pointid", "vertex_id",  "patch", "patch_id", "label", "labels",  "class",
      "class_id", "classification", "segment", "segment_id", "flags", "index",    "scan",  "scan_id", "instance"};
  return std::find(ids.begin(), ids.end(), name) != ids.end();
}

/// Indices of the properties with these names, if all are there, free, of one type, and none is a list.
std::vector<std::size_t> find_group(const PlyElement& vertices, const std::vector<PlyColumn>& columns,
                                    const std::vector<std::string>& fields) {
  std::vector<std::size_t> found;
  for (const std::string& field : fields) {
    const auto at = std::find_if(vertices.properties.begin(), vertices.properties.end(),
                                 [&](const PlyProperty& p) { return p.name == field && !p.list; });
    if (at == vertices.properties.end()) return {};
    const auto i = static_cast<std::size_t>(at - vertices.properties.begin());
    if (columns[i].attribute != PlyColumn::unused) return {};
    if (!found.empty() && vertices.properties[found[0]].type != at->type) return {};
    found.push_back(i);
  }
  return found;
}

/// "f_rest_0" ... as many as there are.
std::vector<std::string> rest_fields(const PlyElement& vertices) {
  std::size_t count = 0;
  for (const PlyProperty& p : vertices.properties)
    if (p.name.starts_with("f_rest_")) ++count;
  std::vector<std::string> fields;
  for (std::size_t i = 0; i < count; ++i) fields.push_back("f_rest_" + std::to_string(i));
  return fields;
}

/// Attributes while they are found: the order that counts is that of the first field of each.
struct Found {
  std::size_t first;
  std::vector<std::size_t> properties;
  Attribute attribute;
};

class LayoutMaker {
 public:
  explicit LayoutMaker(const PlyHeader& header) : vertices_(header.vertices()) {
    layout_.swap = header.swap();
    layout_.columns.resize(vertices_.properties.size());
    offsets_and_position();
    for (const Group& group : groups()) take(group.name, group.kind, group.fields);
    if (const auto rest = rest_fields(vertices_); !rest.empty()) take("f_rest", Kind::SphericalHarmonics, rest);
    for (std::size_t i = 0; i < vertices_.properties.size(); ++i) {
      const PlyProperty& p = vertices_.properties[i];
      if (!p.list && layout_.columns[i].attribute == PlyColumn::unused)
        take(p.name, is_id(p.name) ? Kind::Id : Kind::Scalar, {p.name});
    }
    number_attributes();
  }

  PlyVertices layout() && { return std::move(layout_); }

 private:
  static constexpr int taken = 0;

  void offsets_and_position() {
    static constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
    for (std::size_t i = 0; i < vertices_.properties.size(); ++i) {
      const PlyProperty& p = vertices_.properties[i];
      PlyColumn& column = layout_.columns[i];
      column.type = p.type;
      column.offset = layout_.stride;
      layout_.stride += size_of(p.list ? p.count_type : p.type);
      const auto at = std::find(names.begin(), names.end(), p.name);
      if (at == names.end() || p.list) continue;
      column.attribute = PlyColumn::position;
      column.component = static_cast<int>(at - names.begin());
      const bool wide = p.type == Type::Float64 || p.type == Type::Int32 || p.type == Type::UInt32;
      if (wide) layout_.position_type = Type::Float64;
    }
  }

  void take(const std::string& name, Kind kind, const std::vector<std::string>& fields) {
    auto properties = find_group(vertices_, layout_.columns, fields);
    if (properties.empty()) return;
    Found found;
    found.first = *std::min_element(properties.begin(), properties.end());
    found.attribute.name = name;
    found.attribute.fields = fields;
    found.attribute.kind = kind;
    found.attribute.type = vertices_.properties[found.first].type;
    found.attribute.components = static_cast<int>(fields.size());
    for (const std::size_t i : properties) layout_.columns[i].attribute = taken;
    found.properties = std::move(properties);
    found_.push_back(std::move(found));
  }

  void number_attributes() {
    std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.first < b.first; });
    for (Found& found : found_) {
      const int index = static_cast<int>(layout_.attributes.size());
      for (std::size_t c = 0; c < found.properties.size(); ++c) {
        layout_.columns[found.properties[c]].attribute = index;
        layout_.columns[found.properties[c]].component = static_cast<int>(c);
      }
      // A property may have the name that a group of others has been given.
      const auto same = [&](const Attribute& a) { return a.name == found.attribute.name; };
      while (std::any_of(layout_.attributes.begin(), layout_.attributes.end(), same)) found.attribute.name += '_';
      layout_.attributes.push_back(std::move(found.attribute));
    }
  }

  const PlyElement& vertices_;
  PlyVertices layout_;
  std::vector<Found> found_;
};

void append_positions(const PlyVertices& layout, const PlyColumn& column, std::span<const std::byte> rows,
                      double origin, std::span<Vec3> out) {
  with_type(column.type, [&](auto t) {
    const std::byte* at = rows.data() + column.offset;
    for (Vec3& p : out) {
      p[column.component] = static_cast<double>(load<decltype(t)>(at, layout.swap)) - origin;
      at += layout.stride;
    }
  });
}

double as_coordinate(const PlyVertices& layout, double x) {
  return layout.narrow ? static_cast<double>(static_cast<float>(x)) : x;
}

void patch_positions(const PlyVertices& layout, const PlyColumn& column, std::span<std::byte> rows, double origin,
                     std::span<const Vec3> in) {
  with_type(column.type, [&](auto t) {
    using T = decltype(t);
    std::byte* at = rows.data() + column.offset;
    for (const Vec3& p : in) {
      const double now = p[column.component];
      const double file = as_coordinate(layout, static_cast<double>(load<T>(at, layout.swap)));
      if (!same_coordinate(file, origin, now)) store(at, rounded<T>(as_coordinate(layout, now + origin)), layout.swap);
      at += layout.stride;
    }
  });
}

/// Values are moved as bits, so that no not-a-number and no negative zero changes.
template <class Bits>
void append_values(const PlyVertices& layout, const PlyColumn& column, std::span<const std::byte> rows, Attribute& out,
                   std::size_t first) {
  const auto components = static_cast<std::size_t>(out.components);
  const std::byte* at = rows.data() + column.offset;
  std::byte* to = out.values.data() + (first * components + static_cast<std::size_t>(column.component)) * sizeof(Bits);
  for (std::size_t n = rows.size() / layout.stride; n > 0; --n) {
    store(to, load<Bits>(at, layout.swap), false);
    at += layout.stride;
    to += components * sizeof(Bits);
  }
}

template <class Bits>
void patch_values(const PlyVertices& layout, const PlyColumn& column, std::span<std::byte> rows, const Attribute& in,
                  std::size_t first) {
  const auto components = static_cast<std::size_t>(in.components);
  std::byte* at = rows.data() + column.offset;
  const std::byte* from =
      in.values.data() + (first * components + static_cast<std::size_t>(column.component)) * sizeof(Bits);
  for (std::size_t n = rows.size() / layout.stride; n > 0; --n) {
    store(at, load<Bits>(from, false), layout.swap);
    at += layout.stride;
    from += components * sizeof(Bits);
  }
}

template <class F>
void with_bits(Type type, F&& f) {
  switch (size_of(type)) {
    case 1: return f(std::uint8_t{});
    case 2: return f(std::uint16_t{});
    case 4: return f(std::uint32_t{});
    default: return f(std::uint64_t{});
  }
}

constexpr std::size_t cache_rows = 2048;  ///< rows that all columns walk before the next

}  // namespace

PlyVertices layout_of(const PlyHeader& header) {
  return LayoutMaker(header).layout();
}

void append_rows(const PlyVertices& layout, std::span<const std::byte> rows, Shape& shape) {
  const std::size_t n = rows.size() / layout.stride, before = shape.size();
  shape.positions.resize(before + n);
  for (Attribute& attribute : shape.attributes) attribute.values.resize((before + n) * attribute.row_size());
  for (std::size_t first = 0; first < n; first += cache_rows) {
    const std::size_t count = std::min(cache_rows, n - first);
    const auto block = rows.subspan(first * layout.stride, count * layout.stride);
    const std::span<Vec3> positions(shape.positions.data() + before + first, count);
    for (const PlyColumn& column : layout.columns) {
      if (column.attribute == PlyColumn::position)
        append_positions(layout, column, block, shape.origin[column.component], positions);
      else if (column.attribute >= 0)
        with_bits(column.type, [&](auto bits) {
          Attribute& attribute = shape.attributes[static_cast<std::size_t>(column.attribute)];
          append_values<decltype(bits)>(layout, column, block, attribute, before + first);
        });
    }
  }
}

void patch_rows(const PlyVertices& layout, const Shape& shape, std::size_t first, std::span<std::byte> rows) {
  const std::size_t n = rows.size() / layout.stride;
  for (std::size_t begin = 0; begin < n; begin += cache_rows) {
    const std::size_t count = std::min(cache_rows, n - begin);
    const auto block = rows.subspan(begin * layout.stride, count * layout.stride);
    const std::span<const Vec3> positions(shape.positions.data() + first + begin, count);
    for (const PlyColumn& column : layout.columns) {
      if (column.attribute == PlyColumn::position)
        patch_positions(layout, column, block, shape.origin[column.component], positions);
      else if (column.attribute >= 0)
        with_bits(column.type, [&](auto bits) {
          const Attribute& attribute = shape.attributes[static_cast<std::size_t>(column.attribute)];
          patch_values<decltype(bits)>(layout, column, block, attribute, first + begin);
        });
    }
  }
}

bool is_ply_group(const std::vector<std::string>& names, Kind kind) {
  return std::any_of(groups().begin(), groups().end(),
                     [&](const Group& group) { return group.kind == kind && group.fields == names; });
}

}  // namespace sinew::io
