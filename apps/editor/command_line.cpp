#include "apps/editor/command_line.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "engine/io/frame_pattern.h"
#include "engine/io/sequence.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

bool in_path(const std::string& program) {
  const char* set = std::getenv("PATH");
  std::istringstream list(set == nullptr ? "" : set);
  for (std::string folder; std::getline(list, folder, ':');)
    if (access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

}  // namespace

std::string shell_word(const std::string& text) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '/' || c == '.' || c == '_' || c == '-' || c == '+' || c == ',' || c == '%' ||
           c == ':' || c == '@' || c == '=';
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string bent_name(const std::string& input, bool moves) {
  const fs::path path(input);
  const std::string name = path.filename().string();
  // Its scans keep their names, which would be those of the input's beside it.
  if (path.extension() == ".conf") return (path.parent_path() / (path.stem().string() + "-bent")).string() + "/";
  // Before the place of the frame's number, or before the extension.
  std::size_t at = name.find_first_of("#@%");
  if (!moves || at == std::string::npos) at = std::min(name.rfind('.'), name.size());
  while (moves && at > 0 && (name[at - 1] == '.' || name[at - 1] == '_' || name[at - 1] == '-')) --at;
  const std::string out = (path.parent_path() / (name.substr(0, at) + "-bent" + name.substr(at))).string();
  if (!moves || io::names_frames(out)) return out;
  return fs::path(out).replace_extension(".pc2").string();
}

std::string sinew_word() {
  if (in_path("sinew")) return "sinew";
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "sinew";
  return error || access(beside.c_str(), X_OK) != 0 ? "sinew" : shell_word(beside.string());
}

std::string command_line_of(const Session& session, const std::string& program) {
  if (!session.has_input() || session.edit_path().empty()) return {};
  const std::string& input = session.input_path();
  const std::string out = " -o " + shell_word(bent_name(input, session.moves()));
  return program + " deform " + shell_word(input) + " --edit " + shell_word(session.edit_path()) + out;
}

}  // namespace sinew::editor
