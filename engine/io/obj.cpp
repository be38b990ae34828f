#include "engine/io/obj.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "engine/io/bytes.h"
#include "engine/io/text_patch.h"

namespace sinew::io {

namespace {

constexpr std::size_t most = std::numeric_limits<Index>::max() - 1;

struct ObjContent : FileContent {
  std::vector<std::byte> bytes;
  std::vector<std::size_t> points, normals;  ///< byte of the first number of each v, each vn
  std::size_t faces = 0, corners = 0;        ///< of the shape
  std::size_t colors = 0, color_size = 0;    ///< points with a colour, numbers of one
};

/// The next token of a line; a backslash at the end of a line continues it on the next one.
Token next_token(TextCursor& cursor) {
  for (;;) {
    Token t = cursor.token();
    if (!t.text.ends_with('\\') || !cursor.at_line_end()) return t;
    if (t.text.size() > 1) {
      t.text.remove_suffix(1);
      cursor.seek(t.begin + t.text.size());
      return t;
    }
    cursor.next_line();
  }
}

bool ends_line(const Token& t) {
  return t.text.empty() || t.text.front() == '#';
}

class ObjReader {
 public:
  ObjReader(std::string path, std::vector<std::byte> bytes, const ReadOptions& options)
      : path_(std::move(path)), options_(options), content_(std::make_shared<ObjContent>()), cursor_("", "") {
    content_->bytes = std::move(bytes);
    cursor_ = TextCursor(path_, as_text(content_->bytes), text_begin(path_, content_->bytes));
  }

  Shape read() {
    for (std::size_t lines = 0; !cursor_.at_end(); ++lines) {
      if (lines % 65536 == 0) report_progress(options_, cursor_.at(), content_->bytes.size());
      read_line();
    }
    finish();
    return std::move(shape_);
  }

 private:
  /// An index of a face that counts from the start and has no target yet, the largest of its sort.
  struct Forward {
    std::int64_t index = 0;
    Token token;
  };
  struct Sort {
    const char* name;
    std::size_t count = 0;
    Forward forward{};
  };

  void read_line() {
    const Token keyword = cursor_.token();
    if (ends_line(keyword)) return cursor_.next_line();
    if (keyword.text == "v") return read_point();
    if (keyword.text == "vn") return read_normal();
    if (keyword.text == "f") return read_face();
    if (keyword.text == "vt") {
      ++textures_.count;
    } else if (keyword.text == "l" || keyword.text == "p") {
      ++lines_;
    } else if (keyword.text == "usemtl") {
      ++materials_;
    } else if (keyword.text == "g" || keyword.text == "o" || keyword.text == "s") {
      ++groups_;
    } else if (keyword.text != "mtllib") {
      if (unknown_++ == 0) first_unknown_ = keyword;
    }
    while (!ends_line(next_token(cursor_))) {
    }
    cursor_.next_line();
  }

  double read_number(const Token& t, const char* what, Precision& precision) {
    double x = 0;
    if (ends_line(t) || !parse(t.text, x)) throw cursor_.error(t, std::string("a number (") + what + ")");
    precision.see(t.text, x);
    return x;
  }

  void read_point() {
    static constexpr std::array<const char*, 3> names = {"x of a point", "y of a point", "z of a point"};
    Vec3 p;
    for (int c = 0; c < 3; ++c) {
      const Token t = next_token(cursor_);
      if (c == 0) content_->points.push_back(t.begin);
      p[c] = read_number(t, names[c], position_precision_);
    }
    Precision color_precision = color_precision_;
    std::array<double, 4> behind{};
    std::size_t count = 0;
    for (Token t = next_token(cursor_); !ends_line(t); t = next_token(cursor_), ++count)
      if (count < behind.size()) behind[count] = read_number(t, "weight or colour of a point", color_precision);
    const bool color = (count == 3 || count == 4) && (color_rows_.empty() || color_size_ == count);
    if (color) {
      color_size_ = count;
      color_rows_.push_back(static_cast<Index>(shape_.size()));
      colors_.insert(colors_.end(), behind.begin(), behind.begin() + static_cast<std::ptrdiff_t>(count));
      color_precision_ = color_precision;
    } else if (count > 1) {
      ++odd_points_;
    }
    shape_.positions.push_back(p);
    points_.count = shape_.size();
    cursor_.next_line();
  }

