/// The parser and the quoting of texts: all that is taken from nlohmann-json.

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/document/json.h"

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

}  // namespace

JsonFile::JsonFile(std::string path, std::string text, const SharedArrays* arrays)
    : arrays_(arrays), path_(std::move(path)), text_(std::move(text)) {
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

std::string json_text(const std::string& text) {
  // File names need not be UTF-8; a broken byte becomes the replacement character rather than broken JSON.
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace sinew::document
