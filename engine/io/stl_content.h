#pragma once
/// What the reader and the writer of STL share: what is kept of a file, and a walk over the numbers of its text.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/io/bytes.h"
#include "engine/io/text.h"

namespace sinew::io {

inline constexpr std::size_t stl_header = 84, stl_facet = 50;  ///< bytes of a binary file

struct StlContent : FileContent {
  std::vector<std::byte> bytes;  ///< all of the file
  bool binary = true;
};

/// The header's count of facets; `bytes` has at least stl_header.
std::uint32_t stl_count(std::span<const std::byte> bytes);

/// Facets of an ascii file one after the other. Keywords in any case, line breaks anywhere but in the names of solids.
class StlText {
 public:
  using Facet = std::array<Token, 12>;  ///< normal and three points

  StlText(const std::string& path, std::span<const std::byte> bytes) : path_(path), cursor_(path, as_text(bytes)) {}

  /// False at the end of the file. Throws InputError at a wrong word.
  bool next(Facet& facet);
  /// Throws InputError where the token is not a number.
  double number(const Token& token) const;
  std::size_t at() const { return cursor_.at(); }
  std::size_t solids() const { return solids_; }

  /// In any case of letters; `word` is in lower case.
  static bool is_word(std::string_view text, std::string_view word);

 private:
  Token next_token(const char* expected);
  void expect(const char* word);

  std::string path_;
  TextCursor cursor_;
  bool in_solid_ = false;
  std::size_t solids_ = 0;
};

}  // namespace sinew::io
