#include "engine/io/tetgen.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "engine/io/bytes.h"
#include "engine/io/solid_text.h"

namespace sinew::io {

namespace {

/// SolidContent::bytes are those of the .node.
struct TetgenContent : SolidContent {
  std::optional<std::vector<std::byte>> ele, face;
};

/// A number of the line that begins a file; `otherwise` where the line ends before it.
std::int64_t header_number(SolidReader& reader, const char* expected, std::int64_t otherwise) {
  const Token t = reader.cursor().token();
  if (t.text.empty() || t.text.front() == '#') {
    reader.cursor().seek(t.begin);
    return otherwise;
  }
  std::int64_t x = 0;
  if (!parse(t.text, x) || x < 0) throw reader.error(t, expected);
  return x;
}

/// The number that begins a row: rows count on from that of the first, so that one that is too short is found.
class RowNumbers {
 public:
  void read(SolidReader& reader, const SolidRow& row) {
    reader.progress(row.i);
    Token t;
    const std::int64_t number = reader.integer(t, "the number of a row");
    if (row.i == 0) first_ = number;
    const std::int64_t expected = first_ + static_cast<std::int64_t>(row.i);
    if (number != expected) throw reader.error(t, "the number " + std::to_string(expected) + " of " + row.text());
    if (row.i == 0 && first_ != 0 && first_ != 1) throw reader.error(t, "the number 0 or 1 of " + row.text());
  }
  std::int64_t first() const { return first_; }

 private:
  std::int64_t first_ = 1;
};

class TetgenReader {
 public:
  TetgenReader(TetgenFiles files, const ReadOptions& options)
      : files_(std::move(files)), options_(options), content_(std::make_shared<TetgenContent>()) {}

  Shape read() {
    read_points();
    if (files_.ele) read_tets();
    if (files_.face) read_faces();
    content_->bytes = std::move(files_.node.bytes);
    if (files_.ele) content_->ele = std::move(files_.ele->bytes);
    if (files_.face) content_->face = std::move(files_.face->bytes);
    keep_solid(shape_, content_);
    return std::move(shape_);
  }

 private:
  void read_points() {
    SolidReader reader(files_.node.name, files_.node.bytes, options_, '#');
    const std::size_t n = reader.count("points", 8);
    const Token place = reader.cursor().token();
    reader.cursor().seek(place.begin);
    if (header_number(reader, "the dimension 3", 3) != 3) throw reader.error(place, "the dimension 3");
    const auto columns = static_cast<std::size_t>(header_number(reader, "the count of attributes", 0));
    if (n > 0 && columns > files_.node.bytes.size() / n / 2)
      throw text_error(files_.node.name, place.line, 0, "a count of attributes that fits into the file",
                       std::to_string(columns));
    const bool marked = header_number(reader, "the count of boundary markers, 0 or 1", 0) != 0;
    std::vector<std::vector<double>> values(n > 0 ? columns : 0);
    std::vector<double> labels;
    std::vector<Precision> precisions(values.size());
    for (std::size_t i = 0; i < n; ++i) {
      const SolidRow row{"point", i, n};
      numbers_.read(reader, row);
      reader.point(row, shape_, *content_);
      for (std::size_t a = 0; a < values.size(); ++a) values[a].push_back(reader.number(row, precisions[a]));
      if (marked) labels.push_back(marker(reader, row));
      reader.cursor().next_line();
    }
    reader.finish_points(shape_);
    for (std::size_t a = 0; a < values.size(); ++a) {
      const std::string name = "attribute " + std::to_string(a + 1);
      shape_.attributes.push_back(number_attribute(name, {name}, Kind::Scalar, precisions[a].type(), values[a]));
    }
    if (marked && n > 0)
      shape_.attributes.push_back(number_attribute("label", {"label"}, Kind::Id, Type::Int32, labels));
  }

  static double marker(SolidReader& reader, const SolidRow& row) {
    const Token t = reader.next();
    std::int64_t x = 0;
    if (!parse(t.text, x) || x < std::numeric_limits<std::int32_t>::min() ||
        x > std::numeric_limits<std::int32_t>::max())
      throw reader.error(t, "the boundary marker (a whole number of 32 bits) of " + row.text());
    return static_cast<double>(x);
  }

