#include "engine/io/pcd.h"

#include <lzf.h>

#include <algorithm>

#include "engine/io/bytes.h"
#include "engine/io/pcd_content.h"
#include "engine/io/text.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

/// The values of text: as binary data would hold them.
std::vector<std::byte> parsed(const std::string& path, std::span<const std::byte> bytes, const PcdHeader& header) {
  std::vector<std::byte> values(header.points * header.point_size);
  TextCursor cursor(path, as_text(bytes), header.begin, header.line);
  std::byte* at = values.data();
  for (std::size_t i = 0; i < header.points; ++i) {
    Token first = cursor.next();
    for (std::size_t f = 0, k = 0; f < header.fields.size(); ++f) {
      const PcdField& field = header.fields[f];
      for (std::size_t c = 0; c < field.count; ++c, ++k) {
        const Token t = k == 0 ? first : cursor.token();
        if (!parse_value(t.text, field.type, at)) {
          if (t.text.empty() && cursor.at_end())
            throw text_error(path, t.line, t.column,
                             "point " + std::to_string(i + 1) + " of " + std::to_string(header.points),
                             "the end of the file");
          throw cursor.error(
              t, "a value of type " + std::string(name_of(field.type)) + " for field " + quoted(field.name));
        }
        at += size_of(field.type);
      }
    }
    const Token more = cursor.token();
    if (!more.text.empty())
      throw cursor.error(more, "the end of a line of " + std::to_string(header.values) + " values");
  }
  const Token more = cursor.next();
  if (!more.text.empty())
    throw cursor.error(more, "the end of the file after " + std::to_string(header.points) + " points");
  return values;
}

/// How many bytes LZF data unpack to, by its runs alone, so that memory is asked for what is there.
std::uint64_t unpacked_length(std::span<const std::byte> packed) {
  std::uint64_t length = 0;
  for (std::size_t i = 0; i < packed.size();) {
    const auto control = std::to_integer<std::size_t>(packed[i++]);
    if (control < 32) {
      length += control + 1;
      i += control + 1;
      continue;
    }
    const std::size_t shortened = control >> 5;
    length += 2 + shortened + (shortened == 7 && i < packed.size() ? std::to_integer<std::size_t>(packed[i]) : 0);
    i += shortened == 7 ? 2 : 1;
  }
  return length;
}

std::vector<std::byte> unpacked(const std::string& path, std::span<const std::byte> bytes, const PcdHeader& header) {
  ByteCursor cursor(path, bytes, header.begin);
  const auto packed = cursor.number<std::uint32_t>(false, "the size of the packed data");
  const auto size = cursor.number<std::uint32_t>(false, "the size of the unpacked data");
  const std::uint64_t expected = static_cast<std::uint64_t>(header.points) * header.point_size;
  if (size != expected)
    throw byte_error(path, static_cast<std::int64_t>(header.begin + 4),
                     std::to_string(expected) + " unpacked bytes for " + std::to_string(header.points) + " points",
                     std::to_string(size));
  const auto from = cursor.take(packed, "packed data");
  if (const std::uint64_t length = unpacked_length(from); length != size)
    throw byte_error(path, static_cast<std::int64_t>(header.begin + 8),
                     "LZF data that unpack to " + std::to_string(size) + " bytes",
                     "data for " + std::to_string(length));
  std::vector<std::byte> values(size);
  if (size > 0 && lzf_decompress(from.data(), packed, values.data(), size) != size)
    throw byte_error(path, static_cast<std::int64_t>(header.begin + 8),
                     "LZF data that unpack to " + std::to_string(size) + " bytes", "damaged data");
  return values;
}

bool is_id(const std::string& name) {
  return name.ends_with("label") || name == "id" || name.ends_with("_id");
}

class Grouping {
 public:
  explicit Grouping(const std::vector<PcdField>& fields) : fields_(fields), taken_(fields.size(), false) {}

  /// Empty where x, y and z are not there.
  std::vector<PcdGroup> groups() {
    if (!take("position", Kind::Point, {"x", "y", "z"}, false)) return {};
    take("normal", Kind::Normal, {"normal_x", "normal_y", "normal_z"}, true);
    for (const char* name : {"rgb", "rgba"}) take_packed_color(name);
    if (!take("color", Kind::Color, {"r", "g", "b", "a"}, true)) take("color", Kind::Color, {"r", "g", "b"}, true);
    for (std::size_t f = 0; f < fields_.size(); ++f)
      if (!taken_[f] && fields_[f].name != "_")
        groups_.push_back({names_.add(fields_[f].name), is_id(fields_[f].name) ? Kind::Id : Kind::Scalar, {f}});
    return std::move(groups_);
  }

