#pragma once
/// ByteCursor: a bounds-checked walk over the bytes of a binary file. Every read says what it expected, so that a
/// truncated file names the byte where it ends.

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "engine/geometry/error.h"

namespace sinew::io {

/// x with its bytes reversed.
template <class T>
T swapped(T x) {
  std::byte bytes[sizeof(T)];
  std::memcpy(bytes, &x, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  std::memcpy(&x, bytes, sizeof(T));
  return x;
}

class ByteCursor {
 public:
  ByteCursor(const std::string& path, std::span<const std::byte> bytes, std::size_t at = 0)
      : path_(path), bytes_(bytes), at_(at) {}

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  /// The next `size` bytes; `what` says what they should have been ("12 bytes of vertex 7").
  std::span<const std::byte> take(std::size_t size, const std::string& what) {
    if (size > left()) throw truncated(size, what);
    at_ += size;
    return bytes_.subspan(at_ - size, size);
  }

  template <class T>
  T number(bool big_endian, const char* what) {
    static_assert(std::is_arithmetic_v<T>);
    if (sizeof(T) > left()) throw truncated(sizeof(T), what);
    T x;
    std::memcpy(&x, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return big_endian == (std::endian::native == std::endian::big) ? x : swapped(x);
  }

  /// A header's word on a count is believed only where count x smallest size fits into the bytes left.
  void check_count(std::uint64_t count, std::size_t smallest_size, const std::string& what) const {
    if (smallest_size > 0 && count > left() / smallest_size)
      throw byte_error(path_, static_cast<std::int64_t>(at_),
                       std::to_string(count) + " " + what + " of at least " + std::to_string(smallest_size) + " bytes",
                       "only " + std::to_string(left()) + " bytes to the end of the file");
  }

 private:
  InputError truncated(std::size_t size, const std::string& what) const {
    return byte_error(path_, static_cast<std::int64_t>(at_), std::to_string(size) + " bytes of " + what,
                      "the end of the file after " + std::to_string(left()));
  }

  std::string path_;
  std::span<const std::byte> bytes_;
  std::size_t at_;
};

inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Throws InputError where the file is what Git leaves in place of a large one.
inline void refuse_lfs_pointer(const std::string& path, std::span<const std::byte> bytes, const std::string& format) {
  if (as_text(bytes).starts_with("version https://git-lfs"))
    throw file_error(path, format + " data", "a Git LFS pointer (the file itself was not downloaded)");
}

}  // namespace sinew::io
