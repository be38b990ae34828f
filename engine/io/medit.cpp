#include "engine/io/medit.h"

#include <algorithm>
#include <limits>

#include "engine/io/bytes.h"
#include "engine/io/solid_text.h"

namespace sinew::io {

namespace {

struct MeditContent : SolidContent {};

/// The binary form begins with the number 1 in four bytes.
void refuse_binary(const std::string& path, std::span<const std::byte> bytes) {
  const std::string_view text = as_text(bytes);
  if (text.starts_with(std::string_view("\1\0\0\0", 4)) || text.starts_with(std::string_view("\0\0\0\1", 4)))
    throw byte_error(path, 0, "Medit's text (.mesh), which programs that write .meshb can write too",
                     "its binary form");
}

class MeditReader {
 public:
  MeditReader(const std::string& path, const std::shared_ptr<MeditContent>& content, const ReadOptions& options)
      : path_(path), content_(content), reader_(path, content->bytes, options, '#') {}

  Shape read() {
    read_header();
    for (Token t = reader_.next(); !t.text.empty() && t.text != "End";) {
      if (t.text == "Vertices") {
        read_points(t);
      } else if (t.text == "Triangles" || t.text == "Quadrilaterals") {
        read_faces(t.text == "Triangles" ? 3 : 4);
      } else if (t.text == "Tetrahedra") {
        read_tets();
      } else {
        t = skip_section(t);
        continue;
      }
      t = reader_.next();
    }
    if (!points_read_) throw file_error(path_, "a section Vertices", "none");
    finish();
    return std::move(shape_);
  }

 private:
  void read_header() {
    const Token first = reader_.next();
    if (first.text != "MeshVersionFormatted") throw reader_.error(first, "MeshVersionFormatted");
    Token t;
    const std::int64_t version = reader_.integer(t, "a version of 1 to 4");
    if (version < 1 || version > 4) throw reader_.error(t, "a version of 1 to 4");
    const Token word = reader_.next();
    if (word.text != "Dimension") throw reader_.error(word, "Dimension");
    if (reader_.integer(t, "the dimension 3") != 3) throw reader_.error(t, "the dimension 3");
  }

  std::int64_t reference(const SolidRow& row) {
    const Token t = reader_.next();
    std::int64_t x = 0;
    if (!parse(t.text, x) || x < std::numeric_limits<std::int32_t>::min() ||
        x > std::numeric_limits<std::int32_t>::max())
      throw reader_.error(t, "the reference (a whole number of 32 bits) of " + row.text());
    return x;
  }

  void read_points(const Token& keyword) {
    if (points_read_) throw reader_.error(keyword, "one section Vertices");
    points_read_ = true;
    const std::size_t n = reader_.count("points", 8);
    for (std::size_t i = 0; i < n; ++i) {
      reader_.progress(i);
      const SolidRow row{"point", i, n};
      reader_.point(row, shape_, *content_);
      labels_.push_back(static_cast<double>(reference(row)));
    }
  }

  void read_faces(std::size_t size) {
    const std::size_t n = reader_.count("faces", 2 * size + 2);
    for (std::size_t i = 0; i < n; ++i) {
      reader_.progress(i);
      const SolidRow row{"face", i, n};
      reader_.face(row, shape_, size, 1);
      labeled_faces_ += reference(row) != 0 ? 1 : 0;
    }
  }

  void read_tets() {
    const std::size_t n = reader_.count("tets", 10);
    for (std::size_t i = 0; i < n; ++i) {
      reader_.progress(i);
      const SolidRow row{"tet", i, n};
      reader_.tet(row, shape_, 1);
      labeled_tets_ += reference(row) != 0 ? 1 : 0;
    }
  }

  /// To the next word; what was skipped is a section of a keyword that we know nothing of.
  Token skip_section(const Token& keyword) {
    double number = 0;
    if (parse(keyword.text, number)) throw reader_.error(keyword, "a keyword such as Tetrahedra or End");
    Token t = reader_.next();
    const bool empty = t.text.empty() || t.text == "0";
    while (!t.text.empty() && parse(t.text, number)) t = reader_.next();
    if (!empty) kept_ += (kept_.empty() ? "" : ", ") + quoted(keyword.text);
    return t;
  }

  void finish() {
    reader_.finish_points(shape_);
    if (std::any_of(labels_.begin(), labels_.end(), [](double label) { return label != 0; }))
      shape_.attributes.push_back(number_attribute("label", {"label"}, Kind::Id, Type::Int32, labels_));
    const auto kept = [&](std::size_t count, const char* singular, const char* plural) {
      if (count > 0) shape_.notes.push_back("Kept in the Medit file only: " + counted(count, singular, plural) + ".");
    };
    kept(labeled_faces_, "reference of a face", "references of faces");
    kept(labeled_tets_, "reference of a tet", "references of tets");
    if (!kept_.empty()) shape_.notes.push_back("Kept in the Medit file only: sections " + kept_ + ".");
    keep_solid(shape_, content_);
  }

  std::string path_;
  std::shared_ptr<MeditContent> content_;
  SolidReader reader_;
  Shape shape_;
  bool points_read_ = false;
  std::vector<double> labels_;
  std::size_t labeled_faces_ = 0, labeled_tets_ = 0;
  std::string kept_;
};

void append_faces(std::vector<std::byte>& out, const Faces& faces, const char* section, std::size_t size) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) count += faces[f].size() == size ? 1 : 0;
  if (count == 0) return;
  append_text(out, std::string(section) + "\n" + std::to_string(count) + "\n");
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f].size() == size) {
      append_corners(out, faces[f], 1);
      append_text(out, " 0\n");
    }
}

std::vector<std::byte> generic(const Shape& shape, WriteReport& report) {
  const Attribute* label = label_of(shape);
  report_lost_attributes("Medit", shape, label ? std::vector<std::string>{"label"} : std::vector<std::string>{},
                         report);
  std::vector<std::byte> out;
  append_text(out, std::string("MeshVersionFormatted ") + (shape.position_type == Type::Float32 ? "1" : "2") +
                       "\nDimension 3\nVertices\n" + std::to_string(shape.size()) + "\n");
  for (std::size_t i = 0; i < shape.size(); ++i) {
    append_point(out, shape, i);
    append_text(out,
                " " + (label ? value_text(label->type, label->values.data() + i * label->row_size()) : "0") + "\n");
  }
  const Faces faces = small_faces("Medit", shape, 4, report);
  append_faces(out, faces, "Triangles", 3);
  append_faces(out, faces, "Quadrilaterals", 4);
  if (!shape.tets.empty()) append_text(out, "Tetrahedra\n" + std::to_string(shape.tets.size()) + "\n");
  for (const Tet& tet : shape.tets) {
    append_corners(out, tet, 1);
    append_text(out, " 0\n");
  }
  append_text(out, "End\n");
  return out;
}

}  // namespace

Shape read_medit(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  refuse_binary(path, bytes);
  const auto content = std::make_shared<MeditContent>();
  content->bytes = std::move(bytes);
  return MeditReader(path, content, options).read();
}

std::vector<std::byte> write_medit(const std::string&, const Shape& shape, WriteReport& report) {
  const auto* content = dynamic_cast<const MeditContent*>(shape.content.get());
  if (!content || !fits_solid(shape, *content) || (content->attributes.empty() && label_of(shape))) {
    if (content) report_lost_rest("Medit", report);
    return generic(shape, report);
  }
  report_lost_attributes("Medit", shape, content->attributes, report);
  return patched_solid(shape, *content, '#');
}

}  // namespace sinew::io
