#include "apps/editor/stage.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "engine/geometry/topology.h"
#include "engine/gpu/level_of_detail.h"

namespace sinew::editor {

namespace {

/// Unit normals of the points: the file's, or of a mesh the mean of its faces' (weighted by area); none for others.
std::vector<Vec3> normals_of(const Shape& shape, std::span<const std::uint32_t> triangles) {
  std::vector<Vec3> normals;
  for (const Attribute& attribute : shape.attributes) {
    if (attribute.kind != Kind::Normal || attribute.components != 3 || !attribute.per_point()) continue;
    normals.resize(shape.size());
    for (std::size_t i = 0; i < shape.size(); ++i)
      normals[i] = {attribute.number(i, 0), attribute.number(i, 1), attribute.number(i, 2)};
    return normals;
  }
  if (triangles.empty()) return normals;
  normals.assign(shape.size(), Vec3::Zero());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Vec3& a = shape.positions[triangles[t]];
    const Vec3 area = (shape.positions[triangles[t + 1]] - a).cross(shape.positions[triangles[t + 2]] - a);
    for (std::size_t c = 0; c < 3; ++c) normals[triangles[t + c]] += area;
  }
  for (Vec3& normal : normals) normal.normalize();
  return normals;
}

}  // namespace

void Stage::note(const Changed& changed) {
  pending_.input |= changed.input || changed.frame;
  pending_.weights |= changed.weights;
  pending_.pose |= changed.pose;
  pending_.marks |= changed.marks;
}

void Stage::update(gpu::Frame& frame, Session& session, const View& view) {
  if (pending_.input) {
    points_.reset();
    triangles_ = {};
    weights_ = nullptr;
    if (session.has_input()) take_input(*session.input(), view);
    pending_.pose = pending_.marks = true;
  }
  if (points_) {
    if (view.color_by != colored_by_) {
      coloring_ = coloring_of(*session.input(), view.color_by);
      colored_by_ = view.color_by;
      pending_.marks = true;
    }
    if (pending_.pose || pending_.weights) take_pose(frame, session);
    if (pending_.marks) take_marks(session);
  }
  pending_ = {};
}

void Stage::take_input(const Shape& shape, const View& view) {
  const std::vector<std::uint32_t> triangles = triangles_of(shape.faces);
  points_ = gpu::create_points(device_, paths_.skin_on_device, shape.positions, normals_of(shape, triangles));
  if (triangles.empty())
    gpu::set_order(device_, *points_, gpu::progressive_order(shape.positions));
  else
    triangles_ = gpu::create_triangles(device_, triangles);
  coloring_ = coloring_of(shape, view.color_by);
  colored_by_ = view.color_by;
}

void Stage::take_marks(Session& session) {
  const std::vector<std::uint8_t>& marks = session.point_marks();
  const std::span<gpu::PointColor> colors = gpu::colors_of(*points_);
  std::copy(coloring_.colors.begin(), coloring_.colors.end(), colors.begin());
  for (std::size_t i = 0; i < marks.size(); ++i) colors[i].marks = marks[i];
}

void Stage::take_pose(gpu::Frame& frame, Session& session) {
  const std::vector<document::LayerResult>& layers = session.shown();
  const bool one = layers.size() == 1 && layers[0].weights != nullptr && layers[0].pose != nullptr;
  if (!one) {
    gpu::set_positions(device_, *points_, session.bent_positions(), {});
    return;
  }
  if (layers[0].weights.get() != weights_) {
    gpu::set_weights(device_, *points_, *layers[0].weights);
    weights_ = layers[0].weights.get();
  }
  gpu::pose_points(device_, frame, *points_, *layers[0].pose);
}

gpu::Scene Stage::scene(Session& session, const View& view, const Theme& theme, std::size_t count) const {
  gpu::Scene scene;
  scene.camera = view.camera;
  scene.up = view.up;
  scene.look = theme.look;
  scene.ground = gpu::ground_below(session.rest_bounds(), view.up);
  scene.ground.show = view.show_ground;
  // Points carry their own edges; two by two samples would only cost.
  scene.smooth_edges = is_mesh();
  if (!points_) return scene;
  scene.outline_selected = !session.selection().empty();
  const double size = view.point_size * static_cast<double>(scale());
  if (is_mesh()) {
    scene.meshes.push_back({.points = &*points_, .triangles = &triangles_});
    if (view.show_rest)
      scene.meshes.push_back({.points = &*points_, .triangles = &triangles_, .rest = true, .ghost = 0.35});
  } else {
    // Fewer points are drawn larger, so that the surface stays closed.
    const double share = static_cast<double>(std::max<std::size_t>(1, count)) /
                         static_cast<double>(std::max<std::size_t>(1, points_->count));
    const double grown = std::min(4 * size, size * std::sqrt(1 / share));
    scene.clouds.push_back(
        {.points = &*points_, .size = count < points_->count ? std::max(size, grown) : size, .count = count});
    if (view.show_rest)
      scene.clouds.push_back({.points = &*points_, .size = size, .count = count, .rest = true, .ghost = 0.35});
  }
  add_structure(scene, session, view);
  const std::vector<HandleView> handles = session.handles();
  for (std::size_t i = 0; i < handles.size(); ++i) {
    gpu::Dot dot = gpu::handle_dot(handles[i].target, theme.look.handle);
    dot.radius *= static_cast<double>(scale());
    dot.outline *= static_cast<double>(scale());
    if (session.chosen_handle() == i) {
      dot.radius *= 1.2;
      dot.outline_color = gpu::Color::hex(0xffffff);
    }
    scene.dots.push_back(dot);
  }
  return scene;
}

void Stage::add_structure(gpu::Scene& scene, const Session& session, const View& view) const {
  if (!view.show_graph) return;
  for (const document::LayerResult& result : session.shown()) {
    if (result.layer != session.chosen_layer() || !result.structure || !result.pose) continue;
    const Deformer::Structure& structure = *result.structure;
    std::vector<Vec3> vertices(structure.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Affine& map = (*result.pose)[structure.maps[i]];
      vertices[i] = map.leftCols<3>() * structure.vertices[i] + map.col(3);
    }
    const bool light = scene.look.backdrop_top.r > 128;
    const gpu::Color edge = light ? gpu::Color::hex(0x1a2230, 0.25) : gpu::Color::hex(0xffffff, 0.2);
    const gpu::Color node = light ? gpu::Color::hex(0x1a2230, 0.7) : gpu::Color::hex(0xffffff, 0.7);
    const double width = static_cast<double>(scale());
    for (const auto& [a, b] : structure.edges)
      scene.lines.push_back({.from = vertices[a], .to = vertices[b], .color = edge, .width = width, .hidden = 0.6});
    for (const Vec3& vertex : vertices)
      scene.dots.push_back({.position = vertex, .color = node, .radius = 2.0 * width, .hidden = 0.5});
  }
}

}  // namespace sinew::editor
