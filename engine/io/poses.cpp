#include "engine/io/poses.h"

#include <algorithm>
#include <filesystem>

#include "engine/geometry/error.h"
#include "engine/io/gltf.h"
#include "engine/io/sequence.h"

namespace sinew::io {

namespace {

namespace fs = std::filesystem;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The digits at `at` without leading zeros, and where they end.
std::string_view number_at(const std::string& text, std::size_t& at) {
  const std::size_t first = std::min(text.find_first_not_of('0', at), text.size());
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  const std::size_t begin = std::min(first, end);
  at = end;
  return std::string_view(text).substr(begin, end - begin);
}

bool is_known(const fs::path& path) {
  std::string extension = path.extension().string();
  if (extension.empty()) return false;
  extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto all = formats();
  return std::any_of(all.begin(), all.end(), [&](const Format& format) {
    return std::find(format.extensions.begin(), format.extensions.end(), extension) != format.extensions.end();
  });
}

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_known(entry.path())) out.push_back(entry.path().string());
  if (out.empty()) throw file_error(folder, "files of poses in the folder", "none of a known format");
  std::sort(out.begin(), out.end(), in_natural_order);
  return out;
}

bool is_gltf(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  return extension == ".gltf" || extension == ".glb";
}

void read_file(const std::string& path, const ReadOptions& options, std::vector<NamedPose>& out) {
  const std::string stem = fs::path(path).stem().string();
  if (is_gltf(path)) {
    const auto targets = read_gltf_targets(path);
    for (std::size_t k = 0; k < targets.size(); ++k)
      out.push_back({targets.size() > 1 ? stem + " " + std::to_string(k + 1) : stem, path, targets[k]});
    if (!targets.empty()) return;
  }
  if (!names_frames(path)) {
    out.push_back({stem, path, read(path, options)});
    return;
  }
  const Sequence sequence = open_sequence(path, options);
  for (const int frame : sequence.frames)
    out.push_back({stem + " " + std::to_string(frame), path, sequence.load(frame)});
}

}  // namespace

bool in_natural_order(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = number_at(a, i), y = number_at(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else {
      if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

std::vector<std::string> pose_files(const std::string& path) {
  return fs::is_directory(path) ? files_in(path) : std::vector{path};
}

std::vector<NamedPose> read_poses(const std::string& path, const ReadOptions& options) {
  std::vector<NamedPose> out;
  for (const std::string& file : pose_files(path)) read_file(file, options, out);
  return out;
}

}  // namespace sinew::io
