#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/io/bytes.h"
#include "engine/io/pcd.h"
#include "engine/io/pcd_content.h"
#include "engine/io/rounding.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

/// LZF (liblzf's format). Written here because the library's own packer starts from an uninitialised table: its bytes
/// depend on what lay in memory, ours on the values alone.
class LzfPacker {
 public:
  explicit LzfPacker(std::span<const std::byte> in) : in_(in), last_(1 << 16, none) {}

  std::vector<std::byte> pack() {
    std::size_t at = 0, literals = 0;
    while (at + 2 < in_.size()) {
      std::uint32_t& slot = last_[hash(at)];
      const std::size_t from = slot;
      slot = static_cast<std::uint32_t>(at);
      const std::size_t length = from == none || at - from > 8192 ? 0 : match(from, at);
      if (length < 3) {
        ++at;
        continue;
      }
      put_literals(literals, at);
      put_reference(at - from - 1, length - 2);
      at += length;
      literals = at;
    }
    put_literals(literals, in_.size());
    return std::move(out_);
  }

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::size_t hash(std::size_t at) const {
    const auto byte = [&](std::size_t i) { return std::to_integer<std::uint32_t>(in_[at + i]); };
    return ((byte(0) | byte(1) << 8 | byte(2) << 16) * 2654435761U) >> 16;
  }

  std::size_t match(std::size_t from, std::size_t at) const {
    const std::size_t most = std::min<std::size_t>(264, in_.size() - at);
    std::size_t length = 0;
    while (length < most && in_[from + length] == in_[at + length]) ++length;
    return length;
  }

  void put_literals(std::size_t begin, std::size_t end) {
    for (; begin < end; begin += std::min<std::size_t>(32, end - begin)) {
      const std::size_t count = std::min<std::size_t>(32, end - begin);
      out_.push_back(static_cast<std::byte>(count - 1));
      out_.insert(out_.end(), in_.begin() + static_cast<std::ptrdiff_t>(begin),
                  in_.begin() + static_cast<std::ptrdiff_t>(begin + count));
    }
  }

  /// `length` is that of the match less 2: 1 to 262.
  void put_reference(std::size_t distance, std::size_t length) {
    out_.push_back(static_cast<std::byte>(std::min<std::size_t>(length, 7) << 5 | distance >> 8));
    if (length >= 7) out_.push_back(static_cast<std::byte>(length - 7));
    out_.push_back(static_cast<std::byte>(distance & 255));
  }

  std::span<const std::byte> in_;
  std::vector<std::uint32_t> last_;  ///< where the three bytes of a hash were seen last
  std::vector<std::byte> out_;
};

void store_positions(const Shape& shape, const PcdHeader& header, const PcdGroup& group, std::span<std::byte> values,
                     WriteReport& report) {
  Rounding rounding;
  for (std::size_t i = 0; i < shape.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const std::size_t f = group.fields[static_cast<std::size_t>(c)];
      std::byte* at = values.data() + header.at(f, i);
      with_type(header.fields[f].type, [&](auto x) {
        patch_coordinate<decltype(x)>(at, false, shape.positions[i][c], shape.origin[c], rounding);
        return 0;
      });
    }
  rounding.report(report);
}

void store_attribute(const Attribute& attribute, const PcdHeader& header, const PcdGroup& group,
                     std::span<std::byte> values) {
  const std::byte* from = attribute.values.data();
  for (std::size_t i = 0; i < header.points; ++i)
    for (const std::size_t f : group.fields) {
      std::memcpy(values.data() + header.at(f, i), from, header.fields[f].size());
      from += header.fields[f].size();
    }
}

bool same_layout(const Shape& shape, const PcdContent& content) {
  if (content.header.points != shape.size() || !shape.faces.empty()) return false;
  for (std::size_t g = 1; g < content.groups.size(); ++g) {
    const PcdGroup& group = content.groups[g];
    const Attribute* attribute = shape.find(group.name);
    std::size_t size = 0;
    for (const std::size_t f : group.fields) size += content.header.fields[f].size();
    if (!attribute || !attribute->per_point() || attribute->row_size() != size ||
        attribute->type != content.header.fields[group.fields.front()].type || attribute->count() != shape.size())
      return false;
  }
  return true;
}

/// The text with those values replaced in which `now` differs from `before`.
std::vector<std::byte> patched_text(const PcdContent& content, std::span<const std::byte> before,
                                    std::span<const std::byte> now) {
  const PcdHeader& header = content.header;
  TextPatch patch(content.bytes);
  TextCursor cursor("", as_text(content.bytes), header.begin);
  std::size_t at = 0;
  for (std::size_t i = 0; i < header.points; ++i)
    for (const PcdField& field : header.fields)
      for (std::size_t c = 0; c < field.count; ++c, at += size_of(field.type)) {
        const Token t = cursor.next();
        if (std::memcmp(&before[at], &now[at], size_of(field.type)) == 0) continue;
        patch.replace(t, value_text(field.type, &now[at]));
      }
  return patch.finish();
}

std::vector<std::byte> repacked(const std::string& path, const PcdContent& content, std::span<const std::byte> now) {
  const PcdHeader& header = content.header;
  const std::vector<std::byte> packed = LzfPacker(now).pack();
  if (packed.size() > std::numeric_limits<std::uint32_t>::max())
    throw file_error(path, "compressed PCD data below 4 GiB", std::to_string(packed.size()) + " bytes");
  std::uint32_t sizes[2];
  std::memcpy(sizes, content.bytes.data() + header.begin, sizeof(sizes));
  const std::size_t tail = header.begin + sizeof(sizes) + sizes[0];
  sizes[0] = static_cast<std::uint32_t>(packed.size());
  std::vector<std::byte> out(content.bytes.begin(), content.bytes.begin() + static_cast<std::ptrdiff_t>(header.begin));
  append_text(out, as_text(std::as_bytes(std::span(sizes))));
  append_text(out, as_text(packed));
  append_text(out, as_text(std::span(content.bytes).subspan(tail)));
  return out;
}