  void read_tets() {
    SolidReader reader(files_.ele->name, files_.ele->bytes, options_, '#');
    const std::size_t n = reader.count("tets", 10);
    const Token place = reader.cursor().token();
    reader.cursor().seek(place.begin);
    const std::int64_t corners = header_number(reader, "4 or 10 points a tet", 4);
    if (corners != 4 && corners != 10) throw reader.error(place, "4 or 10 points a tet");
    const bool regions = header_number(reader, "the count of attributes", 0) != 0;
    reader.cursor().next_line();
    RowNumbers numbers;
    for (std::size_t i = 0; i < n; ++i) {
      const SolidRow row{"tet", i, n};
      numbers.read(reader, row);
      reader.tet(row, shape_, numbers_.first());
      Token middle;
      for (std::int64_t c = 4; c < corners; ++c) reader.corner(row, shape_.size(), numbers_.first(), middle);
      reader.cursor().next_line();
    }
    if (corners == 10) shape_.notes.push_back("Kept in the .ele file only: the points in the middle of edges.");
    if (regions) shape_.notes.push_back("Kept in the .ele file only: attributes of tets.");
  }

  void read_faces() {
    SolidReader reader(files_.face->name, files_.face->bytes, options_, '#');
    const std::size_t n = reader.count("faces", 8);
    const bool markers = header_number(reader, "the count of boundary markers, 0 or 1", 0) != 0;
    reader.cursor().next_line();
    RowNumbers numbers;
    for (std::size_t i = 0; i < n; ++i) {
      const SolidRow row{"face", i, n};
      numbers.read(reader, row);
      reader.face(row, shape_, 3, numbers_.first());
      reader.cursor().next_line();
    }
    if (markers) shape_.notes.push_back("Kept in the .face file only: boundary markers of faces.");
  }

