#pragma once
/// The project's own text files, read once, for the tests of the house.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace sinew::house {

struct Source {
  std::string path;  ///< from the root of the checkout, with slashes
  std::string text;
};

/// Files of the folders that hold code, in order of their paths.
inline std::vector<Source> all_sources() {
  const std::filesystem::path root = SINEW_SOURCE_DIR;
  std::vector<Source> sources;
  for (const char* folder : {"engine", "deformers", "shaders", "apps", "tests", "cmake", "scripts"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      sources.push_back({entry.path().lexically_relative(root).generic_string(),
                         std::string(std::istreambuf_iterator<char>(file), {})});
    }
  std::sort(sources.begin(), sources.end(), [](const Source& a, const Source& b) { return a.path < b.path; });
  return sources;
}

inline bool ends_with_any(const std::string& path, std::initializer_list<const char*> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](const char* ending) { return path.ends_with(ending); });
}

inline bool is_cpp(const Source& source) {
  return ends_with_any(source.path, {".cpp", ".h"});
}
inline bool is_code(const Source& source) {
  return is_cpp(source) || source.path.starts_with("shaders/") || source.path.starts_with("scripts/") ||
         ends_with_any(source.path, {".cmake"});
}

}  // namespace sinew::house
