#include "engine/io/bgeo.h"

#include "engine/io/bgeo_content.h"
#include "engine/io/bytes.h"
#include "engine/io/point_names.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

/// An attribute as a dictionary of the file describes it.
struct Definition {
  std::string name;
  std::size_t size = 0;  ///< values
  BgeoType type = BgeoType::Float;
  std::size_t texts = 0;  ///< of an index
};

class BgeoReader {
 public:
  BgeoReader(std::string path, std::vector<std::byte> bytes, const ReadOptions& options)
      : path_(std::move(path)),
        options_(options),
        content_(std::make_shared<BgeoContent>()),
        cursor_(path_, std::span<const std::byte>()) {
    content_->bytes = std::move(bytes);
    cursor_ = ByteCursor(path_, content_->bytes);
  }

  Shape read() {
    refuse_others();
    read_header();
    for (std::uint32_t a = 0; a < point_attributes_; ++a) add_attribute(read_definition("a point attribute"));
    cursor_.check_count(points_, content_->stride, "points");
    if (points_ >= no_row) throw file_error(path_, "fewer than 2^32 - 1 points", "more");
    content_->begin = cursor_.at();
    content_->points = points_;
    read_points(cursor_.take(points_ * content_->stride, "points"));
    read_primitives();
    note_others();
    content_->faces = shape_.faces.size();
    content_->corners = shape_.faces.points.size();
    shape_.content = std::move(content_);
    return std::move(shape_);
  }

 private:
  std::uint32_t number(const char* what) { return cursor_.number<std::uint32_t>(true, what); }
  InputError error(std::size_t at, const std::string& expected, const std::string& found) const {
    return byte_error(path_, static_cast<std::int64_t>(at), expected, found);
  }

  void refuse_others() const {
    const std::string_view text = as_text(content_->bytes);
    const std::string expected = "classic bgeo data that begins with \"BgeoV\"";
    if (text.empty()) throw file_error(path_, expected, "an empty file");
    if (text.starts_with("\x1f\x8b"))
      throw error(0, expected, "gzip-compressed data (unpack the file first, as with gunzip)");
    if (text.starts_with("\x7fNSJ") || text.front() == '[' || text.front() == '{')
      throw error(0, expected, "the JSON geometry of Houdini 12 and later (save it as classic bgeo)");
    if (text.starts_with("PGEOMETRY")) throw error(0, expected, "the ascii geometry of .geo files");
    if (!text.starts_with("BgeoV")) throw error(0, expected, quoted(text.substr(0, 5)));
  }

  void read_header() {
    cursor_.take(5, "the header");
    const std::uint32_t version = number("the version");
    if (version != bgeo_version) throw error(5, "version 5", std::to_string(version));
    points_ = number("the count of points");
    primitives_ = number("the count of primitives");
    point_groups_ = number("the count of point groups");
    primitive_groups_ = number("the count of primitive groups");
    point_attributes_ = number("the count of point attributes");
    vertex_attributes_ = number("the count of vertex attributes");
    primitive_attributes_ = number("the count of primitive attributes");
    detail_attributes_ = number("the count of detail attributes");
    // A dictionary's shortest entry: no name, one value.
    cursor_.check_count(point_attributes_, 12, "point attributes");
  }

  std::string read_text(const char* what) {
    const std::size_t size = cursor_.number<std::uint16_t>(true, what);
    return std::string(as_text(cursor_.take(size, what)));
  }

  Definition read_definition(const std::string& what) {
    Definition out;
    out.name = read_text("the name of an attribute");
    const std::size_t at = cursor_.at();
    out.size = cursor_.number<std::uint16_t>(true, "the size of an attribute");
    if (out.size == 0) throw error(at, "at least one value of " + what + " " + quoted(out.name), "0");
    // The upper half says how the values may be transformed.
    const std::uint32_t type = number("the type of an attribute") & 0xffff;
    out.type = static_cast<BgeoType>(type);
    switch (out.type) {
      case BgeoType::Float:
      case BgeoType::Int:
      case BgeoType::Vector: cursor_.take(4 * out.size, "the default of an attribute"); return out;
      case BgeoType::Index: break;
      default:
        throw error(at + 2, "a type of 0, 1, 4 or 5 (float, int, index, vector) of " + what + " " + quoted(out.name),
                    std::to_string(type));
    }
    const std::uint32_t texts = number("the count of texts");
    cursor_.check_count(texts, 2, "texts");
    for (std::uint32_t i = 0; i < texts; ++i) read_text("a text");
    out.texts = texts;
    return out;
  }

  void add_attribute(const Definition& definition) {
    const bool is_float = definition.type == BgeoType::Float || definition.type == BgeoType::Vector;
    Kind kind = definition.type == BgeoType::Index ? Kind::Id : Kind::Scalar;
    // A rest position must not follow, whatever type it has.
    if (definition.type == BgeoType::Vector && definition.size == 3 && definition.name != "rest") kind = Kind::Vector;
    Attribute attribute = named_attribute(definition.name, static_cast<int>(definition.size), kind, unique_);
    attribute.type = is_float ? Type::Float32 : Type::Int32;
    content_->columns.push_back({attribute.name, attribute.type, attribute.components, content_->stride});
    content_->stride += 4 * definition.size;
    if (definition.texts > 0)
      shape_.notes.push_back("Kept in the bgeo file only: " + counted(definition.texts, "text", "texts") +
                             " of the attribute " + quoted(attribute.name) + ".");
    shape_.attributes.push_back(std::move(attribute));
  }

