#pragma once
/// Where tests and benchmarks find data that is not part of the project: the folder of SINEW_SHARED, or "shared" beside
/// the checkout.

#include <cstdlib>
#include <filesystem>

namespace sinew {

inline std::filesystem::path shared_folder() {
  if (const char* folder = std::getenv("SINEW_SHARED")) return folder;
  return std::filesystem::path(SINEW_SOURCE_DIR) / ".." / "shared";
}

}  // namespace sinew
