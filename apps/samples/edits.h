#pragma once
/// The edits that go with the samples, as texts of EDIT.json files.

#include <string>

namespace sinew::samples {

/// The edit of a sample; empty where it has none.
std::string edit_of(const std::string& sample);

/// Another edit of a sample, by the method tet; empty where it has none.
std::string tet_edit_of(const std::string& sample);

}  // namespace sinew::samples
