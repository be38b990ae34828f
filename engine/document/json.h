#pragma once
/// JSON with places: a parsed tree whose values know their byte, so that every refusal names PATH:LINE:COL, and two
/// archives, ObjectReader and ObjectWriter, through which one description of a struct (a function `fields`) drives both
/// reading and writing.
///
///   template <class A, class T> void fields(A& a, T& ball) {     // T: Ball or const Ball
///     a.required("center", ball.center);
///     a.required("radius", ball.radius, positive);
///   }
///
/// Members that are not described, given twice or of another type are errors; numbers are written as the shortest
/// decimal that reads back as the same double.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/geometry/error.h"
#include "engine/geometry/shape.h"
#include "engine/geometry/skin_weights.h"

namespace sinew::document {

struct JsonMember;
class SharedArrays;

struct Json {
  enum class Type : std::uint8_t { Null, Bool, Number, Text, Array, Object };
  struct Content;

  Type type = Type::Null;
  std::size_t at = 0;                ///< its first byte in the text
  double number = 0;                 ///< of Number; 0 or 1 of Bool
  std::shared_ptr<Content> content;  ///< of Text, Array and Object

  const std::string& text() const;
  std::span<const Json> items() const;
  std::span<const JsonMember> members() const;
  const Json* find(const std::string& name) const;  ///< a member, or null
};

struct JsonMember {
  std::string name;
  std::size_t at = 0;  ///< the first byte of the name
  Json value;
};

/// Where a value stands in its file, "PATH:LINE:COL", for sentences that come later. No part of the value.
struct Place {
  std::string text;
  bool operator==(const Place&) const { return true; }
};

/// A parsed file. Throws InputError where the text is no JSON (RFC 8259) or nested deeper than 32 or an object has more
/// than 1000 members.
class JsonFile {
 public:
  /// `arrays`: those that the text refers to by their numbers; null where it has them all itself. Must outlive this.
  JsonFile(std::string path, std::string text, const SharedArrays* arrays = nullptr);

  const SharedArrays* arrays() const { return arrays_; }
  const Json& root() const { return root_; }
  const std::string& path() const { return path_; }
  Place place(const Json& value) const;
  /// "PATH:LINE:COL: expected EXPECTED, found FOUND"; without `found`, what stands there.
  InputError error(const Json& value, const std::string& expected, const std::string& found = "") const;
  InputError error(std::size_t at, const std::string& expected, const std::string& found) const;

 private:
  std::pair<std::int64_t, std::int64_t> line_and_column(std::size_t at) const;

  const SharedArrays* arrays_;
  std::string path_, text_;
  std::vector<std::size_t> line_begins_;
  Json root_;
};

/// What a number must be: the sentence is "expected ...".
struct Range {
  bool (*holds)(double) = nullptr;
  const char* expected = "a number";
};
inline constexpr Range positive{[](double x) { return x > 0; }, "a number above 0"};
inline constexpr Range not_negative{[](double x) { return x >= 0; }, "a number of at least 0"};

class ObjectReader;
class ObjectWriter;

/// A struct that has a `fields` function (declared in its namespace) is an object; the rest is listed here.
template <class T>
inline constexpr bool is_object = false;
/// Arrays of these stand on one line.
template <class T>
inline constexpr bool is_short = !is_object<T>;
template <>
inline constexpr bool is_short<Affine> = false;

void read_value(const JsonFile& file, const Json& json, bool& value);
void read_value(const JsonFile& file, const Json& json, double& value);
void read_value(const JsonFile& file, const Json& json, int& value);    ///< whole, within int
void read_value(const JsonFile& file, const Json& json, Index& value);  ///< whole, 0 to 2^32 - 2
void read_value(const JsonFile& file, const Json& json, std::string& value);
void read_value(const JsonFile& file, const Json& json, Vec3& value);             ///< [x, y, z]
void read_value(const JsonFile& file, const Json& json, Affine& value);           ///< 12 numbers, row by row
void read_value(const JsonFile& file, const Json& json, Eigen::Matrix4d& value);  ///< 4 rows of 4, or the
                                                                                  ///< path of a file of them
template <class T>
requires is_object<T>
void read_value(const JsonFile& file, const Json& json, T& value);
template <class T>
void read_value(const JsonFile& file, const Json& json, std::vector<T>& value);

/// A text quoted as JSON.
std::string json_text(const std::string& text);

/// Writes indented JSON. Arrays of numbers stand on one line, arrays of objects one a line.
class JsonWriter {
 public:
  /// `arrays`: where long arrays go, in place of the text; null: none do. Must outlive this.
  explicit JsonWriter(SharedArrays* arrays = nullptr) : arrays_(arrays) {}

