/// sinew-samples FOLDER [NAME...]: makes the sample shapes and their edits. What is made is the same every time.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <vector>

#include "apps/samples/dense.h"
#include "apps/samples/edits.h"
#include "apps/samples/meshes.h"
#include "apps/samples/poses.h"
#include "apps/samples/scanner.h"
#include "apps/samples/soup.h"
#include "apps/samples/splats.h"
#include "apps/samples/streams.h"
#include "apps/samples/walk.h"
#include "engine/geometry/error.h"
#include "engine/io/io.h"

namespace sinew::samples {
namespace {

constexpr std::size_t scan_points = 79'000;
constexpr std::size_t splat_count = 30'000;

struct Options {
  std::string folder;
  std::vector<std::string> names;
  std::uint64_t points = 1'000'000;
  bool normals = false;
};

/// Writes what belongs to a sample as STEM and an extension; returns the path of its file, of a sequence as a pattern.
using Make = std::string (*)(const std::string& stem, const Options& options);

struct Sample {
  const char* name;
  Make make;
  const char* help;
  bool unasked = true;  ///< made where no name is given
};

void save_text(const std::string& path, const std::string& text) {
  io::save_bytes(path, std::as_bytes(std::span(text)), true);
}

std::string save_still(const std::string& file, const Shape& shape) {
  io::write(file, shape, true);
  return file;
}

/// Writes STEM.0001.EXT, STEM.0002.EXT and so on.
std::string save_frames(const std::string& stem, const std::string& extension, int frames,
                        const std::function<void(int frames, const TakeFrame& take)>& make) {
  make(frames, [&](int frame, const Shape& shape) {
    std::string number = std::to_string(frame);
    number.insert(0, 4 - std::min<std::size_t>(number.size(), 4), '0');
    io::write(stem + "." + number + "." + extension, shape, true);
  });
  return stem + ".####." + extension;
}

std::string save_large(const std::string& stem, const Options& options) {
  write_dense_animal(stem + ".ply", options.points, options.normals);
  return stem + ".ply";
}

std::string save_soup(const std::string& stem, const Options&) {
  save_text(stem + ".mtl", chair_materials());
  save_text(stem + ".obj", chair(std::filesystem::path(stem).filename().string() + ".mtl"));
  return stem + ".obj";
}

/// The poses lie in a folder of their own: what an edit names as examples. One stands turned about beside the foal.
std::string save_foal(const std::string& stem, const Options&) {
  const std::filesystem::path folder = std::filesystem::path(stem).replace_filename("poses");
  std::filesystem::create_directories(folder);
  for (const NamedShape& pose : foal_poses()) save_still((folder / (pose.name + ".obj")).string(), pose.shape);
  save_still(stem + ".turned.obj", foal_turned());
  return save_still(stem + ".obj", foal());
}

std::string save_helix(const std::string& stem, const Options&) {
  save_still(stem + ".wound.obj", helix(3));
  return save_still(stem + ".obj", tube());
}

constexpr int jet_frames = 72, splash_frames = 6;

constexpr Sample samples[] = {
    {"scan",
     [](const std::string& stem, const Options&) { return save_still(stem + ".ply", sample_animal(scan_points)); },
     "a giraffe, scanned from 22 places"},
    {"plane", [](const std::string& stem, const Options&) { return save_still(stem + ".obj", bumpy_plane()); },
     "a bumpy plane, one side lifted"},
    {"slab", [](const std::string& stem, const Options&) { return save_still(stem + ".obj", bumpy_slab(120, 120)); },
     "the bumpy plane as a thin solid, one side lifted"},
    {"bar", [](const std::string& stem, const Options&) { return save_still(stem + ".obj", bar()); }, "a bar, twisted"},
    {"cactus", [](const std::string& stem, const Options&) { return save_still(stem + ".obj", cactus()); },
     "a cactus, bent"},
    {"cylinder", [](const std::string& stem, const Options&) { return save_still(stem + ".obj", cylinder()); },
     "a cylinder, bent"},
    {"splats",
     [](const std::string& stem, const Options&) { return save_still(stem + ".ply", sample_splats(splat_count)); },
     "the giraffe as Gaussian splats, its neck bowed"},
    {"soup", save_soup, "a chair of loose polygons, bowing"},
    {"walk", [](const std::string& stem, const Options&) { return save_frames(stem, "obj", walk_cycle, make_walk); },
     "a foal that walks, 24 frames"},
    {"foal", save_foal, "the foal at rest, and ten poses of it in the folder poses"},
    {"helix", save_helix, "a straight tube, and the same wound up by three turns"},
    {"jet", [](const std::string& stem, const Options&) { return save_frames(stem, "ply", jet_frames, make_jet); },
     "a jet of about 1,000 particles, 72 frames"},
    {"splash",
     [](const std::string& stem, const Options&) { return save_frames(stem, "ply", splash_frames, make_splash); },
     "two dams that break, 200,000 particles, 6 frames; only where it is named", false},
    {"large", save_large, "the giraffe with --points points; only where it is named", false},
};

void make(const Sample& sample, const Options& options) {
  const std::string stem = (std::filesystem::path(options.folder) / sample.name).string();
  const std::string made = sample.make(stem, options);
  if (const std::string edit = edit_of(sample.name); !edit.empty()) save_text(stem + ".edit.json", edit);
  for (const auto& [name, edit] : more_edits_of(sample.name)) save_text(stem + "." + name + ".edit.json", edit);
  std::cerr << made << '\n';
}

void make_all(const Options& options) {
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw file_error(options.folder, "a folder that can be made", error.message());
  for (const Sample& sample : samples) {
    const bool named = std::find(options.names.begin(), options.names.end(), sample.name) != options.names.end();
    if (named || (options.names.empty() && sample.unasked)) make(sample, options);
  }
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Makes sample shapes and their edits in a folder, over what is there by the same names.",
               "sinew-samples");
  app.add_option("FOLDER", options.folder, "made if missing")->required();
  std::vector<std::string> names;
  std::string help;
  for (const Sample& sample : samples) {
    names.emplace_back(sample.name);
    help += std::string("  ") + sample.name + ": " + sample.help + "\n";
  }
  app.add_option("NAME", options.names, "what to make; without a name all but large and splash")
      ->check(CLI::IsMember(names));
  app.add_option("--points", options.points, "of large")->check(CLI::Range(1, 2'000'000'000))->capture_default_str();
  app.add_flag("--normals", options.normals, "of large");
  app.footer("Names:\n" + help);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  make_all(options);
  return 0;
}

}  // namespace
}  // namespace sinew::samples

int main(int argc, char** argv) {
  try {
    return sinew::samples::run(argc, argv);
  } catch (const sinew::InputError& error) {
    std::cerr << "sinew-samples: " << error.what() << '\n';
    return 3;
  } catch (const std::exception& error) {
    std::cerr << "sinew-samples: " << error.what() << '\n';
    return 1;
  }
}