  void read_normal() {
    for (int c = 0; c < 3; ++c) {
      const Token t = next_token(cursor_);
      if (c == 0) content_->normals.push_back(t.begin);
      normals_.push_back(read_number(t, "part of a normal", normal_precision_));
    }
    ++normal_sort_.count;
    while (!ends_line(next_token(cursor_))) {
    }
    cursor_.next_line();
  }

  /// The number from 0 that `text`, a part of the corner `t`, stands for.
  Index read_index(const Token& t, std::string_view text, Sort& sort) {
    const auto within = static_cast<std::size_t>(text.data() - t.text.data());
    const Token part{text, t.begin + within, t.line, t.column + static_cast<std::int64_t>(within)};
    std::int64_t index = 0;
    const auto count = static_cast<std::int64_t>(sort.count);
    if (!parse(text, index) || index == 0 || index < -count) throw wrong_index(part, sort);
    if (index < 0) return static_cast<Index>(count + index);
    if (index > static_cast<std::int64_t>(most)) throw wrong_index(part, sort);
    if (index > count && index > sort.forward.index) sort.forward = {index, part};
    return static_cast<Index>(index - 1);
  }

  InputError wrong_index(const Token& part, const Sort& sort) const {
    const std::string name = std::string("the index of a ") + sort.name;
    if (sort.count == 0) return cursor_.error(part, name + ", of which there are none");
    const std::string n = std::to_string(sort.count);
    return cursor_.error(part, name + " (1 to " + n + ", or -" + n + " to -1)");
  }

  void read_face() {
    corners_.clear();
    corner_normals_.clear();
    for (Token t = next_token(cursor_); !ends_line(t); t = next_token(cursor_)) {
      const std::size_t first = t.text.find('/');
      const std::size_t second = first == std::string_view::npos ? first : t.text.find('/', first + 1);
      corners_.push_back(read_index(t, t.text.substr(0, first), points_));
      corner_normals_.push_back(no_row);
      if (first == std::string_view::npos) continue;
      const std::string_view texture =
          t.text.substr(first + 1, second == std::string_view::npos ? second : second - first - 1);
      if (!texture.empty()) read_index(t, texture, textures_);
      if (second == std::string_view::npos) continue;
      const std::string_view normal = t.text.substr(second + 1);
      if (!normal.empty()) corner_normals_.back() = read_index(t, normal, normal_sort_);
    }
    cursor_.next_line();
    if (corners_.size() < 3) {
      ++small_faces_;
      return;
    }
    if (corners_.size() > most - shape_.faces.points.size())
      throw file_error(path_, "fewer than 2^32 corners of faces", "more");
    shape_.faces.add(corners_);
    face_normals_.insert(face_normals_.end(), corner_normals_.begin(), corner_normals_.end());
  }

  void finish() {
    if (shape_.size() == 0) throw file_error(path_, "a line \"v x y z\"", "none");
    if (shape_.size() > most || normal_sort_.count > most) throw file_error(path_, "fewer than 2^32 points", "more");
    for (const Sort* sort : {&points_, &textures_, &normal_sort_})
      if (sort->forward.index > static_cast<std::int64_t>(sort->count)) throw wrong_index(sort->forward.token, *sort);
    shape_.position_type = position_precision_.type();
    for (Vec3& p : shape_.positions)
      for (int c = 0; c < 3; ++c) p[c] = as_read(p[c], shape_.position_type);
    add_colors();
    add_normals();
    add_notes();
    content_->faces = shape_.faces.size();
    content_->corners = shape_.faces.points.size();
    shape_.content = std::move(content_);
  }

