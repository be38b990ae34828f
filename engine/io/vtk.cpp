#include "engine/io/vtk.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>

#include "engine/io/bytes.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"
#include "engine/io/vtk_array.h"

namespace sinew::io {

namespace {

constexpr bool swap_big = std::endian::native != std::endian::big;

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Names have their special characters as %20.
std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const auto [end, error] =
        std::from_chars(text.data() + i + 1, text.data() + std::min(i + 3, text.size()), byte, 16);
    const bool code = text[i] == '%' && error == std::errc{} && end == text.data() + i + 3;
    out += code ? static_cast<char>(byte) : text[i];
    if (code) i += 2;
  }
  return out;
}

std::optional<Type> type_named(std::string_view name) {
  const std::string key = lower(name);
  static const std::vector<std::pair<const char*, Type>> names{
      {"char", Type::Int8},
      {"signed_char", Type::Int8},
      {"unsigned_char", Type::UInt8},
      {"short", Type::Int16},
      {"unsigned_short", Type::UInt16},
      {"int", Type::Int32},
      {"unsigned_int", Type::UInt32},
      {"long", Type::Int64},
      {"unsigned_long", Type::UInt64},
      {"long_long", Type::Int64},
      {"unsigned_long_long", Type::UInt64},
      {"vtktypeint64", Type::Int64},
      {"vtktypeuint64", Type::UInt64},
      {"vtkidtype", Type::Int32},
      {"float", Type::Float32},
      {"double", Type::Float64},
  };
  for (const auto& [known, type] : names)
    if (key == known) return type;
  return std::nullopt;
}

class VtkReader {
 public:
  VtkReader(std::string path, std::vector<std::byte> bytes, const ReadOptions& options)
      : path_(std::move(path)), options_(options), content_(std::make_shared<VtkContent>()), cursor_("", "") {
    content_->bytes = std::move(bytes);
    text_ = as_text(content_->bytes);
    cursor_ = TextCursor(path_, text_);
  }

  Shape read() {
    read_header();
    for (Token t = cursor_.next(); !t.text.empty(); t = cursor_.next()) {
      report_progress(options_, cursor_.at(), text_.size());
      read_section(t);
    }
    if (!has_points_) throw error(cursor_.next(), "a section POINTS");
    for (std::size_t i = 0; i < cells_.cells; ++i) others_ += cells_.size(i) > 1 ? 1 : 0;
    keep_vtk(shape_, content_, others_, kept_arrays_);
    return std::move(shape_);
  }

 private:
  enum class Section { Dataset, Points, Cells };

  /// A place in a binary file is a byte, lines mean nothing there.
  InputError error(const Token& t, const std::string& expected) const {
    const std::string found = t.text.empty() ? "the end of the file" : quoted(t.text);
    if (binary_) return byte_error(path_, static_cast<std::int64_t>(t.begin), expected, found);
    return text_error(path_, t.line, t.column, expected, found);
  }

  std::size_t left() const { return text_.size() - cursor_.at(); }

  void read_header() {
    const std::string expected = "a first line that begins with \"# vtk DataFile Version\"";
    if (text_.empty()) throw file_error(path_, expected, "an empty file");
    const std::string_view first = cursor_.rest();
    if (!lower(first).starts_with("# vtk datafile version")) throw text_error(path_, 1, 0, expected, quoted(first));
    cursor_.next_line();
    cursor_.rest();  // the title
    cursor_.next_line();
    const Token form = cursor_.next();
    binary_ = lower(form.text) == "binary";
    if (!binary_ && lower(form.text) != "ascii") throw cursor_.error(form, "ASCII or BINARY");
    if (!binary_) text_begin(path_, content_->bytes);
    const Token dataset = next_keyword();
    if (lower(dataset.text) != "dataset") throw error(dataset, "DATASET");
    const Token kind = cursor_.token();
    polydata_ = lower(kind.text) == "polydata";
    if (!polydata_ && lower(kind.text) != "unstructured_grid")
      throw error(kind, "a DATASET of POLYDATA or UNSTRUCTURED_GRID");
  }

