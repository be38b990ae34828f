#include "engine/io/marker_csv.h"

#include <algorithm>
#include <map>
#include <set>

#include "engine/io/bytes.h"
#include "engine/io/marker_rows.h"
#include "engine/io/text.h"
#include "engine/io/words.h"

namespace sinew::io {

namespace {

struct AxisOfMarker {
  std::string marker;
  std::size_t axis = 0;
};

std::optional<AxisOfMarker> axis_of(const std::string& name) {
  if (name.size() < 3) return std::nullopt;
  const std::size_t axis = std::string_view("xyzXYZ").find(name.back());
  const bool parted = std::string_view("._:").find(name[name.size() - 2]) != std::string_view::npos;
  if (axis == std::string_view::npos || !parted) return std::nullopt;
  return AxisOfMarker{name.substr(0, name.size() - 2), axis % 3};
}

bool names_frame(const std::string& cell) {
  return same_word(cell, "frame") || same_word(cell, "frame#");
}

bool names_time(const std::string& cell) {
  return same_word(cell, "time") || same_word(cell, "time (s)") || same_word(cell, "time_s") || same_word(cell, "t");
}

/// What the row of names says.
class HeaderRow {
 public:
  HeaderRow(const std::string& path, std::int64_t line, const std::vector<Cell>& cells) : path_(path), line_(line) {
    for (std::size_t i = 0; i < cells.size(); ++i) add(cells, i);
    check_whole(cells);
  }

  MarkerColumns columns;
  std::vector<std::string> others;

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  void add(const std::vector<Cell>& cells, std::size_t i) {
    const std::string& text = cells[i].text;
    if (const auto axis = axis_of(text); axis) {
      const auto [at, fresh] = markers_.try_emplace(axis->marker, columns.names.size());
      if (fresh) {
        columns.names.push_back(axis->marker);
        columns.places.push_back({none, none, none});
      }
      take(columns.places[at->second][axis->axis], cells[i], i);
    } else if (names_frame(text)) {
      take_optional(columns.frame, cells[i], i);
    } else if (names_time(text)) {
      take_optional(columns.time, cells[i], i);
    } else if (!text.empty()) {
      others.push_back(text);
    }
  }

  void take(std::size_t& column, const Cell& cell, std::size_t i) {
    if (column != none) throw text_error(path_, line_, cell.column, "each column once", quoted(cell.text) + " again");
    column = i;
  }
  void take_optional(std::optional<std::size_t>& column, const Cell& cell, std::size_t i) {
    std::size_t taken = column.value_or(none);
    take(taken, cell, i);
    column = taken;
  }

  void check_whole(const std::vector<Cell>& cells) {
    if (columns.names.empty())
      throw text_error(path_, line_, 1, "names of columns as NAME.x, NAME.y and NAME.z", quoted(cells.front().text));
    for (std::size_t m = 0; m < columns.names.size(); ++m)
      for (std::size_t c = 0; c < 3; ++c)
        if (columns.places[m][c] == none)
          throw text_error(path_, line_, 0, std::string("x, y and z of ") + quoted(columns.names[m]),
                           std::string("no ") + "xyz"[c]);
  }

  std::string path_;
  std::int64_t line_;
  std::map<std::string, std::size_t> markers_;
};

std::string in_quotes(const std::string& text) {
  if (text.find_first_of(",;\t\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' || c == '\r' ? ' ' : c);
  return out + "\"";
}

/// Names as columns can have them: each once.
std::vector<std::string> column_names(const std::vector<std::string>& names, WriteReport& report) {
  std::set<std::string> taken(names.begin(), names.end()), used;
  std::map<std::string, std::size_t> copies;
  std::vector<std::string> out;
  std::size_t changed = 0;
  for (const std::string& name : names) {
    std::string free = trimmed(name).empty() ? "*" + std::to_string(out.size() + 1) : std::string(trimmed(name));
    if (used.contains(free)) {
      const std::string base = free;
      std::size_t& copy = copies[base];
      while (taken.contains(free) || used.contains(free)) free = base + "#" + std::to_string(++copy + 1);
    }
    changed += free == name ? 0 : 1;
    used.insert(free);
    out.push_back(in_quotes(free));
  }
  if (changed > 0)
    report.lost.push_back("Names that stand twice or are empty: " + std::to_string(changed) + " changed.");
  return out;
}

}  // namespace

bool names_markers(std::string_view row) {
  row = without_mark(row);
  bool markers = false, frames = false;
  for (const Cell& cell : cells_of(row, separator_of(row))) {
    if (names_frame(cell.text) || names_time(cell.text))
      frames = true;
    else if (axis_of(cell.text))
      markers = true;
    else if (!cell.text.empty())
      return false;
  }
  return markers && frames;
}

Trajectories read_marker_csv(const std::string& path, std::span<const std::byte> bytes) {
  const std::string_view text = without_mark(as_text(bytes));
  TextCursor cursor(path, text);
  const std::string_view names = cursor.rest();
  const char separator = separator_of(names);
  HeaderRow header(path, 1, cells_of(names, separator));
  MarkerRows rows(path, text.size(), separator, std::move(header.columns));
  for (cursor.next_line(); !cursor.at_end(); cursor.next_line()) {
    const std::int64_t line = cursor.line();
    rows.add(line, cursor.rest());
  }
  Trajectories out = rows.finish();
  if (!header.others.empty()) {
    std::string all;
    for (std::size_t i = 0; i < std::min<std::size_t>(header.others.size(), 8); ++i)
      all += (i > 0 ? ", " : "") + quoted(header.others[i]);
    out.notes.push_back("Columns that are not read: " + all + (header.others.size() > 8 ? ", ..." : "") + ".");
  }
  return out;
}

std::vector<std::byte> write_marker_csv(const Trajectories& motion, WriteReport& report) {
  if (!motion.unit.empty()) report.lost.push_back("The unit of length, " + quoted(motion.unit) + ".");
  if (!motion.bones.empty()) report.lost.push_back("Bones, the rest and turns of joints.");
  if (motion.rate > 0 && motion.frames.size() < 2) report.lost.push_back("The rate, as there is one frame.");
  std::string text = motion.rate > 0 ? "frame,time" : "frame";
  for (const std::string& name : column_names(motion.names, report)) {
    // Quotes close behind the axis.
    const bool closed = name.ends_with('"');
    for (const char axis : {'x', 'y', 'z'})
      text += "," + name.substr(0, name.size() - (closed ? 1 : 0)) + "." + axis + (closed ? "\"" : "");
  }
  for (std::size_t f = 0; f < motion.frames.size(); ++f) {
    text += "\n" + std::to_string(motion.first_frame + static_cast<std::int64_t>(f));
    if (motion.rate > 0) text += "," + shortest(static_cast<double>(f) / motion.rate);
    for (const Vec3& p : motion.frames[f])
      for (int c = 0; c < 3; ++c) text += seen(p) ? "," + shortest(p[c]) : ",";
  }
  text += "\n";
  const auto all = std::as_bytes(std::span(text));
  return {all.begin(), all.end()};
}

}  // namespace sinew::io
