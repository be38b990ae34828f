#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "apps/sinew/command.h"
#include "apps/sinew/files.h"
#include "engine/document/json.h"
#include "engine/geometry/bounds.h"
#include "engine/io/io.h"

namespace sinew::app {

namespace {

struct Options {
  std::string a, b;
  bool json = false;
};

/// Point i of A against point i of B, in the file's unit.
struct Distances {
  std::size_t moved = 0;         ///< points with any difference, however small
  std::size_t incomparable = 0;  ///< finite in one file only
  double max = 0, rms = 0;
  double diagonal = 0;  ///< of A
};

Distances distances_of(const Shape& a, const Shape& b) {
  Distances out;
  out.diagonal = bounds_of(a.positions).diagonal();
  double sum = 0;
  const Vec3 shift = b.origin - a.origin;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool finite_a = a.positions[i].allFinite(), finite_b = b.positions[i].allFinite();
    if (finite_a != finite_b) ++out.incomparable;
    if (!finite_a || !finite_b) continue;
    const double distance = (b.positions[i] - a.positions[i] + shift).norm();
    out.moved += distance > 0;
    out.max = std::max(out.max, distance);
    sum += distance * distance;
  }
  if (a.size() > 0) out.rms = std::sqrt(sum / static_cast<double>(a.size()));
  return out;
}

struct AttributeDiff {
  std::string name;
  const char* state = "equal";  ///< equal, changed, missing (in B), added (by B)
  std::string what;             ///< of changed: "type", "count" or "values"
  std::size_t rows = 0;         ///< rows whose values changed
  double max = 0;               ///< largest change of a number
};

AttributeDiff compare(const Attribute& a, const Attribute& b) {
  AttributeDiff out{a.name, "changed", "", 0, 0};
  if (a.type != b.type || a.components != b.components || a.kind != b.kind) {
    out.what = "type";
  } else if (a.count() != b.count() || a.points != b.points || a.point_offsets != b.point_offsets) {
    out.what = "count";
  } else if (a.values == b.values) {
    out.state = "equal";
  } else {
    out.what = "values";
    const std::size_t size = a.row_size();
    for (std::size_t i = 0; i < a.count(); ++i) {
      if (std::memcmp(a.values.data() + i * size, b.values.data() + i * size, size) == 0) continue;
      ++out.rows;
      for (int c = 0; c < a.components; ++c) {
        const double change = std::abs(a.number(i, c) - b.number(i, c));
        if (change > out.max) out.max = change;
      }
    }
  }
  return out;
}

std::vector<AttributeDiff> compare_attributes(const Shape& a, const Shape& b) {
  std::vector<AttributeDiff> out;
  for (const Attribute& attribute : a.attributes) {
    const Attribute* other = b.find(attribute.name);
    out.push_back(other != nullptr ? compare(attribute, *other) : AttributeDiff{attribute.name, "missing", "", 0, 0});
  }
  for (const Attribute& attribute : b.attributes)
    if (a.find(attribute.name) == nullptr) out.push_back({attribute.name, "added", "", 0, 0});
  return out;
}

/// A number of 1, 2, 3 that is neither x nor y.
double other_than(double x, double y) {
  for (const double number : {1.0, 2.0})
    if (x != number && y != number) return number;
  return 3;
}

/// `shape` with numbers of our own in place of positions and of attributes that differ in `other`; the same numbers
/// where the two are swapped.
Shape neutral(Shape shape, const Shape& other, const std::vector<AttributeDiff>& attributes) {
  for (std::size_t i = 0; i < shape.size(); ++i) {
    Vec3& p = shape.positions[i];
    if (!p.allFinite() || !other.positions[i].allFinite()) continue;
    const Vec3 x = p + shape.origin, y = other.positions[i] + other.origin;
    for (int c = 0; c < 3; ++c) p[c] = other_than(std::round(x[c]), std::round(y[c])) - shape.origin[c];
  }
  for (const AttributeDiff& diff : attributes) {
    if (diff.what != "values") continue;
    Attribute& mine = *shape.find(diff.name);
    const Attribute& theirs = *other.find(diff.name);
    for (std::size_t i = 0; i < mine.count(); ++i)
      for (int c = 0; c < mine.components; ++c)
        mine.set_number(i, c, other_than(std::round(mine.number(i, c)), std::round(theirs.number(i, c))));
  }
  return shape;
}

/// A writer copies its file and replaces only values that differ from those read. So with all values replaced by the
/// same ones, the two files are the same bytes exactly where everything else is, however each spells its numbers.
bool all_else_equal(const std::string& path, const Shape& a, const Shape& b,
                    const std::vector<AttributeDiff>& attributes) {
  const io::Format& format = io::format_of(path);
  io::WriteReport report;
  return files_of(format, path, neutral(a, b, attributes), report) ==
         files_of(format, path, neutral(b, a, attributes), report);
}

struct Diff {
  std::size_t points_a = 0, points_b = 0;
  std::optional<Distances> distances;  ///< where the numbers of points agree
  std::vector<AttributeDiff> attributes;
  bool faces_equal = false;
  const char* rest = nullptr;  ///< "equal", "changed", or null where it cannot be said
};

Diff diff_of(const Options& options) {
  const std::shared_ptr<const Shape> a = read_input(options.a, ""), b = read_input(options.b, "");
  Diff out{a->size(), b->size(), {}, compare_attributes(*a, *b), false, nullptr};
  out.faces_equal = a->faces.offsets == b->faces.offsets && a->faces.points == b->faces.points;
  if (out.points_a != out.points_b) return out;
  out.distances = distances_of(*a, *b);
  const io::Format& format = io::format_of(options.a);
  if (format.write != nullptr && &format == &io::format_of(options.b) && a->parts.empty() && b->parts.empty())
    out.rest = all_else_equal(options.a, *a, *b, out.attributes) ? "equal" : "changed";
  return out;
}

template <class T>
void member(document::JsonWriter& out, const char* name, const T& value) {
  out.key(name);
  write_value(out, value);
}

void print_json(const Diff& diff) {
  document::JsonWriter out;
  out.begin_object();
  member(out, "points", std::vector<double>{static_cast<double>(diff.points_a), static_cast<double>(diff.points_b)});
  if (diff.distances) {
    member(out, "moved", diff.distances->moved);
    member(out, "incomparable", diff.distances->incomparable);
    out.key("distance");
    out.begin_object();
    member(out, "max", diff.distances->max);
    member(out, "rms", diff.distances->rms);
    out.end_object();
    member(out, "diagonal", diff.distances->diagonal);
  }
  out.key("attributes");
  out.begin_object();
  for (const AttributeDiff& attribute : diff.attributes) {
    out.key(attribute.name);
    out.begin_object();
    member(out, "state", attribute.state);
    if (!attribute.what.empty()) member(out, "what", attribute.what);
    if (attribute.what == "values") {
      member(out, "rows", attribute.rows);
      member(out, "max", attribute.max);
    }
    out.end_object();
  }
  out.end_object();
  member(out, "faces", diff.faces_equal ? "equal" : "changed");
  if (diff.rest != nullptr) member(out, "rest", diff.rest);
  out.end_object();
  fmt::print("{}", out.result());
}

void print_text(const Diff& diff) {
  const auto row = [](const char* name, const std::string& value) { fmt::print("{:<12}{}\n", name, value); };
  if (diff.distances) {
    const Distances& d = *diff.distances;
    const double scale = d.diagonal > 0 ? 1 / d.diagonal : 0;
    row("points", fmt::format("{}, {} moved", diff.points_a, d.moved));
    if (d.incomparable > 0) row("", fmt::format("{} finite in one file only", d.incomparable));
    row("distance", fmt::format("max {:.6g}, rms {:.6g} ({:.3g} and {:.3g} of the diagonal)", d.max, d.rms,
                                d.max * scale, d.rms * scale));
  } else {
    row("points", fmt::format("{} and {}", diff.points_a, diff.points_b));
  }
  const char* heading = "attributes";
  for (const AttributeDiff& a : diff.attributes) {
    std::string state = a.state;
    if (a.what == "values")
      state += fmt::format(" in {} rows, by at most {:.6g}", a.rows, a.max);
    else if (!a.what.empty())
      state += " (" + a.what + ")";
    row(heading, fmt::format("{:<20} {}", a.name, state));
    heading = "";
  }
  row("faces", diff.faces_equal ? "equal" : "changed");
  if (diff.rest != nullptr) row("rest", diff.rest);
}

}  // namespace

std::function<int()> declare_diff(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.positional("A", options->a, "File before");
  arguments.positional("B", options->b, "File after");
  arguments.flag("--json", options->json, "As JSON");
  return [options] {
    const Diff diff = diff_of(*options);
    options->json ? print_json(diff) : print_text(diff);
    return Ok;
  };
}

}  // namespace sinew::app
