#include <algorithm>
#include <limits>

#include "engine/io/bgeo.h"
#include "engine/io/bgeo_content.h"
#include "engine/io/ply_generic.h"
#include "engine/io/rounding.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

bool same_layout(const Shape& shape, const BgeoContent& content) {
  if (content.points != shape.size() || content.faces != shape.faces.size() ||
      content.corners != shape.faces.points.size())
    return false;
  return std::all_of(content.columns.begin(), content.columns.end(), [&](const BgeoContent::Column& column) {
    const Attribute* attribute = shape.find(column.name);
    return attribute && attribute->per_point() && attribute->type == column.type &&
           attribute->components == column.components && attribute->count() == shape.size();
  });
}

std::vector<std::byte> patched(const Shape& shape, const BgeoContent& content, WriteReport& report) {
  std::vector<std::byte> out = content.bytes;
  Rounding rounding;
  for (std::size_t i = 0; i < shape.size(); ++i)
    for (int c = 0; c < 3; ++c)
      patch_coordinate<float>(&out[content.begin + i * content.stride + 4 * static_cast<std::size_t>(c)], bgeo_swap,
                              shape.positions[i][c], shape.origin[c], rounding);
  for (const BgeoContent::Column& column : content.columns) {
    const Attribute& attribute = *shape.find(column.name);
    const std::byte* from = attribute.values.data();
    for (std::size_t i = 0; i < shape.size(); ++i)
      for (std::size_t k = 0; k < attribute.row_size(); k += 4, from += 4)
        store(&out[content.begin + i * content.stride + column.offset + k], load<std::uint32_t>(from, false),
              bgeo_swap);
  }
  rounding.report(report);
  return out;
}

/// An attribute of a new file: its dictionary entry, and its values as the bits of floats or ints.
struct Output {
  std::string name;
  std::size_t size = 1;
  BgeoType type = BgeoType::Float;
  std::vector<std::uint32_t> values;
};

class NewBgeo {
 public:
  NewBgeo(const Shape& shape, WriteReport& report) : shape_(shape), report_(report) {
    for (const Attribute& attribute : shape.attributes) add(attribute);
    if (!shape.parts.empty())
      report.lost.push_back("bgeo cannot hold the division into " + std::to_string(shape.parts.size()) +
                            " scans and their poses.");
  }

  std::vector<std::byte> bytes() {
    append_text(out_, "BgeoV");
    const auto count = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
    for (const std::uint32_t x :
         {bgeo_version, count(shape_.size()), count(shape_.faces.size()), 0U, 0U, count(outputs_.size()), 0U, 0U, 0U})
      append(x);
    for (const Output& output : outputs_) append_definition(output);
    append_points();
    const bool long_index = shape_.size() > bgeo_short_points;
    for (std::size_t f = 0; f < shape_.faces.size(); ++f) {
      append(bgeo_polygon);
      append(count(shape_.faces[f].size()));
      append('<');
      for (const Index p : shape_.faces[f]) long_index ? append(p) : append(static_cast<std::uint16_t>(p));
    }
    append_text(out_, std::string_view("\x00\xff", 2));  // no further data
    return std::move(out_);
  }

 private:
  template <class T>
  void append(T x) {
    std::byte bytes[sizeof(T)];
    store(bytes, x, bgeo_swap);
    out_.insert(out_.end(), bytes, bytes + sizeof(T));
  }

  void append_definition(const Output& output) {
    append(static_cast<std::uint16_t>(output.name.size()));
    append_text(out_, output.name);
    append(static_cast<std::uint16_t>(output.size));
    append(static_cast<std::uint32_t>(output.type));
    for (std::size_t c = 0; c < output.size; ++c) append(std::uint32_t{0});
  }

