#pragma once
/// The edits that go with the samples, as texts of EDIT.json files.

#include <string>

namespace sinew::samples {

/// The edit of "scan", "plane", "bar", "cactus", "cylinder" or "splats".
std::string edit_of(const std::string& sample);

}  // namespace sinew::samples
