#pragma once
/// The JSON and the buffer of a glTF file that is being made.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::io {

enum class GltfContainer { Gltf, Glb };  ///< JSON with the buffer in base64; binary

constexpr std::size_t most_gltf_bytes = std::numeric_limits<std::uint32_t>::max();

class GltfBuilder {
 public:
  /// Begins the next view of the buffer; `rest`: members of its object behind the length, each with a comma before it.
  /// Accessors are added to the last view. Returns its index.
  std::size_t begin_view(const std::string& rest);
  /// Values of 1 or 3 floats, with their bounds; the index of the accessor.
  std::size_t add_floats(std::span<const float> values, std::size_t components);
  std::size_t add_indices(std::span<const Index> indices);

  /// The file; `objects`: the members of scenes, nodes, meshes and animations. Throws InputError: a .glb of over 4 GiB.
  std::vector<std::byte> finish(const std::string& path, const std::string& objects, GltfContainer container) const;

 private:
  struct View {
    std::size_t begin;
    std::string rest;
  };
  std::vector<std::byte> buffer_;
  std::vector<std::string> accessors_;
  std::vector<View> views_;
};

}  // namespace sinew::io
