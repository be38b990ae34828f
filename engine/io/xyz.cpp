#include "engine/io/xyz.h"

#include <algorithm>
#include <array>
#include <optional>

#include "engine/io/bytes.h"
#include "engine/io/text_patch.h"
#include "engine/io/xyz_names.h"
#include "engine/io/xyz_row.h"

namespace sinew::io {

namespace {

struct XyzContent : FileContent {
  bool csv = false;
  std::vector<std::byte> bytes;
  std::vector<std::size_t> rows;  ///< byte where each begins
  std::vector<XyzGroup> groups;
};

using Columns = std::vector<std::vector<double>>;

bool are_bytes(const std::vector<double>& column) {
  return std::all_of(column.begin(), column.end(), [](double x) { return x >= 0 && x <= 255 && x == std::floor(x); });
}

bool are_bytes(const Columns& columns, std::size_t first) {
  return are_bytes(columns[first]) && are_bytes(columns[first + 1]) && are_bytes(columns[first + 2]);
}

bool are_unit_vectors(const Columns& columns, std::size_t first) {
  bool any = false;
  for (std::size_t i = 0; i < columns[first].size(); ++i) {
    const Vec3 n(columns[first][i], columns[first + 1][i], columns[first + 2][i]);
    if (n == Vec3::Zero() || n.hasNaN()) continue;
    if (!(std::abs(n.norm() - 1) <= 1e-3)) return false;
    any = true;
  }
  return any;
}

std::vector<XyzGroup> groups_by_value(const Columns& columns) {
  const std::size_t n = columns.size();
  std::vector<XyzGroup> groups{{"position", Kind::Point, {0, 1, 2}}};
  std::vector<bool> taken(n, false);
  const auto take = [&](const char* name, Kind kind, std::size_t first) {
    groups.push_back({name, kind, {first, first + 1, first + 2}});
    std::fill_n(taken.begin() + static_cast<std::ptrdiff_t>(first), 3, true);
  };
  for (std::size_t c = 3; c + 3 <= n; ++c)
    if (are_unit_vectors(columns, c)) {
      take("normal", Kind::Normal, c);
      break;
    }
  for (std::size_t c = n == 7 && are_bytes(columns, 4) ? 4 : 3; c + 3 <= n; ++c)
    if (!taken[c] && !taken[c + 1] && !taken[c + 2] && are_bytes(columns, c)) {
      take("color", Kind::Color, c);
      break;
    }
  for (std::size_t c = 3; c < n; ++c) {
    const bool intensity = c == 3 && (n == 4 || (n == 7 && has_xyz_group(groups, "color") && taken[6]));
    if (!taken[c]) groups.push_back({intensity ? "intensity" : "column " + std::to_string(c + 1), Kind::Scalar, {c}});
  }
  return groups;
}

class XyzReader {
 public:
  XyzReader(std::string path, std::vector<std::byte> bytes, bool csv, const ReadOptions& options)
      : path_(std::move(path)), options_(options), content_(std::make_shared<XyzContent>()) {
    content_->bytes = std::move(bytes);
    content_->csv = csv;
  }

  Shape read() {
    TextCursor cursor(path_, as_text(content_->bytes), text_begin(path_, content_->bytes));
    for (std::size_t lines = 0; !cursor.at_end(); ++lines) {
      if (lines % 65536 == 0) report_progress(options_, cursor.at(), content_->bytes.size());
      const std::size_t begin = cursor.at();
      line_ = cursor.line();
      read_line(cursor.rest(), begin);
      cursor.next_line();
    }
    if (content_->rows.empty()) throw file_error(path_, "a row of at least three numbers", "none");
    if (content_->rows.size() >= no_row) throw file_error(path_, "fewer than 2^32 rows", "more");
    if (count_ && *count_ != static_cast<std::int64_t>(content_->rows.size()))
      throw text_error(path_, count_line_, 0, "the count of the " + std::to_string(content_->rows.size()) + " rows",
                       std::to_string(*count_));
    return finish();
  }

