#pragma once
/// Where tests find data that is not part of the project: the folder of SINEW_SHARED, or "shared" beside the checkout.
/// Tests that use it skip with a printed reason when it is absent.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace sinew {

inline std::filesystem::path shared_folder() {
  if (const char* folder = std::getenv("SINEW_SHARED")) return folder;
  return std::filesystem::path(SINEW_SOURCE_DIR) / ".." / "shared";
}

}  // namespace sinew

/// In a test's body: `const auto path = ...` is `name` within the shared data, or the test is skipped.
#define SHARED_DATA(variable, name)                                                  \
  const std::filesystem::path variable = ::sinew::shared_folder() / "data" / (name); \
  if (!std::filesystem::exists(variable)) GTEST_SKIP() << "no shared data: " << variable.string()
