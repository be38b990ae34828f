#include "apps/editor/portraits.h"

#include <fmt/format.h>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "apps/editor/coloring.h"
#include "apps/editor/normals.h"
#include "apps/editor/session.h"
#include "apps/editor/view.h"
#include "engine/geometry/error.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "engine/gpu/offscreen.h"
#include "engine/gpu/paths.h"
#include "engine/gpu/png.h"
#include "engine/gpu/splats.h"
#include "engine/io/io.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

fs::path pictures_folder() {
  // Relative values of the variable are to be ignored [XDG Base Directory Specification].
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') return fs::path(cache) / "sinew" / "pictures";
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/') return fs::path(home) / ".cache" / "sinew" / "pictures";
  return {};
}

std::shared_ptr<const Shape> bent_shape(const Portrait& portrait) {
  std::shared_ptr<const Shape> shape = portrait.input;
  for (const document::LayerResult& layer : portrait.layers)
    shape = std::make_shared<const Shape>(skin(*shape, *layer.weights, *layer.pose));
  return shape;
}

/// The device's buffers and the scene that shows them.
struct Drawn {
  gpu::Points points;
  gpu::Triangles triangles;
  gpu::Splats splats;
  gpu::Scene scene;
  Bounds bounds;
};

void fill(const gpu::Device& device, const Portrait& portrait, Drawn& out) {
  const std::shared_ptr<const Shape> shape = bent_shape(portrait);
  out.scene.look = portrait.look;
  out.scene.up = portrait.up;
  out.scene.ground = gpu::ground_below(bounds_of(portrait.input->positions), portrait.up);
  out.scene.ground.show = portrait.ground;
  out.bounds = bounds_of(shape->positions);
  const std::vector<std::uint32_t> triangles = triangles_of(shape->faces);
  if (triangles.empty() && gpu::holds_splats(*shape)) {
    out.splats = gpu::create_splats(*shape);
    if (!portrait.own_colors)
      for (std::size_t i = 0; i < out.splats.count; ++i) {
        const gpu::PointColor& c = portrait.colors[i];
        gpu::tint(out.splats, i, Eigen::Vector3i(c.r, c.g, c.b).cast<float>() / 255, 1);
      }
    out.scene.splats.push_back({&out.splats});
    return;
  }
  out.points = gpu::create_points(device, false, shape->positions, normals_of(*shape, triangles));
  gpu::set_colors(out.points, portrait.colors);
  if (triangles.empty()) {
    out.scene.clouds.push_back({.points = &out.points, .size = portrait.point_size});
    return;
  }
  out.triangles = gpu::create_triangles(device, triangles);
  out.scene.meshes.push_back({.points = &out.points, .triangles = &out.triangles});
}

}  // namespace

Portrait portrait_of(const Session& session, const View& view, const Coloring& coloring, const gpu::Look& look) {
  Portrait out;
  out.input = session.input();
  for (const document::LayerResult& layer : session.shown()) {
    if (layer.weights == nullptr || layer.pose == nullptr) continue;
    document::LayerResult used;
    used.weights = layer.weights;
    used.pose = layer.pose;
    out.layers.push_back(std::move(used));
  }
  out.colors = coloring.colors;
  out.colors.resize(out.input->size());
  out.own_colors = view.color_by.empty() && !view.heat;
  out.look = look;
  out.up = view.up;
  out.ground = view.show_ground;
  out.point_size = view.point_size;
  return out;
}

void draw_portrait(const Portrait& portrait, const Tell& tell) {
  gpu::DeviceOptions options;
  options.validation = portrait.validation;
  std::shared_ptr<gpu::Messages> messages;
  {
    const std::unique_ptr<gpu::Device> device = gpu::create_device(options);
    messages = device->messages;
    gpu::Paths paths = gpu::measure_paths(*device);
    const gpu::RendererHandle renderer = gpu::create_renderer(*device, paths, gpu::offscreen_format);
    const gpu::Offscreen offscreen = gpu::create_offscreen(
        *device, {static_cast<std::uint32_t>(portrait.width), static_cast<std::uint32_t>(portrait.height)});
    Drawn drawn;
    fill(*device, portrait, drawn);
    const double count = static_cast<double>(portrait.pictures.size());
    double done = 0;
    for (const auto& [camera, path] : portrait.pictures) {
      if (!tell(done++ / count)) throw io::Cancelled{};
      drawn.scene.camera = camera;
      gpu::fit_depth(drawn.scene.camera, drawn.bounds);
      const gpu::Picture picture = gpu::render_picture(*device, *renderer, offscreen, drawn.scene);
      if (const fs::path folder = fs::path(path).parent_path(); !folder.empty()) fs::create_directories(folder);
      io::save_bytes(path, gpu::png_bytes(picture), true);
    }
  }
  for (const std::string& message : messages->take()) throw InputError("validation: " + message);
}

std::string picture_path(const std::string& file) {
  const fs::path folder = pictures_folder();
  if (folder.empty()) return {};
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a [Fowler, Noll, Vo]
  for (const char c : file) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return (folder / fmt::format("{:016x}.png", hash)).string();
}

void forget_pictures(const std::vector<std::string>& but_of) {
  std::set<std::string> kept;
  for (const std::string& file : but_of) kept.insert(picture_path(file));
  std::error_code error;
  std::vector<fs::path> gone;
  for (fs::directory_iterator it(pictures_folder(), error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".png" && !kept.contains(it->path().string())) gone.push_back(it->path());
  for (const fs::path& path : gone) fs::remove(path, error);
}

}  // namespace sinew::editor