 private:
  InputError error(std::string_view line, std::string_view field, const std::string& expected) const {
    return text_error(path_, line_, field.data() - line.data() + 1, expected,
                      field.empty() ? "an empty field" : quoted(field));
  }

  void read_line(std::string_view line, std::size_t begin) {
    const std::string_view comment = xyz_comment(line);
    if (comment.data() != nullptr) {
      if (content_->rows.empty()) read_names(comment, true);
      return;
    }
    XyzFields fields(line);
    std::string_view field;
    if (!fields.next(field)) return;
    if (content_->rows.empty()) {
      double x = 0;
      if (!parse(field, x)) {
        if (!read_names(line, false)) throw error(line, field, "a number, or names of columns with x, y and z");
        return;
      }
      if (read_count(line)) return;
    }
    read_row(line, begin);
  }

  bool read_names(std::string_view line, bool comment) {
    bool good = false;
    for (std::vector<std::string>& names : split_xyz_names(line)) {
      if (names.size() > most_xyz_columns || !has_xyz_position(names)) continue;
      if (!good) names_.clear();
      good = true;
      names_.push_back(std::move(names));
    }
    if (good) names_line_ = comment ? 0 : line_;
    return good;
  }

  bool read_count(std::string_view line) {
    XyzFields fields(line);
    std::string_view first, second;
    std::int64_t count = 0;
    if (count_ || !fields.next(first) || fields.next(second) || !parse(first, count)) return false;
    count_ = count;
    count_line_ = line_;
    return true;
  }

  void read_row(std::string_view line, std::size_t begin) {
    const bool first_row = content_->rows.empty();
    XyzFields fields(line);
    std::size_t c = 0;
    for (std::string_view field; fields.next(field); ++c) {
      if (c == columns_.size()) {
        if (!first_row) throw wrong_length(fields, c + 1);
        if (c == most_xyz_columns) throw text_error(path_, line_, 0, "at most 256 numbers in a row", "more");
        columns_.emplace_back();
        precision_.emplace_back();
      }
      double x = 0;
      if (!parse(field, x)) throw error(line, field, "a number");
      precision_[c].see(field, x);
      columns_[c].push_back(x);
    }
    if (first_row && c < 3) throw text_error(path_, line_, 0, "at least three numbers in a row", std::to_string(c));
    if (c < columns_.size()) throw wrong_length(fields, c);
    content_->rows.push_back(begin);
  }

  InputError wrong_length(XyzFields& rest, std::size_t count) const {
    for (std::string_view field; rest.next(field);) ++count;
    return text_error(path_, line_, 0, std::to_string(columns_.size()) + " numbers as in the rows above",
                      std::to_string(count));
  }

  /// Names count where they are as many as the columns. A comment may be about anything.
  void choose_names() {
    for (std::vector<std::string>& names : names_)
      if (names.size() == columns_.size()) column_names_ = std::move(names);
    if (column_names_.empty() && names_line_ > 0)
      throw text_error(path_, names_line_, 0, "a name for each of the " + std::to_string(columns_.size()) + " columns",
                       std::to_string(names_.back().size()));
  }

  Shape finish() {
    choose_names();
    content_->groups = has_names() ? xyz_groups(column_names_) : groups_by_value(columns_);
    Shape shape;
    take_positions(shape, content_->groups.front());
    for (std::size_t g = 1; g < content_->groups.size(); ++g) add_attribute(shape, content_->groups[g]);
    shape.content = std::move(content_);
    return shape;
  }

  void take_positions(Shape& shape, const XyzGroup& group) {
    bool as_float = true;
    for (const std::size_t c : group.columns)
      as_float = as_float && precision_[c].type() == Type::Float32 &&
                 std::none_of(columns_[c].begin(), columns_[c].end(),
                              [](double x) { return std::isfinite(x) && std::abs(x) >= float_limit; });
    shape.position_type = as_float ? Type::Float32 : Type::Float64;
    shape.positions.resize(content_->rows.size());
    for (int c = 0; c < 3; ++c) {
      std::vector<double>& column = columns_[group.columns[static_cast<std::size_t>(c)]];
      for (std::size_t i = 0; i < column.size(); ++i) shape.positions[i][c] = as_read(column[i], shape.position_type);
      column = {};
    }
  }

