#include "engine/io/text_patch.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/io/bytes.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

/// "123.456" has six significant digits, "1.0e-5" two; zeros in front do not count.
int significant_digits(std::string_view text) {
  int count = 0;
  for (const char c : text) {
    if (c == 'e' || c == 'E') break;
    if (c >= '0' && c <= '9' && (count > 0 || c != '0')) ++count;
  }
  return count;
}

struct NumberText {
  char buffer[32];
  std::string_view text;

  NumberText(double x, Type type) {
    const auto f = static_cast<float>(x);
    const bool as_float = type == Type::Float32 && (std::abs(x) < float_limit || static_cast<double>(f) == x);
    char* const end = buffer + sizeof(buffer);
    const auto result = as_float ? std::to_chars(buffer, end, f) : std::to_chars(buffer, end, x);
    text = {buffer, static_cast<std::size_t>(result.ptr - buffer)};
  }
};

}  // namespace

void report_progress(const ReadOptions& options, std::size_t done, std::size_t all) {
  if (options.progress &&
      !options.progress(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(all, 1))))
    throw Cancelled{};
}

std::size_t text_begin(const std::string& path, std::span<const std::byte> bytes) {
  const std::string_view text = as_text(bytes);
  const std::string expected = "text in ASCII or UTF-8";
  if (text.empty()) throw file_error(path, expected, "an empty file");
  if (text.starts_with(std::string_view("\xff\xfe\0\0", 4)) || text.starts_with(std::string_view("\0\0\xfe\xff", 4)))
    throw byte_error(path, 0, expected, "UTF-32 (by its byte order mark)");
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw byte_error(path, 0, expected, "UTF-16 (by its byte order mark)");
  const std::size_t zero = text.find('\0');
  if (zero == 0 || (zero == 1 && text.find('\0', 2) == 3))
    throw byte_error(path, static_cast<std::int64_t>(zero), expected, "a zero byte, as in UTF-16");
  if (zero != std::string_view::npos) throw byte_error(path, static_cast<std::int64_t>(zero), expected, "a zero byte");
  return text.starts_with("\xef\xbb\xbf") ? 3 : 0;
}

bool Precision::fits_float(std::string_view text, double x) const {
  if (!std::isfinite(x) || x == 0) return true;
  const double size = std::abs(x);
  if (!(size < limit_)) return false;
  const auto f = static_cast<float>(x);
  if (static_cast<double>(f) == x) return true;
  // FLT_DIG: any six digits survive a float that is not subnormal.
  if (significant_digits(text) <= 6 && size > 1e-36 && size < 1e36) return true;
  double back = 0;
  return parse(shortest(f), back) && back == x;
}

void append_text(std::vector<std::byte>& out, std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  out.insert(out.end(), begin, begin + text.size());
}

void append_number(std::string& out, double x, Type type) {
  out += NumberText(x, type).text;
}

void append_number(std::vector<std::byte>& out, double x, Type type) {
  append_text(out, NumberText(x, type).text);
}

double as_read(double x, Type type) {
  return type == Type::Float32 ? static_cast<double>(static_cast<float>(x)) : x;
}

bool parse_value(std::string_view token, Type type, std::byte* at) {
  return with_type(type, [&](auto x) {
    if constexpr (std::is_floating_point_v<decltype(x)>) {
      if (!parse(token, x)) return false;
    } else {
      if (token.starts_with('+')) token.remove_prefix(1);
      const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), x);
      if (error != std::errc{} || end != token.data() + token.size()) return false;
    }
    store(at, x, false);
    return true;
  });
}

std::string value_text(Type type, const std::byte* at) {
  return with_type(type, [at](auto x) {
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof(buffer), load<decltype(x)>(at, false));
    return std::string(buffer, end);
  });
}

