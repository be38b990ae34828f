#include "engine/document/json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/io/text.h"

namespace sinew::document {

struct Json::Content {
  std::string text;
  std::vector<Json> items;
  std::vector<JsonMember> members;
};

const std::string& Json::text() const {
  CHECK(type == Type::Text);
  return content->text;
}

std::span<const Json> Json::items() const {
  CHECK(type == Type::Array);
  return content->items;
}

std::span<const JsonMember> Json::members() const {
  CHECK(type == Type::Object);
  return content->members;
}

const Json* Json::find(const std::string& name) const {
  for (const JsonMember& member : members())
    if (member.name == name) return &member.value;
  return nullptr;
}

namespace {

constexpr std::size_t deepest = 32, most_members = 1000;

/// Characters that the parser has taken: a parser event stands at the end of its token.
struct Taken {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char* at;
  const char** last;

  const char& operator*() const { return *at; }
  Taken& operator++() {
    *last = ++at;
    return *this;
  }
  bool operator==(const Taken& other) const { return at == other.at; }
  bool operator!=(const Taken& other) const { return at != other.at; }
};

/// Builds the tree from the events of the parser.
struct TreeBuilder : nlohmann::json_sax<nlohmann::json> {
  const char* begin = nullptr;
  const char* end = nullptr;
  const char* last = nullptr;    ///< after the last character that the parser has taken
  const char* behind = nullptr;  ///< after the event before

  Json root;
  std::vector<Json> open;        ///< objects and arrays around the present place
  std::vector<JsonMember> keys;  ///< names whose values have not come yet
  std::string problem_expected, problem_found;
  std::size_t problem_at = 0;

  /// Where the token of this event begins: after the one before, what separates values is skipped.
  std::size_t token_begin() {
    const char* at = behind;
    while (at < end && std::string_view(" \t\r\n,:").find(*at) != std::string_view::npos) ++at;
    return static_cast<std::size_t>(at - begin);
  }
  bool refuse(std::size_t at, std::string expected, std::string found) {
    problem_at = at;
    problem_expected = std::move(expected);
    problem_found = std::move(found);
    return false;
  }
  bool add(Json value) {
    if (open.empty()) {
      root = std::move(value);
    } else if (open.back().type == Json::Type::Array) {
      open.back().content->items.push_back(std::move(value));
    } else {
      keys.back().value = std::move(value);
      open.back().content->members.push_back(std::move(keys.back()));
      keys.pop_back();
    }
    return true;
  }
  bool add(Json::Type type, double number) {
    Json value{type, token_begin(), number, nullptr};
    behind = last;
    // A number ends where another character comes, which the parser has then seen already.
    const bool seen_more = type == Json::Type::Number && last != end;
    if (seen_more && std::string_view(" \t\r\n,:]}").find(last[-1]) == std::string_view::npos) --behind;
    return add(std::move(value));
  }
  bool start(Json::Type type) {
    const std::size_t at = token_begin();
    if (open.size() == deepest) return refuse(at, "at most 32 levels of nesting", "more");
    open.push_back({type, at, 0, std::make_shared<Json::Content>()});
    behind = last;
    return true;
  }
  bool finish() {
    Json value = std::move(open.back());
    open.pop_back();
    behind = last;
    return add(std::move(value));
  }

  bool null() override { return add(Json::Type::Null, 0); }
  bool boolean(bool value) override { return add(Json::Type::Bool, value ? 1 : 0); }
  bool number_integer(number_integer_t value) override { return add(Json::Type::Number, static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add(Json::Type::Number, static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return add(Json::Type::Number, value); }
  bool binary(binary_t&) override { return false; }
  bool string(string_t& value) override {
    Json text{Json::Type::Text, token_begin(), 0, std::make_shared<Json::Content>()};
    text.content->text = std::move(value);
    behind = last;
    return add(std::move(text));
  }
  bool start_object(std::size_t) override { return start(Json::Type::Object); }
  bool start_array(std::size_t) override { return start(Json::Type::Array); }
  bool end_object() override { return finish(); }
  bool end_array() override { return finish(); }
  bool key(string_t& name) override {
    const std::vector<JsonMember>& members = open.back().content->members;
    if (members.size() == most_members) return refuse(token_begin(), "at most 1000 members of an object", "more");
    for (const JsonMember& member : members)
      if (member.name == name) return refuse(token_begin(), "each name once", sinew::quoted(name) + " again");
    keys.push_back({name, token_begin(), {}});
    behind = last;
    return true;
  }
  /// The parser's own message, cut into what was expected and what was found.
  bool parse_error(std::size_t, const std::string& token, const nlohmann::detail::exception& error) override {
    const std::string message = error.what();
    if (error.id == 406) return refuse(token_begin(), "a number that fits a double", sinew::quoted(token));
    const std::size_t expected = message.find("; expected "), read = message.find("; last read");
    const std::size_t dash = message.find(" - "),
                      found = dash == std::string::npos ? message.rfind(": ") + 2 : dash + 3;
    const std::string what = message.substr(found, std::min(expected, read) - found);
    return refuse(token_begin(), expected == std::string::npos ? "JSON" : plain(message.substr(expected + 11)),
                  plain(what.starts_with("unexpected ") ? what.substr(11) : what));
  }

  /// The parser's name of a token in plain words. Where a comma would do as well, it names the bracket only.
  static std::string plain(const std::string& token) {
    static const std::pair<const char*, const char*> words[] = {
        {"string literal", "a text"},         {"number literal", "a number"}, {"true literal", "true"},
        {"false literal", "false"},           {"null literal", "null"},       {"end of input", "the end of the text"},
        {"'[', '{', or a literal", "a value"}};
    for (const auto& [name, word] : words)
      if (token == name) return word;
    return token;
  }
};

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

JsonFile::JsonFile(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {
  line_begins_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i)
    if (text_[i] == '\n') line_begins_.push_back(i + 1);
  TreeBuilder builder;
  builder.begin = builder.last = builder.behind = text_.data();
  builder.end = text_.data() + text_.size();
  const Taken first{builder.begin, &builder.last}, past{builder.end, &builder.last};
  if (!nlohmann::json::sax_parse(first, past, &builder))
    throw error(builder.problem_at, builder.problem_expected, builder.problem_found);
  root_ = std::move(builder.root);
}

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

void read_value(const JsonFile& file, const Json& json, Eigen::Matrix4d& value) {
  static const std::string expected = "4 rows of 4 numbers";
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
  out_ += nlohmann::json(name).dump() + ": ";
  after_key_ = true;
}

void JsonWriter::raw(const std::string& token) {
  item();
  out_ += token;
}

void JsonWriter::text(const std::string& value) {
  // File names need not be UTF-8; a broken byte becomes the replacement character rather than broken JSON.
  raw(nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
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