  TetgenFiles files_;
  const ReadOptions& options_;
  std::shared_ptr<TetgenContent> content_;
  Shape shape_;
  RowNumbers numbers_;  ///< of the points
};

std::string with_extension(const std::string& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension).string();
}

std::optional<NamedBytes> load_beside(const std::string& path, const char* extension) {
  const std::string name = with_extension(path, extension);
  std::error_code none;
  if (!std::filesystem::exists(name, none)) return std::nullopt;
  std::vector<std::byte> bytes = load_bytes(name);
  refuse_lfs_pointer(name, bytes, "TetGen");
  return NamedBytes{name, std::move(bytes)};
}

const TetgenContent* content_of(const Shape& shape) {
  const auto* content = dynamic_cast<const TetgenContent*>(shape.content.get());
  return content && fits_solid(shape, *content) ? content : nullptr;
}

/// The attributes that a new .node holds as numbers of its points.
std::vector<const Attribute*> columns_of(const Shape& shape) {
  std::vector<const Attribute*> out;
  const Attribute* label = label_of(shape);
  for (const Attribute& attribute : shape.attributes)
    if (attribute.per_point() && &attribute != label) out.push_back(&attribute);
  return out;
}

void report_losses(const Shape& shape, WriteReport& report) {
  std::vector<std::string> held;
  if (const TetgenContent* content = content_of(shape)) {
    report_lost_attributes("TetGen", shape, content->attributes, report);
    return;
  }
  if (dynamic_cast<const TetgenContent*>(shape.content.get())) report_lost_rest("TetGen", report);
  if (label_of(shape)) held.push_back("label");
  int column = 1;
  for (const Attribute* attribute : columns_of(shape)) {
    held.push_back(attribute->name);
    const int first = column;
    column += attribute->components;
    const std::string now = "attribute " + std::to_string(first);
    if (attribute->name == now && attribute->components == 1) continue;
    report.lost.push_back("TetGen cannot hold the name of the attribute " + sinew::quoted(attribute->name) +
                          ": it is " + now +
                          (attribute->components == 1 ? "." : " to " + std::to_string(column - 1) + "."));
  }
  report_lost_attributes("TetGen", shape, held, report);
  small_faces("TetGen", shape, 3, report);
}

std::vector<std::byte> node_bytes(const Shape& shape) {
  if (const TetgenContent* content = content_of(shape)) return patched_solid(shape, *content, '#');
  const std::vector<const Attribute*> columns = columns_of(shape);
  const Attribute* label = label_of(shape);
  int count = 0;
  for (const Attribute* attribute : columns) count += attribute->components;
  std::vector<std::byte> out;
  append_text(out, std::to_string(shape.size()) + " 3 " + std::to_string(count) + (label ? " 1\n" : " 0\n"));
  for (std::size_t i = 0; i < shape.size(); ++i) {
    append_text(out, std::to_string(i + 1) + " ");
    append_point(out, shape, i);
    for (const Attribute* attribute : columns)
      for (int c = 0; c < attribute->components; ++c)
        append_text(out, " " + value_text(attribute->type, attribute->values.data() + i * attribute->row_size() +
                                                               static_cast<std::size_t>(c) * size_of(attribute->type)));
    if (label) append_text(out, " " + value_text(label->type, label->values.data() + i * label->row_size()));
    append_text(out, "\n");
  }
  return out;
}

std::vector<std::byte> ele_bytes(const Shape& shape) {
  if (const TetgenContent* content = content_of(shape); content && content->ele) return *content->ele;
  std::vector<std::byte> out;
  append_text(out, std::to_string(shape.tets.size()) + " 4 0\n");
  for (std::size_t i = 0; i < shape.tets.size(); ++i) {
    append_text(out, std::to_string(i + 1));
    append_corners(out, shape.tets[i], 1);
    append_text(out, "\n");
  }
  return out;
}

std::optional<std::vector<std::byte>> face_bytes(const Shape& shape) {
  if (const TetgenContent* content = content_of(shape)) return content->face;
  WriteReport told_already;
  const Faces faces = small_faces("TetGen", shape, 3, told_already);
  if (faces.empty()) return std::nullopt;
  std::vector<std::byte> out;
  append_text(out, std::to_string(faces.size()) + " 0\n");
  for (std::size_t i = 0; i < faces.size(); ++i) {
    append_text(out, std::to_string(i + 1));
    append_corners(out, faces[i], 1);
    append_text(out, "\n");
  }
  return out;
}

void add_face_file(const std::string& path, const Shape& shape, std::vector<NamedBytes>& files) {
  if (auto bytes = face_bytes(shape)) files.push_back({with_extension(path, ".face"), std::move(*bytes)});
}

}  // namespace

Shape read_tetgen(TetgenFiles files, const ReadOptions& options) {
  return TetgenReader(std::move(files), options).read();
}

Shape read_node(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  return read_tetgen({{path, std::move(bytes)}, load_beside(path, ".ele"), load_beside(path, ".face")}, options);
}

Shape read_ele(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  std::optional<NamedBytes> node = load_beside(path, ".node");
  if (!node) throw file_error(with_extension(path, ".node"), "the points of " + path, "no such file");
  return read_tetgen({std::move(*node), NamedBytes{path, std::move(bytes)}, load_beside(path, ".face")}, options);
}

std::vector<std::byte> write_node(const std::string&, const Shape& shape, WriteReport& report) {
  report_losses(shape, report);
  return node_bytes(shape);
}

std::vector<std::byte> write_ele(const std::string&, const Shape& shape, WriteReport& report) {
  report_losses(shape, report);
  return ele_bytes(shape);
}

std::vector<NamedBytes> beside_node(const std::string& path, const Shape& shape) {
  std::vector<NamedBytes> files;
  const TetgenContent* content = content_of(shape);
  if (!shape.tets.empty() || (content && content->ele))
    files.push_back({with_extension(path, ".ele"), ele_bytes(shape)});
  add_face_file(path, shape, files);
  return files;
}

std::vector<NamedBytes> beside_ele(const std::string& path, const Shape& shape) {
  std::vector<NamedBytes> files;
  files.push_back({with_extension(path, ".node"), node_bytes(shape)});
  add_face_file(path, shape, files);
  return files;
}

}  // namespace sinew::io
