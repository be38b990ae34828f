#include "engine/io/gmsh.h"

#include <array>
#include <unordered_map>

#include "engine/io/bytes.h"
#include "engine/io/solid_text.h"

namespace sinew::io {

namespace {

struct GmshContent : SolidContent {};

/// Gmsh's types of elements that are faces or tets: how many points, the first of which are the corners.
struct ElementType {
  std::int64_t number;
  std::size_t points, corners;
  bool tet;
};
constexpr std::array element_types{
    ElementType{2, 3, 3, false},  ElementType{3, 4, 4, false},   ElementType{4, 4, 4, true},
    ElementType{9, 6, 3, false},  ElementType{10, 9, 4, false},  ElementType{11, 10, 4, true},
    ElementType{16, 8, 4, false}, ElementType{21, 10, 3, false}, ElementType{29, 20, 4, true},
};

const ElementType* type_of(std::int64_t number) {
  for (const ElementType& type : element_types)
    if (type.number == number) return &type;
  return nullptr;
}

/// 1 or 2. Looked at before anything asks for text: a binary file says so in its first lines.
int version_of(const std::string& path, std::string_view text) {
  TextCursor cursor(path, text, text.starts_with("\xef\xbb\xbf") ? 3 : 0);
  const Token first = cursor.next();
  if (first.text == "$NOD") return 1;
  if (first.text != "$MeshFormat") throw cursor.error(first, "$MeshFormat or $NOD");
  const Token version = cursor.next(), form = cursor.token();
  double number = 0;
  if (!parse(version.text, number) || !(number >= 2 && number < 3))
    throw cursor.error(version, "version 1 or 2 of MSH (\"gmsh -format msh22 -save\" converts others)");
  if (form.text != "0")
    throw cursor.error(form, "0, for MSH in text (\"gmsh -format msh22 -save\" converts binary files)");
  return 2;
}

class GmshReader {
 public:
  GmshReader(const std::string& path, int version, const std::shared_ptr<GmshContent>& content,
             const ReadOptions& options)
      : path_(path), version_(version), content_(content), reader_(path, content->bytes, options, 0) {}

  Shape read() {
    for (Token t = reader_.next(); !t.text.empty(); t = reader_.next()) {
      if (t.text == (version_ == 1 ? "$NOD" : "$Nodes")) {
        read_points(t);
      } else if (t.text == (version_ == 1 ? "$ELM" : "$Elements")) {
        read_elements();
      } else if (t.text.front() == '$') {
        skip_section(t);
      } else {
        reader_.cursor().next_line();  // text between sections
      }
    }
    if (!points_read_) throw file_error(path_, version_ == 1 ? "a section $NOD" : "a section $Nodes", "none");
    finish();
    return std::move(shape_);
  }

 private:
  void expect_end(const char* name) {
    const Token t = reader_.next();
    if (t.text != name) throw reader_.error(t, name);
  }

  void read_points(const Token& keyword) {
    if (points_read_) throw reader_.error(keyword, "one section of points");
    points_read_ = true;
    const std::size_t n = reader_.count("points", 8);
    for (std::size_t i = 0; i < n; ++i) {
      reader_.progress(i);
      const SolidRow row{"point", i, n};
      Token t;
      const std::int64_t number = reader_.integer(t, "the number of a point");
      if (!index_.try_emplace(number, static_cast<Index>(i)).second)
        throw reader_.error(t, "another number for " + row.text());
      reader_.point(row, shape_, *content_);
    }
    expect_end(version_ == 1 ? "$ENDNOD" : "$EndNodes");
  }

  void read_elements() {
    const std::size_t n = reader_.count("elements", 9);
    for (std::size_t i = 0; i < n; ++i) {
      reader_.progress(i);
      read_element({"element", i, n});
    }
    expect_end(version_ == 1 ? "$ENDELM" : "$EndElements");
  }

  /// A number of the element's line.
  std::int64_t number(const SolidRow& row) {
    const Token t = reader_.cursor().token();
    std::int64_t x = 0;
    if (!parse(t.text, x)) throw reader_.error(t, "a whole number of " + row.text());
    return x;
  }

  void read_element(const SolidRow& row) {
    Token t;
    reader_.integer(t, "the number of an element");
    const ElementType* type = type_of(number(row));
    const std::int64_t tags = version_ == 1 ? 2 : number(row);
    for (std::int64_t i = 0; i < tags; ++i) number(row);
    if (version_ == 1) number(row);  // the count of points
    points_.clear();
    for (t = reader_.cursor().token(); !t.text.empty(); t = reader_.cursor().token()) points_.push_back(t);
    if (type == nullptr) {
      ++others_;
      return;
    }
    if (points_.size() != type->points)
      throw reader_.error(points_.size() < type->points ? t : points_[type->points],
                          std::to_string(type->points) + " points in " + row.text());
    higher_ += type->points > type->corners ? 1 : 0;
    add(row, *type);
  }

