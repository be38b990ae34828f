#include "engine/io/vtk_array.h"

#include <algorithm>
#include <array>

#include "engine/io/bytes.h"
#include "engine/io/ply_generic.h"
#include "engine/io/rounding.h"
#include "engine/io/solid_text.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

void swap_values(Type type, std::span<std::byte> values) {
  const std::size_t size = size_of(type);
  for (std::size_t i = 0; size > 1 && i < values.size(); i += size) std::reverse(&values[i], &values[i] + size);
}

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// A walk over base64, four characters at a time; white space between them is skipped.
class Base64 {
 public:
  struct Group {
    std::array<std::size_t, 4> at{};  ///< bytes of the file
    std::array<std::byte, 3> bytes{};
    std::size_t size = 0;  ///< 1 to 3 bytes
  };

  Base64(const std::string& path, std::span<const std::byte> bytes, std::size_t begin, std::size_t end)
      : path_(path), bytes_(bytes), at_(begin), end_(end) {}

  std::size_t at() const { return at_; }

  /// False at the end. Throws InputError where a character is none of base64 or a group is cut.
  bool next(Group& group) {
    std::uint32_t bits = 0;
    std::size_t padding = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      while (at_ < end_ && is_space(character(at_))) ++at_;
      if (at_ >= end_) {
        if (k == 0) return false;
        throw error("a group of four characters of base64", "its end after " + std::to_string(k));
      }
      const char c = character(at_);
      const std::size_t digit = digits.find(c);
      const bool is_padding = c == '=' && k >= 2;
      if (!is_padding && (digit == std::string_view::npos || padding > 0))
        throw error("a character of base64", quoted(std::string(1, c)));
      padding += is_padding ? 1 : 0;
      bits = bits << 6 | static_cast<std::uint32_t>(is_padding ? 0 : digit);
      group.at[k] = at_++;
    }
    group.size = 3 - padding;
    for (std::size_t b = 0; b < 3; ++b) group.bytes[b] = static_cast<std::byte>(bits >> (16 - 8 * b) & 255);
    return true;
  }

 private:
  char character(std::size_t at) const { return static_cast<char>(bytes_[at]); }
  static bool is_space(char c) { return TextCursor::is_blank(c) || TextCursor::is_end(c); }
  InputError error(const std::string& expected, const std::string& found) const {
    return byte_error(path_, static_cast<std::int64_t>(at_), expected, found);
  }

  const std::string& path_;
  std::span<const std::byte> bytes_;
  std::size_t at_, end_;
};

/// Puts `values` in place of those that the base64 holds behind `header` bytes; groups that stay are not touched.
void patch_base64(std::span<std::byte> file, const VtkArray& array, std::span<const std::byte> values) {
  Base64 base64("", file, array.begin, array.end);
  Base64::Group group;
  for (std::size_t at = 0; at < array.header + values.size() && base64.next(group); at += group.size) {
    bool changed = false;
    for (std::size_t b = 0; b < group.size; ++b) {
      const std::size_t i = at + b;
      if (i < array.header || i - array.header >= values.size() || group.bytes[b] == values[i - array.header]) continue;
      group.bytes[b] = values[i - array.header];
      changed = true;
    }
    if (!changed) continue;
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b)
      bits = bits << 8 | (b < group.size ? std::to_integer<std::uint32_t>(group.bytes[b]) : 0);
    for (std::size_t k = 0; k <= group.size; ++k)
      file[group.at[k]] = static_cast<std::byte>(digits[bits >> (18 - 6 * k) & 63]);
  }
}

/// The values that an array has now, in this machine's byte order.
std::vector<std::byte> values_now(const Shape& shape, const VtkContent& content, const VtkArray& array,
                                  const std::vector<std::byte>& before, Rounding& rounding) {
  if (&array != &content.points) return shape.find(array.name)->values;
  std::vector<std::byte> now = before;
  with_type(array.type, [&](auto t) {
    std::byte* at = now.data();
    for (const Vec3& p : shape.positions)
      for (int c = 0; c < 3; ++c, at += sizeof(t))
        patch_coordinate<decltype(t)>(at, false, p[c], shape.origin[c], rounding);
    return 0;
  });
  return now;
}

/// The cursor ends where the text of the array does: the tag behind it may touch the last number.
TextCursor cursor_of(const VtkContent& content, const VtkArray& array) {
  return TextCursor("", as_text(content.bytes).substr(0, array.end), array.begin);
}

