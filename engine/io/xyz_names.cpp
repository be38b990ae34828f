#include "engine/io/xyz_names.h"

#include <algorithm>

#include "engine/io/text_patch.h"
#include "engine/io/xyz_row.h"

namespace sinew::io {

namespace {

/// The groups that are known by the names of their columns: all of the first `needed` names, or the group is not there.
struct NamedGroup {
  const char* name;
  Kind kind;
  std::size_t needed;
  std::vector<const char*> columns;
};

const std::vector<NamedGroup>& named_groups() {
  static const std::vector<NamedGroup> groups{
      {"position", Kind::Point, 3, {"x", "y", "z"}},
      {"position", Kind::Point, 3, {"points:0", "points:1", "points:2"}},
      {"normal", Kind::Normal, 3, {"nx", "ny", "nz"}},
      {"normal", Kind::Normal, 3, {"normal_x", "normal_y", "normal_z"}},
      {"color", Kind::Color, 3, {"r", "g", "b", "a"}},
      {"color", Kind::Color, 3, {"red", "green", "blue", "alpha"}},
      {"color", Kind::Color, 3, {"rf", "gf", "bf"}},
      {"velocity", Kind::Velocity, 3, {"vx", "vy", "vz"}},
      {"velocity", Kind::Velocity, 3, {"velocity_x", "velocity_y", "velocity_z"}},
      {"velocity", Kind::Velocity, 3, {"velocity:0", "velocity:1", "velocity:2"}},
  };
  return groups;
}

std::vector<std::string> keys_of(const std::vector<std::string>& names) {
  std::vector<std::string> keys(names.size());
  std::transform(names.begin(), names.end(), keys.begin(), xyz_lower);
  return keys;
}

/// The columns of a group as far as they are there.
std::vector<std::size_t> columns_of(const NamedGroup& known, const std::vector<std::string>& keys) {
  std::vector<std::size_t> columns;
  for (const char* key : known.columns) {
    const auto at = std::find(keys.begin(), keys.end(), key);
    if (at == keys.end()) break;
    columns.push_back(static_cast<std::size_t>(at - keys.begin()));
  }
  return columns;
}

}  // namespace

std::string xyz_lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

bool has_xyz_group(const std::vector<XyzGroup>& groups, const std::string& name) {
  return std::any_of(groups.begin(), groups.end(), [&](const XyzGroup& group) { return group.name == name; });
}

bool has_xyz_position(const std::vector<std::string>& names) {
  const std::vector<std::string> keys = keys_of(names);
  return std::any_of(named_groups().begin(), named_groups().end(), [&](const NamedGroup& known) {
    return known.kind == Kind::Point && columns_of(known, keys).size() == known.needed;
  });
}

std::vector<XyzGroup> xyz_groups(const std::vector<std::string>& names) {
  const std::vector<std::string> keys = keys_of(names);
  std::vector<bool> taken(names.size(), false);
  std::vector<XyzGroup> groups;
  for (const NamedGroup& known : named_groups()) {
    const XyzGroup group{known.name, known.kind, columns_of(known, keys)};
    if (group.columns.size() < known.needed || has_xyz_group(groups, known.name)) continue;
    for (const std::size_t c : group.columns) taken[c] = true;
    groups.push_back(group);
  }
  UniqueNames unique;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (taken[c]) continue;
    const bool id = keys[c] == "label" || keys[c] == "class" || keys[c] == "classification" || keys[c] == "id";
    groups.push_back({unique.add(names[c]), id ? Kind::Id : Kind::Scalar, {c}});
  }
  return groups;
}

std::vector<std::vector<std::string>> split_xyz_names(std::string_view line) {
  std::vector<std::vector<std::string>> ways(2);
  XyzFields fields(line);
  for (std::string_view field; fields.next(field) && ways[0].size() <= most_xyz_columns;) ways[0].emplace_back(field);
  const std::string_view blanks = " \t\v\f\r";
  while (line.find_first_not_of(blanks) != std::string_view::npos && ways[1].size() <= most_xyz_columns) {
    line.remove_prefix(line.find_first_not_of(blanks));
    const std::size_t quote = line.front() == '"' ? line.find('"', 1) : std::string_view::npos;
    const std::size_t end =
        std::min(line.find_first_of(",;\t", quote == std::string_view::npos ? 0 : quote), line.size());
    std::string_view name = line.substr(0, end);
    name = name.substr(0, name.find_last_not_of(blanks) + 1);
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    ways[1].emplace_back(name);
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return ways;
}

}  // namespace sinew::io