  SharedArrays* arrays() const { return arrays_; }
  void begin_object() { open('{'); }
  void end_object() { close('}'); }
  void begin_array(bool one_line) { open('[', one_line); }
  void end_array() { close(']'); }
  void key(const std::string& name);
  void raw(const std::string& token);  ///< a number, true, false, null
  void text(const std::string& value);
  const std::string& result() const { return out_; }

 private:
  void open(char bracket, bool one_line = false);
  void close(char bracket);
  void item();
  void new_line();

  SharedArrays* arrays_;
  std::string out_;
  struct Level {
    bool one_line = false, empty = true;
  };
  std::vector<Level> levels_;
  bool after_key_ = false;
};

void write_value(JsonWriter& out, bool value);
void write_value(JsonWriter& out, double value);  ///< null where it is not finite
void write_value(JsonWriter& out, int value);
void write_value(JsonWriter& out, std::size_t value);
void write_value(JsonWriter& out, Index value);
void write_value(JsonWriter& out, const std::string& value);
void write_value(JsonWriter& out, const char* value);
void write_value(JsonWriter& out, const Vec3& value);
void write_value(JsonWriter& out, const Affine& value);
void write_value(JsonWriter& out, const Eigen::Matrix4d& value);
template <class T>
requires is_object<T>
void write_value(JsonWriter& out, const T& value);
template <class T>
void write_value(JsonWriter& out, const std::vector<T>& value);

class ObjectReader {
 public:
  static constexpr bool reading = true;
  ObjectReader(const JsonFile& file, const Json& json);

  template <class T>
  void required(const char* name, T& value, const Range& range = {}) {
    if (!read(name, value, range)) absent_.emplace_back(name);
  }
  /// Absent: stays as it is. Written only where it differs from a T{}.
  template <class T>
  void optional(const char* name, T& value, const Range& range = {}) {
    read(name, value, range);
  }
  template <class T>
  void optional(const char* name, std::optional<T>& value, const Range& range = {}) {
    T given{};
    if (read(name, given, range)) value = given;
  }
  void place(Place& place) const { place = file_.place(json_); }

  const JsonFile& file() const { return file_; }
  const Json& json() const { return json_; }
  /// After all members were described: refuses unknown names, then absent ones.
  void done() const;

 private:
  template <class T>
  bool read(const char* name, T& value, const Range& range) {
    known_.emplace_back(name);
    const Json* member = json_.find(name);
    if (member == nullptr) return false;
    read_value(file_, *member, value);
    if constexpr (std::is_same_v<T, double>)
      if (range.holds != nullptr && !range.holds(value)) throw file_.error(*member, range.expected);
    return true;
  }

  const JsonFile& file_;
  const Json& json_;
  std::vector<std::string> known_, absent_;
};

class ObjectWriter {
 public:
  static constexpr bool reading = false;
  explicit ObjectWriter(JsonWriter& out) : out_(out) {}

  template <class T>
  void required(const char* name, const T& value, const Range& = {}) {
    out_.key(name);
    write_value(out_, value);
  }
  template <class T>
  void optional(const char* name, const T& value, const Range& = {}) {
    if (!(value == T{})) required(name, value);
  }
  template <class T>
  void optional(const char* name, const std::optional<T>& value, const Range& = {}) {
    if (value) required(name, *value);
  }
  void place(const Place&) const {}

  JsonWriter& out() { return out_; }

 private:
  JsonWriter& out_;
};

template <class T>
requires is_object<T>
void read_value(const JsonFile& file, const Json& json, T& value) {
  ObjectReader reader(file, json);
  fields(reader, value);
  reader.done();
}

template <class T>
void read_value(const JsonFile& file, const Json& json, std::vector<T>& value) {
  if (json.type != Json::Type::Array) throw file.error(json, "an array");
  value.resize(json.items().size());
  for (std::size_t i = 0; i < value.size(); ++i) read_value(file, json.items()[i], value[i]);
}

template <class T>
requires is_object<T>
void write_value(JsonWriter& out, const T& value) {
  out.begin_object();
  ObjectWriter writer(out);
  fields(writer, value);
  out.end_object();
}

template <class T>
void write_value(JsonWriter& out, const std::vector<T>& value) {
  out.begin_array(is_short<T>);
  for (const T& item : value) write_value(out, item);
  out.end_array();
}

}  // namespace sinew::document
