#include "engine/io/io.h"

#include <algorithm>
#include <filesystem>

#include "engine/geometry/error.h"
#include "engine/io/bgeo.h"
#include "engine/io/bytes.h"
#include "engine/io/gltf.h"
#include "engine/io/gmsh.h"
#include "engine/io/input_file.h"
#include "engine/io/mdd.h"
#include "engine/io/medit.h"
#include "engine/io/obj.h"
#include "engine/io/off.h"
#include "engine/io/output_file.h"
#include "engine/io/pc2.h"
#include "engine/io/pcd.h"
#include "engine/io/ply.h"
#include "engine/io/scan_set.h"
#include "engine/io/stl.h"
#include "engine/io/tetgen.h"
#include "engine/io/text_patch.h"
#include "engine/io/vtk.h"
#include "engine/io/vtp.h"
#include "engine/io/xyz.h"

namespace sinew::io {

namespace {

/// A format that holds tets.
Format solid(Format format) {
  format.tets = true;
  return format;
}

/// A format of several files that holds tets.
Format solid(Format format, std::vector<NamedBytes> (*write_beside)(const std::string&, const Shape&)) {
  format.write_beside = write_beside;
  return solid(std::move(format));
}

/// A row is a format: its reader and writer are all that is known of it here.
const std::vector<Format>& table() {
  static const std::vector<Format> rows{
      {"PLY", {"ply"}, "ascii and binary; points, faces, strips; everything else is kept", read_ply, write_ply},
      {"OBJ", {"obj"}, "points, colours, normals, faces; everything else is kept", read_obj, write_obj},
      {"OFF", {"off"}, "points, colours, normals, faces; everything else is kept", read_off, write_off},
      {"XYZ", {"xyz", "asc", "txt", "pts"}, "rows of numbers; columns by name or by value", read_xyz, write_xyz},
      {"CSV", {"csv"}, "rows of numbers with commas; columns by name or by value", read_csv, write_csv},
      {"PCD", {"pcd"}, "ascii, binary, compressed; all fields; everything else is kept", read_pcd, write_pcd},
      {"STL", {"stl"}, "ascii and binary; a soup of triangles, each with its normal", read_stl, write_stl},
      {"bgeo",
       {"bgeo"},
       "classic (BgeoV 5); points, attributes, polygons; everything else is kept",
       read_bgeo,
       write_bgeo},
      solid({"VTK",
             {"vtk"},
             "legacy, ascii and binary; points, data of points, polygons, tets; everything else is kept",
             read_vtk,
             write_vtk}),
      {"VTP",
       {"vtp"},
       "XML, not compressed; points, data of points, polygons; everything else is kept",
       read_vtp,
       write_vtp},
      solid({"VTU",
             {"vtu"},
             "XML, not compressed; points, data of points, polygons, tets; everything else is kept",
             read_vtp,
             write_vtu}),
      solid({"Medit",
             {"mesh"},
             "text; points, faces, tets, labels of points; everything else is kept",
             read_medit,
             write_medit}),
      solid({"TetGen nodes", {"node"}, "text; points, with the .ele and .face beside it", read_node, write_node},
            beside_node),
      solid({"TetGen", {"ele"}, "text; tets, with the .node and .face beside it; all is kept", read_ele, write_ele},
            beside_ele),
      solid({"Gmsh",
             {"msh"},
             "text of versions 1 and 2; points, faces, tets; everything else is kept",
             read_gmsh,
             write_gmsh}),
      {"Scan set", {"conf"}, "scans in files of their own and the pose of each, as Stanford's", read_scan_set, nullptr},
      {"PC2", {"pc2"}, "frames of points, with their start and step", read_pc2, write_pc2, open_pc2, create_pc2},
      {"MDD", {"mdd"}, "frames of points, with their times", read_mdd, write_mdd, open_mdd, create_mdd},
      {"glTF", {"gltf"}, "a mesh and its frames as morph targets", read_gltf, write_gltf, open_gltf, create_gltf},
      {"glTF binary", {"glb"}, "as glTF, in one binary file", read_gltf, write_glb, open_gltf, create_glb},
  };
  return rows;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

/// Several files, all of them ready before the first is written.
void save_files(const std::filesystem::path& folder, const std::vector<NamedBytes>& files, bool force) {
  for (const NamedBytes& file : files) refuse_existing((folder / file.name).string(), force);
  for (const NamedBytes& file : files) {
    const std::filesystem::path path = folder / file.name;
    std::error_code error;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
    if (error)
      throw file_error(path.parent_path().string(), "a folder that can be made", sinew::quoted(error.message()));
    save_bytes(path.string(), file.bytes, force);
  }
}

/// The scans beside the .conf.
WriteReport write_set(const std::string& path, const Shape& shape, bool force) {
  if (path == "-") throw file_error(path, "a folder for the files of a scan set", "standard output");
  if (shape.parts.empty()) throw file_error(path, "a scan set to write", std::string("a ") + representation(shape));
  const std::filesystem::path p(path);
  WriteReport report;
  save_files(p.parent_path(), scan_set_files(shape, p.filename().string(), report), force);
  return report;
}

}  // namespace

std::span<const Format> formats() {
  return table();
}

const Format& format_of(const std::string& path) {
  std::string extension = lower(std::filesystem::path(path).extension().string());
  if (!extension.empty()) extension.erase(0, 1);
  std::string known;
  for (const Format& format : formats())
    for (const std::string& e : format.extensions) {
      if (e == extension) return format;
      known += (known.empty() ? "." : ", .") + e;
    }
  throw file_error(path, "a name that ends in " + known,
                   extension.empty() ? "no extension" : sinew::quoted("." + extension));
}

const Format& format_of(const std::string& path, const std::string& as) {
  if (path != "-") return format_of(path);
  if (as.empty()) throw file_error("-", "the format of the stream, by an extension", "none");
  return format_of("-." + as);
}

std::vector<std::byte> load_bytes(const std::string& path) {
  InputFile in(path);
  // One byte more than the file has: its end is seen without another buffer.
  std::vector<std::byte> bytes(static_cast<std::size_t>(in.size().value_or(1 << 20)) + 1);
  std::size_t size = 0;
  while ((size += in.read(std::span(bytes).subspan(size))) == bytes.size()) bytes.resize(2 * size);
  bytes.resize(size);
  return bytes;
}

void save_bytes(const std::string& path, std::span<const std::byte> bytes, bool force) {
  OutputFile out(path, force);
  out.write(bytes);
  out.commit();
}

void report_lost_tets(const Format& format, std::size_t tets, WriteReport& report) {
  if (tets > 0 && !format.tets)
    report.lost.push_back(format.name + " cannot hold " + counted(tets, "tet", "tets") + ".");
}

std::vector<NamedBytes> files_of(const Format& format, const std::string& path, const Shape& shape,
                                 WriteReport& report) {
  std::vector<NamedBytes> files;
  files.push_back({path, format.write(path, shape, report)});
  report_lost_tets(format, shape.tets.size(), report);
  if (format.write_beside == nullptr) return files;
  for (NamedBytes& file : format.write_beside(path, shape)) files.push_back(std::move(file));
  if (path == "-" && files.size() > 1)
    throw file_error(path, "a name for the " + std::to_string(files.size()) + " files of " + format.name,
                     "standard output");
  return files;
}

std::shared_ptr<const Shape> read(const std::string& path, const ReadOptions& options, const std::string& as) {
  const Format& format = format_of(path, as);
  std::vector<std::byte> bytes = load_bytes(path);
  refuse_lfs_pointer(path, bytes, format.name);
  auto shape = std::make_shared<Shape>(format.read(path, std::move(bytes), options));
  set_origin(*shape);
  return shape;
}

WriteReport write(const std::string& path, const Shape& shape, bool force, const std::string& as) {
  const Format& format = format_of(path, as);
  if (format.write == nullptr) return write_set(path, shape, force);
  refuse_existing(path, force);
  WriteReport report;
  const std::vector<NamedBytes> files = files_of(format, path, shape, report);
  for (const NamedBytes& file : files) refuse_existing(file.name, force);
  for (const NamedBytes& file : files) save_bytes(file.name, file.bytes, force);
  return report;
}

WriteReport write_parts(const std::string& folder, const Shape& shape, bool force) {
  if (shape.parts.empty()) throw file_error(folder, "a scan set to write", std::string("a ") + representation(shape));
  WriteReport report;
  save_files(folder, scan_set_files(shape, "", report), force);
  return report;
}

}  // namespace sinew::io
