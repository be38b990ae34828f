#pragma once
/// A mesh of a glTF file with its frames: what gltf.h reads.

#include <Eigen/Core>
#include <map>
#include <memory>
#include <span>

#include "engine/geometry/shape.h"
#include "engine/io/gltf_document.h"

namespace sinew::io {

class GltfMesh {
 public:
  explicit GltfMesh(std::unique_ptr<const GltfDocument> document);

  const GltfDocument& document() const { return *document_; }
  const std::vector<int>& frames() const { return frames_; }
  double rate() const { return rate_; }
  /// Frame number i in order; without an origin and a content.
  Shape shape(std::size_t i) const;
  std::size_t targets() const { return targets_; }
  /// base + target k alone; as shape().
  Shape target(std::size_t k) const;

 private:
  /// Vertices that one or more primitives use.
  struct Block {
    JsonView position;
    std::vector<std::optional<JsonView>> targets;  ///< accessors of offsets, where a target has them
    std::size_t first = 0, count = 0;
  };
  Shape shape_at(std::span<const double> weights) const;
  void find_node();
  void read_primitive(const JsonView& primitive);
  std::size_t block_of(const JsonView& primitive);
  void add_faces(const JsonView& primitive, const Block& block);
  void read_weights();
  bool read_animation(const JsonView& animation, std::size_t& channels);
  void note_rest(std::size_t channels);

  std::unique_ptr<const GltfDocument> document_;
  std::size_t node_ = 0, other_meshes_ = 0;
  Eigen::Matrix4d world_ = Eigen::Matrix4d::Identity();
  std::vector<Block> blocks_;
  std::map<std::vector<double>, std::size_t> block_keys_;  ///< accessors of a block -> its number
  std::size_t points_ = 0, targets_ = 0, corners_ = 0;
  Faces faces_;
  std::size_t unread_primitives_ = 0;  ///< of points and lines
  bool unread_attributes_ = false;
  std::vector<int> frames_{1};
  double rate_ = 24;
  std::vector<double> weights_;  ///< frames x targets
  std::vector<std::string> notes_;
};

/// What a shape that was read from glTF knows of its file.
struct GltfContent : FileContent {
  std::shared_ptr<const GltfMesh> mesh;
  std::size_t frame = 0;  ///< in order
};

}  // namespace sinew::io
