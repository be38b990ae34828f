#pragma once
/// What the commands share that solve an edit and write what it makes of a file.

#include <functional>
#include <string>
#include <vector>

#include "apps/sinew/files.h"
#include "engine/document/project.h"

namespace sinew::app {

struct DeformOptions {
  std::string input, from, edit, report, pose, frames, jobs, task;  ///< as given, empty where not
  std::vector<std::string> settings;
  Output out;
  bool strict = false;
};

/// Checks outputs, takes the edit, then reads, solves and writes. Gives an Exit.
int run_deform(const DeformOptions& options, const std::function<document::Project()>& edit);

}  // namespace sinew::app
