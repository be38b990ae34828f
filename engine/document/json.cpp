#include "engine/document/json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/io/bytes.h"
#include "engine/io/io.h"
#include "engine/io/text.h"

namespace sinew::document {

namespace {

std::string describe(const Json& json) {
  switch (json.type) {
    case Json::Type::Null: return "null";
    case Json::Type::Bool: return json.number != 0 ? "true" : "false";
    case Json::Type::Number: return io::shortest(json.number);
    case Json::Type::Text: return sinew::quoted(json.text());
    case Json::Type::Array: return "an array of " + std::to_string(json.items().size());
    case Json::Type::Object: return "an object";
  }
  CHECK(false, static_cast<int>(json.type));
}

double whole(const JsonFile& file, const Json& json, double low, double high) {
  const double x = json.number;
  if (json.type != Json::Type::Number || !(x >= low && x <= high) || x != std::floor(x))
    throw file.error(json, "a whole number from " + io::shortest(low) + " to " + io::shortest(high));
  return x;
}

void read_numbers(const JsonFile& file, const Json& json, std::span<double> out, const std::string& expected) {
  if (json.type != Json::Type::Array || json.items().size() != out.size()) throw file.error(json, expected);
  for (std::size_t i = 0; i < out.size(); ++i) read_value(file, json.items()[i], out[i]);
}

}  // namespace

std::pair<std::int64_t, std::int64_t> JsonFile::line_and_column(std::size_t at) const {
  const auto next = std::upper_bound(line_begins_.begin(), line_begins_.end(), at);
  return {next - line_begins_.begin(), static_cast<std::int64_t>(at - *(next - 1)) + 1};
}

Place JsonFile::place(const Json& value) const {
  const auto [line, column] = line_and_column(value.at);
  return {path_ + ":" + std::to_string(line) + ":" + std::to_string(column)};
}

InputError JsonFile::error(const Json& value, const std::string& expected, const std::string& found) const {
  return error(value.at, expected, found.empty() ? describe(value) : found);
}

InputError JsonFile::error(std::size_t at, const std::string& expected, const std::string& found) const {
  const auto [line, column] = line_and_column(at);
  return text_error(path_, line, column, expected, found);
}

void read_value(const JsonFile& file, const Json& json, bool& value) {
  if (json.type != Json::Type::Bool) throw file.error(json, "true or false");
  value = json.number != 0;
}

void read_value(const JsonFile& file, const Json& json, double& value) {
  if (json.type != Json::Type::Number) throw file.error(json, "a number");
  value = json.number;
}

void read_value(const JsonFile& file, const Json& json, int& value) {
  value = static_cast<int>(whole(file, json, -2147483648.0, 2147483647.0));
}

void read_value(const JsonFile& file, const Json& json, Index& value) {
  value = static_cast<Index>(whole(file, json, 0, 4294967294.0));
}

void read_value(const JsonFile& file, const Json& json, std::string& value) {
  if (json.type != Json::Type::Text) throw file.error(json, "a text");
  value = json.text();
}

void read_value(const JsonFile& file, const Json& json, Vec3& value) {
  read_numbers(file, json, {value.data(), 3}, "3 numbers [x, y, z]");
}

void read_value(const JsonFile& file, const Json& json, Affine& value) {
  double rows[12];
  read_numbers(file, json, rows, "12 numbers, a 3x4 matrix row by row");
  value = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(rows);
}

/// 16 numbers row by row, separated by white space; from # to the end of the line is a comment.
static Eigen::Matrix4d read_matrix(const std::string& path) {
  const std::vector<std::byte> bytes = io::load_bytes(path);
  io::TextCursor cursor(path, io::as_text(bytes));
  Eigen::Matrix4d out;
  for (int k = 0; k < 16; ++k) {
    const io::Token token = cursor.next('#');
    if (!io::parse(token.text, out(k / 4, k % 4)) || !std::isfinite(out(k / 4, k % 4)))
      throw cursor.error(token, "16 finite numbers, a 4x4 matrix row by row");
  }
  if (const io::Token token = cursor.next('#'); !token.text.empty())
    throw cursor.error(token, "the end of the file after 16 numbers");
  return out;
}

void read_value(const JsonFile& file, const Json& json, Eigen::Matrix4d& value) {
  if (json.type == Json::Type::Text) {
    value = read_matrix((std::filesystem::path(file.path()).parent_path() / json.text()).string());
    return;
  }
  static const std::string expected = "4 rows of 4 numbers, or a file of them";
  if (json.type != Json::Type::Array || json.items().size() != 4) throw file.error(json, expected);
  for (int r = 0; r < 4; ++r) {
    double row[4];
    read_numbers(file, json.items()[static_cast<std::size_t>(r)], row, "4 numbers, a row of the matrix");
    value.row(r) = Eigen::Map<const Eigen::RowVector4d>(row);
  }
}

ObjectReader::ObjectReader(const JsonFile& file, const Json& json) : file_(file), json_(json) {
  if (json.type != Json::Type::Object) throw file.error(json, "an object");
}

void ObjectReader::done() const {
  const auto list = [](const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
    return text;
  };
  std::vector<std::string> given;
  for (const JsonMember& member : json_.members()) {
    given.push_back(member.name);
    if (std::find(known_.begin(), known_.end(), member.name) == known_.end())
      throw file_.error(member.at, "one of " + list(known_), sinew::quoted(member.name));
  }
  if (absent_.empty()) return;
  throw file_.error(json_, list(absent_), given.empty() ? "an object without members" : "only " + list(given));
}

void JsonWriter::new_line() {
  out_ += '\n';
  out_.append(2 * levels_.size(), ' ');
}

void JsonWriter::item() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  if (!level.empty) out_ += level.one_line ? ", " : ",";
  if (!level.one_line) new_line();
  level.empty = false;
}

