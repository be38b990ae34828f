#include "engine/io/scan_set.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/geometry/error.h"
#include "engine/io/bytes.h"
#include "engine/io/scan_set_content.h"
#include "engine/io/text.h"

namespace sinew::io {

namespace {

/// A line of the file that names a scan.
struct Entry {
  Token name;
  Mat3 rotation;
  Vec3 translation;
};

bool same_kind(const Attribute& a, const Attribute& b) {
  return a.name == b.name && a.kind == b.kind && a.type == b.type && a.components == b.components;
}

/// What can be one attribute of the set: it has a value a point, and we can turn it.
bool can_merge(const Attribute& a) {
  const bool turned =
      a.kind == Kind::Normal || a.kind == Kind::Vector || a.kind == Kind::Velocity || a.kind == Kind::Point;
  const bool still = a.kind == Kind::Scalar || a.kind == Kind::Color || a.kind == Kind::Id;
  return a.per_point() && (still || (turned && a.components == 3));
}

Entry read_entry(const std::string& path, TextCursor& cursor) {
  Entry entry;
  entry.name = cursor.token();
  if (entry.name.text.empty()) throw cursor.error(entry.name, "the file of a scan");
  double numbers[7];
  for (int i = 0; i < 7; ++i) {
    const Token token = cursor.token();
    if (!parse(token.text, numbers[i]) || !std::isfinite(numbers[i]))
      throw cursor.error(token,
                         i < 3 ? "a number of the translation tx ty tz" : "a number of the rotation qi qj qk qr");
  }
  const Token end = cursor.token();
  if (!end.text.empty()) throw cursor.error(end, "the end of the line after qr");
  const Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(q.norm() > 1e-6) || !(q.norm() < 1e6))
    throw text_error(path, entry.name.line, 0, "a rotation qi qj qk qr of length 1",
                     "the length " + shortest(static_cast<float>(q.norm())));
  entry.rotation = q.normalized().toRotationMatrix().transpose();
  entry.translation = Vec3(numbers[0], numbers[1], numbers[2]);
  return entry;
}

std::vector<Entry> read_entries(const std::string& path, std::string_view text) {
  std::vector<Entry> entries;
  for (TextCursor cursor(path, text); !cursor.at_end(); cursor.next_line()) {
    const Token word = cursor.token();
    if (word.text == "bmesh" || word.text == "mesh") entries.push_back(read_entry(path, cursor));
  }
  return entries;
}

/// The scan's shape in its own frame.
std::shared_ptr<const Shape> read_scan(const std::string& path, const Entry& entry, const std::string& file,
                                       const ReadOptions& options) {
  const Format& format = format_of(file);
  if (format.read == read_scan_set)
    throw text_error(path, entry.name.line, entry.name.column, "a file of points",
                     "another scan set, " + sinew::quoted(entry.name.text));
  std::vector<std::byte> bytes = load_bytes(file);
  refuse_lfs_pointer(file, bytes, format.name);
  return std::make_shared<Shape>(format.read(file, std::move(bytes), options));
}

void check_size(const std::string& path, const Shape& shape, const Shape& own) {
  constexpr std::size_t most = std::size_t{0xfffffffe};
  if (shape.size() + own.size() > most || shape.faces.points.size() + own.faces.points.size() > most)
    throw file_error(path, "at most 4294967294 points and corners in all", "more");
}

/// Points and faces of a scan behind those that are there.
void append_scan(Shape& shape, const std::string& name, const Entry& entry, const Shape& own) {
  Part part;
  part.path = name;
  part.first = static_cast<Index>(shape.size());
  part.count = static_cast<Index>(own.size());
  part.rotation = entry.rotation;
  part.translation = entry.translation;
  part.content = own.content;
  for (const Vec3& p : own.positions) shape.positions.push_back(to_world(part, p));
  if (own.position_type == Type::Float64) shape.position_type = Type::Float64;
  std::vector<Index> corners;
  for (std::size_t f = 0; f < own.faces.size(); ++f) {
    corners.assign(own.faces[f].begin(), own.faces[f].end());
    for (Index& corner : corners) corner += part.first;
    shape.faces.add(corners);
  }
  for (Tet tet : own.tets) {
    for (Index& corner : tet) corner += part.first;
    shape.tets.push_back(tet);
  }
  for (const std::string& note : own.notes) shape.notes.push_back(fmt::format("{}: {}", name, note));
  shape.parts.push_back(std::move(part));
}

void merge_attributes(Shape& shape, const std::vector<std::shared_ptr<const Shape>>& scans) {
  const auto in_all = [&](const Attribute& attribute) {
    return can_merge(attribute) && std::all_of(scans.begin(), scans.end(), [&](const auto& scan) {
             const Attribute* other = scan->find(attribute.name);
             return other != nullptr && same_kind(*other, attribute) && can_merge(*other);
           });
  };
  for (const Attribute& attribute : scans.front()->attributes) {
    if (!in_all(attribute)) continue;
    Attribute merged = attribute;
    merged.values.clear();
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const Attribute own = in_world(shape.parts[i], *scans[i]->find(attribute.name));
      merged.values.insert(merged.values.end(), own.values.begin(), own.values.end());
    }
    shape.attributes.push_back(std::move(merged));
  }
  std::vector<std::string> noted;
  for (const auto& scan : scans)
    for (const Attribute& attribute : scan->attributes) {
      const bool merged = shape.find(attribute.name) != nullptr;
      if (merged || std::find(noted.begin(), noted.end(), attribute.name) != noted.end()) continue;
      noted.push_back(attribute.name);
      shape.notes.push_back("The attribute " + sinew::quoted(attribute.name) +
                            " is not the same in all scans: it is kept in their files and not bent.");
    }
}

}  // namespace

