#include "engine/io/trc.h"

#include <algorithm>
#include <cmath>

#include "engine/io/bytes.h"
#include "engine/io/marker_rows.h"
#include "engine/io/text.h"
#include "engine/io/words.h"

namespace sinew::io {

namespace {

constexpr std::size_t first_marker = 2;  // column, after number and time

class TrcReader {
 public:
  TrcReader(const std::string& path, std::string_view text) : path_(path), size_(text.size()), cursor_(path, text) {}

  Trajectories read();

 private:
  /// The cells of the present line; then stands at the next. Throws InputError at the end of the file.
  std::vector<Cell> line(const std::string& what);
  std::optional<double> number(const char* key) const;
  const Cell* value(const char* key) const;
  std::vector<std::string> read_names();
  void read_column_names(std::vector<std::string>& names);
  void note_header(Trajectories& out) const;

  std::string path_;
  std::size_t size_;
  TextCursor cursor_;
  std::vector<Cell> keys_, values_;
  std::string axes_;
};

std::vector<Cell> TrcReader::line(const std::string& what) {
  if (cursor_.at_end()) throw text_error(path_, cursor_.line(), 1, what, "the end of the file");
  std::vector<Cell> cells = cells_of(cursor_.rest(), '\t');
  cursor_.next_line();
  return cells;
}

const Cell* TrcReader::value(const char* key) const {
  for (std::size_t i = 0; i < std::min(keys_.size(), values_.size()); ++i)
    if (same_word(keys_[i].text, key)) return &values_[i];
  return nullptr;
}

std::optional<double> TrcReader::number(const char* key) const {
  const Cell* cell = value(key);
  double x = 0;
  return cell != nullptr && parse(cell->text, x) ? std::optional(x) : std::nullopt;
}

/// A name stands over the first of its three columns.
std::vector<std::string> TrcReader::read_names() {
  const std::int64_t at = cursor_.line();
  const std::vector<Cell> cells = line("the names of markers");
  if (!same_word(cells[0].text.substr(0, 5), "Frame"))
    throw text_error(path_, at, cells[0].column, "\"Frame#\" and the names of markers", quoted(cells[0].text));
  std::vector<std::string> names;
  for (std::size_t i = first_marker; i < cells.size(); ++i) {
    if (cells[i].text.empty()) continue;
    if ((i - first_marker) % 3 != 0)
      throw text_error(path_, at, cells[i].column, "an empty cell, as each marker has three columns",
                       quoted(cells[i].text));
    names.resize((i - first_marker) / 3 + 1);
    names.back() = cells[i].text;
  }
  return names;
}

/// X1, Y1, Z1, ...: columns that have no marker's name above them are markers too.
void TrcReader::read_column_names(std::vector<std::string>& names) {
  const TextCursor before = cursor_;
  std::vector<Cell> cells = line("the names of columns");
  double number = 0;
  if (parse(cells[0].text, number)) {  // the row of names was left out, and this is a frame
    cursor_ = before;
    cells.clear();
  }
  const auto filled = [](const Cell& c) { return !c.text.empty(); };
  const auto width = static_cast<std::size_t>(cells.rend() - std::find_if(cells.rbegin(), cells.rend(), filled));
  if (width > first_marker) names.resize(std::max(names.size(), (width - first_marker + 2) / 3));
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i].empty()) names[i] = "*" + std::to_string(i + 1);
  if (names.empty()) throw file_error(path_, "at least one marker", "0");
}

void TrcReader::note_header(Trajectories& out) const {
  const auto compare = [&](const char* key, double there, const char* counts) {
    if (const auto said = number(key); said && *said != there)
      out.notes.push_back(std::string(key) + " is " + shortest(*said) + ": " + shortest(there) + counts);
  };
  compare("NumMarkers", static_cast<double>(out.names.size()), " have columns and are read.");
  compare("NumFrames", static_cast<double>(out.frames.size()), " have rows and are read.");
  compare("OrigDataStartFrame", out.first_frame, " is the number of the first row, and counts.");
  if (axes_ != "(X/Y/Z)") out.notes.push_back("Its axes are " + quoted(axes_) + ".");
}

Trajectories TrcReader::read() {
  const std::vector<Cell> kind = line("a TRC file (\"PathFileType\")");
  if (!same_word(kind[0].text, "PathFileType"))
    throw text_error(path_, 1, kind[0].column, "a TRC file (\"PathFileType\")", quoted(kind[0].text));
  axes_ = kind.size() > 2 ? kind[2].text : "";
  keys_ = line("the names of properties (DataRate, ...)");
  values_ = line("the values of properties");
  MarkerColumns columns;
  columns.names = read_names();
  read_column_names(columns.names);
  for (std::size_t m = 0; m < columns.names.size(); ++m) {
    const std::size_t x = first_marker + 3 * m;
    columns.places.push_back({x, x + 1, x + 2});
  }
  columns.frame = 0;
  columns.time = 1;
  MarkerRows rows(path_, size_, '\t', std::move(columns));
  for (; !cursor_.at_end(); cursor_.next_line()) {
    const std::int64_t at = cursor_.line();
    rows.add(at, cursor_.rest());
  }
  Trajectories out = rows.finish();
  if (const auto rate = number("DataRate"); rate && *rate > 0 && std::isfinite(*rate)) out.rate = *rate;
  if (const Cell* unit = value("Units")) out.unit = unit->text;
  note_header(out);
  return out;
}

}  // namespace

Trajectories read_trc(const std::string& path, std::span<const std::byte> bytes) {
  return TrcReader(path, as_text(bytes)).read();
}

}  // namespace sinew::io