  void add_attribute(Shape& shape, const XyzGroup& group) {
    const std::size_t n = content_->rows.size(), size = group.columns.size();
    Type type = Type::Float32;
    for (const std::size_t c : group.columns)
      if (precision_[c].type() == Type::Float64) type = Type::Float64;
    if (is_byte_color(group)) type = Type::UInt8;
    std::vector<double> values(n * size);
    std::vector<std::string> fields;
    for (std::size_t k = 0; k < size; ++k) {
      const std::size_t c = group.columns[k];
      fields.push_back(has_names() ? column_names_[c] : size == 1 ? group.name : group_field(group, k));
      for (std::size_t i = 0; i < n; ++i) values[i * size + k] = columns_[c][i];
      columns_[c] = {};
    }
    shape.attributes.push_back(number_attribute(group.name, std::move(fields), group.kind, type, values));
  }

  bool has_names() const { return !column_names_.empty(); }

  /// By CloudCompare's habit Rf Gf Bf are fractions.
  bool is_byte_color(const XyzGroup& group) const {
    if (group.kind != Kind::Color || (has_names() && xyz_lower(column_names_[group.columns.front()]) == "rf"))
      return false;
    return std::all_of(group.columns.begin(), group.columns.end(),
                       [&](std::size_t c) { return are_bytes(columns_[c]); });
  }

  static std::string group_field(const XyzGroup& group, std::size_t k) {
    static const std::array<const char*, 3> normal = {"nx", "ny", "nz"}, color = {"r", "g", "b"};
    return group.kind == Kind::Normal ? normal[k] : color[k];
  }

