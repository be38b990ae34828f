/// What sinew render draws of each kind of shape is what it drew before: tests/pictures has a row for each picture.
/// Where a change is meant, scripts/pictures makes them anew.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "engine/gpu/png.h"
#include "tests/apps/program.h"
#include "tests/io/temporary_folder.h"

namespace sinew {

namespace {

const std::string folder = SINEW_SOURCE_DIR "/tests/pictures/";

struct Row {
  std::string name, size;
  std::vector<std::string> arguments;
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << row.name;
}

std::vector<Row> rows() {
  std::vector<Row> out;
  std::istringstream text(contents(folder + "pictures.txt"));
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    Row row;
    words >> row.name >> row.size;
    for (std::string word; words >> word;) row.arguments.push_back(word);
    out.push_back(row);
  }
  return out;
}

/// The size in the README, 320 pixels wide.
std::string small(const std::string& size) {
  int width = 0, height = 0;
  char x = 0;
  std::istringstream(size) >> width >> x >> height;
  if (width <= 0 || height <= 0) ADD_FAILURE() << size;
  return "320x" + std::to_string(320 * height / std::max(1, width));
}

struct Difference {
  double mean = 0;  ///< of all channels, in steps of 255
  double most = 0;  ///< the mean of the block of 8 x 8 pixels that differs most: pixels of an edge may flip one by one
};

Difference difference(const gpu::Picture& a, const gpu::Picture& b) {
  constexpr int block = 8;
  if (a.width != b.width || a.height != b.height) return {255, 255};
  Difference out;
  for (int top = 0; top < a.height; top += block)
    for (int left = 0; left < a.width; left += block) {
      double sum = 0, values = 0;
      for (int y = top; y < std::min(a.height, top + block); ++y)
        for (int x = left; x < std::min(a.width, left + block); ++x)
          for (int c = 0; c < 3; ++c, ++values) sum += std::abs(a.at(x, y)[c] - b.at(x, y)[c]);
      out.mean += sum / (3.0 * a.width * a.height);
      out.most = std::max(out.most, sum / values);
    }
  return out;
}

/// Rounding differs from processor to processor; what a person would see is more.
bool alike(const Difference& d) {
  return d.mean <= 0.5 && d.most <= 12;
}

/// Where they differ, eight times as much, on grey.
gpu::Picture picture_of_difference(const gpu::Picture& a, const gpu::Picture& b) {
  gpu::Picture out = a;
  if (a.rgba.size() != b.rgba.size()) return out;
  for (std::size_t i = 0; i < out.rgba.size(); ++i)
    if (i % 4 != 3) out.rgba[i] = static_cast<std::uint8_t>(std::clamp(128 + 8 * (a.rgba[i] - b.rgba[i]), 0, 255));
  return out;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// "scan" of "SAMPLES/scan.edit.json"; empty where it is no sample.
std::string sample_of(const std::string& argument) {
  const std::string prefix = "SAMPLES/";
  return argument.starts_with(prefix) ? argument.substr(prefix.size(), argument.find('.') - prefix.size()) : "";
}

class Pictures : public ::testing::TestWithParam<Row> {
 protected:
  /// FOLDER/SHAPE.EDIT.mesh-ik.obj: the edit FOLDER/SHAPE.EDIT.edit.json done by the original mesh-based inverse
  /// kinematics.
  static void make_by_mesh_ik(const std::string& path) {
    const std::string stem = path.substr(0, path.size() - std::string(".mesh-ik.obj").size());
    const std::string shape = stem.substr(0, stem.rfind('.')) + ".obj";
    const Outcome outcome = Program({shape, stem + ".edit.json", path}, "sinew-mesh-ik").wait();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }

  /// Makes the row's samples and draws it, on the software driver: graphics cards smooth edges in ways of their own.
  gpu::Picture draw(const Row& row) const {
    setenv("SINEW_VULKAN_DEVICE", "llvmpipe", 1);
    std::vector<std::string> arguments{"render"};
    std::set<std::string> made;
    for (std::string argument : row.arguments) {
      if (const std::string sample = sample_of(argument); !sample.empty() && made.insert(sample).second) {
        const Outcome outcome = Program({samples_.path().string(), sample}, "sinew-samples").wait();
        EXPECT_EQ(outcome.status, 0) << outcome.err;
      }
      replace_all(argument, "SAMPLES", samples_.path().string());
      if (argument.ends_with(".mesh-ik.obj")) make_by_mesh_ik(argument);
      arguments.push_back(argument);
    }
    const std::string path = samples_ / "picture.png";
    arguments.insert(arguments.end(), {"--size", small(row.size), "-o", path, "--force"});
    const Outcome drawn = run_sinew(arguments);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    return gpu::read_png(path);
  }

  TemporaryFolder samples_;
};

void write(const std::string& path, const gpu::Picture& picture) {
  const std::vector<std::byte> bytes = gpu::png_bytes(picture);
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

}  // namespace

TEST_P(Pictures, AreWhatTheyWere) {
  const Row& row = GetParam();
  const gpu::Picture picture = draw(row);
  const std::string reference = folder + row.name + ".png";
  if (std::getenv("SINEW_NEW_PICTURES") != nullptr) {
    write(reference, picture);
    return;
  }
  const gpu::Picture expected = gpu::read_png(reference);
  const Difference d = difference(picture, expected);
  if (alike(d)) return;
  const std::string out = SINEW_BINARY_DIR "/pictures/";
  std::filesystem::create_directories(out);
  write(out + row.name + ".png", picture);
  write(out + row.name + "-difference.png", picture_of_difference(picture, expected));
  FAIL() << row.name << " differs from tests/pictures by " << d.mean << " of 255, at most " << d.most
         << " in a block of 8 x 8; see " << out << row.name << "-difference.png";
}

INSTANTIATE_TEST_SUITE_P(Each, Pictures, ::testing::ValuesIn(rows()), [](const auto& row) {
  std::string name = row.param.name;
  replace_all(name, "-", "_");
  return name;
});

TEST(PicturesTest, NoneIsLeftOver) {
  std::vector<std::string> names;
  for (const Row& row : rows()) names.push_back(row.name + ".png");
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name == "pictures.txt" || std::find(names.begin(), names.end(), name) != names.end()) << name;
  }
}