// Not inlined: reading and writing compare what it gives bit by bit, so there must be one machine code of it.
[[gnu::noinline]] Vec3 to_world(const Part& part, const Vec3& own) {
  return part.rotation * own + part.translation;
}

[[gnu::noinline]] Vec3 to_own(const Part& part, const Vec3& world) {
  return part.rotation.transpose() * (world - part.translation);
}

Attribute in_world(const Part& part, Attribute attribute) {
  Part turn = part;
  if (attribute.kind != Kind::Point) turn.translation.setZero();
  transform(attribute, [&turn](const Vec3& x) { return to_world(turn, x); });
  return attribute;
}

void transform(Attribute& attribute, const std::function<Vec3(const Vec3&)>& map) {
  const bool turned = attribute.kind == Kind::Normal || attribute.kind == Kind::Vector ||
                      attribute.kind == Kind::Velocity || attribute.kind == Kind::Point;
  if (!turned || attribute.components != 3) return;
  for (std::size_t i = 0; i < attribute.count(); ++i) {
    const Vec3 x = map({attribute.number(i, 0), attribute.number(i, 1), attribute.number(i, 2)});
    for (int c = 0; c < 3; ++c) attribute.set_number(i, c, x[c]);
  }
}

Shape read_scan_set(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  auto content = std::make_shared<ScanSetContent>();
  content->bytes = std::move(bytes);
  content->name = std::filesystem::path(path).filename().string();
  const std::vector<Entry> entries = read_entries(path, as_text(content->bytes));
  if (entries.empty()) throw file_error(path, "a line \"bmesh FILE tx ty tz qi qj qk qr\"", "none");
  Shape shape;
  std::string missing;
  std::size_t missing_count = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string name(entries[i].name.text);
    const std::string file = (std::filesystem::path(path).parent_path() / name).string();
    std::error_code none;
    if (!std::filesystem::exists(file, none)) {
      missing += (missing_count++ > 0 ? ", " : "") + sinew::quoted(name);
      continue;
    }
    ReadOptions part_options;
    if (options.progress)
      part_options.progress = [&](double x) {
        return options.progress((static_cast<double>(i) + x) / static_cast<double>(entries.size()));
      };
    auto own = read_scan(path, entries[i], file, part_options);
    check_size(path, shape, *own);
    append_scan(shape, name, entries[i], *own);
    content->names.push_back({entries[i].name.begin, name.size()});
    content->scans.push_back(std::move(own));
  }
  if (content->scans.empty()) throw file_error(path, "a scan beside it", "none of " + missing);
  if (missing_count > 0)
    shape.notes.push_back(std::to_string(missing_count) + " of " + std::to_string(entries.size()) +
                          " scans are missing: " + missing + ".");
  merge_attributes(shape, content->scans);
  shape.content = std::move(content);
  return shape;
}

}  // namespace sinew::io
