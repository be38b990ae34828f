#include "engine/geometry/deformer.h"

namespace sinew {

const char* name_of(Status status) {
  static constexpr const char* names[] = {"converged", "max_iterations", "stalled", "stopped", "failed"};
  return names[static_cast<int>(status)];
}

double value_of(const Settings& settings, std::span<const Setting> described, const std::string& name) {
  for (const auto& [key, value] : settings)
    if (key == name) return value;
  for (const Setting& setting : described)
    if (setting.name == name) return setting.standard;
  CHECK(false, name);
}

}  // namespace sinew
