#include "engine/io/point_names.h"

#include <algorithm>

namespace sinew::io {

namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_any(const std::string& name, std::initializer_list<const char*> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// "id", "Ids", "particleId", "point_id", "PointIds"; not "fluid" or "pyramids".
bool is_id(const std::string& name, const std::string& key) {
  if (is_any(key, {"id", "ids"})) return true;
  const std::size_t length = key.ends_with("ids") ? 3 : key.ends_with("id") ? 2 : 0;
  if (length == 0) return false;
  const char first = name[name.size() - length], before = name[name.size() - length - 1];
  return before == '_' || before == ' ' || (first == 'I' && before == lower(before));
}

}  // namespace

Attribute named_attribute(const std::string& name, int components, Kind otherwise, UniqueNames& unique) {
  std::string key = name;
  std::transform(key.begin(), key.end(), key.begin(), lower);
  Attribute out;
  out.components = components;
  out.name = name;
  out.kind = otherwise;
  const auto take = [&](const char* known, Kind kind, std::vector<std::string> fields) {
    if (!unique.take(known)) return;
    out.name = known;
    out.kind = kind;
    out.fields = std::move(fields);
    out.fields.resize(static_cast<std::size_t>(components));
  };
  if (components == 3 && is_any(key, {"v", "vel", "velocity", "velocities"})) {
    take("velocity", Kind::Velocity, {"vx", "vy", "vz"});
    out.kind = Kind::Velocity;
  } else if (components == 3 && (otherwise == Kind::Normal || is_any(key, {"n", "normal", "normals"}))) {
    take("normal", Kind::Normal, {"nx", "ny", "nz"});
    out.kind = Kind::Normal;
  } else if ((components == 3 || components == 4) &&
             (otherwise == Kind::Color || is_any(key, {"cd", "color", "colors", "colour", "rgb", "rgba"}))) {
    take("color", Kind::Color, {"red", "green", "blue", "alpha"});
    out.kind = Kind::Color;
  } else if (components == 1 && is_id(name, key)) {
    out.kind = Kind::Id;
  }
  if (!out.fields.empty()) return out;
  out.name = unique.add(name);
  if (components == 1) out.fields = {out.name};
  for (int c = 0; components > 1 && c < components; ++c) out.fields.push_back(out.name + "_" + std::to_string(c));
  return out;
}

}  // namespace sinew::io
