#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include "engine/geometry/error.h"
#include "engine/io/bytes.h"
#include "engine/io/scan_set.h"
#include "engine/io/scan_set_content.h"
#include "engine/io/text_patch.h"

namespace sinew::io {

namespace {

/// The values of the part's points.
Attribute slice(const Attribute& attribute, const Part& part) {
  Attribute out = attribute;
  const std::byte* begin = attribute.values.data() + part.first * attribute.row_size();
  out.values.assign(begin, begin + part.count * attribute.row_size());
  return out;
}

Attribute in_own_frame(const Part& part, Attribute attribute) {
  Part turn = part;
  if (attribute.kind != Kind::Point) turn.translation.setZero();
  transform(attribute, [&turn](const Vec3& x) { return to_own(turn, x); });
  return attribute;
}

/// The set's values back in the scan's frame; rows that are as they were read keep the bits of `own`.
Attribute moved_attribute(const Part& part, const Attribute& own, const Attribute& now) {
  const Attribute rest = in_world(part, own), back = in_own_frame(part, now);
  Attribute out = own;
  const std::size_t row = own.row_size();
  for (std::size_t i = 0; i < own.count(); ++i)
    if (std::memcmp(rest.values.data() + i * row, now.values.data() + i * row, row) != 0)
      std::memcpy(out.values.data() + i * row, back.values.data() + i * row, row);
  return out;
}

bool same_or_nan(const Vec3& a, const Vec3& b) {
  for (int c = 0; c < 3; ++c)
    if (!(a[c] == b[c] || (std::isnan(a[c]) && std::isnan(b[c])))) return false;
  return true;
}

/// The scan as it was read, with what has changed in the world brought back.
Shape moved_scan(const Shape& shape, const Part& part, const Shape& own) {
  Shape out = own;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Vec3& now = shape.positions[part.first + i];
    Vec3 rest = to_world(part, own.positions[i]);
    rest -= shape.origin;
    if (!same_or_nan(now, rest)) out.positions[i] = to_own(part, now + shape.origin);
  }
  for (const Attribute& attribute : shape.attributes) {
    if (!attribute.per_point()) continue;
    const Attribute now = slice(attribute, part);
    Attribute* mine = out.find(attribute.name);
    if (mine == nullptr) {
      out.attributes.push_back(in_own_frame(part, now));
    } else if (mine->type == now.type && mine->components == now.components && mine->count() == now.count()) {
      *mine = moved_attribute(part, *mine, now);
    }
  }
  return out;
}

/// A scan of a set that was not read from files.
Shape new_scan(const Shape& shape, const Part& part) {
  Shape out;
  out.position_type = shape.position_type;
  for (std::size_t i = 0; i < part.count; ++i)
    out.positions.push_back(to_own(part, shape.positions[part.first + i] + shape.origin));
  for (const Attribute& attribute : shape.attributes)
    if (attribute.per_point()) out.attributes.push_back(in_own_frame(part, slice(attribute, part)));
  std::vector<Index> corners;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    const auto face = shape.faces[f];
    const bool inside = std::all_of(face.begin(), face.end(), [&part](Index corner) {
      return corner >= part.first && corner - part.first < part.count;
    });
    if (!inside) continue;
    corners.assign(face.begin(), face.end());
    for (Index& corner : corners) corner -= part.first;
    out.faces.add(corners);
  }
  for (Tet tet : shape.tets) {
    const bool inside = std::all_of(tet.begin(), tet.end(), [&part](Index corner) {
      return corner >= part.first && corner - part.first < part.count;
    });
    if (!inside) continue;
    for (Index& corner : tet) corner -= part.first;
    out.tets.push_back(tet);
  }
  return out;
}

/// The content of the set, if the parts are still those that were read.
const ScanSetContent* content_of(const Shape& shape) {
  const auto* content = dynamic_cast<const ScanSetContent*>(shape.content.get());
  if (content == nullptr || content->scans.size() != shape.parts.size()) return nullptr;
  for (std::size_t i = 0; i < shape.parts.size(); ++i)
    if (content->scans[i]->size() != shape.parts[i].count) return nullptr;
  return content;
}

/// The path is not one within the folder.
bool leads_out(const std::filesystem::path& path) {
  return path.is_absolute() || path.empty() || *path.begin() == "..";
}

std::string name_within(const std::string& path) {
  const std::filesystem::path p = std::filesystem::path(path).lexically_normal();
  return leads_out(p) ? p.filename().string() : p.string();
}

/// The lines of a set that was not read from files.
std::string new_conf(const Shape& shape, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Part& part = shape.parts[i];
    const Eigen::Quaterniond q(Mat3(part.rotation.transpose()));
    text += "bmesh " + names[i];
    for (const double x :
         {part.translation.x(), part.translation.y(), part.translation.z(), q.x(), q.y(), q.z(), q.w()})
      text += " " + shortest(x);
    text += "\n";
  }
  return text;
}

/// The .conf as it was read, with the names of scans that had to change.
std::vector<std::byte> patched_conf(const ScanSetContent& content, const std::vector<std::string>& names) {
  std::vector<std::byte> out;
  const std::string_view text = as_text(content.bytes);
  std::size_t copied = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto [begin, size] = content.names[i];
    append_text(out, text.substr(copied, begin - copied));
    const std::string_view was = text.substr(begin, size);
    const bool out_of_folder = leads_out(std::filesystem::path(was).lexically_normal());
    append_text(out, out_of_folder ? std::string_view(names[i]) : was);
    copied = begin + size;
  }
  append_text(out, text.substr(copied));
  return out;
}

}  // namespace

std::vector<NamedBytes> scan_set_files(const Shape& shape, const std::string& conf_name, WriteReport& report) {
  if (shape.parts.empty())
    throw file_error(conf_name.empty() ? "a scan set" : conf_name, "a shape of several scans", representation(shape));
  const ScanSetContent* content = content_of(shape);
  std::vector<NamedBytes> files;
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < shape.parts.size(); ++i) {
    const Part& part = shape.parts[i];
    CHECK(std::size_t{part.first} + part.count <= shape.size(), part.first, part.count, shape.size());
    const std::string name = name_within(part.path);
    if (!taken.insert(name).second) throw file_error(name, "another name for each scan to write", "it twice");
    const Shape scan = content != nullptr ? moved_scan(shape, part, *content->scans[i]) : new_scan(shape, part);
    const Format& format = format_of(name);
    if (format.write == nullptr) throw file_error(name, "a format of one scan", format.name);
    WriteReport own;
    for (NamedBytes& file : files_of(format, name, scan, own)) {
      if (file.name != name && !taken.insert(file.name).second)
        throw file_error(file.name, "another name for each scan to write", "it twice");
      files.push_back(std::move(file));
    }
    for (const std::string& sentence : own.lost) report.lost.push_back(fmt::format("{}: {}", name, sentence));
    names.push_back(name);
  }
  const std::string fallback = content != nullptr ? content->name : "scans.conf";
  std::vector<std::byte> conf;
  if (content != nullptr) {
    conf = patched_conf(*content, names);
  } else {
    append_text(conf, new_conf(shape, names));
  }
  files.push_back({conf_name.empty() ? fallback : conf_name, std::move(conf)});
  return files;
}

}  // namespace sinew::io