  /// The first keyword behind data of the whole.
  Token next_keyword() {
    for (;;) {
      Token t = cursor_.next();
      if (lower(t.text) == "metadata") {
        skip_metadata();
      } else if (lower(t.text) == "field") {
        read_field(Section::Dataset);
      } else {
        return t;
      }
    }
  }

  void read_section(const Token& t) {
    const std::string key = lower(t.text);
    if (key == "points") {
      read_points(t);
    } else if (key == "polygons" && polydata_) {
      read_polygons();
    } else if (key == "vertices" || key == "lines" || key == "triangle_strips") {
      const Cells cells = read_cells();
      for (std::size_t i = 0; i < cells.cells; ++i) others_ += cells.size(i) > 1 ? 1 : 0;
    } else if (key == "cells" && !polydata_) {
      if (cells_.cells > 0) throw error(t, "one section CELLS");
      cells_ = read_cells();
    } else if (key == "cell_types" && !polydata_) {
      read_cell_types();
    } else if (key == "point_data") {
      section_ = Section::Points;
      const Token count = peek();
      rows_ = integer("the count of points with data");
      if (!has_points_ || rows_ != shape_.size())
        throw error(count, "data of the " + std::to_string(shape_.size()) + " points");
    } else if (key == "cell_data") {
      section_ = Section::Cells;
      rows_ = integer("the count of cells with data");
    } else if (key == "metadata") {
      skip_metadata();
    } else if (key == "field") {
      read_field(section_);
    } else if (section_ != Section::Dataset) {
      read_data(key, t);
    } else {
      throw error(t, "a keyword such as POINTS, POLYGONS or POINT_DATA");
    }
  }

  Token peek() const {
    TextCursor ahead = cursor_;
    return ahead.next();
  }

  std::size_t integer(const char* what) {
    const Token t = cursor_.next();
    std::int64_t x = 0;
    if (!parse(t.text, x) || x < 0) throw error(t, what);
    return static_cast<std::size_t>(x);
  }

  Type type(const char* of) {
    const Token t = cursor_.next();
    const auto found = type_named(t.text);
    if (!found) throw error(t, std::string("a type of ") + of + " such as float");
    return *found;
  }

  /// Values that come next; in a binary file they begin behind the line.
  std::vector<std::byte> read_values(VtkArray& array, const std::string& what) {
    array.form = binary_ ? VtkArray::Form::Bytes : VtkArray::Form::Text;
    array.swap = swap_big;
    if (binary_) {
      cursor_.rest();
      cursor_.next_line();
    }
    array.begin = cursor_.at();
    check_vtk_size(path_, array.begin, array, left(), what);
    std::vector<std::byte> values;
    if (binary_) {
      values = vtk_binary_values(path_, content_->bytes, array, what);
      cursor_.seek(array.begin + array.size());
    } else {
      values = vtk_text_values(cursor_, array, what);
    }
    array.end = cursor_.at();
    return values;
  }

  std::vector<std::byte> read_values(std::size_t rows, std::size_t components, Type type, const std::string& what) {
    VtkArray array;
    array.rows = rows;
    array.components = components;
    array.type = type;
    return read_values(array, what);
  }

  void skip(std::size_t rows, std::size_t components, Type type, const std::string& what) {
    if (rows > 0 && components > 0) read_values(rows, components, type, what);
  }

  void read_points(const Token& keyword) {
    if (has_points_) throw error(keyword, "one section POINTS");
    has_points_ = true;
    content_->points.rows = integer("the count of points");
    if (content_->points.rows >= no_row) throw file_error(path_, "fewer than 2^32 - 1 points", "more");
    content_->points.components = 3;
    content_->points.type = type("points");
    set_vtk_points(shape_, content_->points.type, read_values(content_->points, "points"));
  }

