#pragma once
/// What sinew-editing and the test that kills it share.

#include <functional>
#include <string>

#include "engine/document/edit.h"

namespace sinew {

/// Differs, but by chance, where two projects do.
inline std::size_t hash_of(const document::Project& project) {
  return std::hash<std::string>{}(document::edit_text("/edit.json", project));
}

}  // namespace sinew