namespace {

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

void TextPatch::set(std::size_t begin, std::string_view token, double now, Type type, double origin) {
  double read = 0;
  if (parse(token, read)) {
    const double was = as_read(read, type);
    // The same subtraction as set_origin's: it holds for coordinates too that origin does not subtract from exactly.
    if (same(now, was - origin) || same(as_read(now + origin, type), was)) return;
  }
  replace(begin, token.size(), NumberText(now + origin, type).text);
}

void TextPatch::replace(std::size_t begin, std::size_t size, std::string_view now) {
  CHECK(begin >= copied_, begin, copied_);
  append_text(out_, as_text(from_.subspan(copied_, begin - copied_)));
  append_text(out_, now);
  copied_ = begin + size;
}

std::vector<std::byte> TextPatch::finish() {
  append_text(out_, as_text(from_.subspan(copied_)));
  copied_ = from_.size();
  return std::move(out_);
}

Attribute number_attribute(std::string name, std::vector<std::string> field_names, Kind kind, Type type,
                           std::span<const double> values) {
  const std::size_t fields = field_names.size();
  Attribute attribute;
  attribute.components = static_cast<int>(fields);
  attribute.name = std::move(name);
  attribute.fields = std::move(field_names);
  attribute.kind = kind;
  attribute.type = type;
  attribute.values.resize(values.size() * size_of(type));
  if (type == Type::Float32) {
    std::transform(values.begin(), values.end(), attribute.as<float>().begin(),
                   [](double x) { return static_cast<float>(x); });
  } else if (type == Type::Float64) {
    std::copy(values.begin(), values.end(), attribute.as<double>().begin());
  } else {
    for (std::size_t i = 0; i < values.size(); ++i)
      attribute.set_number(i / fields, static_cast<int>(i % fields), values[i]);
  }
  return attribute;
}

std::optional<std::vector<Index>> row_of_points(const Shape& shape, const Attribute& attribute) {
  std::vector<Index> row(shape.size(), no_row);
  for (Index i = 0; i < attribute.count(); ++i) {
    if (attribute.per_point()) {
      row[i] = i;
      continue;
    }
    for (Index k = attribute.point_offsets[i]; k < attribute.point_offsets[i + 1]; ++k) {
      if (row[attribute.points[k]] != no_row) return std::nullopt;
      row[attribute.points[k]] = i;
    }
  }
  return row;
}

bool is_text_color(const Attribute& color) {
  if (color.kind != Kind::Color || !color.per_point()) return false;
  if (color.components == 1) return size_of(color.type) == 4;
  const bool type = color.type == Type::UInt8 || color.type == Type::Float32 || color.type == Type::Float64;
  return type && (color.components == 3 || color.components == 4);
}

void append_color(std::vector<std::byte>& out, const Attribute& color, std::size_t i, bool fractions) {
  const auto append_byte = [&](unsigned x) {
    append_text(out, " ");
    append_number(out, fractions ? x / 255.0 : x, Type::Float32);
  };
  const std::byte* row = color.values.data() + i * color.row_size();
  if (color.components == 1) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, row, sizeof(bits));
    for (const int shift : {16, 8, 0}) append_byte((bits >> shift) & 255);
    return;
  }
  for (int c = 0; c < color.components; ++c) {
    if (color.type == Type::UInt8) {
      append_byte(std::to_integer<unsigned>(row[c]));
    } else {
      append_text(out, " ");
      append_number(out, color.number(i, c), color.type);
    }
  }
}

std::string UniqueNames::add(const std::string& name) {
  std::string out = name;
  while (!taken_.insert(out).second) {
    int& last = last_.try_emplace(name, 1).first->second;
    out = name + " " + std::to_string(++last);
  }
  return out;
}

void report_lost_attributes(const std::string& format, const Shape& shape, const std::vector<std::string>& held,
                            WriteReport& report) {
  for (const Attribute& attribute : shape.attributes)
    if (std::find(held.begin(), held.end(), attribute.name) == held.end())
      report.lost.push_back(format + " cannot hold the attribute " + quoted(attribute.name) + ".");
  if (!shape.parts.empty())
    report.lost.push_back(format + " cannot hold the division into " + std::to_string(shape.parts.size()) +
                          " scans and their poses.");
}

void report_lost_precision(const std::string& format, const Shape& shape, WriteReport& report) {
  if (shape.position_type != Type::Float64) return;
  double rounding = 0;
  for (const Vec3& p : shape.positions)
    for (int c = 0; c < 3; ++c) {
      const double x = p[c] + shape.origin[c];
      const double by = std::abs(static_cast<double>(static_cast<float>(x)) - x);
      if (std::isfinite(by)) rounding = std::max(rounding, by);
    }
  if (rounding > 0)
    report.lost.push_back(format + " cannot hold coordinates beyond float: they change by up to " +
                          shortest(static_cast<float>(rounding)) + ".");
}

std::string counted(std::size_t count, const char* singular, const char* plural) {
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

}  // namespace sinew::io
