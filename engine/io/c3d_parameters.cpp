#include "engine/io/c3d_parameters.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "engine/io/bytes.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

std::string capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

std::string without_blanks(std::string_view text) {
  const std::string_view blanks(" \t\0", 3);
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(blanks) - begin + 1));
}

/// A file's byte as the signed number that lengths, group numbers and types are.
int signed_byte(std::byte b) {
  return static_cast<std::int8_t>(std::to_integer<std::uint8_t>(b));
}

}  // namespace

std::uint16_t c3d_word(C3dProcessor processor, const std::byte* at) {
  const bool file_big = processor == C3dProcessor::Mips;
  return load<std::uint16_t>(at, file_big != (std::endian::native == std::endian::big));
}

double c3d_float(C3dProcessor processor, const std::byte* at) {
  if (processor != C3dProcessor::Dec) {
    const bool file_big = processor == C3dProcessor::Mips;
    return static_cast<double>(load<float>(at, file_big != (std::endian::native == std::endian::big)));
  }
  const std::uint32_t high = c3d_word(processor, at), low = c3d_word(processor, at + 2);
  const int exponent = static_cast<int>(high >> 7 & 0xff);
  const bool negative = (high & 0x8000) != 0;
  if (exponent == 0) return negative ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  const double fraction = static_cast<double>((high & 0x7f) << 16 | low);
  const double size = std::ldexp(1 + fraction / 8388608.0, exponent - 129);
  return negative ? -size : size;
}

C3dParameters::C3dParameters(const std::string& path, std::span<const std::byte> bytes, std::size_t begin,
                             std::size_t end) {
  // Four bytes: two without a meaning, the count of blocks, which is wrong in many files, and the processor.
  ByteCursor cursor(path, bytes, begin);
  const auto head = cursor.take(4, "the head of the parameters");
  const int processor = std::to_integer<int>(head[3]);
  if (processor < 84 || processor > 86)
    throw byte_error(path, static_cast<std::int64_t>(begin) + 3, "the processor: 84 (Intel), 85 (DEC) or 86 (MIPS)",
                     std::to_string(processor));
  processor_ = static_cast<C3dProcessor>(processor);
  const auto section = bytes.first(end);
  // Each record begins behind the one before it, so that this ends.
  for (std::optional<std::size_t> at = cursor.at(); at;) at = read_record(section, *at);
}

std::optional<std::size_t> C3dParameters::read_record(std::span<const std::byte> section, std::size_t at) {
  const auto broken = [&](const std::string& why) {
    notes_.push_back("Its parameters break off at byte " + std::to_string(at) + ": " + why +
                     "; what stands before that counts.");
    return std::nullopt;
  };
  // A name of no length ends the section; so does the end of it, after whole records.
  if (at >= section.size() || section[at] == std::byte{0}) return std::nullopt;
  // A negative length marks a parameter that programs are not to change.
  const auto name_size = static_cast<std::size_t>(std::abs(signed_byte(section[at])));
  const std::size_t offset_at = at + 2 + name_size;
  if (offset_at + 2 > section.size()) return broken("a name goes on behind their end");
  const std::size_t offset = c3d_word(processor_, &section[offset_at]);
  const std::size_t next = offset == 0 ? section.size() : offset_at + offset;
  if (next > section.size()) return broken("the next record would stand behind their end");
  if (next < offset_at + 3) return broken("the next record would stand within this one");

  const int group = signed_byte(section[at + 1]);
  const std::string name = capitals(as_text(section.subspan(at + 2, name_size)));
  if (group < 0) {
    groups_.push_back({-group, name});
  } else {
    Parameter parameter = read_parameter(section.subspan(offset_at + 2, next - offset_at - 2));
    parameter.group = group;
    parameter.name = name;
    parameters_.push_back(std::move(parameter));
  }
  return offset == 0 ? std::nullopt : std::optional(next);
}

/// `record`: type, count of dimensions, dimensions, values, description. Values go at most to the next record: some
/// programs write wrong dimensions.
C3dParameters::Parameter C3dParameters::read_parameter(std::span<const std::byte> record) const {
  Parameter parameter;
  parameter.type = signed_byte(record[0]);
  const int type = parameter.type;
  const bool known = type == -1 || type == 1 || type == 2 || type == 4;
  if (!known || record.size() < 2) return parameter;
  const std::size_t count = std::to_integer<std::size_t>(record[1]);
  if (record.size() < 2 + count) return parameter;
  std::size_t size = static_cast<std::size_t>(std::abs(type));
  for (std::size_t i = 0; i < count; ++i) {
    parameter.dimensions.push_back(std::to_integer<std::size_t>(record[2 + i]));
    size = std::min(size * parameter.dimensions.back(), record.size() * 256);  // no overflow by 255 dimensions
  }
  parameter.value = record.subspan(2 + count, std::min(size, record.size() - 2 - count));
  return parameter;
}

const C3dParameters::Parameter* C3dParameters::find(std::string_view group, std::string_view name) const {
  const auto g = std::find_if(groups_.begin(), groups_.end(), [&](const Group& x) { return x.name == group; });
  if (g == groups_.end()) return nullptr;
  const auto p = std::find_if(parameters_.begin(), parameters_.end(),
                              [&](const Parameter& x) { return x.group == g->number && x.name == name; });
  return p == parameters_.end() ? nullptr : &*p;
}

std::optional<double> C3dParameters::number(std::string_view group, std::string_view name, std::size_t i) const {
  const Parameter* p = find(group, name);
  if (p == nullptr || p->type < 1) return std::nullopt;
  const auto size = static_cast<std::size_t>(p->type);
  if ((i + 1) * size > p->value.size()) return std::nullopt;
  const std::byte* at = &p->value[i * size];
  if (size == 4) return c3d_float(processor_, at);
  return size == 2 ? c3d_word(processor_, at) : std::to_integer<std::uint8_t>(*at);
}

std::vector<std::string> C3dParameters::texts(std::string_view group, std::string_view name) const {
  const Parameter* p = find(group, name);
  std::vector<std::string> texts;
  if (p == nullptr || p->type != -1) return texts;
  const std::string_view all = as_text(p->value);
  const std::size_t length = p->dimensions.empty() ? 1 : p->dimensions[0];
  if (length == 0) return texts;
  for (std::size_t at = 0; at + length <= all.size(); at += length)
    texts.push_back(without_blanks(all.substr(at, length)));
  return texts;
}

std::string C3dParameters::text(std::string_view group, std::string_view name) const {
  const std::vector<std::string> all = texts(group, name);
  return all.empty() ? "" : all.front();
}

}  // namespace sinew::io
