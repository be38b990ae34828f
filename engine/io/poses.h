#pragma once
/// Poses of one mesh, as an example-driven method takes them: files in correspondence, the frames of a sequence, or the
/// morph targets of a glTF file.

#include <memory>
#include <string>
#include <vector>

#include "engine/io/io.h"

namespace sinew::io {

struct NamedPose {
  std::string name;  ///< what to call it: the name of its file without extension, with a number where it holds several
  std::string path;  ///< the file, for messages
  std::shared_ptr<const Shape> shape;
};

/// The poses that `path` names: of a folder each file of a known format, in the order of their names, numbers by their
/// value (2 before 10); of a glTF file its morph targets, where it has any; of a numbered run and of any other file
/// each frame. Whether they correspond is for the caller to see. Throws InputError or Cancelled.
std::vector<NamedPose> read_poses(const std::string& path, const ReadOptions& options = {});

/// The files that `path` names poses by, in their order: of a folder each of a known format, else `path` itself. Throws
/// InputError where a folder has none.
std::vector<std::string> pose_files(const std::string& path);

/// Whether `a` comes before `b`: letters by their code, runs of digits by their value.
bool in_natural_order(const std::string& a, const std::string& b);

}  // namespace sinew::io