  struct Cells {
    std::size_t cells = 0;
    std::vector<std::int64_t> corners, offsets;  ///< cell i has corners [offsets[i], offsets[i + 1])
    std::size_t size(std::size_t i) const { return static_cast<std::size_t>(offsets[i + 1] - offsets[i]); }
  };

  static std::vector<std::int64_t> integers(Type type, const std::vector<std::byte>& values) {
    std::vector<std::int64_t> out;
    out.reserve(values.size() / size_of(type));
    with_type(type, [&](auto t) {
      for (std::size_t i = 0; i < values.size(); i += sizeof(t))
        out.push_back(static_cast<std::int64_t>(load<decltype(t)>(&values[i], false)));
      return 0;
    });
    return out;
  }

  Cells read_cells() {
    const Token count_token = peek();
    const std::size_t count = integer("the count of cells"), size = integer("the count of numbers of cells");
    Cells out;
    if (lower(peek().text) == "offsets") return read_cells_5(count, size);
    out.cells = count;
    const std::vector<std::int64_t> numbers =
        integers(Type::Int32, read_values(size, 1, Type::Int32, "numbers of cells"));
    out.offsets.push_back(0);
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (at >= numbers.size() || numbers[at] < 0 || static_cast<std::size_t>(numbers[at]) > numbers.size() - at - 1)
        throw error(count_token, "cells of " + std::to_string(size) + " numbers that are as many as they say");
      const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(at) + 1;
      out.corners.insert(out.corners.end(), begin, begin + static_cast<std::ptrdiff_t>(numbers[at]));
      out.offsets.push_back(static_cast<std::int64_t>(out.corners.size()));
      at += 1 + static_cast<std::size_t>(numbers[at]);
    }
    if (at != numbers.size())
      throw error(count_token, std::to_string(at) + " numbers of cells, not " + std::to_string(size) + ", behind");
    return out;
  }

  /// Since version 5: where each cell begins, and one more; then all corners.
  Cells read_cells_5(std::size_t offsets, std::size_t size) {
    Cells out;
    const Token t = cursor_.next();
    Type of = type("offsets");
    out.offsets = integers(of, read_values(offsets, 1, of, "offsets of cells"));
    const Token connectivity = cursor_.next();
    if (lower(connectivity.text) != "connectivity") throw error(connectivity, "CONNECTIVITY");
    of = type("corners");
    out.corners = integers(of, read_values(size, 1, of, "corners of cells"));
    if (out.offsets.empty()) out.offsets.push_back(0);
    out.cells = out.offsets.size() - 1;
    if (out.offsets.front() != 0 || !std::is_sorted(out.offsets.begin(), out.offsets.end()) ||
        static_cast<std::size_t>(out.offsets.back()) != out.corners.size())
      throw error(t, "offsets from 0 to " + std::to_string(size) + " behind");
    return out;
  }

  /// Corners of cell i; `place` is what a message about them points at.
  std::vector<Index> corners_of(const Cells& cells, std::size_t i, const Token& place, const char* what) const {
    std::vector<Index> corners;
    for (auto k = static_cast<std::size_t>(cells.offsets[i]); k < static_cast<std::size_t>(cells.offsets[i + 1]); ++k) {
      if (cells.corners[k] < 0 || static_cast<std::size_t>(cells.corners[k]) >= shape_.size())
        throw error(place, std::string(what) + " of the " + std::to_string(shape_.size()) + " points, not of point " +
                               std::to_string(cells.corners[k]) + ", behind");
      corners.push_back(static_cast<Index>(cells.corners[k]));
    }
    return corners;
  }

  void add_polygon(const std::vector<Index>& corners) {
    if (corners.size() < 3) {
      ++others_;
      return;
    }
    if (corners.size() >= no_row - shape_.faces.points.size())
      throw file_error(path_, "fewer than 2^32 corners of faces", "more");
    shape_.faces.add(corners);
  }

  void read_polygons() {
    const Token place = peek();
    const Cells cells = read_cells();
    for (std::size_t f = 0; f < cells.cells; ++f) add_polygon(corners_of(cells, f, place, "polygons"));
  }

  /// The types of the cells of a grid, which tell faces and tets from others.
  void read_cell_types() {
    const Token place = peek();
    const std::size_t count = integer("the count of types of cells");
    if (count != cells_.cells)
      throw error(place, "types of the " + std::to_string(cells_.cells) + " cells in front of them");
    if (count == 0) return;
    const std::vector<std::int64_t> types = integers(Type::Int32, read_values(count, 1, Type::Int32, "types of cells"));
    const Cells cells = std::move(cells_);
    cells_ = {};
    for (std::size_t i = 0; i < count; ++i) {
      if (is_vtk_face(types[i])) {
        add_polygon(corners_of(cells, i, place, "cells"));
      } else if (types[i] == vtk_tetra) {
        const std::string wrong = add_vtk_tet(shape_, corners_of(cells, i, place, "cells"));
        if (!wrong.empty())
          throw error(
              place, "tets of four different points, not of " + wrong + " as cell " + std::to_string(i) + ", in front");
      } else {
        others_ += cells.size(i) > 1 ? 1 : 0;
      }
    }
  }

  /// An array of the points becomes an attribute; of cells and of the whole it stays in the file.
  void read_array(const std::string& name, std::size_t components, Type type, Kind kind) {
    VtkArray array;
    array.rows = rows_;
    array.components = components;
    array.type = type;
    std::vector<std::byte> values = read_values(array, "the array " + quoted(name));
    if (section_ != Section::Points) {
      ++kept_arrays_;
      return;
    }
    Attribute attribute = named_attribute(name, static_cast<int>(components), kind, unique_);
    add_vtk_attribute(shape_, *content_, array, std::move(attribute), std::move(values));
  }

  void read_data(const std::string& key, const Token& t) {
    if (key == "lookup_table") {
      cursor_.token();
      skip(integer("the size of a lookup table"), 4, binary_ ? Type::UInt8 : Type::Float32, "a lookup table");
      return;
    }
    const std::string name = decoded(cursor_.token().text);
    if (key == "scalars") {
      read_scalars(name);
    } else if (key == "color_scalars") {
      read_array(name, components(), binary_ ? Type::UInt8 : Type::Float32, Kind::Color);
    } else if (key == "texture_coordinates") {
      const std::size_t size = components();
      read_array(name, size, type("coordinates"), Kind::Scalar);
    } else if (key == "vectors") {
      read_array(name, 3, type("vectors"), Kind::Vector);
    } else if (key == "normals") {
      read_array(name, 3, type("normals"), Kind::Normal);
    } else if (key == "tensors" || key == "tensors6") {
      read_array(name, key == "tensors" ? 9 : 6, type("tensors"), Kind::Scalar);
    } else if (key == "global_ids" || key == "pedigree_ids") {
      read_array(name, 1, type("ids"), Kind::Id);
    } else if (key == "edge_flags") {
      read_array(name, 1, type("flags"), Kind::Scalar);
    } else {
      throw error(t, "a keyword of data such as SCALARS, VECTORS or FIELD");
    }
  }

  std::size_t components() {
    const Token t = peek();
    const std::size_t count = integer("a count of values of 1 to 65536");
    if (count == 0 || count > 65536) throw error(t, "a count of values of 1 to 65536");
    return count;
  }

  void read_scalars(const std::string& name) {
    const Type of = type("scalars");
    std::size_t size = 1;
    if (!cursor_.at_line_end()) {
      TextCursor ahead = cursor_;
      if (!ahead.token().text.empty()) size = components();
    }
    if (lower(peek().text) == "lookup_table") {
      cursor_.next();
      cursor_.token();
    }
    read_array(name, size, of, Kind::Scalar);
  }

  void read_field(Section section) {
    cursor_.token();  // its name
    const std::size_t arrays = integer("the count of arrays");
    for (std::size_t a = 0; a < arrays; ++a) {
      Token name = cursor_.next();
      while (lower(name.text) == "metadata") {
        skip_metadata();
        name = cursor_.next();
      }
      if (name.text.empty()) throw error(name, "array " + std::to_string(a + 1) + " of " + std::to_string(arrays));
      if (name.text == "NULL_ARRAY") continue;
      const Token size_token = peek();
      const std::size_t size = integer("the count of values in a row"), rows = integer("the count of rows");
      const std::string of = lower(peek().text);
      if (of == "string" || of == "utf8_string" || of == "bit") {
        cursor_.next();
        skip_special(of == "bit", rows, size);
        continue;
      }
      const Type value_type = type("an array");
      if (section == Section::Points && rows == rows_ && size > 0) {
        if (size > 65536) throw error(size_token, "a count of values in a row of 1 to 65536");
        read_array(decoded(name.text), size, value_type, Kind::Scalar);
        continue;
      }
      skip(rows, size, value_type, "the array " + quoted(name.text));
      ++kept_arrays_;
    }
  }

  /// Texts (a line each; in binary files behind their length) and bits (eight in a byte) stay in the file.
  void skip_special(bool bits, std::size_t rows, std::size_t size) {
    ++kept_arrays_;
    const std::size_t most = 8 * (left() + 1);  // that the bytes left could hold
    if (size > 0 && rows > most / size)
      throw error(peek(), "an array of " + std::to_string(rows) + " rows that fits into the file");
    const std::size_t count = rows * size;
    if (!binary_) {
      cursor_.rest();
      for (std::size_t i = 0; i < count; ++i) {
        if (cursor_.at_end()) throw error(cursor_.next(), "value " + std::to_string(i + 1) + " of an array");
        if (bits) {
          cursor_.next();
        } else {
          cursor_.next_line();
        }
      }
      cursor_.rest();
      return;
    }
    cursor_.rest();
    cursor_.next_line();
    ByteCursor bytes(path_, content_->bytes, cursor_.at());
    if (bits) bytes.take((count + 7) / 8, "bits of an array");
    for (std::size_t i = 0; !bits && i < count; ++i) {
      // The first two bits tell how many bytes hold the length: 8, 4, 2 or 1.
      const auto first = std::to_integer<std::uint64_t>(bytes.take(1, "the length of a text")[0]);
      std::uint64_t length = first & 63;
      for (std::size_t more = (std::size_t{8} >> (first >> 6)) - 1; more > 0; --more)
        length = length << 8 | std::to_integer<std::uint64_t>(bytes.take(1, "the length of a text")[0]);
      bytes.take(static_cast<std::size_t>(length), "a text");
    }
    cursor_.seek(bytes.at());
  }

  /// To the empty line that ends it.
  void skip_metadata() {
    cursor_.rest();
    cursor_.next_line();
    while (!cursor_.at_end() && !cursor_.at_line_end()) {
      cursor_.rest();
      cursor_.next_line();
    }
  }

  std::string path_;
  const ReadOptions& options_;
  std::shared_ptr<VtkContent> content_;
  std::string_view text_;
  TextCursor cursor_;
  Shape shape_;
  UniqueNames unique_;
  Section section_ = Section::Dataset;
  bool binary_ = false, polydata_ = false, has_points_ = false;
  std::size_t rows_ = 0, others_ = 0, kept_arrays_ = 0;
  Cells cells_;  ///< of a grid, until their types are read
};

}  // namespace

Shape read_vtk(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  return VtkReader(path, std::move(bytes), options).read();
}

}  // namespace sinew::io