void patch_text(TextPatch& patch, const Shape& shape, const VtkContent& content, const VtkArray& array,
                Rounding& rounding) {
  TextCursor cursor = cursor_of(content, array);
  const std::vector<std::byte> before = vtk_text_values(cursor, array, "");
  const std::vector<std::byte> now = values_now(shape, content, array, before, rounding);
  cursor = cursor_of(content, array);
  const std::size_t size = size_of(array.type);
  for (std::size_t i = 0; i < now.size(); i += size) {
    const Token t = cursor.next();
    if (std::memcmp(&before[i], &now[i], size) != 0) patch.replace(t, value_text(array.type, &now[i]));
  }
}

}  // namespace

void check_vtk_size(const std::string& path, std::size_t at, const VtkArray& array, std::size_t left,
                    const std::string& what) {
  // A number of text takes a digit and a blank, but for the last; base64 takes four characters for three bytes.
  const std::size_t room = array.form == VtkArray::Form::Text    ? (left + 1) / 2
                           : array.form == VtkArray::Form::Bytes ? left / size_of(array.type)
                                                                 : left / 4 * 3 / size_of(array.type);
  if (array.components == 0 || array.rows <= room / array.components) return;
  throw byte_error(
      path, static_cast<std::int64_t>(at),
      std::to_string(array.rows) + " rows of " + what + " of " + counted(array.components, "value", "values"),
      "only " + std::to_string(left) + " bytes");
}

std::vector<std::byte> vtk_text_values(TextCursor& cursor, const VtkArray& array, const std::string& what) {
  std::vector<std::byte> values(array.size());
  for (std::size_t i = 0, at = 0; i < array.count(); ++i, at += size_of(array.type)) {
    const Token t = cursor.next();
    if (parse_value(t.text, array.type, &values[at])) continue;
    const std::string expected = "value " + std::to_string(i + 1) + " of " + std::to_string(array.count()) + " of " +
                                 what + ", of type " + name_of(array.type);
    throw t.text.empty() ? cursor.error_at_end(t, expected) : cursor.error(t, expected);
  }
  return values;
}

std::vector<std::byte> decode_base64(const std::string& path, std::span<const std::byte> bytes, std::size_t begin,
                                     std::size_t& end, std::size_t size, const std::string& what) {
  std::vector<std::byte> out;
  out.reserve(std::min(size, (end - begin) / 4 * 3) + 3);
  Base64 base64(path, bytes, begin, end);
  Base64::Group group;
  while (out.size() < size && base64.next(group))
    out.insert(out.end(), group.bytes.begin(), group.bytes.begin() + static_cast<std::ptrdiff_t>(group.size));
  if (out.size() < size)
    throw byte_error(path, static_cast<std::int64_t>(base64.at()), std::to_string(size) + " bytes of " + what,
                     "the end of the base64 after " + std::to_string(out.size()));
  out.resize(size);
  end = base64.at();
  return out;
}

std::vector<std::byte> vtk_binary_values(const std::string& path, std::span<const std::byte> bytes,
                                         const VtkArray& array, const std::string& what) {
  std::vector<std::byte> values;
  if (array.form == VtkArray::Form::Base64) {
    std::size_t end = array.end;
    values = decode_base64(path, bytes, array.begin, end, array.header + array.size(), what);
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(array.header));
  } else {
    const auto from = ByteCursor(path, bytes, array.begin).take(array.size(), what);
    values.assign(from.begin(), from.end());
  }
  if (array.swap) swap_values(array.type, values);
  return values;
}

void set_vtk_points(Shape& shape, Type type, std::span<const std::byte> values) {
  const bool wide = type == Type::Float64 || (is_integer(type) && size_of(type) >= 4);
  shape.position_type = wide ? Type::Float64 : Type::Float32;
  shape.positions.resize(values.size() / (3 * size_of(type)));
  with_type(type, [&](auto t) {
    const std::byte* at = values.data();
    for (Vec3& p : shape.positions)
      for (int c = 0; c < 3; ++c, at += sizeof(t)) p[c] = static_cast<double>(load<decltype(t)>(at, false));
    return 0;
  });
}

void add_vtk_attribute(Shape& shape, VtkContent& content, VtkArray array, Attribute attribute,
                       std::vector<std::byte> values) {
  attribute.type = array.type;
  attribute.values = std::move(values);
  array.name = attribute.name;
  content.attributes.push_back(std::move(array));
  shape.attributes.push_back(std::move(attribute));
}

std::string add_vtk_tet(Shape& shape, std::span<const Index> corners) {
  if (corners.size() != 4) return "one of " + counted(corners.size(), "point", "points");
  const Tet tet{corners[0], corners[1], corners[2], corners[3]};
  const std::size_t again = repeated_corner(tet);
  if (again < 4) return "point " + std::to_string(tet[again]) + " twice";
  shape.tets.push_back(tet);
  return "";
}

