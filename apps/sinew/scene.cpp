#include "apps/sinew/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "apps/sinew/command.h"
#include "engine/geometry/error.h"
#include "engine/geometry/topology.h"
#include "engine/io/text.h"
#include "shaders/shared.h"

namespace sinew::app {

namespace {

/// The file's normals, one a point; else those of the faces; else none.
std::vector<Vec3> normals_of(const Shape& shape) {
  for (const Attribute& attribute : shape.attributes) {
    if (attribute.kind != Kind::Normal || !attribute.per_point() || attribute.components != 3) continue;
    std::vector<Vec3> out(shape.size());
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = Vec3(attribute.number(i, 0), attribute.number(i, 1), attribute.number(i, 2));
    return out;
  }
  return shape.faces.empty() ? std::vector<Vec3>{} : vertex_normals(shape);
}

/// The file's colours: bytes as they are, other whole types by their range, floats 0..1.
std::vector<gpu::PointColor> colors_of(const Shape& shape) {
  std::vector<gpu::PointColor> out(shape.size());
  for (const Attribute& a : shape.attributes) {
    if (a.kind != Kind::Color || !a.per_point() || a.components < 3) continue;
    const double scale = a.type == Type::UInt8 ? 1 : a.type == Type::UInt16 ? 1.0 / 257 : 255;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto byte = [&](int c) {
        const double x = a.number(i, c) * scale;
        return static_cast<std::uint8_t>(x > 0 ? std::min(255.0, x + 0.5) : 0);
      };
      out[i] = {byte(0), byte(1), byte(2), 0};
    }
    break;
  }
  return out;
}

/// Six numbers, eye and target in the file's coordinates.
bool parse_eye(const std::string& text, const Vec3& origin, gpu::Camera& camera) {
  double numbers[6];
  std::size_t begin = 0;
  for (int i = 0; i < 6; ++i) {
    const std::size_t comma = text.find(',', begin);
    if ((comma == std::string::npos) != (i == 5)) return false;
    if (!io::parse(text.substr(begin, comma - begin), numbers[i]) || !std::isfinite(numbers[i])) return false;
    begin = comma + 1;
  }
  camera.eye = Vec3(numbers[0], numbers[1], numbers[2]) - origin;
  camera.target = Vec3(numbers[3], numbers[4], numbers[5]) - origin;
  return camera.distance() > 0;
}

constexpr double frame_fill = 0.9;  ///< of the picture, where a named view frames the shape

gpu::Camera camera_of(const View& view, const Bounds& bounds, const Vec3& origin) {
  gpu::Camera camera;
  const gpu::UpAxis up = view.z_up ? gpu::UpAxis::Z : gpu::UpAxis::Y;
  camera.up = gpu::up_vector(up);
  if (gpu::look_from(camera, view.name, up)) {
    gpu::frame_bounds(camera, bounds, static_cast<double>(view.width) / view.height, frame_fill);
    return camera;
  }
  if (!parse_eye(view.name, origin, camera))
    throw UsageError("--view: expected front, back, left, right, top, bottom, iso or ex,ey,ez,tx,ty,tz, found " +
                     sinew::quoted(view.name));
  const Vec3 look = (camera.target - camera.eye).normalized();
  if (look.cross(camera.up).norm() < 1e-6) camera.up = view.z_up ? Vec3(0, 1, 0) : Vec3(0, 0, -1);
  gpu::fit_depth(camera, bounds);
  return camera;
}

/// So wide that neighbours meet where the points cover about a third of the picture as a surface.
double size_of_points(const View& view, std::size_t count) {
  if (view.point_size > 0) return view.point_size;
  const double covered = 0.3 * view.width * view.height;
  return std::clamp(1.4 * std::sqrt(covered / static_cast<double>(std::max<std::size_t>(1, count))), 1.5, 12.0);
}

void mark(std::vector<gpu::PointColor>& colors, std::span<const Index> points, unsigned bit) {
  for (const Index i : points) colors[i].marks = static_cast<std::uint8_t>(colors[i].marks | bit);
}

/// The colours of splats as the camera sees them.
void color_by_splats(const gpu::Splats& splats, const gpu::Camera& camera, std::vector<gpu::PointColor>& colors) {
  for (std::size_t i = 0; i < splats.count; ++i) {
    const Vec3 from_eye = splats.centre + splats.positions[i].cast<double>() - camera.eye;
    const Eigen::Vector3f color = gpu::splat_color(splats, i, from_eye.normalized().cast<float>());
    if (!color.allFinite()) continue;
    const auto byte = [&](int c) { return static_cast<std::uint8_t>(std::lround(255 * std::min(1.0f, color[c]))); };
    colors[i] = {byte(0), byte(1), byte(2), 0};
  }
}

/// Marks as points have them (surface.glsl); a field covers what the file says.
void color_splats(std::span<const gpu::PointColor> colors, bool field, const gpu::Look& look, gpu::Splats& splats) {
  const auto mixed = [&](std::size_t i, int r, int g, int b, float part) {
    gpu::tint(splats, i, Eigen::Vector3i(r, g, b).cast<float>() / 255, part);
  };
  const gpu::Color marks[] = {look.handle, look.fixed, look.rigid};
  for (std::size_t i = 0; i < splats.count; ++i) {
    if (field) mixed(i, colors[i].r, colors[i].g, colors[i].b, 1);
    for (unsigned k = 0; k < 3; ++k)
      if ((colors[i].marks >> k & 1) != 0) mixed(i, marks[k].r, marks[k].g, marks[k].b, gpu::shared::mark_strength);
  }
}

/// Factors of a point that is named several times add up as a product.
void color_stiffness(const Constraints& constraints, std::vector<gpu::PointColor>& colors) {
  std::vector<double> factors(colors.size(), 1);
  for (const Stiff& stiff : constraints.stiffness)
    for (const Index i : stiff.points) factors[i] *= stiff.factor;
  for (std::size_t i = 0; i < colors.size(); ++i) colors[i] = gpu::stiffness_color(colors[i], factors[i]);
}

/// A ball at the mean of where each handle's points are to be.
void add_handles(const document::LayerResult& layer, gpu::Scene& scene) {
  for (const Handle& handle : layer.constraints.handles) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& target : handle.targets) sum += target;
    scene.dots.push_back(gpu::handle_dot(sum / static_cast<double>(handle.targets.size()), scene.look.handle));
  }
}

