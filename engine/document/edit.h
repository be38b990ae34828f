#pragma once
/// EDIT.json, read and written by one description of each struct (interface.md gives the format). A file of the window
/// is the same with "inputs".
///
/// Beyond interface.md: a layer may have "name", "off": true, "nodes" (selections of the points that the method is
/// to build its structure on) and "start" (maps of 12 numbers, the pose to start from); a rotation without "about"
/// turns about the mean of the handle's points; "input_hashes" (input_hash.h) stand beside "inputs".

#include <string>

#include "engine/document/project.h"
#include "engine/document/shared_arrays.h"

namespace sinew::document {

/// Parses the text of an edit. `path` stands in messages; relative paths in the text are taken from its folder.
/// Throws InputError: "PATH:LINE:COL: expected ..., found ...".
/// `arrays`: those of a text that was made with some.
Project parse_edit(const std::string& path, std::string text, const SharedArrays* arrays = nullptr);

/// The text of an edit that parse_edit(path, ...) reads back as `project`.
std::string edit_text(const std::string& path, const Project& project);

/// The same with absolute paths, its long arrays put into `arrays`.
std::string edit_text(const Project& project, SharedArrays& arrays);

/// Reads a file. Throws InputError.
Project read_edit(const std::string& path);

}  // namespace sinew::document