  std::string path_;
  const ReadOptions& options_;
  std::shared_ptr<XyzContent> content_;
  std::int64_t line_ = 0;
  Columns columns_;
  std::vector<Precision> precision_;             ///< of each column
  std::vector<std::vector<std::string>> names_;  ///< the ways to read the line of names
  std::int64_t names_line_ = 0;                  ///< 0: a comment
  std::vector<std::string> column_names_;
  std::optional<std::int64_t> count_;  ///< said by a line of its own
  std::int64_t count_line_ = 0;
};

bool same_layout(const Shape& shape, const XyzContent& content) {
  if (content.rows.size() != shape.size() || !shape.faces.empty()) return false;
  for (std::size_t g = 1; g < content.groups.size(); ++g) {
    const Attribute* attribute = shape.find(content.groups[g].name);
    if (!attribute || !attribute->per_point() || attribute->count() != shape.size() ||
        static_cast<std::size_t>(attribute->components) != content.groups[g].columns.size())
      return false;
  }
  return true;
}

std::vector<std::byte> patched(const Shape& shape, const XyzContent& content) {
  struct Source {
    const Attribute* attribute = nullptr;  ///< null: the position
    int component = 0;
  };
  std::vector<Source> sources;
  for (const XyzGroup& group : content.groups)
    for (std::size_t k = 0; k < group.columns.size(); ++k) {
      if (group.columns[k] >= sources.size()) sources.resize(group.columns[k] + 1);
      sources[group.columns[k]] = {&group == &content.groups.front() ? nullptr : shape.find(group.name),
                                   static_cast<int>(k)};
    }
  TextPatch patch(content.bytes);
  TextCursor cursor("", as_text(content.bytes));
  for (std::size_t i = 0; i < shape.size(); ++i) {
    cursor.seek(content.rows[i]);
    const std::string_view line = cursor.rest();
    XyzFields fields(line);
    std::string_view field;
    for (const Source& source : sources) {
      CHECK(fields.next(field), i);
      const std::size_t begin = content.rows[i] + static_cast<std::size_t>(field.data() - line.data());
      if (source.attribute)
        patch.set(begin, field, source.attribute->number(i, source.component), source.attribute->type);
      else
        patch.set(begin, field, shape.positions[i][source.component], shape.position_type,
                  shape.origin[source.component]);
    }
  }
  return patch.finish();
}

bool is_velocity(const Attribute& attribute) {
  return attribute.name == "velocity" && attribute.kind == Kind::Velocity && attribute.components == 3;
}

/// Names of columns that xyz_groups reads back as the same attribute.
std::vector<std::string> names_of(const Attribute& attribute) {
  if (attribute.name == "color" && attribute.kind == Kind::Color) {
    const bool bytes = attribute.type == Type::UInt8 || attribute.components == 1;
    if (!bytes && attribute.components == 3) return {"Rf", "Gf", "Bf"};
    return attribute.components == 4 ? std::vector<std::string>{"R", "G", "B", "A"}
                                     : std::vector<std::string>{"R", "G", "B"};
  }
  if (is_velocity(attribute)) return {"vx", "vy", "vz"};
  if (attribute.name == "normal") return {"Nx", "Ny", "Nz"};
  std::vector<std::string> names;
  for (const std::string& field : attribute.fields) {
    names.push_back(field);
    for (char& c : names.back())
      if (static_cast<unsigned char>(c) <= ' ' || c == ',' || c == ';' || c == '#' || c == '/' || c == '"') c = '_';
    if (names.back().empty()) names.back() = "_";
  }
  return names;
}

bool can_hold(const Attribute& attribute) {
  if (!attribute.per_point()) return false;
  if (attribute.name == "color" || attribute.kind == Kind::Color)
    return attribute.name == "color" && is_text_color(attribute);
  if (attribute.name == "normal") return attribute.kind == Kind::Normal && attribute.components == 3;
  return attribute.components == 1 || is_velocity(attribute);
}

/// A new file. Its values are separated by blanks, or in CSV by commas.
std::vector<std::byte> generic(const Shape& shape, bool csv, WriteReport& report) {
  const std::string format = csv ? "CSV" : "XYZ";
  std::vector<const Attribute*> attributes;
  std::vector<std::string> held;
  std::string names = csv ? "x y z" : "//X Y Z";
  for (const Attribute& attribute : shape.attributes) {
    if (!can_hold(attribute)) continue;
    attributes.push_back(&attribute);
    held.push_back(attribute.name);
    for (const std::string& name : names_of(attribute)) names += " " + name;
  }
  report_lost_attributes(format, shape, held, report);
  if (!shape.faces.empty())
    report.lost.push_back(format + " cannot hold the " + counted(shape.faces.size(), "face", "faces") + ".");

  std::vector<std::byte> out;
  out.reserve(shape.size() * 32);
  if (csv || !attributes.empty()) append_text(out, names + "\n");
  for (std::size_t i = 0; i < shape.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (c > 0) append_text(out, " ");
      append_number(out, shape.positions[i][c] + shape.origin[c], shape.position_type);
    }
    for (const Attribute* attribute : attributes) {
      if (attribute->kind == Kind::Color) {
        append_color(out, *attribute, i, false);
        continue;
      }
      for (int c = 0; c < attribute->components; ++c) {
        append_text(out, " ");
        append_number(out, attribute->number(i, c), attribute->type);
      }
    }
    append_text(out, "\n");
  }
  if (csv) std::replace(out.begin(), out.end(), std::byte{' '}, std::byte{','});
  return out;
}

std::vector<std::byte> write(const Shape& shape, bool csv, WriteReport& report) {
  const auto* content = dynamic_cast<const XyzContent*>(shape.content.get());
  if (!content || content->csv != csv || !same_layout(shape, *content)) return generic(shape, csv, report);
  std::vector<std::string> held;
  for (const XyzGroup& group : content->groups) held.push_back(group.name);
  report_lost_attributes(csv ? "CSV" : "XYZ", shape, held, report);
  return patched(shape, *content);
}

}  // namespace

Shape read_xyz(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  return XyzReader(path, std::move(bytes), false, options).read();
}

std::vector<std::byte> write_xyz(const std::string&, const Shape& shape, WriteReport& report) {
  return write(shape, false, report);
}

Shape read_csv(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  return XyzReader(path, std::move(bytes), true, options).read();
}

std::vector<std::byte> write_csv(const std::string&, const Shape& shape, WriteReport& report) {
  return write(shape, true, report);
}

}  // namespace sinew::io