std::vector<std::byte> patched(const std::string& path, const Shape& shape, const PcdContent& content,
                               WriteReport& report) {
  const PcdHeader& header = content.header;
  const std::vector<std::byte> before = pcd_values(path, content.bytes, header);
  std::vector<std::byte> now = before;
  store_positions(shape, header, content.groups.front(), now, report);
  for (std::size_t g = 1; g < content.groups.size(); ++g)
    store_attribute(*shape.find(content.groups[g].name), header, content.groups[g], now);
  if (now == before) return content.bytes;
  if (header.data == PcdHeader::Data::Ascii) return patched_text(content, before, now);
  if (header.data == PcdHeader::Data::Compressed) return repacked(path, content, now);
  std::vector<std::byte> out = content.bytes;
  std::copy(now.begin(), now.end(), out.begin() + static_cast<std::ptrdiff_t>(header.begin));
  return out;
}

/// Fields of an attribute of another format; none where PCD cannot hold it.
std::vector<PcdField> fields_of(const Attribute& attribute) {
  const auto count = static_cast<std::size_t>(attribute.components);
  if (!attribute.per_point()) return {};
  if (attribute.name == "normal" && count == 3)
    return {{"normal_x", attribute.type}, {"normal_y", attribute.type}, {"normal_z", attribute.type}};
  if (attribute.name == "color" && count == 1) return {{"rgb", attribute.type}};
  if (attribute.name == "color" && (count == 3 || count == 4)) {
    if (attribute.type == Type::UInt8) return {{count == 4 ? "rgba" : "rgb", Type::UInt32}};
    std::vector<PcdField> fields = {{"r", attribute.type}, {"g", attribute.type}, {"b", attribute.type}};
    if (count == 4) fields.push_back({"a", attribute.type});
    return fields;
  }
  PcdField field{attribute.name, attribute.type, count};
  for (char& c : field.name)
    if (static_cast<unsigned char>(c) <= ' ') c = '_';
  if (field.name.empty() || field.name == "_") field.name = "unnamed";
  return {field};
}

std::string header_text(const std::vector<PcdField>& fields, std::size_t points) {
  std::string names = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (const PcdField& field : fields) {
    const bool is_signed =
        field.type == Type::Int8 || field.type == Type::Int16 || field.type == Type::Int32 || field.type == Type::Int64;
    names += " " + field.name;
    sizes += " " + std::to_string(size_of(field.type));
    types += !is_integer(field.type) ? " F" : is_signed ? " I" : " U";
    counts += " " + std::to_string(field.count);
  }
  const std::string n = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + names + "\n" + sizes + "\n" + types + "\n" +
         counts + "\nWIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n";
}

template <class T>
void append_value(std::vector<std::byte>& out, T x) {
  append_text(out, as_text(std::as_bytes(std::span(&x, 1))));
}

void append_row(std::vector<std::byte>& out, const Attribute& attribute, std::size_t i) {
  const std::byte* row = attribute.values.data() + i * attribute.row_size();
  if (attribute.name != "color" || attribute.type != Type::UInt8 || attribute.components < 3) {
    out.insert(out.end(), row, row + attribute.row_size());
    return;
  }
  const auto byte = [&](int c) { return std::to_integer<std::uint32_t>(row[c]); };
  const std::uint32_t alpha = attribute.components == 4 ? byte(3) : 255;
  append_value(out, alpha << 24 | byte(0) << 16 | byte(1) << 8 | byte(2));
}

std::vector<std::byte> generic(const Shape& shape, WriteReport& report) {
  const Type type = shape.position_type;
  std::vector<PcdField> fields = {{"x", type}, {"y", type}, {"z", type}};
  std::vector<const Attribute*> attributes;
  std::vector<std::string> held;
  for (const Attribute& attribute : shape.attributes) {
    const std::vector<PcdField> more = fields_of(attribute);
    if (more.empty()) continue;
    fields.insert(fields.end(), more.begin(), more.end());
    attributes.push_back(&attribute);
    held.push_back(attribute.name);
  }
  report_lost_attributes("PCD", shape, held, report);
  if (!shape.faces.empty())
    report.lost.push_back("PCD cannot hold the " + counted(shape.faces.size(), "face", "faces") + ".");

  std::vector<std::byte> out;
  append_text(out, header_text(fields, shape.size()));
  Rounding rounding;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double x = shape.positions[i][c] + shape.origin[c];
      if (type == Type::Float64) {
        append_value(out, x);
        continue;
      }
      append_value(out, static_cast<float>(x));
      if (std::abs(x) >= float_limit) rounding.see(x, static_cast<double>(static_cast<float>(x)));
    }
    for (const Attribute* attribute : attributes) append_row(out, *attribute, i);
  }
  rounding.report(report);
  return out;
}

}  // namespace

std::vector<std::byte> write_pcd(const std::string& path, const Shape& shape, WriteReport& report) {
  const auto* content = dynamic_cast<const PcdContent*>(shape.content.get());
  if (!content || !same_layout(shape, *content)) return generic(shape, report);
  std::vector<std::string> held;
  for (const PcdGroup& group : content->groups) held.push_back(group.name);
  report_lost_attributes("PCD", shape, held, report);
  return patched(path, shape, *content, report);
}

}  // namespace sinew::io