  void append_points() {
    Rounding rounding;
    for (std::size_t i = 0; i < shape_.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double x = shape_.positions[i][c] + shape_.origin[c];
        if (std::abs(x) >= float_limit) rounding.see(x, static_cast<double>(static_cast<float>(x)));
        append(static_cast<float>(x));
      }
      append(1.0F);
      for (const Output& output : outputs_)
        for (std::size_t c = 0; c < output.size; ++c) append(output.values[i * output.size + c]);
    }
    rounding.report(report_);
  }

  void lose(const Attribute& attribute, const std::string& why) {
    report_.lost.push_back("bgeo cannot hold the attribute " + quoted(attribute.name) + why + ".");
  }

  void add(const Attribute& original) {
    const Attribute attribute = one_a_point(original, shape_.size());
    if (attribute.count() != shape_.size()) return lose(original, ": its values do not belong to one point each");
    if (attribute.name == "color" && is_text_color(attribute)) return add_color(attribute);
    if (attribute.components > std::numeric_limits<std::uint16_t>::max())
      return lose(original, ": more than 65535 values a point");
    Output output;
    output.name = free_name(attribute.kind == Kind::Velocity && attribute.components == 3 ? "v"
                            : attribute.kind == Kind::Normal && attribute.components == 3 ? "N"
                                                                                          : attribute.name);
    output.size = static_cast<std::size_t>(attribute.components);
    const bool vector =
        attribute.kind == Kind::Velocity || attribute.kind == Kind::Normal || attribute.kind == Kind::Vector;
    output.type = is_integer(attribute.type)            ? BgeoType::Int
                  : vector && attribute.components == 3 ? BgeoType::Vector
                                                        : BgeoType::Float;
    if (!fill(attribute, output)) return lose(original, ": integers beyond 32 bits");
    outputs_.push_back(std::move(output));
  }

  bool fill(const Attribute& attribute, Output& output) {
    output.values.resize(shape_.size() * output.size);
    bool rounds = false;
    for (std::size_t i = 0; i < output.values.size(); ++i) {
      const double x = attribute.number(i / output.size, static_cast<int>(i % output.size));
      if (output.type != BgeoType::Int) {
        if (attribute.type == Type::Float32) {
          output.values[i] = load<std::uint32_t>(attribute.values.data() + 4 * i, false);  // a NaN keeps its bits
          continue;
        }
        const auto narrow = static_cast<float>(x);
        rounds = rounds || (std::isfinite(x) && static_cast<double>(narrow) != x);
        output.values[i] = std::bit_cast<std::uint32_t>(narrow);
        continue;
      }
      if (!(x >= std::numeric_limits<std::int32_t>::min() && x <= std::numeric_limits<std::int32_t>::max()))
        return false;
      output.values[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(x));
    }
    if (rounds)
      report_.lost.push_back("bgeo rounds the doubles of the attribute " + quoted(attribute.name) + " to floats.");
    return true;
  }

  /// Cd, and Alpha where there is one.
  void add_color(const Attribute& color) {
    Output cd{free_name("Cd"), 3, BgeoType::Float, {}};
    Output alpha{"", 1, BgeoType::Float, {}};
    const auto append_value = [](Output& output, double x) {
      output.values.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    };
    for (std::size_t i = 0; i < shape_.size(); ++i) {
      std::uint32_t bits = 0;
      if (color.components == 1) bits = load<std::uint32_t>(color.values.data() + 4 * i, false);
      for (int c = 0; c < std::max(3, color.components); ++c) {
        double x = color.components == 1 ? ((bits >> (16 - 8 * c)) & 255) : color.number(i, c);
        if (color.components == 1 || color.type == Type::UInt8) x /= 255;
        append_value(c < 3 ? cd : alpha, x);
      }
    }
    outputs_.push_back(std::move(cd));
    if (color.components != 4) return;
    alpha.name = free_name("Alpha");
    outputs_.push_back(std::move(alpha));
  }

  /// Letters, digits and underlines, not beginning with a digit, and different from all others.
  std::string free_name(std::string name) {
    for (char& c : name)
      if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
    if (name.empty() || (name.front() >= '0' && name.front() <= '9')) name.insert(name.begin(), '_');
    name.resize(std::min<std::size_t>(name.size(), 1000));
    while (std::any_of(outputs_.begin(), outputs_.end(), [&](const Output& o) { return o.name == name; })) name += '_';
    return name;
  }

  const Shape& shape_;
  WriteReport& report_;
  std::vector<Output> outputs_;
  std::vector<std::byte> out_;
};

}  // namespace

std::vector<std::byte> write_bgeo(const std::string& path, const Shape& shape, WriteReport& report) {
  if (const auto* content = dynamic_cast<const BgeoContent*>(shape.content.get()); content) {
    if (same_layout(shape, *content)) {
      std::vector<std::string> held;
      for (const BgeoContent::Column& column : content->columns) held.push_back(column.name);
      report_lost_attributes("bgeo", shape, held, report);
      return patched(shape, *content, report);
    }
    report.lost.push_back(
        "What the bgeo file held besides points, attributes and polygons is not written: the points, "
        "attributes or faces are no longer those of the file.");
  }
  const std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (shape.size() > most || shape.faces.size() > most)
    throw file_error(path, "fewer than 2^31 points and faces in a bgeo file", std::to_string(shape.size()));
  return NewBgeo(shape, report).bytes();
}

}  // namespace sinew::io
