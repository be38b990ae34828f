#include "apps/editor/stage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>

#include "apps/editor/normals.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "engine/gpu/level_of_detail.h"

namespace sinew::editor {

namespace {

/// The chosen layer's answer, where it has a structure; else null.
const document::LayerResult* structured(const Session& session) {
  for (const document::LayerResult& result : session.shown())
    if (result.layer == session.chosen_layer() && result.structure && result.pose) return &result;
  return nullptr;
}

/// Where the vertices of a structure are now.
std::vector<Vec3> bent_vertices(const document::LayerResult& result) {
  const Deformer::Structure& structure = *result.structure;
  std::vector<Vec3> out(structure.vertices.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Affine& map = (*result.pose)[structure.maps[i]];
    out[i] = map.leftCols<3>() * structure.vertices[i] + map.col(3);
  }
  return out;
}

/// More splats than this are only moved while the mouse drags, and take their new form when it rests.
constexpr std::size_t splats_bent_live = 100'000;

}  // namespace

void Stage::note(const Changed& changed) {
  pending_.input |= changed.input || changed.frame;
  pending_.weights |= changed.weights;
  pending_.pose |= changed.pose;
  pending_.marks |= changed.marks;
}

bool Stage::poll() {
  const bool painted = painter_.poll();
  return onion_.poll() || painted;
}

void Stage::update(gpu::Frame& frame, Session& session, const View& view) {
  if (pending_.input) {
    points_.reset();
    triangles_ = {};
    splats_.reset();
    weights_ = nullptr;
    if (session.has_input()) take_input(*session.input());
    pending_.pose = pending_.marks = true;
  }
  if (points_) {
    if (painter_.update(session, view)) pending_.marks = true;
    colored_ = !view.color_by.empty() || view.heat;
    if (pending_.pose || pending_.weights) take_pose(frame, session);
    const bool bend = pending_.pose || pending_.weights || (only_moved_ && !session.dragging());
    if (splats_ && bend) bend_splats(session);
    if (pending_.marks) take_marks(session);
    if (splats_ && (pending_.marks || (bend && !only_moved_))) color_splats(session);
  }
  take_solid(session, view);
  take_onion(session, view);
  pending_ = {};
}

/// Ghosts of other frames, one by one as they are found.
void Stage::take_onion(Session& session, const View& view) {
  if (!onion_.update(session, view)) return;
  ghosts_.clear();
  for (const OnionSkin::Ghost& found : onion_.ghosts()) {
    const std::vector<std::uint32_t> triangles = triangles_of(found.shape->faces);
    Ghost ghost;
    ghost.away = found.away;
    ghost.points = gpu::create_points(device_, false, found.shape->positions, normals_of(*found.shape, triangles));
    if (!triangles.empty()) ghost.triangles = gpu::create_triangles(device_, triangles);
    ghosts_.push_back(std::move(ghost));
  }
}

/// Faces are found anew for another structure or cut, and drawn anew where a vertex or its colour changed.
void Stage::take_solid(Session& session, const View& view) {
  const document::LayerResult* result = view.show_graph && view.cut_tets ? structured(session) : nullptr;
  if (result == nullptr || result->structure->tets.empty() || !points_) {
    solid_.reset();
    solid_structure_.reset();
    return;
  }
  const Deformer::Structure& structure = *result->structure;
  const bool other = result->structure != solid_structure_ || view.section != section_;
  if (other) solid_faces_ = gpu::faces_of(structure.vertices, structure.tets, view.section);
  if (!other && !pending_.pose && !pending_.weights && !pending_.marks) return;
  solid_structure_ = result->structure;
  section_ = view.section;
  solid_at_ = bent_vertices(*result);
  const std::vector<std::uint8_t>& marks = session.point_marks();
  const std::vector<float> stiffness = session.point_stiffness();
  std::vector<gpu::PointColor> colors(solid_at_.size(), gpu::PointColor{204, 202, 198, 0});
  for (std::size_t v = 0; v < colors.size(); ++v) {
    const Index i = structure.points[v];
    if (i >= marks.size()) continue;
    if (!stiffness.empty()) colors[v] = gpu::stiffness_color(colors[v], static_cast<double>(stiffness[i]));
    colors[v].marks = static_cast<std::uint8_t>(marks[i] & ~(gpu::shared::mark_selected | gpu::shared::mark_hidden));
  }
  solid_ = gpu::create_solid(device_, solid_faces_, solid_at_, colors);
}

void Stage::take_input(const Shape& shape) {
  const std::vector<std::uint32_t> triangles = triangles_of(shape.faces);
  points_ = gpu::create_points(device_, paths_.skin_on_device, shape.positions, normals_of(shape, triangles));
  if (triangles.empty())
    gpu::set_order(device_, *points_, gpu::progressive_order(shape.positions));
  else
    triangles_ = gpu::create_triangles(device_, triangles);
  if (triangles.empty() && gpu::holds_splats(shape)) splats_ = gpu::create_splats(shape);
  only_moved_ = false;
}

/// Covariances and colours bend on the CPU, by the weights that are shown: without their gradients, which is as near as
/// a picture needs; an export has them.
void Stage::bend_splats(Session& session) {
  only_moved_ = session.dragging() && splats_->count > splats_bent_live;
  if (only_moved_) {
    const std::span<const Vec3> bent = session.bent_positions();
    for (std::size_t i = 0; i < bent.size(); ++i) splats_->positions[i] = (bent[i] - splats_->centre).cast<float>();
    return;
  }
  std::shared_ptr<const Shape> shape = session.input();
  for (const document::LayerResult& layer : session.shown())
    if (layer.weights != nullptr && layer.pose != nullptr)
      shape = std::make_shared<const Shape>(skin(*shape, *layer.weights, *layer.pose));
  splats_ = gpu::create_splats(*shape);
  splat_harmonics_ = splats_->harmonics;
  splat_opacities_ = splats_->opacities;
}

/// Marks over the splats' own colours; an attribute that they are coloured by covers those.
void Stage::color_splats(Session& session) {
  splats_->harmonics = splat_harmonics_;
  splats_->opacities = splat_opacities_;
  const gpu::Look& look = theme().look;
  const auto mix = [&](std::size_t i, int r, int g, int b, float part) {
    gpu::tint(*splats_, i, Eigen::Vector3i(r, g, b).cast<float>() / 255, part);
  };
  const std::vector<std::uint8_t>& marks = session.point_marks();
  const std::vector<float> stiffness = session.point_stiffness();
  for (std::size_t i = 0; i < splats_->count; ++i) {
    gpu::PointColor color = coloring().colors[i];
    const bool changed = !stiffness.empty() && stiffness[i] != 1;
    if (changed) color = gpu::stiffness_color(color, static_cast<double>(stiffness[i]));
    if (changed || colored_) mix(i, color.r, color.g, color.b, 1);
    if ((marks[i] & gpu::shared::mark_hidden) != 0) splats_->opacities[i] = NAN;  // not drawn
    // A selected splat's mark is seen through.
    const std::pair<unsigned, gpu::Color> tints[] = {{gpu::shared::mark_selected, look.outline},
                                                     {gpu::shared::mark_handle, look.handle},
                                                     {gpu::shared::mark_fixed, look.fixed},
                                                     {gpu::shared::mark_rigid, look.rigid}};
    for (const auto& [bit, tint] : tints)
      if ((marks[i] & bit) != 0) mix(i, tint.r, tint.g, tint.b, gpu::shared::mark_strength);
  }
}

void Stage::take_marks(Session& session) {
  const std::vector<std::uint8_t>& marks = session.point_marks();
  const std::span<gpu::PointColor> colors = gpu::colors_of(*points_);
  std::copy(coloring().colors.begin(), coloring().colors.end(), colors.begin());
  const std::vector<float> stiffness = session.point_stiffness();
  for (std::size_t i = 0; i < stiffness.size(); ++i)
    colors[i] = gpu::stiffness_color(colors[i], static_cast<double>(stiffness[i]));
  // Marks would tint the colours that stand for numbers.
  const unsigned shown = coloring().field ? gpu::shared::mark_selected : 0xff;
  for (std::size_t i = 0; i < marks.size(); ++i) colors[i].marks = static_cast<std::uint8_t>(marks[i] & shown);
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
  if (solid_) {
    // The shape would hide what the cut laid bare.
    if (solid_->triangles.count > 0)
      scene.meshes.push_back({.points = &solid_->points, .triangles = &solid_->triangles, .flat = true});
    if (is_mesh()) scene.meshes.push_back({.points = &*points_, .triangles = &triangles_, .ghost = 0.2});
  } else if (is_mesh()) {
    scene.meshes.push_back({.points = &*points_, .triangles = &triangles_});
    if (view.show_rest)
      scene.meshes.push_back({.points = &*points_, .triangles = &triangles_, .rest = true, .ghost = 0.35});
  } else if (splats_) {
    scene.splats.push_back({&*splats_});
    if (view.show_rest)
      scene.clouds.push_back({.points = &*points_, .size = size, .count = count, .rest = true, .ghost = 0.35});
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
  for (const Ghost& ghost : ghosts_) {
    // Before: cold, after: warm, as on the bars of a light table; the farther, the fainter.
    const gpu::Color color = ghost.away < 0 ? gpu::Color::hex(0x5aa2f0) : gpu::Color::hex(0xf0924a);
    const double opacity = 0.6 / (1 + 0.5 * (std::abs(ghost.away) - 1));
    if (ghost.triangles.count > 0)
      scene.meshes.push_back(
          {.points = &ghost.points, .triangles = &ghost.triangles, .ghost = opacity, .ghost_color = color});
    else
      scene.clouds.push_back({.points = &ghost.points, .size = size, .ghost = 0.5 * opacity, .ghost_color = color});
  }
  add_structure(scene, session, view);
  if (view.show_markers)
    for (const document::Markers::Picture& picture : session.marker_pictures())
      gpu::add_markers(picture.seen, picture.unseen, picture.bones, static_cast<double>(scale()), scene);
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
  const document::LayerResult* result = view.show_graph ? structured(session) : nullptr;
  if (result == nullptr) return;
  const bool light = scene.look.backdrop_top.r > 128;
  const double width = static_cast<double>(scale());
  const gpu::Color edge = light ? gpu::Color::hex(0x1a2230, 0.25) : gpu::Color::hex(0xffffff, 0.2);
  if (solid_) {
    gpu::add_edges(solid_faces_, solid_at_, {.color = gpu::Color::hex(0x14181e, 0.55), .width = width}, scene);
    return;
  }
  const Deformer::Structure& structure = *result->structure;
  const std::vector<Vec3> vertices = bent_vertices(*result);
  for (const auto& [a, b] : structure.edges)
    scene.lines.push_back({.from = vertices[a], .to = vertices[b], .color = edge, .width = width, .hidden = 0.6});
  if (!structure.tets.empty()) return;  // so many dots would hide the edges
  const gpu::Color node = light ? gpu::Color::hex(0x1a2230, 0.7) : gpu::Color::hex(0xffffff, 0.7);
  for (const Vec3& vertex : vertices)
    scene.dots.push_back({.position = vertex, .color = node, .radius = 2.0 * width, .hidden = 0.5});
}

}  // namespace sinew::editor
