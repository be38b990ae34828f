#include "engine/io/gltf_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/io/frame_times.h"
#include "engine/io/text_patch.h"

namespace sinew::io {

namespace {

/// Targets are often sparse, or share their offsets; a file in which this many do not fit is made to waste time.
constexpr std::size_t most_offsets_a_byte = 100;

std::array<double, 4> four_numbers(const JsonView& view, std::size_t size) {
  if (view.size() != size) throw view.error(std::to_string(size) + " numbers", std::to_string(view.size()));
  std::array<double, 4> out{};
  for (std::size_t i = 0; i < size; ++i) out[i] = view.item(i).number();
  return out;
}

/// Section 3.5.3: a matrix by columns, or T R S.
Eigen::Matrix4d local_matrix(const JsonView& node) {
  Eigen::Matrix4d M = Eigen::Matrix4d::Identity();
  if (const auto matrix = node.find("matrix")) {
    if (matrix->size() != 16) throw matrix->error("16 numbers", std::to_string(matrix->size()));
    for (std::size_t i = 0; i < 16; ++i) M(static_cast<int>(i % 4), static_cast<int>(i / 4)) = matrix->item(i).number();
    return M;
  }
  if (const auto rotation = node.find("rotation")) {
    const auto q = four_numbers(*rotation, 4);
    M.topLeftCorner<3, 3>() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
  }
  if (const auto scale = node.find("scale")) {
    const auto s = four_numbers(*scale, 3);
    for (int c = 0; c < 3; ++c) M.col(c) *= s[static_cast<std::size_t>(c)];
  }
  if (const auto translation = node.find("translation")) {
    const auto t = four_numbers(*translation, 3);
    M.topRightCorner<3, 1>() = Vec3(t[0], t[1], t[2]);
  }
  return M;
}

/// A node that is still to be looked at.
struct Branch {
  JsonView index;
  Eigen::Matrix4d above;
};

/// Items of an array as branches, the first on top.
void push(std::vector<Branch>& open, const JsonView& nodes, const Eigen::Matrix4d& above) {
  for (std::size_t i = nodes.size(); i-- > 0;) open.push_back({nodes.item(i), above});
}

}  // namespace

GltfMesh::GltfMesh(std::unique_ptr<const GltfDocument> document) : document_(std::move(document)) {
  find_node();
  const JsonView node = document_->root().member("nodes").item(node_);
  const JsonView primitives = document_->object("meshes", node.member("mesh")).member("primitives");
  for (std::size_t i = 0; i < primitives.size(); ++i) read_primitive(primitives.item(i));
  if (points_ == 0) throw primitives.error("vertices", "none");
  read_weights();
}

/// The first node with a mesh, depth first from the nodes of the scene.
void GltfMesh::find_node() {
  const JsonView root = document_->root();
  const std::size_t nodes = root.size_of("nodes");
  std::vector<Branch> open;
  const std::optional<JsonView> scenes = root.find("scenes");
  if (const auto scene = root.find("scene")) {
    if (const auto roots = document_->object("scenes", *scene).find("nodes")) push(open, *roots, world_);
  } else if (scenes && scenes->size() > 0) {
    if (const auto roots = scenes->item(0).find("nodes")) push(open, *roots, world_);
  }
  std::vector<bool> seen(nodes, false);
  bool found = false;
  while (!open.empty()) {
    const Branch branch = std::move(open.back());
    open.pop_back();
    const JsonView node = document_->object("nodes", branch.index);
    const std::size_t index = branch.index.index(nodes);
    if (seen[index]) throw branch.index.error("a tree of nodes", "node " + std::to_string(index) + " twice");
    seen[index] = true;
    const Eigen::Matrix4d world = branch.above * local_matrix(node);
    if (node.find("mesh")) {
      other_meshes_ += found ? 1 : 0;
      if (!found) {
        node_ = index;
        world_ = world;
      }
      found = true;
    }
    if (const auto children = node.find("children")) push(open, *children, world);
  }
  if (!found) throw file_error(document_->path(), "a mesh in the scene", "none");
}

void GltfMesh::read_primitive(const JsonView& primitive) {
  const std::optional<JsonView> mode = primitive.find("mode");
  const std::size_t kind = mode ? mode->count(6) : 4;
  const std::size_t block = block_of(primitive);
  if (kind < 4) {
    // Primitives of points still have points; lines have no faces.
    ++unread_primitives_;
    return;
  }
  add_faces(primitive, blocks_[block]);
}

/// Vertices are known by the accessors of their positions and offsets.
std::size_t GltfMesh::block_of(const JsonView& primitive) {
  const JsonView attributes = primitive.member("attributes");
  Block block{attributes.member("POSITION"), {}, points_, 0};
  unread_attributes_ = unread_attributes_ || attributes.members() > 1;
  const std::optional<JsonView> targets = primitive.find("targets");
  for (std::size_t i = 0; targets && i < targets->size(); ++i)
    block.targets.push_back(targets->item(i).find("POSITION"));
  // What names the vertices: accessors, and a number that none has where a target leaves positions alone.
  std::vector<double> key{block.position.number()};
  for (const auto& target : block.targets) key.push_back(target ? target->number() : -1);
  if (const auto known = block_keys_.find(key); known != block_keys_.end()) return known->second;
  if (!blocks_.empty() && block.targets.size() != targets_)
    throw primitive.error("as many morph targets as the first primitive has, " + std::to_string(targets_),
                          std::to_string(block.targets.size()));
  targets_ = block.targets.size();
  const GltfDocument::Accessor position = document_->accessor(block.position);
  block.count = position.count;
  if (block.count == 0 || position.components != 3)
    throw block.position.error("an accessor of positions", counted(block.count, "element", "elements") + " of " +
                                                               counted(position.components, "number", "numbers"));
  for (const auto& target : block.targets)
    if (target && document_->accessor(*target).count != block.count)
      throw target->error("offsets of " + std::to_string(block.count) + " vertices",
                          std::to_string(document_->accessor(*target).count));
  if (block.targets.size() > most_offsets_a_byte * document_->size() / block.count)
    throw primitive.error("fewer morph targets for a file of " + std::to_string(document_->size()) + " bytes",
                          std::to_string(block.targets.size()));
  // Accessors may lie upon each other: together they have no more vertices than the file has bytes.
  if (block.count > document_->size() - std::min(points_, document_->size()))
    throw primitive.error("no more vertices than the file has bytes, " + std::to_string(document_->size()), "more");
  points_ += block.count;
  block_keys_[key] = blocks_.size();
  blocks_.push_back(std::move(block));
  return blocks_.size() - 1;
}

void GltfMesh::add_faces(const JsonView& primitive, const Block& block) {
  const std::optional<JsonView> mode = primitive.find("mode");
  const std::size_t kind = mode ? mode->count(6) : 4;
  const std::optional<JsonView> indices = primitive.find("indices");
  const GltfDocument::Accessor accessor = indices ? document_->accessor(*indices) : GltfDocument::Accessor();
  const int type = accessor.component_type;
  if (indices && type != 5121 && type != 5123 && type != 5125)
    throw indices->error("indices of a component type 5121, 5123 or 5125", std::to_string(type));
  const std::size_t count = indices ? accessor.count : block.count;
  if (count > document_->size() - std::min(corners_, document_->size()))
    throw primitive.error("no more indices than the file has bytes, " + std::to_string(document_->size()), "more");
  if (kind == 4 && count % 3 != 0) throw primitive.error("three corners a triangle", std::to_string(count) + " in all");
  corners_ += count;
  std::vector<Index> corners(count);
  const std::vector<double> numbers = indices ? document_->numbers(*indices, 1) : std::vector<double>();
  for (std::size_t i = 0; i < count; ++i) {
    const double index = indices ? numbers[i] : static_cast<double>(i);
    if (!(index >= 0) || !(index < static_cast<double>(block.count)))
      throw primitive.error("indices below " + std::to_string(block.count), shortest(index));
    corners[i] = static_cast<Index>(block.first + static_cast<std::size_t>(index));
  }
  for (std::size_t i = 2; i < count; i += kind == 4 ? 3 : 1) {
    const std::size_t odd = kind == 5 ? i % 2 : 0;
    const Index a = kind == 6 ? corners[0] : corners[i - 2 + odd], b = corners[i - 1 - odd];
    faces_.add(std::array{a, kind == 6 ? corners[i - 1] : b, corners[i]});
  }
}

void GltfMesh::read_weights() {
  const JsonView root = document_->root();
  const JsonView node = root.member("nodes").item(node_);
  std::size_t channels = 0;
  bool animated = false;
  const std::size_t animations = root.size_of("animations");
  for (std::size_t i = 0; i < animations; ++i) {
    const JsonView animation = root.member("animations").item(i);
    if (animated || targets_ == 0)
      channels += animation.member("channels").size();
    else
      animated = read_animation(animation, channels);
  }
  if (!animated) {
    weights_.assign(targets_, 0.0);
    std::optional<JsonView> weights = node.find("weights");
    if (!weights) weights = document_->object("meshes", node.member("mesh")).find("weights");
    for (std::size_t k = 0; weights && k < std::min(targets_, weights->size()); ++k)
      weights_[k] = weights->item(k).number();
    if (targets_ > 0)
      notes_.push_back("Kept in the glTF file only: " + counted(targets_, "morph target", "morph targets") +
                       " without an animation.");
  }
  note_rest(channels);
}

/// True where the animation moves the weights of the node; `channels` counts all others.
bool GltfMesh::read_animation(const JsonView& animation, std::size_t& channels) {
  const JsonView list = animation.member("channels");
  bool found = false;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonView channel = list.item(i), target = channel.member("target");
    const std::optional<JsonView> node = target.find("node");
    if (found || !node || node->index(document_->root().size_of("nodes")) != node_ ||
        target.member("path").text() != "weights") {
      ++channels;
      continue;
    }
    found = true;
    const JsonView samplers = animation.member("samplers");
    const JsonView sampler = samplers.item(channel.member("sampler").index(samplers.size()));
    const std::string interpolation = sampler.text_or("interpolation", "LINEAR");
    if (interpolation != "LINEAR" && interpolation != "STEP" && interpolation != "CUBICSPLINE")
      throw sampler.error("an interpolation LINEAR, STEP or CUBICSPLINE", sinew::quoted(interpolation));
    const std::vector<double> times = document_->numbers(sampler.member("input"), 1);
    const std::vector<double> values = document_->numbers(sampler.member("output"), 1);
    // A key of a cubic spline has an incoming tangent, the value, and an outgoing tangent.
    const std::size_t parts = interpolation == "CUBICSPLINE" ? 3 : 1;
    if (times.empty() || values.size() / targets_ / parts != times.size() || values.size() % (targets_ * parts) != 0)
      throw sampler.error(std::to_string(times.size()) + " keys of " + std::to_string(targets_ * parts) + " weights",
                          counted(values.size(), "weight", "weights"));
    for (std::size_t key = 0; key < times.size(); ++key) {
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>((key * parts + parts / 2) * targets_);
      weights_.insert(weights_.end(), begin, begin + static_cast<std::ptrdiff_t>(targets_));
    }
    const std::vector<float> seconds(times.begin(), times.end());
    FrameTimes numbered = frames_of_times(seconds);
    frames_ = std::move(numbered.frames);
    rate_ = numbered.rate;
    if (numbered.numbered) notes_.push_back("Its keys are no multiples of one step: frames are counted from 1.");
  }
  return found;
}