  void add_colors() {
    if (color_rows_.empty()) return;
    std::vector<std::string> fields = {"r", "g", "b", "a"};
    fields.resize(color_size_);
    content_->colors = color_rows_.size();
    content_->color_size = color_size_;
    Attribute color = number_attribute("color", fields, Kind::Color, color_precision_.type(), colors_);
    if (color_rows_.size() < shape_.size()) {
      color.points = color_rows_;
      for (Index i = 0; i <= color_rows_.size(); ++i) color.point_offsets.push_back(i);
    }
    shape_.attributes.push_back(std::move(color));
  }

  void add_normals() {
    const std::size_t n = normal_sort_.count;
    if (n == 0) return;
    Attribute normal = number_attribute("normal", {"x", "y", "z"}, Kind::Normal, normal_precision_.type(), normals_);
    if (!(shape_.faces.empty() && n == shape_.size())) {
      // Corners sorted by normal (counting sort), then each point once in the row of a normal.
      std::vector<Index> begin(n + 1, 0), sorted(face_normals_.size());
      for (const Index i : face_normals_)
        if (i != no_row) ++begin[i + 1];
      for (std::size_t i = 0; i < n; ++i) begin[i + 1] += begin[i];
      std::vector<Index> at(begin.begin(), begin.end() - 1);
      for (std::size_t corner = 0; corner < face_normals_.size(); ++corner)
        if (face_normals_[corner] != no_row) sorted[at[face_normals_[corner]]++] = shape_.faces.points[corner];
      std::vector<Index> last(shape_.size(), no_row);
      normal.point_offsets.assign(1, 0);
      for (Index i = 0; i < n; ++i) {
        for (Index k = begin[i]; k < begin[i + 1]; ++k)
          if (last[sorted[k]] != i) {
            last[sorted[k]] = i;
            normal.points.push_back(sorted[k]);
          }
        normal.point_offsets.push_back(static_cast<Index>(normal.points.size()));
      }
    }
    shape_.attributes.push_back(std::move(normal));
  }

  void add_notes() {
    const auto kept = [&](std::size_t count, const char* singular, const char* plural) {
      if (count > 0) shape_.notes.push_back("Kept in the OBJ file only: " + counted(count, singular, plural) + ".");
    };
    kept(textures_.count, "texture coordinate", "texture coordinates");
    kept(materials_, "use of a material", "uses of materials");
    kept(groups_, "line of groups and objects", "lines of groups and objects");
    kept(lines_, "line or point element", "line or point elements");
    kept(small_faces_, "face of fewer than three corners", "faces of fewer than three corners");
    kept(odd_points_, "point with unknown numbers behind it", "points with unknown numbers behind them");
    if (unknown_ > 0)
      shape_.notes.push_back("Kept in the OBJ file only: " + counted(unknown_, "unknown line", "unknown lines") +
                             ", first " + quoted(first_unknown_.text) + " in line " +
                             std::to_string(first_unknown_.line) + ".");
  }

