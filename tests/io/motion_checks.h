#pragma once
/// What the tests of motion capture share.

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <string_view>

#include "engine/geometry/error.h"
#include "engine/io/motion.h"
#include "tests/io/file_checks.h"

namespace sinew::io {

/// What holds of all that a reader returns.
inline void expect_sound(const Trajectories& read) {
  ASSERT_FALSE(read.names.empty());
  ASSERT_FALSE(read.frames.empty());
  EXPECT_GE(read.rate, 0);
  for (const auto& frame : read.frames) {
    ASSERT_EQ(frame.size(), read.names.size());
    for (const Vec3& p : frame) ASSERT_TRUE(p.allFinite() || p.array().isNaN().all()) << p.transpose();
  }
  for (const auto& [parent, child] : read.bones) {
    ASSERT_GE(parent, 0);
    ASSERT_LT(parent, child);
    ASSERT_LT(static_cast<std::size_t>(child), read.names.size());
  }
  ASSERT_EQ(read.transforms.size(), read.rest.empty() ? 0 : read.frames.size());
  for (const auto& frame : read.transforms) ASSERT_EQ(frame.size(), read.names.size());
}

using ReadMotion = Trajectories (*)(const std::string&, std::span<const std::byte>);

/// True where the text was read; else it was refused in a sentence that names the file.
inline bool expect_sound_or_refused(ReadMotion read, std::string_view text) {
  try {
    expect_sound(read("damaged", bytes_of(text)));
    return true;
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with("damaged:")) << error.what();
    EXPECT_NE(std::string_view(error.what()).find(" expected "), std::string_view::npos) << error.what();
    return false;
  }
}

}  // namespace sinew::io