void keep_vtk(Shape& shape, std::shared_ptr<VtkContent> content, std::size_t others, std::size_t arrays) {
  const auto kept = [&](std::size_t count, const char* singular, const char* plural) {
    if (count > 0) shape.notes.push_back("Kept in the VTK file only: " + counted(count, singular, plural) + ".");
  };
  kept(others, "cell that is neither polygon nor tet", "cells that are neither polygons nor tets");
  kept(arrays, "array that is not of the points' numbers", "arrays that are not of the points' numbers");
  content->faces = shape.faces.size();
  content->corners = shape.faces.points.size();
  content->tets = shape.tets.size();
  shape.content = std::move(content);
}

bool fits_vtk(const Shape& shape, const VtkContent& content, VtkContent::Form form) {
  if (content.form != form || content.points.rows != shape.size() || content.faces != shape.faces.size() ||
      content.corners != shape.faces.points.size() || content.tets != shape.tets.size())
    return false;
  return std::all_of(content.attributes.begin(), content.attributes.end(), [&](const VtkArray& array) {
    const Attribute* attribute = shape.find(array.name);
    return attribute && attribute->per_point() && attribute->type == array.type &&
           static_cast<std::size_t>(attribute->components) == array.components && attribute->count() == shape.size();
  });
}

std::vector<std::byte> patched_vtk(const Shape& shape, const VtkContent& content, WriteReport& report) {
  std::vector<const VtkArray*> arrays{&content.points};
  std::vector<std::string> held;
  for (const VtkArray& array : content.attributes) {
    arrays.push_back(&array);
    held.push_back(array.name);
  }
  report_lost_attributes("VTK", shape, held, report);
  std::sort(arrays.begin(), arrays.end(), [](const VtkArray* a, const VtkArray* b) { return a->begin < b->begin; });
  // Bytes keep their places; text that gets longer comes after, from a copy in which they are new already.
  std::vector<std::byte> out = content.bytes;
  Rounding rounding;
  for (const VtkArray* array : arrays) {
    if (array->form == VtkArray::Form::Text) continue;
    const std::vector<std::byte> before = vtk_binary_values("", content.bytes, *array, "");
    std::vector<std::byte> now = values_now(shape, content, *array, before, rounding);
    if (now == before) continue;
    if (array->swap) swap_values(array->type, now);
    if (array->form == VtkArray::Form::Base64) {
      patch_base64(out, *array, now);
    } else {
      std::copy(now.begin(), now.end(), out.begin() + static_cast<std::ptrdiff_t>(array->begin));
    }
  }
  const bool text = std::any_of(arrays.begin(), arrays.end(),
                                [](const VtkArray* array) { return array->form == VtkArray::Form::Text; });
  if (text) {
    const std::vector<std::byte> from = std::move(out);
    TextPatch patch(from);
    for (const VtkArray* array : arrays) {
      if (array->form == VtkArray::Form::Text) patch_text(patch, shape, content, *array, rounding);
    }
    out = patch.finish();
  }
  rounding.report(report);
  return out;
}

std::vector<Attribute> new_vtk_attributes(const Shape& shape, const std::string& format, WriteReport& report) {
  std::vector<Attribute> out;
  for (const Attribute& original : shape.attributes) {
    Attribute attribute = one_a_point(original, shape.size());
    if (attribute.count() != shape.size()) {
      report.lost.push_back(format + " cannot hold the attribute " + quoted(original.name) +
                            ": its values do not belong to one point each.");
      continue;
    }
    if (attribute.kind == Kind::Color && attribute.components == 1 && size_of(attribute.type) == 4) {
      Attribute bytes = attribute;
      bytes.type = Type::UInt8;
      bytes.components = 3;
      bytes.values.resize(3 * shape.size());
      for (std::size_t i = 0; i < shape.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
          bytes.values[3 * i + c] =
              static_cast<std::byte>(load<std::uint32_t>(attribute.values.data() + 4 * i, false) >> (16 - 8 * c) & 255);
      attribute = std::move(bytes);
    }
    out.push_back(std::move(attribute));
  }
  if (!shape.parts.empty())
    report.lost.push_back(format + " cannot hold the division into " + std::to_string(shape.parts.size()) +
                          " scans and their poses.");
  return out;
}

std::vector<std::byte> new_vtk_points(const Shape& shape, WriteReport& report) {
  std::vector<std::byte> out(shape.size() * 3 * size_of(shape.position_type));
  Rounding rounding;
  std::byte* at = out.data();
  for (const Vec3& p : shape.positions)
    for (int c = 0; c < 3; ++c) {
      const double x = p[c] + shape.origin[c];
      with_type(shape.position_type, [&](auto t) {
        const auto stored = rounded<decltype(t)>(x);
        if (std::abs(x) >= float_limit) rounding.see(x, static_cast<double>(stored));
        store(at, stored, false);
        at += sizeof(t);
        return 0;
      });
    }
  rounding.report(report);
  return out;
}

}  // namespace sinew::io