/// What is not to pass is planted in each reference: an edge moved by two pixels, a spot, a little more light.
TEST(PicturesTest, WhatAPersonWouldSeeIsSeen) {
  for (const Row& row : rows()) {
    const gpu::Picture expected = gpu::read_png(folder + row.name + ".png");
    gpu::Picture moved = expected, spotted = expected, lit = expected, noisy = expected, small = expected;
    for (int y = 0; y < expected.height; ++y)
      std::copy_n(expected.at(0, y), 4 * (expected.width - 2), const_cast<std::uint8_t*>(moved.at(2, y)));
    for (int y = 100; y < 110; ++y)
      for (int x = 150; x < 160; ++x) {
        std::uint8_t* color = const_cast<std::uint8_t*>(spotted.at(x, y));
        for (int c = 0; c < 3; ++c)
          color[c] = static_cast<std::uint8_t>(color[c] < 128 ? color[c] + 60 : color[c] - 60);
      }
    for (std::size_t i = 0; i < lit.rgba.size(); ++i) {
      lit.rgba[i] = static_cast<std::uint8_t>(std::min(255, lit.rgba[i] + 2));
      noisy.rgba[i] = static_cast<std::uint8_t>(std::max(0, noisy.rgba[i] - (i / 4 % 4 == 0 ? 1 : 0)));
    }
    small.height -= 1;
    small.rgba.resize(small.rgba.size() - 4 * static_cast<std::size_t>(small.width));
    for (const gpu::Picture* planted : {&moved, &spotted, &lit, &small})
      EXPECT_FALSE(alike(difference(*planted, expected))) << row.name;
    EXPECT_TRUE(alike(difference(noisy, expected))) << row.name;
  }
}

}  // namespace sinew
