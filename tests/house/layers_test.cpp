/// A folder is a layer: what it includes lies in itself or below. Third-party headers are seen by few files.

#include <fnmatch.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>

#include "tests/house/sources.h"

namespace sinew::house {

namespace {

struct Layer {
  std::string folder;
  std::vector<std::string> below;  ///< prefixes of paths that it may include besides its own
};

const std::vector<Layer>& layers() {
  static const std::vector<Layer> table{
      {"engine/geometry/", {}},
      {"engine/io/", {"engine/geometry/"}},
      {"engine/document/", {"engine/geometry/", "engine/io/"}},
      {"engine/gpu/", {"engine/geometry/", "shaders/shared.h"}},
      {"deformers/", {"engine/geometry/"}},
      {"shaders/", {}},
      {"apps/sinew/", {"engine/", "deformers/", "shaders/shared.h"}},
      {"apps/editor/", {"engine/", "deformers/", "shaders/shared.h"}},
      {"apps/samples/", {"engine/geometry/", "engine/io/"}},
      {"apps/tets/", {"deformers/tet_protocol.h"}},
  };
  return table;
}

/// Which files of the program may include <prefix...>; patterns as the shell's.
const std::map<std::string, std::vector<std::string>>& third_party() {
  static const std::map<std::string, std::vector<std::string>> table{
      {"flann/", {"engine/geometry/nearest.cpp"}},
      {"OpenMesh/", {"deformers/decimate.cpp"}},
      {"tetgen.h", {"apps/tets/main.cpp"}},
      {"metis.h", {"deformers/sparse_cholesky_symbolic.cpp"}},
      {"lzf.h", {"engine/io/pcd.cpp"}},
      {"png.h", {"engine/gpu/png.cpp"}},
      {"vulkan/", {"engine/gpu/vulkan.h"}},
      {"nlohmann/", {"engine/document/json_parse.cpp", "engine/io/json_tree.cpp"}},
      {"CLI/", {"apps/sinew/command_line.cpp", "apps/samples/main.cpp", "apps/editor/main.cpp"}},
      {"GLFW/", {"apps/editor/window.cpp", "apps/editor/gui.cpp"}},
      {"systemd/", {"apps/editor/portal.cpp"}},
      {"imgui", {"apps/editor/*"}},
      {"backends/imgui", {"apps/editor/gui.cpp"}},
  };
  return table;
}

struct Include {
  bool angled = false;
  std::string name;
};

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex line(R"((?:^|\n)[ \t]*#[ \t]*include[ \t]*(["<])([^">\n]+)[">])");
  std::vector<Include> includes;
  for (std::sregex_iterator i(text.begin(), text.end(), line), end; i != end; ++i)
    includes.push_back({(*i)[1] == "<", (*i)[2]});
  return includes;
}

/// What is wrong with the includes of one file, a sentence each.
std::vector<std::string> complaints(const Source& source) {
  std::vector<std::string> wrong;
  const auto layer =
      std::find_if(layers().begin(), layers().end(), [&](const Layer& l) { return source.path.starts_with(l.folder); });
  if (layer == layers().end()) return {source.path + " lies in no layer"};
  for (const Include& include : includes_of(source.text)) {
    if (!include.angled) {
      // Shaders include each other by name.
      const bool own = include.name.starts_with(layer->folder) ||
                       (layer->folder == "shaders/" && include.name.find('/') == std::string::npos);
      const bool below = std::any_of(layer->below.begin(), layer->below.end(),
                                     [&](const std::string& prefix) { return include.name.starts_with(prefix); });
      if (!own && !below) wrong.push_back(source.path + " may not include \"" + include.name + "\"");
      continue;
    }
    for (const auto& [prefix, files] : third_party()) {
      if (!include.name.starts_with(prefix)) continue;
      const bool allowed = std::any_of(files.begin(), files.end(), [&](const std::string& pattern) {
        return fnmatch(pattern.c_str(), source.path.c_str(), 0) == 0;
      });
      if (!allowed) wrong.push_back(source.path + " may not include <" + include.name + ">");
    }
  }
  return wrong;
}

bool is_program(const Source& source) {
  return source.path.starts_with("engine/") || source.path.starts_with("deformers/") ||
         source.path.starts_with("apps/") || source.path.starts_with("shaders/");
}

}  // namespace

TEST(House, IncludesGoDown) {
  std::size_t read = 0;
  for (const Source& source : all_sources()) {
    if (!is_program(source)) continue;
    ++read;
    for (const std::string& complaint : complaints(source)) ADD_FAILURE() << complaint;
  }
  EXPECT_GT(read, 50u);
}

TEST(House, TheListOfThirdPartyHeadersIsNoLongerThanNeeded) {
  std::map<std::string, bool> used;
  for (const auto& [prefix, files] : third_party())
    for (const std::string& pattern : files) used[prefix + " in " + pattern] = false;
  for (const Source& source : all_sources())
    for (const Include& include : includes_of(source.text))
      for (const auto& [prefix, files] : third_party())
        for (const std::string& pattern : files)
          if (include.angled && include.name.starts_with(prefix) &&
              fnmatch(pattern.c_str(), source.path.c_str(), 0) == 0)
            used[prefix + " in " + pattern] = true;
  for (const auto& [row, is_used] : used) EXPECT_TRUE(is_used) << row;
}

TEST(House, AnIncludeThatGoesUpIsSeen) {
  const auto count = [](const char* path, const char* text) { return complaints({path, text}).size(); };
  EXPECT_EQ(count("engine/geometry/planted.h", "#pragma once\n#include \"engine/io/io.h\"\n"), 1u);
  EXPECT_EQ(count("engine/io/planted.cpp", "#include \"engine/document/project.h\"\n"), 1u);
  EXPECT_EQ(count("engine/document/planted.cpp", "#include \"deformers/graph.h\"\n"), 1u);
  EXPECT_EQ(count("engine/gpu/planted.cpp", "  #  include \"engine/io/io.h\"\n"), 1u);
  EXPECT_EQ(count("deformers/planted.cpp", "#include \"engine/gpu/device.h\"\n"), 1u);
  EXPECT_EQ(count("apps/sinew/planted.cpp", "#include \"apps/editor/editor.h\"\n"), 1u);
  EXPECT_EQ(count("engine/io/planted.cpp", "#include \"ply.h\"\n"), 1u) << "not from the root";
  EXPECT_EQ(count("engine/planted/planted.cpp", ""), 1u) << "a folder of no layer";
  EXPECT_EQ(count("engine/io/planted.cpp", "#include <flann/flann.hpp>\n"), 1u);
  EXPECT_EQ(count("apps/sinew/planted.cpp", "#include <vulkan/vulkan.h>\n#include <GLFW/glfw3.h>\n"), 2u);
  EXPECT_EQ(count("engine/io/planted.cpp", "#include \"engine/io/io.h\"\n#include \"engine/geometry/shape.h\"\n"), 0u);
  EXPECT_EQ(count("engine/gpu/planted.cpp", "#include \"shaders/shared.h\"\n"), 0u);
}

}  // namespace sinew::house