  std::string path_;
  const ReadOptions& options_;
  std::shared_ptr<ObjContent> content_;
  TextCursor cursor_;
  Shape shape_;
  Precision position_precision_{float_limit}, normal_precision_, color_precision_;
  std::vector<double> normals_, colors_;
  std::vector<Index> color_rows_;  ///< points that have a colour
  std::size_t color_size_ = 0;
  std::vector<Index> corners_, corner_normals_;  ///< of one face
  std::vector<Index> face_normals_;              ///< of each corner of shape_.faces
  Sort points_{"point"}, textures_{"texture coordinate"}, normal_sort_{"normal"};
  std::size_t lines_ = 0, materials_ = 0, groups_ = 0, small_faces_ = 0, odd_points_ = 0, unknown_ = 0;
  Token first_unknown_;
};

bool same_layout(const Shape& shape, const ObjContent& content) {
  const Attribute *normal = shape.find("normal"), *color = shape.find("color");
  const std::size_t normals = normal && normal->components == 3 ? normal->count() : 0;
  const std::size_t colors = color ? color->count() : 0;
  return content.points.size() == shape.size() && content.normals.size() == normals && content.colors == colors &&
         (colors == 0 || content.color_size == static_cast<std::size_t>(color->components)) &&
         content.faces == shape.faces.size() && content.corners == shape.faces.points.size();
}

std::vector<std::byte> patched(const Shape& shape, const ObjContent& content) {
  TextPatch patch(content.bytes);
  TextCursor cursor("", as_text(content.bytes));
  const Attribute *normal = shape.find("normal"), *color = shape.find("color");
  std::size_t i = 0, k = 0, row = 0;
  while (i < content.points.size() || k < content.normals.size()) {
    const bool point =
        k == content.normals.size() || (i < content.points.size() && content.points[i] < content.normals[k]);
    cursor.seek(point ? content.points[i] : content.normals[k]);
    for (int c = 0; c < 3; ++c) {
      const Token t = next_token(cursor);
      if (point)
        patch.set(t, shape.positions[i][c], shape.position_type, shape.origin[c]);
      else
        patch.set(t, normal->number(k, c), normal->type);
    }
    if (point && color && row < color->count() && (color->per_point() || color->points[row] == i)) {
      for (int c = 0; c < color->components; ++c) patch.set(next_token(cursor), color->number(row, c), color->type);
      ++row;
    }
    ++(point ? i : k);
  }
  return patch.finish();
}

std::vector<std::byte> generic(const Shape& shape, WriteReport& report) {
  std::vector<std::byte> out;
  out.reserve(shape.size() * 32 + shape.faces.points.size() * 8);
  std::vector<std::string> held;
  const Attribute* color = shape.find("color");
  if (color && !is_text_color(*color)) color = nullptr;
  if (color) held.push_back("color");
  const Attribute* normal = shape.find("normal");
  std::optional<std::vector<Index>> normal_of;
  if (normal && normal->components == 3 && normal->kind == Kind::Normal) normal_of = row_of_points(shape, *normal);
  if (normal_of) held.push_back("normal");
  report_lost_attributes("OBJ", shape, held, report);

  for (std::size_t i = 0; i < shape.size(); ++i) {
    append_text(out, "v");
    for (int c = 0; c < 3; ++c) {
      append_text(out, " ");
      append_number(out, shape.positions[i][c] + shape.origin[c], shape.position_type);
    }
    if (color) append_color(out, *color, i, true);
    append_text(out, "\n");
  }
  for (std::size_t i = 0; normal_of && i < normal->count(); ++i) {
    append_text(out, "vn");
    for (int c = 0; c < 3; ++c) {
      append_text(out, " ");
      append_number(out, normal->number(i, c), normal->type);
    }
    append_text(out, "\n");
  }
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    append_text(out, "f");
    for (const Index p : shape.faces[f]) {
      append_text(out, " " + std::to_string(p + 1ULL));
      if (normal_of && (*normal_of)[p] != no_row) append_text(out, "//" + std::to_string((*normal_of)[p] + 1ULL));
    }
    append_text(out, "\n");
  }
  return out;
}

}  // namespace

Shape read_obj(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  return ObjReader(path, std::move(bytes), options).read();
}

std::vector<std::byte> write_obj(const std::string&, const Shape& shape, WriteReport& report) {
  const auto* content = dynamic_cast<const ObjContent*>(shape.content.get());
  if (!content || !same_layout(shape, *content)) return generic(shape, report);
  report_lost_attributes("OBJ", shape, {"normal", "color"}, report);
  return patched(shape, *content);
}

}  // namespace sinew::io
