#pragma once
/// What the readers and writers of text files with tets share (Medit, TetGen, Gmsh): rows of points and cells with
/// their place in messages, what is kept of a file, and faces of as many corners as a format can hold.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/io/io.h"
#include "engine/io/text_patch.h"

namespace sinew::io {

/// What is kept of a file; each format derives its own, so that none takes another's.
struct SolidContent : FileContent {
  std::vector<std::byte> bytes;                  ///< of the file that has the points
  std::vector<std::size_t> points;               ///< byte of the first coordinate of each point
  std::vector<std::string> attributes;           ///< names of those whose numbers follow the coordinates, in that order
  std::size_t faces = 0, corners = 0, tets = 0;  ///< of the shape
};

/// Row i of n in a section, for messages: "tet 1 of 7".
struct SolidRow {
  const char* what;
  std::size_t i, n;
  std::string text() const;
};

/// Walks over the tokens of one file and adds to a shape.
class SolidReader {
 public:
  /// Throws InputError where the file is no text. All but the path must outlive the reader; `comment` begins a comment
  /// to the end of the line (0: none).
  SolidReader(const std::string& path, std::span<const std::byte> bytes, const ReadOptions& options, char comment);

  TextCursor& cursor() { return cursor_; }
  Token next() { return cursor_.next(comment_); }
  InputError error(const Token& t, const std::string& expected) const;

  std::int64_t integer(Token& t, const char* expected);
  /// A count of rows of at least `smallest` bytes each, believed only where they fit into the bytes left.
  std::size_t count(const char* of, std::size_t smallest);
  double number(const SolidRow& row, Precision& precision);
  /// Three coordinates; adds a point, and its place to `content`.
  void point(const SolidRow& row, Shape& shape, SolidContent& content);
  /// Rounds the points that were read to position_type, which it sets.
  void finish_points(Shape& shape) const;

  /// The index of a point, counted from `first`, and its token.
  Index corner(const SolidRow& row, std::size_t points, std::int64_t first, Token& t);
  /// A face of `size` corners that come next.
  void face(const SolidRow& row, Shape& shape, std::size_t size, std::int64_t first);
  /// The four corners of a tet that come next; throws InputError where one is there twice.
  void tet(const SolidRow& row, Shape& shape, std::int64_t first);

  /// Now and then tells how much was read.
  void progress(std::size_t row) const;

 private:
  std::string path_;
  std::string_view text_;
  const ReadOptions& options_;
  char comment_;
  TextCursor cursor_;
  Precision precision_{float_limit};
};

/// Adds a face; throws InputError where there would be too many corners.
void add_solid_face(const std::string& path, Shape& shape, std::span<const Index> corners);

/// The place of the first corner that stands before it too; 4 where all are different.
std::size_t repeated_corner(const Tet& tet);

/// Completes the content from the shape that was read, and gives it to the shape.
void keep_solid(Shape& shape, std::shared_ptr<SolidContent> content);

/// Whether the file can take the shape's points and attributes in place of those read.
bool fits_solid(const Shape& shape, const SolidContent& content);
/// The file of the points with those numbers replaced that have changed.
std::vector<std::byte> patched_solid(const Shape& shape, const SolidContent& content, char comment);

/// Says of a file that cannot take the shape what is not written of it.
void report_lost_rest(const std::string& format, WriteReport& report);

/// The label of each point, as the formats hold it: whole numbers of 32 bits, one a point. Null where the shape has
/// none.
const Attribute* label_of(const Shape& shape);

/// "x y z" of point i, in the file's coordinates.
void append_point(std::vector<std::byte>& out, const Shape& shape, std::size_t i);
/// " 1 2 3": corners, counted from `first`.
void append_corners(std::vector<std::byte>& out, std::span<const Index> corners, Index first);

/// The faces with at most `most` corners; larger ones become triangles around their first corner, and the report says
/// so.
Faces small_faces(const std::string& format, const Shape& shape, std::size_t most, WriteReport& report);

}  // namespace sinew::io
