#pragma once
/// Data that is not part of the project (shared_folder.h). Tests that use it skip with a printed reason when it is
/// absent.

#include <gtest/gtest.h>

#include "tests/shared_folder.h"

/// In a test's body: `const auto path = ...` is `name` within the shared data, or the test is skipped.
#define SHARED_DATA(variable, name)                                                  \
  const std::filesystem::path variable = ::sinew::shared_folder() / "data" / (name); \
  if (!std::filesystem::exists(variable)) GTEST_SKIP() << "no shared data: " << variable.string()
