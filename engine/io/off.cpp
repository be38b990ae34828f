#include "engine/io/off.h"

#include <array>

#include "engine/io/bytes.h"
#include "engine/io/text_patch.h"

namespace sinew::io {

namespace {

struct OffContent : FileContent {
  std::vector<std::byte> bytes;
  std::vector<std::size_t> points;     ///< byte of the first number of each point
  bool normals = false;                ///< three numbers behind the coordinates
  int color_size = 0;                  ///< numbers behind those
  std::size_t faces = 0, corners = 0;  ///< of the shape
};

/// What stands behind the coordinates of a point, in the file's order.
struct Columns {
  bool normal = false;
  int color = 0, texture = 0;  ///< numbers
};

class OffReader {
 public:
  OffReader(std::string path, std::vector<std::byte> bytes, const ReadOptions& options)
      : path_(std::move(path)), options_(options), content_(std::make_shared<OffContent>()), cursor_("", "") {
    content_->bytes = std::move(bytes);
    text_ = as_text(content_->bytes);
  }

  Shape read() {
    refuse_binary();
    cursor_ = TextCursor(path_, text_, text_begin(path_, content_->bytes));
    read_keyword();
    const std::size_t points = read_count("points", 6), faces = read_count("faces", 2);
    read_count("edges", 0);
    find_color_size();
    for (std::size_t i = 0; i < points; ++i) {
      if (i % 65536 == 0) report_progress(options_, cursor_.at(), text_.size());
      read_point(i, points);
    }
    finish_points();
    for (std::size_t i = 0; i < faces; ++i) {
      if (i % 65536 == 0) report_progress(options_, cursor_.at(), text_.size());
      read_face(i, faces);
    }
    finish();
    return std::move(shape_);
  }

 private:
  Token next() { return cursor_.next('#'); }
  std::size_t left() const { return text_.size() - cursor_.at(); }

  InputError error(const Token& t, const std::string& expected) const {
    if (t.text.empty()) return text_error(path_, t.line, t.column, expected, "the end of the file");
    return cursor_.error(t, expected);
  }

  /// A binary file has zero bytes: its first line is looked at before anything asks for text.
  void refuse_binary() const {
    const std::string_view line = TextCursor(path_, text_.substr(0, 80)).rest();
    if (line.find("OFF BINARY") != std::string_view::npos)
      throw text_error(path_, 1, 0, "OFF in text", "the keyword BINARY");
  }

  void read_keyword() {
    const std::size_t at = cursor_.at();
    const Token t = next();
    std::int64_t count = 0;
    if (parse(t.text, count)) {
      // The keyword may be missing: the counts come first.
      cursor_ = TextCursor(path_, text_, at);
      return;
    }
    std::string_view prefix = t.text;
    if (!prefix.ends_with("OFF")) throw error(t, "OFF or a keyword that ends in OFF");
    prefix.remove_suffix(3);
    const auto has = [&](std::string_view part) {
      if (!prefix.starts_with(part)) return false;
      prefix.remove_prefix(part.size());
      return true;
    };
    columns_.texture = has("ST") ? 2 : 0;
    columns_.color = has("C") ? 4 : 0;
    columns_.normal = has("N");
    if (prefix == "4" || prefix == "n" || prefix == "4n") throw error(t, "OFF with points of three coordinates");
    if (!prefix.empty()) throw error(t, "OFF with a prefix of ST, C and N");
    content_->normals = columns_.normal;
  }

  std::size_t read_count(const char* what, std::size_t smallest) {
    const Token t = next();
    std::int64_t count = 0;
    if (!parse(t.text, count) || count < 0) throw error(t, std::string("the count of ") + what);
    const auto size = static_cast<std::size_t>(count);
    if (smallest > 0 && (size > left() / smallest || size >= no_row))
      throw error(t,
                  std::string("a count of ") + what + " that fits into the " + std::to_string(left()) + " bytes left");
    return size;
  }

  /// Colours should be four numbers, but many programs write three: the first point's line tells.
  void find_color_size() {
    if (columns_.color == 0) return;
    TextCursor ahead = cursor_;
    int count = ahead.next('#').text.empty() ? 0 : 1;
    for (Token t = ahead.token(); !t.text.empty() && t.text.front() != '#'; t = ahead.token()) ++count;
    if (count == 3 + (columns_.normal ? 3 : 0) + 3 + columns_.texture) columns_.color = 3;
  }

