#include "engine/io/vtp.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "engine/io/bytes.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"
#include "engine/io/vtk_array.h"
#include "engine/io/xml_scanner.h"

namespace sinew::io {

namespace {

std::optional<Type> type_named(const std::string& name) {
  static constexpr const char* names[] = {"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                          "UInt32", "Int64", "UInt64", "Float32", "Float64"};
  for (int i = 0; i < 10; ++i)
    if (name == names[i]) return static_cast<Type>(i);
  return std::nullopt;
}

/// An element DataArray: its tag, the element that it stands in, and its text.
struct Source {
  XmlTag tag;
  std::string section;  ///< "Points", "PointData", "Polys", ...
  std::size_t text_begin = 0, text_end = 0;
  std::int64_t line = 1;  ///< of the tag's end
  std::string name() const { return tag.value("Name"); }
};

class VtpReader {
 public:
  VtpReader(std::string path, std::vector<std::byte> bytes, const ReadOptions& options)
      : path_(std::move(path)), options_(options), content_(std::make_shared<VtkContent>()), scanner_("", "") {
    content_->bytes = std::move(bytes);
    text_ = as_text(content_->bytes);
    scanner_ = XmlScanner(path_, text_);
  }

  Shape read() {
    if (text_.empty()) throw file_error(path_, "an XML file of VTK", "an empty file");
    scan();
    if (pieces_ == 0) throw file_error(path_, "an element Piece", "none");
    read_points();
    report_progress(options_, 1, 2);
    read_attributes();
    read_faces();
    refuse_overlap();
    keep_vtk(shape_, content_, others_, kept_arrays_);
    return std::move(shape_);
  }

 private:
  /// Collects the arrays; ends at the appended data, which need not be XML.
  void scan() {
    std::vector<XmlTag> open;
    for (;;) {
      const std::size_t behind = open.empty() ? 0 : last_end_;
      XmlTag tag = scanner_.next();
      if (!open.empty() && open.back().name == "DataArray") see_text(behind, tag.begin);
      if (tag.name.empty()) {
        if (open.empty() && file_seen_) return;
        throw scanner_.error(tag,
                             open.empty() ? "an element VTKFile" : "the end of the element " + quoted(open.back().name),
                             "the end of the file");
      }
      last_end_ = tag.end;
      if (tag.opens) {
        enter(tag, open);
        if (tag.name == "AppendedData") return;
        if (!tag.closes) open.push_back(std::move(tag));
      } else if (open.empty() || open.back().name != tag.name) {
        throw scanner_.error(
            tag, open.empty() ? "the end of the file" : "the end of the element " + quoted(open.back().name),
            quoted("</" + std::string(tag.name)));
      } else {
        open.pop_back();
      }
    }
  }

  void see_text(std::size_t begin, std::size_t end) {
    Source& source = sources_.back();
    const std::size_t first = text_.find_first_not_of(" \t\r\n\v\f", begin);
    if (source.text_end != 0 || first >= end) return;
    source.text_begin = begin;
    source.text_end = end;
    source.line += std::count(text_.begin() + static_cast<std::ptrdiff_t>(source.tag.begin),
                              text_.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
  }

  void enter(const XmlTag& tag, const std::vector<XmlTag>& open) {
    if (open.empty()) {
      enter_file(tag);
    } else if (open.back().name == "VTKFile" && tag.name == "AppendedData") {
      enter_appended(tag);
    } else if (tag.name == "Piece") {
      if (++pieces_ > 1) throw scanner_.error(tag, "one Piece", "another");
      piece_ = tag;
    } else if (tag.name == "PointData") {
      point_data_ = tag;
    } else if (tag.name == "DataArray") {
      if (open.back().name == "DataArray") throw scanner_.error(tag, "the end of a DataArray", "another in it");
      sources_.push_back({tag, std::string(open.back().name), 0, 0, tag.line});
    }
  }

  void enter_file(const XmlTag& tag) {
    if (tag.name != "VTKFile" || file_seen_) throw scanner_.error(tag, "one element VTKFile", quoted(tag.name));
    file_seen_ = true;
    const std::string type = tag.value("type");
    if (type != "PolyData" && type != "UnstructuredGrid")
      throw scanner_.error(tag, "a VTKFile of type PolyData or UnstructuredGrid", quoted(type));
    content_->form = type == "PolyData" ? VtkContent::Form::PolyData : VtkContent::Form::UnstructuredGrid;
    const std::string order = tag.value("byte_order", "LittleEndian"), header = tag.value("header_type", "UInt32");
    if (order != "LittleEndian" && order != "BigEndian")
      throw scanner_.error(tag, "a byte_order of LittleEndian or BigEndian", quoted(order));
    if (header != "UInt32" && header != "UInt64")
      throw scanner_.error(tag, "a header_type of UInt32 or UInt64", quoted(header));
    big_endian_ = order == "BigEndian";
    header_ = header == "UInt64" ? 8 : 4;
    compressor_ = tag.value("compressor");
  }

  void enter_appended(const XmlTag& tag) {
    const std::string encoding = tag.value("encoding", "base64");
    if (encoding != "raw" && encoding != "base64")
      throw scanner_.error(tag, "an encoding of raw or base64", quoted(encoding));
    appended_raw_ = encoding == "raw";
    appended_ = text_.find_first_not_of(" \t\r\n", tag.end);
    if (appended_ >= text_.size() || text_[appended_] != '_')
      throw scanner_.error(tag, "\"_\" in front of the appended data",
                           appended_ >= text_.size() ? "the end of the file" : quoted(text_.substr(appended_, 1)));
    ++appended_;
  }

  std::size_t number(const XmlTag& tag, const char* attribute, const char* otherwise) const {
    const std::string text = tag.value(attribute, otherwise);
    std::int64_t x = 0;
    if (!parse(text, x) || x < 0)
      throw scanner_.error(tag, "a whole number as " + std::string(attribute), text.empty() ? "none" : quoted(text));
    return static_cast<std::size_t>(x);
  }

  const Source* find(const std::string& section, const std::string& name) const {
    for (const Source& source : sources_)
      if (source.section == section && (name.empty() || source.name() == name)) return &source;
    return nullptr;
  }

  static std::string what(const Source& source) { return "the array " + quoted(source.name()); }

  /// The values of an array of `rows`; says in `array` where they lie.
  std::vector<std::byte> values(const Source& source, std::size_t rows, VtkArray& array) {
    const auto type = type_named(source.tag.value("type"));
    if (!type) throw scanner_.error(source.tag, "a type such as Float32", quoted(source.tag.value("type")));
    array.type = *type;
    array.rows = rows;
    array.components = number(source.tag, "NumberOfComponents", "1");
    if (array.components == 0 || array.components > 65536)
      throw scanner_.error(source.tag, "a NumberOfComponents of 1 to 65536", std::to_string(array.components));
    array.swap = big_endian_ != (std::endian::native == std::endian::big);
    const std::string format = source.tag.value("format", "ascii");
    if (format == "ascii") return text_values(source, array);
    if (!compressor_.empty())
      throw scanner_.error(source.tag, "data that are not compressed (writers can switch it off)", quoted(compressor_));
    if (format == "binary") return base64_values(source, array, source.text_begin, source.text_end);
    if (format != "appended") throw scanner_.error(source.tag, "a format of ascii, binary or appended", quoted(format));
    return appended_values(source, array);
  }

  std::vector<std::byte> text_values(const Source& source, VtkArray& array) {
    array.form = VtkArray::Form::Text;
    array.begin = source.text_begin;
    array.end = source.text_end;
    check_vtk_size(path_, array.begin, array, array.end - array.begin, what(source));
    const std::size_t line = array.begin == 0 ? 0 : text_.rfind('\n', array.begin - 1) + 1;
    TextCursor cursor(path_, text_.substr(0, array.end), line, source.line);
    cursor.seek(array.begin);
    std::vector<std::byte> out = vtk_text_values(cursor, array, what(source));
    const Token more = cursor.next();
    if (!more.text.empty())
      throw cursor.error(more, "the end of " + what(source) + " after " + counted(array.count(), "value", "values"));
    return out;
  }

  void check_length(const Source& source, const VtkArray& array, std::span<const std::byte> header, std::size_t at) {
    ByteCursor cursor(path_, header);
    const std::uint64_t length = header_ == 8 ? cursor.number<std::uint64_t>(big_endian_, "a length")
                                              : cursor.number<std::uint32_t>(big_endian_, "a length");
    if (length != array.size())
      throw byte_error(path_, static_cast<std::int64_t>(at),
                       "a length of " + what(source) + " of " + std::to_string(array.size()) + " bytes",
                       std::to_string(length));
  }

  std::vector<std::byte> base64_values(const Source& source, VtkArray& array, std::size_t begin, std::size_t end) {
    array.form = VtkArray::Form::Base64;
    array.header = header_;
    array.begin = begin;
    array.end = end;
    check_vtk_size(path_, begin, array, end - begin, what(source));
    check_length(source, array, decode_base64(path_, content_->bytes, begin, end, header_, what(source)), begin);
    decode_base64(path_, content_->bytes, begin, array.end, header_ + array.size(), what(source));
    return vtk_binary_values(path_, content_->bytes, array, what(source));
  }

  std::vector<std::byte> appended_values(const Source& source, VtkArray& array) {
    const std::size_t offset = number(source.tag, "offset", "");
    if (appended_ == 0) throw scanner_.error(source.tag, "an element AppendedData", "none");
    if (offset >= text_.size() - appended_)
      throw scanner_.error(source.tag,
                           "an offset within the " + std::to_string(text_.size() - appended_) +
                               " bytes from the appended data to the end of the file",
                           std::to_string(offset));
    const std::size_t begin = appended_ + offset;
    if (!appended_raw_) return base64_values(source, array, begin, std::min(text_.find('<', begin), text_.size()));
    array.form = VtkArray::Form::Bytes;
    array.begin = begin + header_;
    ByteCursor cursor(path_, content_->bytes, begin);
    check_length(source, array, cursor.take(header_, "the length of " + what(source)), begin);
    check_vtk_size(path_, array.begin, array, cursor.left(), what(source));
    array.end = array.begin + array.size();
    return vtk_binary_values(path_, content_->bytes, array, what(source));
  }

  void read_points() {
    const std::size_t n = number(piece_, "NumberOfPoints", "");
    if (n >= no_row) throw file_error(path_, "fewer than 2^32 - 1 points", "more");
    const Source* source = find("Points", "");
    if (source == nullptr) {
      if (n == 0) return;
      throw scanner_.error(piece_, "a DataArray of Points", "none");
    }
    const std::vector<std::byte> xyz = values(*source, n, content_->points);
    if (content_->points.components != 3)
      throw scanner_.error(source->tag, "points of 3 components", std::to_string(content_->points.components));
    set_vtk_points(shape_, content_->points.type, xyz);
    remember(content_->points);
  }

  void read_attributes() {
    for (const Source& source : sources_) {
      if (source.section != "PointData" || !type_named(source.tag.value("type"))) {
        if (source.section == "CellData" || source.section == "FieldData" || source.section == "PointData")
          ++kept_arrays_;
        continue;
      }
      VtkArray array;
      std::vector<std::byte> bytes = values(source, shape_.size(), array);
      remember(array);
      const std::string name = source.name().empty() ? "unnamed" : source.name();
      const auto is = [&](const char* role) {
        return point_data_.value(role) == source.name() && !source.name().empty();
      };
      Kind kind = is("GlobalIds") || is("PedigreeIds") ? Kind::Id : Kind::Scalar;
      if (array.components == 3 && is("Vectors")) kind = Kind::Vector;
      if (array.components == 3 && is("Normals")) kind = Kind::Normal;
      Attribute attribute = named_attribute(name, static_cast<int>(array.components), kind, unique_);
      add_vtk_attribute(shape_, *content_, array, std::move(attribute), std::move(bytes));
    }
  }

  /// The integers of an array of cells.
  std::vector<std::int64_t> integers(const std::string& section, const char* name, std::size_t rows) {
    const Source* source = find(section, name);
    if (source == nullptr) throw scanner_.error(piece_, "a DataArray " + quoted(name) + " of " + section, "none");
    VtkArray array;
    const std::vector<std::byte> bytes = values(*source, rows, array);
    if (array.components != 1 || !is_integer(array.type))
      throw scanner_.error(source->tag, "single integers in " + what(*source), quoted(source->tag.value("type")));
    remember(array);
    std::vector<std::int64_t> out;
    out.reserve(array.rows);
    with_type(array.type, [&](auto t) {
      for (std::size_t i = 0; i < bytes.size(); i += sizeof(t))
        out.push_back(static_cast<std::int64_t>(load<decltype(t)>(&bytes[i], false)));
      return 0;
    });
    return out;
  }

  void read_faces() {
    const bool grid = content_->form == VtkContent::Form::UnstructuredGrid;
    const std::string section = grid ? "Cells" : "Polys";
    const std::size_t cells = number(piece_, grid ? "NumberOfCells" : "NumberOfPolys", "0");
    others_ = grid ? 0 : number(piece_, "NumberOfLines", "0") + number(piece_, "NumberOfStrips", "0");
    if (cells == 0) return;
    const std::vector<std::int64_t> ends = integers(section, "offsets", cells);
    if (ends.front() < 0 || !std::is_sorted(ends.begin(), ends.end()))
      throw scanner_.error(find(section, "offsets")->tag, "offsets that ascend from 0", "others");
    const std::vector<std::int64_t> corners = integers(section, "connectivity", static_cast<std::size_t>(ends.back()));
    std::vector<std::int64_t> types;
    if (grid) types = integers(section, "types", cells);
    std::vector<Index> face;
    std::size_t k = 0;
    for (std::size_t f = 0; f < cells; ++f) {
      face.clear();
      for (; k < static_cast<std::size_t>(ends[f]); ++k) {
        if (corners[k] < 0 || static_cast<std::size_t>(corners[k]) >= shape_.size())
          throw scanner_.error(find(section, "connectivity")->tag,
                               "the numbers from 0 of some of " + std::to_string(shape_.size()) + " points",
                               std::to_string(corners[k]));
        face.push_back(static_cast<Index>(corners[k]));
      }
      if (grid && types[f] == vtk_tetra) {
        add_tet(face, f);
      } else {
        add_face(face, !grid || is_vtk_face(types[f]));
      }
    }
  }

  void add_tet(const std::vector<Index>& corners, std::size_t cell) {
    const std::string wrong = add_vtk_tet(shape_, corners);
    if (!wrong.empty())
      throw scanner_.error(find("Cells", "connectivity")->tag,
                           "four different points of the tet that is cell " + std::to_string(cell), wrong);
  }

  void add_face(const std::vector<Index>& face, bool polygon) {
    if (!polygon || face.size() < 3) {
      others_ += face.size() > 1 ? 1 : 0;
      return;
    }
    if (face.size() >= no_row - shape_.faces.points.size())
      throw file_error(path_, "fewer than 2^32 corners of faces", "more");
    shape_.faces.add(face);
  }

  void remember(const VtkArray& array) {
    extents_.emplace_back(array.begin - (array.form == VtkArray::Form::Bytes ? header_ : 0), array.end);
  }

  /// New values of one array must not change another.
  void refuse_overlap() {
    if (appended_ == 0) return;
    std::vector<std::size_t> begins;
    for (const Source& source : sources_)
      if (source.tag.value("format") == "appended") begins.push_back(appended_ + number(source.tag, "offset", ""));
    std::sort(begins.begin(), begins.end());
    for (const auto& [begin, end] : extents_) {
      const auto [same, next] = std::equal_range(begins.begin(), begins.end(), begin);
      if (next - same > 1 || (next != begins.end() && *next < end))
        throw byte_error(path_, static_cast<std::int64_t>(begin), "arrays that do not overlap",
                         "one that begins within another");
    }
  }

  std::string path_;
  const ReadOptions& options_;
  std::shared_ptr<VtkContent> content_;
  XmlScanner scanner_;
  std::string_view text_;
  Shape shape_;
  UniqueNames unique_;
  std::vector<Source> sources_;
  XmlTag piece_, point_data_;
  std::vector<std::pair<std::size_t, std::size_t>>
      extents_;  ///< bytes of the arrays that were read, with their lengths
  std::string compressor_;
  bool file_seen_ = false, big_endian_ = false, appended_raw_ = false;
  std::size_t header_ = 4;                   ///< bytes of a length
  std::size_t appended_ = 0, last_end_ = 0;  ///< byte behind '_'; behind the tag before
  std::size_t pieces_ = 0, others_ = 0, kept_arrays_ = 0;
};

}  // namespace

Shape read_vtp(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  return VtpReader(path, std::move(bytes), options).read();
}

}  // namespace sinew::io
