#pragma once
/// What a file of some name would not hold of a shape: told before it is written.

#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::editor {

/// A sentence each: what the format loses, as its writer says of this shape, and how many frames of `sequence` the file
/// would hold; `shape` is that of `frame`. Empty where all is written, and for a name that no format knows. Writes
/// nothing but a temporary file for formats of many frames.
std::vector<std::string> export_notes(const std::string& path, const Shape& shape, const Sequence& sequence, int frame);

}  // namespace sinew::editor