  void add(const SolidRow& row, const ElementType& type) {
    Tet corners{};
    for (std::size_t c = 0; c < type.corners; ++c) {
      std::int64_t number = 0;
      const bool whole = parse(points_[c].text, number);
      const auto found = whole ? index_.find(number) : index_.end();
      if (found == index_.end()) throw reader_.error(points_[c], "the number of a point in " + row.text());
      corners[c] = found->second;
    }
    if (!type.tet) {
      add_solid_face(path_, shape_, std::span(corners).first(type.corners));
      return;
    }
    const std::size_t again = repeated_corner(corners);
    if (again < 4) throw reader_.error(points_[again], "four different points in " + row.text());
    shape_.tets.push_back(corners);
  }

  void skip_section(const Token& keyword) {
    const std::string name(keyword.text.substr(1));
    const std::string end = "$End" + name, old_end = "$END" + name;
    for (;;) {
      reader_.cursor().next_line();
      const Token t = reader_.cursor().token();
      if (t.text == end || t.text == old_end) break;
      if (t.text.empty() && reader_.cursor().at_end()) throw reader_.error(t, sinew::quoted(end));
    }
    if (name != "MeshFormat") kept_ += (kept_.empty() ? "" : ", ") + sinew::quoted(name);
  }

  void finish() {
    reader_.finish_points(shape_);
    const auto kept = [&](std::size_t count, const char* singular, const char* plural) {
      if (count > 0) shape_.notes.push_back("Kept in the Gmsh file only: " + counted(count, singular, plural) + ".");
    };
    kept(others_, "element that is neither face nor tet", "elements that are neither faces nor tets");
    kept(higher_, "element's points between its corners", "elements' points between their corners");
    if (!kept_.empty()) shape_.notes.push_back("Kept in the Gmsh file only: sections " + kept_ + ".");
    keep_solid(shape_, content_);
  }

  std::string path_;
  int version_;
  std::shared_ptr<GmshContent> content_;
  SolidReader reader_;
  Shape shape_;
  bool points_read_ = false;
  std::unordered_map<std::int64_t, Index> index_;  ///< of the number of a point
  std::vector<Token> points_;                      ///< of one element
  std::size_t others_ = 0, higher_ = 0;
  std::string kept_;
};

std::vector<std::byte> generic(const Shape& shape, WriteReport& report) {
  report_lost_attributes("Gmsh", shape, {}, report);
  const Faces faces = small_faces("Gmsh", shape, 4, report);
  std::vector<std::byte> out;
  append_text(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(shape.size()) + "\n");
  for (std::size_t i = 0; i < shape.size(); ++i) {
    append_text(out, std::to_string(i + 1) + " ");
    append_point(out, shape, i);
    append_text(out, "\n");
  }
  append_text(out, "$EndNodes\n$Elements\n" + std::to_string(faces.size() + shape.tets.size()) + "\n");
  std::size_t number = 0;
  // Two tags each: no physical group, and the elementary entity that has to be there.
  const auto append = [&](std::span<const Index> corners, int type) {
    append_text(out, std::to_string(++number) + " " + std::to_string(type) + " 2 0 1");
    append_corners(out, corners, 1);
    append_text(out, "\n");
  };
  for (std::size_t f = 0; f < faces.size(); ++f) append(faces[f], faces[f].size() == 3 ? 2 : 3);
  for (const Tet& tet : shape.tets) append(tet, 4);
  append_text(out, "$EndElements\n");
  return out;
}

}  // namespace

Shape read_gmsh(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  if (bytes.empty()) throw file_error(path, "$MeshFormat or $NOD", "an empty file");
  const int version = version_of(path, as_text(bytes));
  const auto content = std::make_shared<GmshContent>();
  content->bytes = std::move(bytes);
  return GmshReader(path, version, content, options).read();
}

std::vector<std::byte> write_gmsh(const std::string&, const Shape& shape, WriteReport& report) {
  const auto* content = dynamic_cast<const GmshContent*>(shape.content.get());
  if (!content || !fits_solid(shape, *content)) {
    if (content) report_lost_rest("Gmsh", report);
    return generic(shape, report);
  }
  report_lost_attributes("Gmsh", shape, {}, report);
  return patched_solid(shape, *content, 0);
}

}  // namespace sinew::io
