/// Length and layout of the files of code.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/house/sources.h"

namespace sinew::house {

namespace {

constexpr std::ptrdiff_t longest_file = 600;

std::ptrdiff_t lines_of(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

/// The exit status of a shell command.
int shell(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST(House, NoFileIsLong) {
  for (const Source& source : all_sources()) {
    if (!is_code(source)) continue;
    EXPECT_LE(lines_of(source.text), longest_file) << source.path;
  }
}

TEST(House, ALongFileIsSeen) {
  EXPECT_GT(lines_of(std::string(601, '\n')), longest_file);
}

TEST(House, CppIsLaidOutByClangFormat) {
  if (shell("command -v clang-format >/dev/null 2>&1") != 0) GTEST_SKIP() << "no clang-format";
  const auto folder = std::filesystem::temp_directory_path() / ("sinew-house-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string style = "--style=file:" SINEW_SOURCE_DIR "/.clang-format";
  const auto check = [&](const std::string& files) {
    return shell("cd '" SINEW_SOURCE_DIR "' && clang-format --dry-run --Werror '" + style + "' " + files);
  };

  std::ofstream(folder / "planted.cpp") << "int  main( ){return 0 ;}\n";
  EXPECT_NE(check((folder / "planted.cpp").string() + " 2>/dev/null"), 0) << "a planted defect is not seen";

  const auto list = folder / "files";
  {
    std::ofstream out(list);
    for (const Source& source : all_sources())
      if (is_cpp(source) && !source.path.starts_with("shaders/")) out << source.path << '\n';
  }
  EXPECT_EQ(check("$(cat '" + list.string() + "')"), 0);
  std::filesystem::remove_all(folder);
}

}  // namespace sinew::house