 private:
  bool has(const std::string& name) const {
    return std::any_of(groups_.begin(), groups_.end(), [&](const PcdGroup& group) { return group.name == name; });
  }

  bool take(const char* name, Kind kind, const std::vector<const char*>& wanted, bool same_type) {
    if (has(name)) return false;
    PcdGroup group{name, kind, {}};
    for (const char* field : wanted) {
      const auto at = std::find_if(fields_.begin(), fields_.end(), [&](const PcdField& f) { return f.name == field; });
      if (at == fields_.end() || at->count != 1) return false;
      group.fields.push_back(static_cast<std::size_t>(at - fields_.begin()));
      if (same_type && at->type != fields_[group.fields.front()].type) return false;
    }
    for (const std::size_t f : group.fields) taken_[f] = true;
    groups_.push_back(std::move(group));
    return true;
  }

  void take_packed_color(const char* name) {
    const auto at = std::find_if(fields_.begin(), fields_.end(), [&](const PcdField& f) { return f.name == name; });
    if (at != fields_.end() && at->size() == 4 && at->count == 1) take("color", Kind::Color, {name}, false);
  }

  const std::vector<PcdField>& fields_;
  std::vector<bool> taken_;
  UniqueNames names_;
  std::vector<PcdGroup> groups_;
};

Type position_type(const PcdHeader& header, const PcdGroup& position) {
  const bool wide = std::any_of(position.fields.begin(), position.fields.end(), [&](std::size_t f) {
    return header.fields[f].type != Type::Float32 && size_of(header.fields[f].type) > 2;
  });
  return wide ? Type::Float64 : Type::Float32;
}

Attribute attribute_of(const PcdHeader& header, const PcdGroup& group, std::span<const std::byte> values) {
  Attribute attribute;
  attribute.name = group.name;
  attribute.kind = group.kind;
  attribute.type = header.fields[group.fields.front()].type;
  for (const std::size_t f : group.fields) {
    const PcdField& field = header.fields[f];
    for (std::size_t c = 0; c < field.count; ++c)
      attribute.fields.push_back(field.count == 1 ? field.name : field.name + "[" + std::to_string(c) + "]");
  }
  attribute.components = static_cast<int>(attribute.fields.size());
  attribute.values.resize(header.points * attribute.row_size());
  std::byte* to = attribute.values.data();
  for (std::size_t i = 0; i < header.points; ++i)
    for (const std::size_t f : group.fields) {
      std::memcpy(to, values.data() + header.at(f, i), header.fields[f].size());
      to += header.fields[f].size();
    }
  return attribute;
}

}  // namespace

std::vector<std::byte> pcd_values(const std::string& path, std::span<const std::byte> bytes, const PcdHeader& header) {
  if (header.data == PcdHeader::Data::Ascii) return parsed(path, bytes, header);
  if (header.points == 0) return {};
  if (header.data == PcdHeader::Data::Compressed) return unpacked(path, bytes, header);
  const auto values = bytes.subspan(header.begin, header.points * header.point_size);
  return {values.begin(), values.end()};
}

Shape read_pcd(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  auto content = std::make_shared<PcdContent>();
  content->bytes = std::move(bytes);
  content->header = parse_pcd_header(path, content->bytes);
  const PcdHeader& header = content->header;
  content->groups = Grouping(header.fields).groups();
  if (content->groups.empty()) throw file_error(path, "fields x, y and z of one value each", "none such in the header");
  report_progress(options, 0, 1);
  const std::vector<std::byte> values = pcd_values(path, content->bytes, header);

  Shape shape;
  shape.position_type = position_type(header, content->groups.front());
  shape.positions.resize(header.points);
  for (std::size_t i = 0; i < header.points; ++i)
    for (int c = 0; c < 3; ++c) {
      const std::size_t f = content->groups.front().fields[static_cast<std::size_t>(c)];
      shape.positions[i][c] = with_type(header.fields[f].type, [&](auto x) {
        return static_cast<double>(load<decltype(x)>(values.data() + header.at(f, i), false));
      });
    }
  for (std::size_t g = 1; g < content->groups.size(); ++g) {
    report_progress(options, g, content->groups.size());
    shape.attributes.push_back(attribute_of(header, content->groups[g], values));
  }
  shape.content = std::move(content);
  return shape;
}

}  // namespace sinew::io
