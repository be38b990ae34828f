#pragma once
/// What the reader and the writer of scan sets share.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::io {

struct ScanSetContent : FileContent {
  struct Name {
    std::size_t begin = 0, size = 0;
  };
  std::vector<std::byte> bytes;                     ///< of the .conf
  std::string name;                                 ///< of the .conf, without folder
  std::vector<Name> names;                          ///< where the .conf names the scan of each part
  std::vector<std::shared_ptr<const Shape>> scans;  ///< of each part, in its own frame, as read
};

Vec3 to_world(const Part& part, const Vec3& own);
Vec3 to_own(const Part& part, const Vec3& world);

/// Replaces normals, vectors and points by their images; leaves attributes of other kinds.
void transform(Attribute& attribute, const std::function<Vec3(const Vec3&)>& map);

/// The attribute of a scan as the set has it.
Attribute in_world(const Part& part, Attribute attribute);

}  // namespace sinew::io