  double read_number(std::size_t i, std::size_t points, Precision& precision, Token& t) {
    t = next();
    double x = 0;
    if (!parse(t.text, x))
      throw error(t, "a number of point " + std::to_string(i + 1) + " of " + std::to_string(points));
    precision.see(t.text, x);
    return x;
  }

  void read_point(std::size_t i, std::size_t points) {
    Token t;
    Vec3 p;
    for (int c = 0; c < 3; ++c) {
      p[c] = read_number(i, points, position_precision_, t);
      if (c == 0) content_->points.push_back(t.begin);
    }
    shape_.positions.push_back(p);
    for (int c = 0; c < (columns_.normal ? 3 : 0); ++c)
      normals_.push_back(read_number(i, points, normal_precision_, t));
    for (int c = 0; c < columns_.color; ++c) {
      const double x = read_number(i, points, color_precision_, t);
      std::int64_t whole = 0;
      color_bytes_ = color_bytes_ && parse(t.text, whole) && whole >= 0 && whole <= 255;
      color_above_1_ = color_above_1_ || x > 1;
      colors_.push_back(x);
    }
    Precision ignored;
    for (int c = 0; c < columns_.texture; ++c) read_number(i, points, ignored, t);
  }

  void finish_points() {
    shape_.position_type = position_precision_.type();
    for (Vec3& p : shape_.positions)
      for (int c = 0; c < 3; ++c) p[c] = as_read(p[c], shape_.position_type);
    if (columns_.normal)
      shape_.attributes.push_back(
          number_attribute("normal", {"nx", "ny", "nz"}, Kind::Normal, normal_precision_.type(), normals_));
    content_->color_size = columns_.color;
    if (columns_.color > 0) {
      std::vector<std::string> fields = {"r", "g", "b", "a"};
      fields.resize(static_cast<std::size_t>(columns_.color));
      const Type type = color_bytes_ && color_above_1_ ? Type::UInt8 : color_precision_.type();
      shape_.attributes.push_back(number_attribute("color", fields, Kind::Color, type, colors_));
    }
  }

  void read_face(std::size_t i, std::size_t faces) {
    const Token count_token = next();
    std::int64_t count = 0;
    const auto face = [&] { return " face " + std::to_string(i + 1) + " of " + std::to_string(faces); };
    if (!parse(count_token.text, count) || count < 0) throw error(count_token, "the count of corners of" + face());
    if (static_cast<std::size_t>(count) > left() / 2)
      throw error(count_token, "a count of corners that fits into the " + std::to_string(left()) + " bytes left");
    corners_.clear();
    for (std::int64_t c = 0; c < count; ++c) {
      const Token t = next();
      std::int64_t index = 0;
      if (!parse(t.text, index) || index < 0 || static_cast<std::size_t>(index) >= shape_.size())
        throw error(t, "an index from 0 of one of " + std::to_string(shape_.size()) + " points, in" + face());
      corners_.push_back(static_cast<Index>(index));
    }
    const Token behind = cursor_.token();
    if (!behind.text.empty() && behind.text.front() != '#') ++colored_faces_;
    cursor_.next_line();
    if (count < 3) {
      ++small_faces_;
      return;
    }
    if (corners_.size() >= no_row - shape_.faces.points.size())
      throw file_error(path_, "fewer than 2^32 corners of faces", "more");
    shape_.faces.add(corners_);
  }

  void finish() {
    const auto kept = [&](std::size_t count, const char* singular, const char* plural) {
      if (count > 0) shape_.notes.push_back("Kept in the OFF file only: " + counted(count, singular, plural) + ".");
    };
    if (columns_.texture > 0) kept(shape_.size(), "texture coordinate", "texture coordinates");
    kept(colored_faces_, "colour of a face", "colours of faces");
    kept(small_faces_, "face of fewer than three corners", "faces of fewer than three corners");
    if (!next().text.empty()) shape_.notes.push_back("Kept in the OFF file only: text behind the last face.");
    content_->faces = shape_.faces.size();
    content_->corners = shape_.faces.points.size();
    shape_.content = std::move(content_);
  }

