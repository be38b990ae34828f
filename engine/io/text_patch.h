#pragma once
/// What readers and writers of text formats share: whether a file is text, how precise its numbers are, and a copy of
/// a file in which single numbers are replaced.

#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/attribute.h"
#include "engine/io/io.h"
#include "engine/io/text.h"

namespace sinew::io {

/// From here on a float no longer keeps a millimetre where the unit is a metre (its step is then 2^-10).
inline constexpr double float_limit = 8192;

/// Calls options.progress with done / all; throws Cancelled where it says so.
void report_progress(const ReadOptions& options, std::size_t done, std::size_t all);

/// The byte where the text begins: 0, or 3 behind a UTF-8 byte order mark. Throws InputError where the file is empty,
/// has a zero byte, or is UTF-16 or UTF-32.
std::size_t text_begin(const std::string& path, std::span<const std::byte> bytes);

/// Whether numbers seen so far lose nothing as floats: each is a float's exact value or its shortest text, and its
/// magnitude is below `limit`.
class Precision {
 public:
  explicit Precision(double limit = HUGE_VAL) : limit_(limit) {}

  /// A number and the text that it was read from.
  void see(std::string_view text, double x) { float_ = float_ && fits_float(text, x); }
  Type type() const { return float_ ? Type::Float32 : Type::Float64; }

 private:
  bool fits_float(std::string_view text, double x) const;

  double limit_;
  bool float_ = true;
};

/// Appends the shortest text of a coordinate or other number that was read as `type`: of the float for Float32, unless
/// that would lose more than half a millimetre of a metre (at float_limit and above), otherwise of the double.
void append_number(std::string& out, double x, Type type);
void append_number(std::vector<std::byte>& out, double x, Type type);
void append_text(std::vector<std::byte>& out, std::string_view text);

/// The double of a text as the value of an attribute or position of `type`: rounded to float for Float32.
double as_read(double x, Type type);

/// The whole of `token` as a value of `type`, stored at `at`; false where it is no number or out of range.
bool parse_value(std::string_view token, Type type, std::byte* at);
/// The shortest text of the value of `type` at `at`.
std::string value_text(Type type, const std::byte* at);

/// A copy of a file with some numbers replaced; all else, also how unchanged numbers are written, stays.
class TextPatch {
 public:
  explicit TextPatch(std::span<const std::byte> from) : from_(from) { out_.reserve(from.size() + from.size() / 8); }

  /// Replaces the number `token` at byte `begin` of the file where it is not `now` + `origin`, `now` being a number
  /// that was read from it as `type`, less `origin`. In ascending order of `begin`.
  void set(std::size_t begin, std::string_view token, double now, Type type, double origin = 0);
  void set(const Token& token, double now, Type type, double origin = 0) {
    set(token.begin, token.text, now, type, origin);
  }

  /// Replaces a token, whatever it is.
  void replace(const Token& token, std::string_view now) { replace(token.begin, token.text.size(), now); }

  std::vector<std::byte> finish();

 private:
  void replace(std::size_t begin, std::size_t size, std::string_view now);

  std::span<const std::byte> from_;
  std::vector<std::byte> out_;
  std::size_t copied_ = 0;  ///< bytes of from_ that are dealt with
};

/// An attribute with these values (row by row) as `type`.
Attribute number_attribute(std::string name, std::vector<std::string> field_names, Kind kind, Type type,
                           std::span<const double> values);

inline constexpr Index no_row = 0xffffffff;

/// For each point the row of `attribute` that belongs to it, no_row where none does. Nothing where a point has several.
std::optional<std::vector<Index>> row_of_points(const Shape& shape, const Attribute& attribute);

/// A colour for each point that can be written as numbers: three or four components, bytes or floating point, or the
/// bits 0x00rrggbb in one component of four bytes (PCD).
bool is_text_color(const Attribute& color);

/// " r g b" or " r g b a" of point i: bytes as 0 to 255, or as fractions of 1 where `fractions`.
void append_color(std::vector<std::byte>& out, const Attribute& color, std::size_t i, bool fractions);

/// Names of attributes, each different: "a", "a 2", "a 3".
class UniqueNames {
 public:
  /// Names that only vectors and colours should have are taken from the start.
  UniqueNames() : taken_{"position", "normal", "color", "velocity"} {}
  std::string add(const std::string& name);
  /// Whether one of those is still free; it is not any more.
  bool take(const std::string& name) { return used_.insert(name).second; }

 private:
  std::set<std::string> taken_, used_;
  std::map<std::string, int> last_;  ///< number given to a name
};

/// "NAME cannot hold the attribute "intensity"." for each attribute whose name is not among `held`, and a sentence for
/// the scans of a set.
void report_lost_attributes(const std::string& format, const Shape& shape, const std::vector<std::string>& held,
                            WriteReport& report);

/// "NAME cannot hold coordinates beyond float: they change by up to 1e-09." where the shape has doubles and some do.
void report_lost_precision(const std::string& format, const Shape& shape, WriteReport& report);

/// "1 point", "2 points"
std::string counted(std::size_t count, const char* singular, const char* plural);

}  // namespace sinew::io
