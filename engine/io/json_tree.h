#pragma once
/// JSON of file formats: a parsed tree, and a view of it that knows the way to each value, so that a refusal names it:
/// "PATH: meshes[0].primitives[2].indices: expected ..., found ...".

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/error.h"

namespace sinew::io {

struct JsonNode {
  enum class Type : std::uint8_t { Null, Bool, Number, Text, Array, Object };
  Type type = Type::Null;
  double number = 0;  ///< of Number; 0 or 1 of Bool
  std::string text;
  std::vector<JsonNode> items;     ///< of Array and Object
  std::vector<std::string> names;  ///< of Object: one an item
};

/// Throws InputError "PATH: byte N: ...": no JSON, or nested deeper than 64.
JsonNode parse_json(const std::string& path, std::string_view text);

/// `text` as a JSON string, with its quotes; broken UTF-8 is replaced.
std::string json_string(const std::string& text);

/// A value of a tree, which must outlive it. Everything that is asked for and not there is an InputError.
class JsonView {
 public:
  JsonView(std::string path, const JsonNode& root) : path_(std::move(path)), node_(&root) {}

  std::optional<JsonView> find(const char* name) const;  ///< a member of an object
  JsonView member(const char* name) const;
  std::size_t members() const;  ///< of an object, how many
  std::size_t size() const;     ///< of an array
  JsonView item(std::size_t i) const;
  double number() const;
  bool truth() const;
  const std::string& text() const;
  /// A whole number of 0 to most.
  std::size_t count(std::size_t most = std::size_t{1} << 53) const;
  /// An index into an array of this size.
  std::size_t index(std::size_t size) const;

  /// Members that may be missing.
  std::size_t count_or(const char* name, std::size_t fallback) const;
  std::string text_or(const char* name, const std::string& fallback) const;
  std::size_t size_of(const char* name) const;  ///< of an array; 0 where it is missing

  InputError error(const std::string& expected, const std::string& found) const;

 private:
  const JsonNode& expect(JsonNode::Type type) const;

  std::string path_, place_;
  const JsonNode* node_;
};

}  // namespace sinew::io