  void read_points(std::span<const std::byte> rows) {
    const std::size_t stride = content_->stride;
    shape_.position_type = Type::Float32;
    shape_.positions.resize(points_);
    for (std::size_t i = 0; i < points_; ++i) {
      if (i % 65536 == 0) report_progress(options_, i, points_);
      for (std::size_t c = 0; c < 3; ++c)
        shape_.positions[i][static_cast<Eigen::Index>(c)] = load<float>(&rows[i * stride + 4 * c], bgeo_swap);
    }
    for (std::size_t a = 0; a < shape_.attributes.size(); ++a) {
      Attribute& attribute = shape_.attributes[a];
      attribute.values.resize(points_ * attribute.row_size());
      std::byte* to = attribute.values.data();
      for (std::size_t i = 0; i < points_; ++i)
        for (std::size_t k = 0; k < attribute.row_size(); k += 4, to += 4)
          store(to, load<std::uint32_t>(&rows[i * stride + content_->columns[a].offset + k], bgeo_swap), false);
    }
  }

  std::size_t read_dictionary(std::uint32_t count, const char* what) {
    cursor_.check_count(count, 12, std::string(what) + "s");
    std::size_t size = 0;
    for (std::uint32_t a = 0; a < count; ++a) size += 4 * read_definition(std::string("a ") + what).size;
    return size;
  }

  void read_primitives() {
    if (primitives_ == 0) return;
    const std::size_t vertex_size = read_dictionary(vertex_attributes_, "vertex attribute");
    const std::size_t primitive_size = read_dictionary(primitive_attributes_, "primitive attribute");
    const std::size_t index_size = points_ > bgeo_short_points ? 4 : 2;
    for (std::uint32_t done = 0; done < primitives_;) {
      std::uint32_t type = number("the type of a primitive"), count = 1;
      if (type == bgeo_run) {
        count = cursor_.number<std::uint16_t>(true, "the length of a run of primitives");
        type = number("the type of a run of primitives");
        if (count == 0 || count > primitives_ - done)
          throw error(cursor_.at() - 6, "a run of 1 to " + std::to_string(primitives_ - done) + " primitives",
                      std::to_string(count));
      }
      if (type != bgeo_polygon && type != bgeo_particles) {
        others_ += primitives_ - done;
        return;
      }
      for (std::uint32_t i = 0; i < count; ++i, ++done)
        read_primitive(type == bgeo_polygon, index_size, vertex_size, primitive_size);
    }
  }

  void read_primitive(bool polygon, std::size_t index_size, std::size_t vertex_size, std::size_t primitive_size) {
    const std::uint32_t corners = number("the count of a primitive's points");
    bool closed = false;
    if (polygon) {
      const std::size_t at = cursor_.at();
      const auto sign = cursor_.number<char>(true, "the sign of a closed or open polygon");
      if (sign != '<' && sign != ':')
        throw error(at, "\"<\" or \":\" (a closed or an open polygon)", quoted(std::string(1, sign)));
      closed = sign == '<';
    }
    cursor_.check_count(corners, index_size + vertex_size, "points of a primitive");
    corners_.clear();
    for (std::uint32_t c = 0; c < corners; ++c) {
      const std::size_t at = cursor_.at();
      const std::uint32_t index = index_size == 2 ? cursor_.number<std::uint16_t>(true, "a point of a primitive")
                                                  : number("a point of a primitive");
      if (index >= points_)
        throw error(at, "the number from 0 of one of " + std::to_string(points_) + " points", std::to_string(index));
      corners_.push_back(index);
      cursor_.take(vertex_size, "attributes of a vertex");
    }
    cursor_.take(primitive_size, "attributes of a primitive");
    if (closed && corners >= 3) {
      if (corners_.size() >= no_row - shape_.faces.points.size())
        throw file_error(path_, "fewer than 2^32 corners of faces", "more");
      shape_.faces.add(corners_);
    } else if (polygon) {
      ++others_;
    }
  }

  void note_others() {
    const auto kept = [&](std::size_t count, const char* singular, const char* plural) {
      if (count > 0) shape_.notes.push_back("Kept in the bgeo file only: " + counted(count, singular, plural) + ".");
    };
    kept(others_, "primitive that is not a closed polygon", "primitives that are no closed polygons");
    kept(vertex_attributes_, "attribute of vertices", "attributes of vertices");
    kept(primitive_attributes_, "attribute of primitives", "attributes of primitives");
    kept(detail_attributes_, "attribute of the whole", "attributes of the whole");
    kept(std::size_t{point_groups_} + primitive_groups_, "group", "groups");
  }

  std::string path_;
  const ReadOptions& options_;
  std::shared_ptr<BgeoContent> content_;
  ByteCursor cursor_;
  Shape shape_;
  UniqueNames unique_;
  std::vector<Index> corners_;
  std::uint32_t points_ = 0, primitives_ = 0, point_groups_ = 0, primitive_groups_ = 0;
  std::uint32_t point_attributes_ = 0, vertex_attributes_ = 0, primitive_attributes_ = 0, detail_attributes_ = 0;
  std::size_t others_ = 0;  ///< primitives
};

}  // namespace

Shape read_bgeo(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  return BgeoReader(path, std::move(bytes), options).read();
}

}  // namespace sinew::io
