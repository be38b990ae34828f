#include "engine/io/sha256.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <vector>

#include "tests/io/temporary_folder.h"

namespace sinew::io {

namespace {

std::string hash_of(const std::string& text) {
  return hexadecimal(sha256(std::as_bytes(std::span(text))));
}

}  // namespace

/// The examples of FIPS 180-2, appendix B, and of its errata.
TEST(Sha256, ThePublishedExamples) {
  EXPECT_EQ(hash_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hash_of(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesOfAnySizeGiveTheSame) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += static_cast<char>(i * 7);
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const auto bytes = std::as_bytes(std::span(text).first(size));
    for (const std::size_t piece : {1u, 63u, 64u, 65u}) {
      Sha256 hash;
      for (std::size_t at = 0; at < size; at += piece) hash.add(bytes.subspan(at, std::min(piece, size - at)));
      ASSERT_EQ(hash.digest(), sha256(bytes)) << size << " bytes by " << piece;
    }
  }
}

TEST(Sha256, OfAFileAsSha256sumPrintsIt) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 3000000; ++i) text += static_cast<char>(i * 31 >> 3);
  std::ofstream(folder / "a", std::ios::binary) << text;
  FILE* command = popen(("sha256sum " + (folder / "a")).c_str(), "r");
  ASSERT_NE(command, nullptr);
  char line[128] = {};
  ASSERT_NE(fgets(line, sizeof(line), command), nullptr);
  pclose(command);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(sha256_of_file(folder / "a"), std::string(line, 64));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("SHA-256: %.0f MB/s\n", static_cast<double>(text.size()) / 1e6 / seconds);
  EXPECT_EQ(sha256_of_file(folder / "a", [] { return false; }), "");
}

}  // namespace sinew::io
