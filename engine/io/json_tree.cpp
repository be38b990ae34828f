#include "engine/io/json_tree.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace sinew::io {

namespace {

constexpr std::size_t deepest = 64;

/// Builds the tree from the events of the parser, so that its depth is bounded.
struct Builder : nlohmann::json_sax<nlohmann::json> {
  JsonNode root;
  std::vector<JsonNode> open;  ///< arrays and objects around the present place
  std::size_t problem_at = 0;
  std::string problem;

  bool add(JsonNode node) {
    if (open.empty()) {
      root = std::move(node);
    } else {
      open.back().items.push_back(std::move(node));
    }
    return true;
  }
  bool add(JsonNode::Type type, double number) {
    JsonNode node;
    node.type = type;
    node.number = number;
    return add(std::move(node));
  }
  bool start(JsonNode::Type type) {
    if (open.size() == deepest) {
      problem = "more than 64 levels of nesting";
      return false;
    }
    open.emplace_back();
    open.back().type = type;
    return true;
  }
  bool finish() {
    JsonNode node = std::move(open.back());
    open.pop_back();
    return add(std::move(node));
  }

  bool null() override { return add(JsonNode::Type::Null, 0); }
  bool boolean(bool value) override { return add(JsonNode::Type::Bool, value ? 1 : 0); }
  bool number_integer(number_integer_t value) override {
    return add(JsonNode::Type::Number, static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return add(JsonNode::Type::Number, static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return add(JsonNode::Type::Number, value); }
  bool string(string_t& value) override {
    JsonNode node;
    node.type = JsonNode::Type::Text;
    node.text = std::move(value);
    return add(std::move(node));
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return start(JsonNode::Type::Object); }
  bool key(string_t& name) override {
    open.back().names.push_back(std::move(name));
    return true;
  }
  bool end_object() override { return finish(); }
  bool start_array(std::size_t) override { return start(JsonNode::Type::Array); }
  bool end_array() override { return finish(); }
  bool parse_error(std::size_t at, const std::string& token, const nlohmann::detail::exception&) override {
    problem_at = at > 0 ? at - 1 : 0;  // from the count of bytes that were read
    problem = token.empty() ? "the end of the text" : sinew::quoted(token);
    return false;
  }
};

const char* name_of(JsonNode::Type type) {
  static const char* const names[] = {"null", "true or false", "a number", "a text", "an array", "an object"};
  return names[static_cast<std::size_t>(type)];
}

}  // namespace

JsonNode parse_json(const std::string& path, std::string_view text) {
  Builder builder;
  if (!nlohmann::json::sax_parse(text.begin(), text.end(), &builder))
    throw byte_error(path, static_cast<std::int64_t>(builder.problem_at), "JSON", builder.problem);
  return std::move(builder.root);
}

std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

InputError JsonView::error(const std::string& expected, const std::string& found) const {
  return file_error(place_.empty() ? path_ : path_ + ": " + place_, expected, found);
}

const JsonNode& JsonView::expect(JsonNode::Type type) const {
  if (node_->type != type) throw error(name_of(type), name_of(node_->type));
  return *node_;
}

std::optional<JsonView> JsonView::find(const char* name) const {
  const JsonNode& object = expect(JsonNode::Type::Object);
  for (std::size_t i = 0; i < object.names.size(); ++i) {
    if (object.names[i] != name) continue;
    JsonView view = *this;
    view.place_ += (place_.empty() ? "" : ".") + object.names[i];
    view.node_ = &object.items[i];
    return view;
  }
  return {};
}

JsonView JsonView::member(const char* name) const {
  std::optional<JsonView> view = find(name);
  if (!view) throw error(std::string("a member \"") + name + "\"", "none");
  return std::move(*view);
}

std::size_t JsonView::members() const {
  return expect(JsonNode::Type::Object).items.size();
}

std::size_t JsonView::size() const {
  return expect(JsonNode::Type::Array).items.size();
}

JsonView JsonView::item(std::size_t i) const {
  const JsonNode& array = expect(JsonNode::Type::Array);
  if (i >= array.items.size())
    throw error("an item " + std::to_string(i), "only " + std::to_string(array.items.size()));
  JsonView view = *this;
  view.place_ += "[" + std::to_string(i) + "]";
  view.node_ = &array.items[i];
  return view;
}

double JsonView::number() const {
  return expect(JsonNode::Type::Number).number;
}

bool JsonView::truth() const {
  return expect(JsonNode::Type::Bool).number != 0;
}

const std::string& JsonView::text() const {
  return expect(JsonNode::Type::Text).text;
}

std::size_t JsonView::count(std::size_t most) const {
  const double x = number();
  if (!(x >= 0) || x > static_cast<double>(most) || std::floor(x) != x)
    throw error("a whole number of 0 to " + std::to_string(most), nlohmann::json(x).dump());
  return static_cast<std::size_t>(x);
}

std::size_t JsonView::index(std::size_t size) const {
  if (size == 0) throw error("no index, for there is nothing that it could name", nlohmann::json(number()).dump());
  return count(size - 1);
}

std::size_t JsonView::count_or(const char* name, std::size_t fallback) const {
  const std::optional<JsonView> view = find(name);
  return view ? view->count() : fallback;
}

std::string JsonView::text_or(const char* name, const std::string& fallback) const {
  const std::optional<JsonView> view = find(name);
  return view ? view->text() : fallback;
}

std::size_t JsonView::size_of(const char* name) const {
  const std::optional<JsonView> view = find(name);
  return view ? view->size() : 0;
}

}  // namespace sinew::io
