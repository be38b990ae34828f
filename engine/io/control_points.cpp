#include "engine/io/control_points.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>

#include "engine/io/bytes.h"
#include "engine/io/io.h"
#include "engine/io/marker_rows.h"
#include "engine/io/text.h"
#include "engine/io/words.h"

namespace sinew::io {

namespace {

using Three = std::array<std::size_t, 3>;

struct Columns {
  std::optional<std::size_t> name, id;
  std::optional<Three> at;
  Three to{};
  std::size_t least = 0;  ///< cells that a row must have
};

std::optional<std::size_t> find(const std::vector<Cell>& cells, std::initializer_list<const char*> words) {
  for (const char* word : words)
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (same_word(cells[i].text, word)) return i;
  return std::nullopt;
}

std::optional<Three> targets_in(const std::vector<Cell>& cells) {
  const auto x = find(cells, {"tx", "target_x"}), y = find(cells, {"ty", "target_y"}),
             z = find(cells, {"tz", "target_z"});
  return x && y && z ? std::optional(Three{*x, *y, *z}) : std::nullopt;
}

bool is_number(const Cell& cell) {
  double x = 0;
  return parse(cell.text, x);
}

Columns named_columns(const std::string& path, std::int64_t line, const std::vector<Cell>& cells) {
  const std::optional<Three> to = targets_in(cells);
  if (!to) throw text_error(path, line, 1, "columns tx, ty and tz, the targets", sinew::quoted(cells.front().text));
  Columns out;
  out.to = *to;
  const auto x = find(cells, {"x"}), y = find(cells, {"y"}), z = find(cells, {"z"});
  if (x && y && z) {
    out.at = Three{*x, *y, *z};
    out.name = find(cells, {"name", "label", "id", "index", "point"});
  } else {
    out.id = find(cells, {"id", "index", "point"});
    out.name = find(cells, {"name", "label"});
  }
  if (!out.at && !out.id)
    throw text_error(path, line, 1, "columns x, y and z, or id, beside the targets", "neither of them");
  out.least = std::max({(*to)[0], (*to)[1], (*to)[2]}) + 1;
  if (out.at) out.least = std::max({out.least, *x + 1, *y + 1, *z + 1});
  if (out.id) out.least = std::max(out.least, *out.id + 1);
  return out;
}

Columns counted_columns(const std::string& path, std::int64_t line, std::size_t count) {
  switch (count) {
    case 4: return {std::nullopt, 0, std::nullopt, {1, 2, 3}, 4};
    case 6: return {std::nullopt, std::nullopt, Three{0, 1, 2}, {3, 4, 5}, 6};
    case 7: return {0, std::nullopt, Three{1, 2, 3}, {4, 5, 6}, 7};
    default: break;
  }
  throw text_error(path, line, 1,
                   "id, tx, ty, tz, or x, y, z, tx, ty, tz with or without a name before, or a row of names",
                   std::to_string(count) + " columns");
}

class Rows {
 public:
  explicit Rows(const std::string& path) : path_(path) {}

  void add(std::int64_t line, std::string_view text) {
    if (trimmed(text).empty() || trimmed(text).starts_with('#')) return;
    if (!separator_) separator_ = separator_of(text);
    const std::vector<Cell> cells = cells_of(text, *separator_);
    if (!columns_) {
      const bool names = targets_in(cells) || !is_number(cells.back());
      columns_ = names ? named_columns(path_, line, cells) : counted_columns(path_, line, cells.size());
      exact_ = !names;
      if (names) return;
    }
    if (cells.size() < columns_->least || (exact_ && cells.size() != columns_->least))
      throw text_error(path_, line, 1, std::to_string(columns_->least) + " columns", std::to_string(cells.size()));
    points.push_back(point_of(line, cells));
  }

  std::vector<ControlPoint> points;

 private:
  double number(std::int64_t line, const Cell& cell) const {
    double x = 0;
    if (!parse(cell.text, x) || !std::isfinite(x))
      throw text_error(path_, line, cell.column, "a finite number", sinew::quoted(cell.text));
    return x;
  }

  Vec3 place(std::int64_t line, const std::vector<Cell>& cells, const Three& columns) const {
    return {number(line, cells[columns[0]]), number(line, cells[columns[1]]), number(line, cells[columns[2]])};
  }

  ControlPoint point_of(std::int64_t line, const std::vector<Cell>& cells) const {
    ControlPoint out;
    out.to = place(line, cells, columns_->to);
    if (columns_->name && *columns_->name < cells.size()) out.name = cells[*columns_->name].text;
    if (columns_->at) {
      out.at = place(line, cells, *columns_->at);
      return out;
    }
    const Cell& cell = cells[*columns_->id];
    std::int64_t id = 0;
    if (!parse(cell.text, id) || id < 0 || id >= static_cast<std::int64_t>(~Index{0}))
      throw text_error(path_, line, cell.column, "the number of a point, from 0", sinew::quoted(cell.text));
    out.point = static_cast<Index>(id);
    return out;
  }

  std::string path_;
  std::optional<char> separator_;
  std::optional<Columns> columns_;
  bool exact_ = false;
};

}  // namespace

std::vector<ControlPoint> read_control_points(const std::string& path) {
  return read_control_points(path, load_bytes(path));
}

std::vector<ControlPoint> read_control_points(const std::string& path, std::span<const std::byte> bytes) {
  const std::string_view text = without_mark(as_text(bytes));
  TextCursor cursor(path, text);
  Rows rows(path);
  for (; !cursor.at_end(); cursor.next_line()) {
    const std::int64_t line = cursor.line();
    rows.add(line, cursor.rest());
  }
  if (rows.points.empty()) throw file_error(path, "at least one control point", "none");
  return std::move(rows.points);
}

bool is_control_points(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (!same_word(extension, ".csv")) return false;
  std::ifstream file(path, std::ios::binary);
  std::string text(1 << 16, '\0');  // longer than any row of names
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  TextCursor cursor(path, without_mark(text));
  for (; !cursor.at_end(); cursor.next_line()) {
    const std::string_view row = cursor.rest();
    if (trimmed(row).empty() || trimmed(row).starts_with('#')) continue;
    return targets_in(cells_of(row, separator_of(row))).has_value();
  }
  return false;
}

}  // namespace sinew::io
