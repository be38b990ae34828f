#pragma once
/// Rows of cells of which three are the place of a marker: what TRC and CSV have in common.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/motion.h"

namespace sinew::io {

struct Cell {
  std::string text;         ///< without blanks around it and without its quotes
  std::int64_t column = 1;  ///< from 1
};

/// The cells of a line. A cell in quotes may hold the separator, and a quote as two.
std::vector<Cell> cells_of(std::string_view line, char separator);

/// The first of comma, semicolon and tab that is in the line; a comma where none is.
char separator_of(std::string_view line);

/// Without the mark that spreadsheets put before UTF-8.
std::string_view without_mark(std::string_view text);

struct MarkerColumns {
  std::vector<std::string> names;
  std::vector<std::array<std::size_t, 3>> places;  ///< x, y, z of each marker, counted from 0
  std::optional<std::size_t> frame, time;
};

/// Takes row by row and gives the trajectories.
class MarkerRows {
 public:
  /// `size`: bytes of the file.
  MarkerRows(std::string path, std::size_t size, char separator, MarkerColumns columns);

  /// A cell that is empty, not there or "nan" means that the marker was not seen; an empty row is none. Throws
  /// InputError: what is no number, more cells than columns.
  void add(std::int64_t line, std::string_view text);

  /// Names, frames, the first frame's number by its column, the rate by that of times, and notes on what is odd about
  /// them. Throws InputError where there was no row.
  Trajectories finish();

 private:
  double number(std::int64_t line, const Cell& cell, const std::string& what) const;
  Vec3 place(std::int64_t line, const std::vector<Cell>& cells, std::size_t marker) const;
  void add_frame_number(double number);

  std::string path_;
  std::size_t size_;
  char separator_;
  MarkerColumns columns_;
  std::size_t width_ = 0;  ///< columns
  Trajectories out_;
  std::vector<double> times_;
  std::optional<double> last_number_;
  bool consecutive_ = true;
  std::size_t short_rows_ = 0;
};

}  // namespace sinew::io