void GltfMesh::note_rest(std::size_t channels) {
  const auto kept = [this](const std::string& what) { notes_.push_back("Not read from the glTF file: " + what + "."); };
  const JsonView root = document_->root();
  if (other_meshes_ > 0) kept(counted(other_meshes_, "other node with a mesh", "other nodes with a mesh"));
  if (unread_primitives_ > 0)
    kept("the lines or single points of " + counted(unread_primitives_, "primitive", "primitives"));
  if (unread_attributes_) kept("normals, colours, texture coordinates and other attributes of vertices");
  if (root.size_of("materials") > 0) kept(counted(root.size_of("materials"), "material", "materials"));
  if (root.member("nodes").item(node_).find("skin")) kept("the skin");
  if (channels > 0) kept(counted(channels, "other channel of animations", "other channels of animations"));
}

Shape GltfMesh::shape(std::size_t i) const {
  return shape_at(std::span(weights_).subspan(i * targets_, targets_));
}

Shape GltfMesh::target(std::size_t k) const {
  std::vector<double> weights(targets_, 0.0);
  weights[k] = 1;
  return shape_at(weights);
}

Shape GltfMesh::shape_at(std::span<const double> weights) const {
  const bool moved = !world_.isIdentity(0);
  Shape shape;
  shape.positions.resize(points_);
  shape.position_type = moved ? Type::Float64 : Type::Float32;
  shape.faces = faces_;
  shape.notes = notes_;
  for (const Block& block : blocks_) {
    std::vector<double> x = document_->numbers(block.position, 3);
    for (std::size_t k = 0; k < targets_; ++k) {
      const double w = weights[k];
      if (w == 0 || !block.targets[k]) continue;
      const std::vector<double> offsets = document_->numbers(*block.targets[k], 3);
      for (std::size_t c = 0; c < x.size(); ++c) x[c] += w * offsets[c];
    }
    for (std::size_t p = 0; p < block.count; ++p) {
      const Vec3 own(x[3 * p], x[3 * p + 1], x[3 * p + 2]);
      Vec3& position = shape.positions[block.first + p];
      // A sum of floats is none; what others show is one.
      position = moved ? Vec3(world_.topLeftCorner<3, 3>() * own + world_.topRightCorner<3, 1>())
                       : Vec3(own.cast<float>().cast<double>());
    }
  }
  return shape;
}

}  // namespace sinew::io
