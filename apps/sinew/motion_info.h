#pragma once
/// What `sinew info` shows of motion capture.

#include <string>

#include "engine/document/json.h"

namespace sinew::app {

/// A file of motion by its extension, of "-" by `from`. CSV is taken for points.
bool is_motion(const std::string& path, const std::string& from);

/// Reads the file and prints it, or adds it as an object to `json`. Throws InputError.
void show_motion(const std::string& path, const std::string& from, document::JsonWriter* json);

}  // namespace sinew::app
