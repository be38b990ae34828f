/// sinew-samples FOLDER [NAME...]: makes the sample shapes and their edits. What is made is the same every time.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <iostream>
#include <vector>

#include "apps/samples/dense.h"
#include "apps/samples/edits.h"
#include "apps/samples/meshes.h"
#include "apps/samples/scanner.h"
#include "apps/samples/splats.h"
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

struct Sample {
  const char* name;
  const char* extension;
  Shape (*make)();  ///< null for the one that is written block by block
  const char* help;
};

constexpr Sample samples[] = {
    {"scan", "ply", [] { return sample_animal(scan_points); }, "a giraffe, scanned from 22 places"},
    {"plane", "obj", bumpy_plane, "a bumpy plane, one side lifted"},
    {"bar", "obj", bar, "a bar, twisted"},
    {"cactus", "obj", cactus, "a cactus, bent"},
    {"cylinder", "obj", cylinder, "a cylinder, bent"},
    {"splats", "ply", [] { return sample_splats(splat_count); }, "the giraffe as Gaussian splats, its neck bowed"},
    {"large", "ply", nullptr, "the giraffe with --points points; only where it is named"},
};

void save_text(const std::string& path, const std::string& text) {
  io::save_bytes(path, std::as_bytes(std::span(text)), true);
}

void make(const Sample& sample, const Options& options) {
  const std::string path = (std::filesystem::path(options.folder) / sample.name).string();
  const std::string file = path + "." + sample.extension;
  if (sample.make == nullptr) {
    write_dense_animal(file, options.points, options.normals);
  } else {
    io::write(file, sample.make(), true);
    save_text(path + ".edit.json", edit_of(sample.name));
  }
  std::cerr << file << '\n';
}

void make_all(const Options& options) {
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw file_error(options.folder, "a folder that can be made", error.message());
  for (const Sample& sample : samples) {
    const bool named = std::find(options.names.begin(), options.names.end(), sample.name) != options.names.end();
    if (named || (options.names.empty() && sample.make != nullptr)) make(sample, options);
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
  app.add_option("NAME", options.names, "what to make; without a name all but large")->check(CLI::IsMember(names));
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