  std::string path_;
  const ReadOptions& options_;
  std::shared_ptr<OffContent> content_;
  std::string_view text_;
  TextCursor cursor_;
  Shape shape_;
  Columns columns_;
  Precision position_precision_{float_limit}, normal_precision_, color_precision_;
  std::vector<double> normals_, colors_;
  bool color_bytes_ = true, color_above_1_ = false;
  std::vector<Index> corners_;
  std::size_t colored_faces_ = 0, small_faces_ = 0;
};

bool same_layout(const Shape& shape, const OffContent& content) {
  const Attribute* normal = shape.find("normal");
  const bool normals = normal && normal->components == 3 && normal->count() == shape.size();
  return content.points.size() == shape.size() && content.normals == normals && content.faces == shape.faces.size() &&
         content.corners == shape.faces.points.size();
}

std::vector<std::byte> patched(const Shape& shape, const OffContent& content) {
  TextPatch patch(content.bytes);
  TextCursor cursor("", as_text(content.bytes));
  const Attribute* normal = content.normals ? shape.find("normal") : nullptr;
  const Attribute* color = shape.find("color");
  for (std::size_t i = 0; i < shape.size(); ++i) {
    cursor.seek(content.points[i]);
    for (int c = 0; c < 3; ++c)
      patch.set(cursor.next('#'), shape.positions[i][c], shape.position_type, shape.origin[c]);
    for (int c = 0; normal && c < 3; ++c) patch.set(cursor.next('#'), normal->number(i, c), normal->type);
    for (int c = 0; color && c < content.color_size; ++c) patch.set(cursor.next('#'), color->number(i, c), color->type);
  }
  return patch.finish();
}

void append_numbers(std::vector<std::byte>& out, const std::array<double, 3>& numbers, Type type) {
  for (const double x : numbers) {
    append_text(out, " ");
    append_number(out, x, type);
  }
}

std::vector<std::byte> generic(const Shape& shape, WriteReport& report) {
  const Attribute* color = shape.find("color");
  if (color && !is_text_color(*color)) color = nullptr;
  const Attribute* normal = shape.find("normal");
  if (normal && !(normal->components == 3 && normal->kind == Kind::Normal && normal->per_point())) normal = nullptr;
  std::vector<std::string> held;
  if (color) held.push_back("color");
  if (normal) held.push_back("normal");
  report_lost_attributes("OFF", shape, held, report);

  std::vector<std::byte> out;
  out.reserve(shape.size() * 32 + shape.faces.points.size() * 8);
  append_text(out, std::string(color ? "C" : "") + (normal ? "N" : "") + "OFF\n" + std::to_string(shape.size()) + " " +
                       std::to_string(shape.faces.size()) + " 0\n");
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Vec3 p = shape.positions[i] + shape.origin;
    append_number(out, p.x(), shape.position_type);
    append_text(out, " ");
    append_number(out, p.y(), shape.position_type);
    append_text(out, " ");
    append_number(out, p.z(), shape.position_type);
    if (normal) append_numbers(out, {normal->number(i, 0), normal->number(i, 1), normal->number(i, 2)}, normal->type);
    if (color) {
      append_color(out, *color, i, false);
      if (color->components != 4)
        append_text(out, color->components == 1 || color->type == Type::UInt8 ? " 255" : " 1");
    }
    append_text(out, "\n");
  }
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    append_text(out, std::to_string(shape.faces[f].size()));
    for (const Index p : shape.faces[f]) append_text(out, " " + std::to_string(p));
    append_text(out, "\n");
  }
  return out;
}

}  // namespace

Shape read_off(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  return OffReader(path, std::move(bytes), options).read();
}

std::vector<std::byte> write_off(const std::string&, const Shape& shape, WriteReport& report) {
  const auto* content = dynamic_cast<const OffContent*>(shape.content.get());
  if (!content || !same_layout(shape, *content)) return generic(shape, report);
  report_lost_attributes("OFF", shape, {"normal", "color"}, report);
  return patched(shape, *content);
}

}  // namespace sinew::io