void JsonWriter::open(char bracket, bool one_line) {
  item();
  out_ += bracket;
  levels_.push_back({one_line || (!levels_.empty() && levels_.back().one_line), true});
}

void JsonWriter::close(char bracket) {
  const Level level = levels_.back();
  levels_.pop_back();
  if (!level.one_line && !level.empty) new_line();
  out_ += bracket;
  if (levels_.empty()) out_ += '\n';
}

void JsonWriter::key(const std::string& name) {
  item();
  out_ += json_text(name) + ": ";
  after_key_ = true;
}

void JsonWriter::raw(const std::string& token) {
  item();
  out_ += token;
}

void JsonWriter::text(const std::string& value) {
  raw(json_text(value));
}

void write_value(JsonWriter& out, bool value) {
  out.raw(value ? "true" : "false");
}
void write_value(JsonWriter& out, double value) {
  if (value == 0 && std::signbit(value))
    out.raw("-0.0");  // "-0" would come back as a whole number, without its sign
  else
    out.raw(std::isfinite(value) ? io::shortest(value) : "null");
}
void write_value(JsonWriter& out, int value) {
  out.raw(std::to_string(value));
}
void write_value(JsonWriter& out, std::size_t value) {
  out.raw(std::to_string(value));
}
void write_value(JsonWriter& out, Index value) {
  out.raw(std::to_string(value));
}
void write_value(JsonWriter& out, const std::string& value) {
  out.text(value);
}
void write_value(JsonWriter& out, const char* value) {
  out.text(value);
}

void write_value(JsonWriter& out, const Vec3& value) {
  out.begin_array(true);
  for (int c = 0; c < 3; ++c) write_value(out, value[c]);
  out.end_array();
}

void write_value(JsonWriter& out, const Affine& value) {
  out.begin_array(true);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) write_value(out, value(r, c));
  out.end_array();
}

void write_value(JsonWriter& out, const Eigen::Matrix4d& value) {
  out.begin_array(true);
  for (int r = 0; r < 4; ++r) {
    out.begin_array(true);
    for (int c = 0; c < 4; ++c) write_value(out, value(r, c));
    out.end_array();
  }
  out.end_array();
}

}  // namespace sinew::document
