#pragma once
/// The parameter section of a C3D file: groups of named values, and numbers as the processor that wrote them has them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::io {

/// Numbers as in the file's parameter section.
enum class C3dProcessor : std::uint8_t { Intel = 84, Dec = 85, Mips = 86 };

std::uint16_t c3d_word(C3dProcessor processor, const std::byte* at);

/// Of a DEC float, F_floating of the VAX: sign 1, exponent e of 8 bits, fraction f of 23 bits, the word with sign and
/// exponent first. (-1)^s (1 + f/2^23) 2^(e - 129); e = 0 is zero, or with the sign no number.
double c3d_float(C3dProcessor processor, const std::byte* at);

class C3dParameters {
 public:
  /// Reads from byte `begin` to at most `end`, neither of them beyond the file. Where the section breaks off, what was
  /// read until there counts, and a note tells the byte. Throws InputError: no processor.
  C3dParameters(const std::string& path, std::span<const std::byte> bytes, std::size_t begin, std::size_t end);

  C3dProcessor processor() const { return processor_; }
  const std::vector<std::string>& notes() const { return notes_; }

  /// Number i of a parameter, of any type; integers without a sign, as counts of points and frames are. Nothing where
  /// there is no such parameter or it is shorter.
  std::optional<double> number(std::string_view group, std::string_view name, std::size_t i = 0) const;
  /// The texts of a parameter, without blanks at their ends; only those that are there whole. Empty where there is
  /// none.
  std::vector<std::string> texts(std::string_view group, std::string_view name) const;
  /// The first of the texts.
  std::string text(std::string_view group, std::string_view name) const;

 private:
  struct Parameter {
    int group = 0;
    std::string name;  ///< capitals
    int type = 0;      ///< -1 text, 1 byte, 2 word, 4 float
    std::vector<std::size_t> dimensions;
    std::span<const std::byte> value;  ///< of the file's bytes, so that records that overlap cost nothing
  };
  struct Group {
    int number = 0;
    std::string name;
  };
  /// Reads the record at `at`; where the next one begins, or nothing after the last.
  std::optional<std::size_t> read_record(std::span<const std::byte> section, std::size_t at);
  Parameter read_parameter(std::span<const std::byte> record) const;
  const Parameter* find(std::string_view group, std::string_view name) const;

  C3dProcessor processor_ = C3dProcessor::Intel;
  std::vector<Group> groups_;
  std::vector<Parameter> parameters_;
  std::vector<std::string> notes_;
};

}  // namespace sinew::io