/// Where a structure is under a pose.
std::vector<Vec3> posed(const Deformer::Structure& structure, const Pose& pose) {
  std::vector<Vec3> out(structure.vertices.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Affine& map = pose[structure.maps[i]];
    out[i] = map.leftCols<3>() * structure.vertices[i] + map.col(3);
  }
  return out;
}

/// Lines and dots of the method's own structure, carried along by the pose; with the energy of each map as the colour
/// of its dots where `energy` has colours.
void add_structure(const Deformer::Structure& structure, const Pose& pose, const Field* energy,
                   std::span<const double> energies, gpu::Scene& scene) {
  const std::vector<Vec3> at = posed(structure, pose);
  for (const auto& [a, b] : structure.edges) {
    gpu::Line line;
    line.from = at[a];
    line.to = at[b];
    line.color = gpu::Color::hex(0xffffff, 0.35);
    line.hidden = 0.4;
    scene.lines.push_back(line);
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    gpu::Dot dot;
    dot.position = at[i];
    dot.color = gpu::Color::hex(0xffffff, 0.9);
    dot.radius = 2;
    dot.hidden = 0.5;
    if (energy != nullptr) {
      const gpu::PointColor color = color_of(*energy, energies[structure.maps[i]]);
      dot.color = {color.r, color.g, color.b, 255};
      dot.radius = 3;
      dot.outline = 1;
    }
    scene.dots.push_back(dot);
  }
}

/// Tets as solids, in the colours of the points that their corners are or are nearest to.
void add_solids(const gpu::Device& device, const document::Evaluation& evaluation,
                std::span<const gpu::PointColor> colors, const std::optional<gpu::Section>& section, DrawnShape& out) {
  for (const document::LayerResult& layer : evaluation.layers) {
    const Deformer::Structure& structure = *layer.structure;
    if (structure.tets.empty()) continue;
    const gpu::SolidFaces faces = gpu::faces_of(structure.vertices, structure.tets, section);
    if (faces.faces.empty()) continue;
    const std::vector<Vec3> at = posed(structure, *layer.pose);
    std::vector<gpu::PointColor> corners(at.size());
    for (std::size_t v = 0; v < corners.size(); ++v)
      if (structure.points[v] < colors.size()) corners[v] = colors[structure.points[v]];
    out.solids.push_back(gpu::create_solid(device, faces, at, corners));
    gpu::Line edge;
    edge.color = gpu::Color::hex(0x14181e, 0.5);
    gpu::add_edges(faces, at, edge, out.scene);
  }
  for (const gpu::SolidItem& solid : out.solids)
    out.scene.meshes.push_back({.points = &solid.points, .triangles = &solid.triangles, .flat = true});
}

