#pragma once
/// The edits that go with the samples, as texts of EDIT.json files.

#include <string>
#include <utility>
#include <vector>

namespace sinew::samples {

/// The edit of a sample; empty where it has none.
std::string edit_of(const std::string& sample);

/// Other edits of a sample, by the methods tet and shell: what goes into their names before ".edit.json" ("tet"), and
/// the text.
std::vector<std::pair<std::string, std::string>> more_edits_of(const std::string& sample);

}  // namespace sinew::samples
