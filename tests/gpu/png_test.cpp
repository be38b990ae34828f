#include "engine/gpu/png.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>

#include "engine/geometry/error.h"

namespace sinew::gpu {
namespace {

std::string path_of(const char* name) {
  return (std::filesystem::path(testing::TempDir()) / name).string();
}

void write(const std::string& path, const std::vector<std::byte>& bytes) {
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

TEST(Png, ComesBackAsItWas) {
  Picture picture{7, 5, {}};
  for (int i = 0; i < 7 * 5 * 4; ++i) picture.rgba.push_back(static_cast<std::uint8_t>(i * 37));
  const std::string path = path_of("sinew_png_test.png");
  write(path, png_bytes(picture));
  const Picture back = read_png(path);
  EXPECT_EQ(back.width, 7);
  EXPECT_EQ(back.height, 5);
  EXPECT_EQ(back.rgba, picture.rgba);
  std::filesystem::remove(path);
}

TEST(Png, RefusesWhatCannotBeRead) {
  EXPECT_THROW(read_png(path_of("no_such_file.png")), InputError);
  const std::string path = path_of("sinew_not_a_png.png");
  std::ofstream(path) << "not a picture";
  EXPECT_THROW(read_png(path), InputError);
  std::filesystem::remove(path);
}

TEST(Png, RefusesACutFile) {
  Picture picture{64, 64, std::vector<std::uint8_t>(64 * 64 * 4)};
  for (std::size_t i = 0; i < picture.rgba.size(); ++i) picture.rgba[i] = static_cast<std::uint8_t>(i * i >> 3);
  const std::string path = path_of("sinew_cut.png");
  write(path, png_bytes(picture));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THROW(read_png(path), InputError);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace sinew::gpu
