#include "engine/io/marker_rows.h"

#include <algorithm>
#include <cmath>

#include "engine/io/text.h"
#include "engine/io/words.h"

namespace sinew::io {

std::vector<Cell> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  for (;;) {
    while (at < line.size() && line[at] == ' ') ++at;
    Cell cell{{}, static_cast<std::int64_t>(at) + 1};
    if (at < line.size() && line[at] == '"') {
      for (++at; at < line.size() && (line[at] != '"' || (at + 1 < line.size() && line[at + 1] == '"')); ++at) {
        cell.text += line[at];
        at += line[at] == '"' ? 1 : 0;
      }
      at = std::min(at + 1, line.size());
    }
    const std::size_t end = std::min(line.find(separator, at), line.size());
    cell.text += trimmed(line.substr(at, end - at));
    cells.push_back(std::move(cell));
    if (end == line.size()) return cells;
    at = end + 1;
  }
}

char separator_of(std::string_view line) {
  for (const char separator : {',', ';', '\t'})
    if (line.find(separator) != std::string_view::npos) return separator;
  return ',';
}

std::string_view without_mark(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

MarkerRows::MarkerRows(std::string path, std::size_t size, char separator, MarkerColumns columns)
    : path_(std::move(path)), size_(size), separator_(separator), columns_(std::move(columns)) {
  out_.names = columns_.names;
  for (const auto& xyz : columns_.places) width_ = std::max(width_, *std::max_element(xyz.begin(), xyz.end()) + 1);
  for (const auto& column : {columns_.frame, columns_.time}) width_ = std::max(width_, column ? *column + 1 : 0);
}

double MarkerRows::number(std::int64_t line, const Cell& cell, const std::string& what) const {
  double x = 0;
  if (!parse(cell.text, x)) throw text_error(path_, line, cell.column, what, quoted(cell.text));
  return x;
}

Vec3 MarkerRows::place(std::int64_t line, const std::vector<Cell>& cells, std::size_t marker) const {
  Vec3 p = not_seen;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t column = columns_.places[marker][c];
    if (column < cells.size() && !cells[column].text.empty())
      p[static_cast<int>(c)] =
          number(line, cells[column], std::string(1, "xyz"[c]) + " of " + quoted(columns_.names[marker]));
  }
  return seen(p) ? p : not_seen;
}

void MarkerRows::add(std::int64_t line, std::string_view text) {
  const std::vector<Cell> cells = cells_of(text, separator_);
  const auto filled = [](const Cell& c) { return !c.text.empty(); };
  if (std::none_of(cells.begin(), cells.end(), filled)) return;
  if (cells.size() > width_) {
    const auto more = std::find_if(cells.begin() + static_cast<std::ptrdiff_t>(width_), cells.end(), filled);
    if (more != cells.end())
      throw text_error(path_, line, more->column, "the end of the row after " + std::to_string(width_) + " columns",
                       quoted(more->text));
  }
  check_places(path_, out_.frames.size() + 1, columns_.names.size(), size_);
  short_rows_ += cells.size() < width_ ? 1 : 0;
  const auto number_at = [&](const std::optional<std::size_t>& column, const char* what) {
    const bool there = column && *column < cells.size() && filled(cells[*column]);
    return there ? number(line, cells[*column], what) : std::nan("");
  };
  if (columns_.frame) add_frame_number(number_at(columns_.frame, "the number of a frame"));
  if (columns_.time) times_.push_back(number_at(columns_.time, "a time"));
  std::vector<Vec3> frame(columns_.names.size());
  for (std::size_t m = 0; m < frame.size(); ++m) frame[m] = place(line, cells, m);
  out_.frames.push_back(std::move(frame));
}

void MarkerRows::add_frame_number(double number) {
  constexpr double largest = 1e9;
  if (!last_number_) {
    const bool good = std::abs(number) < largest && number == std::round(number);
    if (good) out_.first_frame = static_cast<int>(number);
    consecutive_ = good;
  } else if (number != *last_number_ + 1) {
    consecutive_ = false;
  }
  last_number_ = number;
}

Trajectories MarkerRows::finish() {
  if (out_.frames.empty()) throw file_error(path_, "at least one frame", "0");
  if (!consecutive_)
    out_.notes.push_back("Its frames are not numbered one after the other: rows are counted from " +
                         std::to_string(out_.first_frame) + ".");
  if (short_rows_ > 0)
    out_.notes.push_back("In " + std::to_string(short_rows_) + (short_rows_ == 1 ? " row" : " rows") +
                         " the last columns are missing.");
  if (times_.size() > 1) {
    // Times of three decimals at 250 frames a second are off by up to a quarter of a step.
    const double step = (times_.back() - times_.front()) / static_cast<double>(times_.size() - 1);
    bool even = step > 0 && std::isfinite(step);
    for (std::size_t i = 1; i < times_.size(); ++i)
      even = even && std::abs(times_[i] - times_[i - 1] - step) < 0.3 * step;
    out_.rate = even ? rate_of_step(step) : 0;
    if (!even) out_.notes.push_back("Its times are not evenly spaced: the rate is not known by them.");
  }
  return std::move(out_);
}

}  // namespace sinew::io
