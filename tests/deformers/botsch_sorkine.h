#pragma once
/// The cases of Botsch and Sorkine in the shared data, and the independent implementations of the three methods beside
/// them, where numpy is at hand.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "engine/geometry/deformer.h"
#include "engine/io/io.h"

namespace sinew::test {

namespace fs = std::filesystem;

/// A Botsch-Sorkine case: NAME.off, NAME.sel (0 fixed, 2 handle), NAME.def (4x4 of the handle).
struct Case {
  std::shared_ptr<const Shape> shape;
  Constraints constraints;
};

inline std::vector<double> numbers_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<double> out;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    for (double x; words >> x;) out.push_back(x);
  }
  return out;
}

inline Case read_case(const fs::path& base) {
  Case c{io::read(base.string() + ".off"), {}};
  const std::vector<double> labels = numbers_of(base.string() + ".sel"), m = numbers_of(base.string() + ".def");
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> motion(m.data());
  Handle handle;
  for (Index i = 0; i < c.shape->size(); ++i) {
    if (labels[i] == 0) c.constraints.fixed.push_back(i);
    if (labels[i] != 2) continue;
    const Vec3 p = c.shape->positions[i] + c.shape->origin;
    handle.points.push_back(i);
    handle.targets.push_back(motion.topLeftCorner<3, 3>() * p + motion.topRightCorner<3, 1>() - c.shape->origin);
  }
  c.constraints.handles.push_back(std::move(handle));
  return c;
}

/// What a command prints; empty where it fails.
inline std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return out;
  char buffer[256];
  while (std::fgets(buffer, sizeof(buffer), pipe) != nullptr) out += buffer;
  return pclose(pipe) == 0 ? out : std::string();
}

/// Whether `python` has what the reference implementations need.
inline const char* python = "/usr/bin/python3";
inline bool has_numpy() {
  return !output_of(std::string(python) + " -c 'import numpy, scipy; print(1)' 2>/dev/null").empty();
}

}  // namespace sinew::test