/// What `show` asks to see of the edit's layers: marks on points, balls, structures.
void add_layers(const document::Evaluation& evaluation, const std::set<std::string>& show,
                std::vector<gpu::PointColor>& colors, DrawnShape& out) {
  const Field* energy = out.field && out.field->field.name == "energy" ? &*out.field : nullptr;
  for (std::size_t i = 0; i < evaluation.layers.size(); ++i) {
    const document::LayerResult& layer = evaluation.layers[i];
    if (show.contains("fixed") && layer.of_frame) mark(colors, layer.constraints.fixed, gpu::shared::mark_fixed);
    if (show.contains("rigid") && layer.of_frame)
      for (const std::vector<Index>& group : layer.constraints.rigid) mark(colors, group, gpu::shared::mark_rigid);
    if (show.contains("stiffness") && layer.of_frame) color_stiffness(layer.constraints, colors);
    if (show.contains("handles")) {
      if (layer.of_frame)
        for (const Handle& handle : layer.constraints.handles) mark(colors, handle.points, gpu::shared::mark_handle);
      add_handles(layer, out.scene);
    }
    if (show.contains("graph"))
      add_structure(*layer.structure, *layer.pose, energy, evaluation.map_energies[i], out.scene);
  }
}

void add_motion(const document::Markers::Picture& picture, Bounds& bounds, gpu::Scene& scene) {
  picture.add_to(bounds);
  gpu::add_markers(picture.seen, picture.unseen, picture.bones, 1, scene);
}

void add_bounds(const Bounds& more, Bounds& bounds) {
  if (more.empty()) return;
  bounds.add(more.min);
  bounds.add(more.max);
}

}  // namespace

void fill_scene(const gpu::Device& device, const Shape& input, const document::Evaluation* evaluation, const View& view,
                const std::set<std::string>& show, DrawnShape& out) {
  const Shape& shape = evaluation != nullptr ? *evaluation->shape : input;
  const bool rest = evaluation != nullptr && show.contains("rest");
  const bool splats = shape.faces.empty() && gpu::holds_splats(shape);
  if (splats) out.splats = gpu::create_splats(shape);
  Bounds bounds = splats ? gpu::bulk_bounds(out.splats) : bounds_of(shape.positions);
  if (rest) add_bounds(splats ? gpu::bulk_bounds(gpu::create_splats(input)) : bounds_of(input.positions), bounds);
  if (evaluation != nullptr && show.contains("markers"))
    for (const document::LayerResult& layer : evaluation->layers)
      if (layer.markers != nullptr) add_motion(layer.markers->picture(view.frame, shape.origin), bounds, out.scene);
  out.scene.up = view.z_up ? gpu::UpAxis::Z : gpu::UpAxis::Y;
  out.scene.camera = camera_of(view, bounds, shape.origin);
  if (view.turntable > 0) {
    gpu::Camera named;
    const double fill = gpu::look_from(named, view.name, out.scene.up) ? frame_fill : 0;
    out.cameras = gpu::cameras_around(out.scene.camera, out.scene.up, view.turntable, 360, bounds,
                                      static_cast<double>(view.width) / view.height, fill);
  } else {
    out.cameras = {out.scene.camera};
  }
  out.scene.ground = gpu::ground_below(bounds, out.scene.up);
  out.scene.ground.show = show.contains("ground");

  std::vector<gpu::PointColor> colors = colors_of(shape);
  if (splats) color_by_splats(out.splats, out.scene.camera, colors);
  if (!view.color.name.empty()) {
    out.field = field_of(view.color, input, shape, evaluation);
    for (std::size_t i = 0; i < colors.size(); ++i)
      colors[i] = color_of(*out.field, static_cast<double>(out.field->field.values[i]));
  }
  if (evaluation != nullptr) add_layers(*evaluation, show, colors, out);
  const bool tets = evaluation != nullptr && show.contains("tets");
  const double size = size_of_points(view, shape.size());
  const auto add = [&](gpu::Points& points, const Shape& of, bool ghost) {
    points = gpu::create_points(device, false, of.positions, normals_of(of));
    if (!ghost) gpu::set_colors(points, colors);
    const double opacity = ghost ? 0.25 : 0;
    if (of.faces.empty() || show.contains("points"))
      out.scene.clouds.push_back({.points = &points, .size = size, .ghost = opacity});
    else
      out.scene.meshes.push_back({.points = &points, .triangles = &out.triangles, .ghost = opacity});
  };
  if (!shape.faces.empty()) out.triangles = gpu::create_triangles(device, triangles_of(shape.faces));
  if (tets) {
    add_solids(device, *evaluation, colors, view.section, out);
  } else if (splats && !show.contains("points")) {
    color_splats(colors, out.field.has_value(), out.scene.look, out.splats);
    out.scene.splats.push_back({&out.splats});
  } else {
    add(out.points, shape, false);
  }
  if (rest) add(out.rest_points, input, true);
}

}  // namespace sinew::app
