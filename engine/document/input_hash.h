#pragma once
/// Input hashes: whether an input is still the file that an edit was made on. Of a file "sha256:" and what `sha256sum`
/// prints of it; of frames (frame_pattern.h) that of the lines which `sha256sum` prints of their files in ascending
/// order, run in their folder.

#include <functional>
#include <string>

namespace sinew::document {

/// `go_on` is asked now and then; where it says false, the result is empty. Throws InputError where a file can't be
/// read.
std::string input_hash(const std::string& path, const std::function<bool()>& go_on = {});

/// Whether a text has the form of one.
bool is_input_hash(const std::string& text);

/// What to tell where the input has another hash than the edit says.
std::string sentence_of_other_input(const std::string& input);

}  // namespace sinew::document
