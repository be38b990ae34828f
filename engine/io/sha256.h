#pragma once
/// SHA-256 [FIPS 180-4], which `sha256sum` prints too: whether a file is the one that it was.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace sinew::io {

class Sha256 {
 public:
  using Digest = std::array<std::uint8_t, 32>;

  void add(std::span<const std::byte> bytes);
  /// Of all that was added; nothing may be added after it.
  Digest digest();

 private:
  void block(const std::uint8_t* bytes);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> rest_{};  ///< what does not fill a block yet
  std::uint64_t size_ = 0;               ///< bytes so far
};

Sha256::Digest sha256(std::span<const std::byte> bytes);
/// 64 digits from 0 to f.
std::string hexadecimal(const Sha256::Digest& digest);

/// Of the bytes of a file, hexadecimal. `go_on` is asked now and then; where it says false, the result is empty. Throws
/// InputError where the file can't be read.
std::string sha256_of_file(const std::string& path, const std::function<bool()>& go_on = {});

}  // namespace sinew::io
