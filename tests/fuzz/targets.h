#pragma once
/// What each fuzz target does with its bytes; the tests do the same with the seeds.

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/io/byte_source.h"
#include "engine/io/bytes.h"
#include "engine/io/control_points.h"
#include "engine/io/gltf.h"
#include "engine/io/marker_csv.h"
#include "engine/io/mdd.h"
#include "engine/io/pc2.h"
#include "engine/io/ply.h"
#include "engine/io/scan_set.h"
#include "engine/io/stl.h"
#include "engine/io/tetgen.h"
#include "engine/io/values.h"
#include "engine/io/vtk_array.h"
#include "engine/io/vtp.h"
#include "tests/fuzz/fuzz_format.h"

namespace sinew::io {

/// A new PLY file of `shape` holds its coordinates in the shape's type, and each value of its attributes.
inline void check_new_ply(Shape shape) {
  shape.content = nullptr;
  WriteReport report;
  const Shape again = read_ply("new", write_ply("new", shape, report), {});
  CHECK(again.size() == shape.size() && again.faces.points == shape.faces.points);
  CHECK(again.position_type == shape.position_type);
  for (std::size_t i = 0; i < shape.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double x = shape.positions[i][c] + shape.origin[c], y = again.positions[i][c];
      const double expected = shape.position_type == Type::Float32 ? static_cast<double>(static_cast<float>(x)) : x;
      CHECK(y == expected || (std::isnan(y) && std::isnan(expected)), y, expected);
    }
  CHECK(again.attributes.size() == shape.attributes.size() && report.lost.empty());
  for (std::size_t a = 0; a < shape.attributes.size(); ++a)
    CHECK(again.attributes[a].values == shape.attributes[a].values, shape.attributes[a].name);
}

inline void fuzz_ply(std::span<const std::uint8_t> data) {
  fuzz_format(read_ply, write_ply, data);
  const auto bytes = std::as_bytes(data);
  try {
    Shape shape = read_ply("fuzz", {bytes.begin(), bytes.end()}, {});
    set_origin(shape);
    check_new_ply(std::move(shape));
  } catch (const InputError&) {
  }
}

inline void fuzz_stl(std::span<const std::uint8_t> data) {
  fuzz_format(read_stl, write_stl, data);
}

/// As what the file was: a PolyData or an UnstructuredGrid.
inline std::vector<std::byte> write_vtk_xml(const std::string& path, const Shape& shape, WriteReport& report) {
  const auto* content = dynamic_cast<const VtkContent*>(shape.content.get());
  const bool grid = content && content->form == VtkContent::Form::UnstructuredGrid;
  return grid ? write_vtu(path, shape, report) : write_vtp(path, shape, report);
}

inline void fuzz_vtp(std::span<const std::uint8_t> data) {
  fuzz_format(read_vtp, write_vtk_xml, data);
}

/// The three files of TetGen in one: behind a line "%ele" the .ele, behind "%face" the .face.
inline void fuzz_tetgen(std::span<const std::uint8_t> data) {
  const std::string_view text(reinterpret_cast<const char*>(data.data()), data.size());
  const auto part = [&text](std::string_view mark) -> std::optional<NamedBytes> {
    const std::size_t at = text.find(mark);
    if (at == std::string_view::npos) return std::nullopt;
    const std::string_view own = text.substr(at + mark.size(), text.find("\n%", at + mark.size()) - at - mark.size());
    const auto bytes = std::as_bytes(std::span(own));
    return NamedBytes{"fuzz", {bytes.begin(), bytes.end()}};
  };
  const auto node = std::as_bytes(std::span(text.substr(0, text.find("\n%"))));
  try {
    const std::optional<NamedBytes> ele = part("\n%ele"), face = part("\n%face");
    Shape shape = read_tetgen({{"fuzz", {node.begin(), node.end()}}, ele, face}, {});
    check_sound(shape);
    set_origin(shape);
    WriteReport report;
    CHECK(std::ranges::equal(write_node("fuzz.node", shape, report), node));
    const std::vector<NamedBytes> files = beside_node("fuzz.node", shape);
    CHECK(files.size() == std::size_t{ele.has_value()} + std::size_t{face.has_value()}, files.size());
    if (ele) CHECK(files.front().bytes == ele->bytes);
    if (face) CHECK(files.back().bytes == face->bytes);
    shape.content = nullptr;
    const std::vector<NamedBytes> others = beside_ele("new.ele", shape);
    const NamedBytes tets{"new.ele", write_ele("new.ele", shape, report)};
    const Shape again =
        read_tetgen({others.front(), tets, others.size() > 1 ? std::optional(others.back()) : std::nullopt}, {});
    check_sound(again);
    CHECK(again.size() == shape.size() && again.tets == shape.tets && again.faces.points == shape.faces.points);
    CHECK(again.attributes.size() == shape.attributes.size());
  } catch (const InputError&) {
  }
}

/// A folder with two scans, "a.ply" and "b.obj", for the .conf files of the fuzzer; made anew for each process.
inline const std::string& scan_folder() {
  static const std::string folder = [] {
    std::string name = (std::filesystem::temp_directory_path() / "sinew-fuzz-XXXXXX").string();
    CHECK(mkdtemp(name.data()) != nullptr);
    std::ofstream(name + "/a.ply") << "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                                      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                                      "end_header\n1 2 3 0 0 1\n4 5 6 0 1 0\n";
    std::ofstream(name + "/b.obj") << "v 0.5 0.25 2\nvn 1 0 0\nv 1 1 1\nvn 0 0 1\nv 3 4 5.5\nvn 0 1 0\n";
    return name;
  }();
  return folder;
}

/// Scans that were not bent come back byte for byte, with the .conf, and can be bent and read again.
inline void fuzz_scan_set(std::span<const std::uint8_t> data) {
  const auto bytes = std::as_bytes(data);
  try {
    Shape shape = read_scan_set(scan_folder() + "/fuzz.conf", {bytes.begin(), bytes.end()}, {});
    check_sound(shape);
    set_origin(shape);
    WriteReport report;
    std::vector<NamedBytes> files = scan_set_files(shape, "", report);
    CHECK(files.size() == shape.parts.size() + 1, files.size(), shape.parts.size());
    for (std::size_t i = 0; i < shape.parts.size(); ++i)
      CHECK(files[i].bytes == load_bytes(scan_folder() + "/" + shape.parts[i].path), files[i].name);
    CHECK(std::equal(files.back().bytes.begin(), files.back().bytes.end(), bytes.begin(), bytes.end()));
    for (Vec3& p : shape.positions) p += Vec3(1, 2, 3);
    files = scan_set_files(shape, "", report);
    for (std::size_t i = 0; i < shape.parts.size(); ++i)
      CHECK(format_of(files[i].name).read("again", files[i].bytes, {}).size() == shape.parts[i].count, i);
  } catch (const InputError&) {
  }
}

/// A file of many frames: each of the first is a sound shape, can be written as a file of one frame, and read again
/// with as many points. `exact`: coordinates have the same bits then.
inline void fuzz_frames(Sequence (*open)(std::shared_ptr<const ByteSource>, const ReadOptions&), ReadFunction read,
                        WriteFunction write, bool exact, std::span<const std::uint8_t> data) {
  const auto bytes = std::as_bytes(data);
  try {
    const Sequence sequence = open(bytes_in_memory("fuzz", {bytes.begin(), bytes.end()}), {});
    CHECK(!sequence.frames.empty() && std::is_sorted(sequence.frames.begin(), sequence.frames.end()));
    CHECK(sequence.rate > 0 && std::isfinite(sequence.rate), sequence.rate);
    for (std::size_t i = 0; i < std::min<std::size_t>(sequence.frames.size(), 8); ++i) {
      const auto shape = sequence.load(sequence.frames[i]);
      check_sound(*shape);
      const Shape again = read_again(read, write, *shape);
      for (std::size_t p = 0; exact && p < shape->size(); ++p)
        for (int c = 0; c < 3; ++c)
          CHECK(same_coordinate(again.positions[p][c] + again.origin[c], shape->origin[c], shape->positions[p][c]), p,
                c);
    }
  } catch (const InputError&) {
  }
}

inline void fuzz_pc2(std::span<const std::uint8_t> data) {
  fuzz_frames(open_pc2, read_pc2, write_pc2, true, data);
}

inline void fuzz_mdd(std::span<const std::uint8_t> data) {
  fuzz_frames(open_mdd, read_mdd, write_mdd, true, data);
}

inline void fuzz_gltf(std::span<const std::uint8_t> data) {
  fuzz_frames(open_gltf, read_gltf, write_gltf, false, data);
}

inline void check_sound(const Trajectories& motion) {
  CHECK(!motion.names.empty() && !motion.frames.empty() && motion.rate >= 0, motion.rate);
  for (const auto& frame : motion.frames) {
    CHECK(frame.size() == motion.names.size(), frame.size());
    for (const Vec3& p : frame) CHECK(p.allFinite() || p.array().isNaN().all());
  }
  const auto points = static_cast<int>(motion.names.size());
  for (const auto& [parent, child] : motion.bones)
    CHECK(0 <= parent && parent < child && child < points, parent, child);
  CHECK(motion.transforms.size() == (motion.rest.empty() ? 0 : motion.frames.size()));
  for (const auto& frame : motion.transforms) CHECK(frame.size() == motion.names.size(), frame.size());
}

/// Motion capture: sound, every gap bridged or released, and as CSV of markers the same numbers again.
inline void fuzz_motion(Trajectories (*read)(const std::string&, std::span<const std::byte>),
                        std::span<const std::uint8_t> data) {
  try {
    Trajectories motion = read("fuzz", std::as_bytes(data));
    check_sound(motion);
    const GapReport gaps = gaps_of(motion);
    WriteReport lost;
    const Trajectories again = read_marker_csv("again", write_marker_csv(motion, lost));
    check_sound(again);
    CHECK(again.frames.size() == motion.frames.size() && again.names.size() == motion.names.size());
    for (std::size_t f = 0; f < motion.frames.size(); ++f)
      for (std::size_t p = 0; p < motion.names.size(); ++p) {
        const Vec3 &a = motion.frames[f][p], &b = again.frames[f][p];
        CHECK(a == b || (!seen(a) && !seen(b)), f, p);
      }
    const GapReport bridged = bridge_gaps(motion, 5);
    CHECK(bridged.bridged + bridged.released == gaps.released, bridged.bridged, gaps.released);
    CHECK(bridged.sentences().size() == gaps.sentences().size());
  } catch (const InputError&) {
  }
}

/// Control points: finite, each by its number or its place.
inline void fuzz_control(std::span<const std::uint8_t> data) {
  try {
    const std::vector<ControlPoint> points = read_control_points("fuzz", std::as_bytes(data));
    CHECK(!points.empty());
    for (const ControlPoint& point : points) {
      CHECK(point.to.allFinite() && point.at.allFinite());
      CHECK(point.point.value_or(0) < ~Index{0});
      CHECK(point.point.has_value() == points.front().point.has_value());
    }
  } catch (const InputError&) {
  }
}

}  // namespace sinew::io
