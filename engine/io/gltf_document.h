#pragma once
/// The container of a glTF file: its JSON and its buffers, and the numbers of its accessors (glTF 2.0, sections 3.6 and
/// 4.4). Buffers are in the file (.glb), in a data URI, or in files beside it.

#include <span>

#include "engine/io/json_tree.h"

namespace sinew::io {

class GltfDocument {
 public:
  /// Throws InputError: no glTF 2.0, a truncated .glb, buffers that are missing or shorter than they should be,
  /// compressed geometry.
  GltfDocument(const std::string& path, std::vector<std::byte> bytes);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  const std::string& path() const { return path_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  bool is_glb() const { return glb_; }
  bool self_contained() const { return self_contained_; }  ///< no buffer in a file beside it
  std::size_t size() const { return total_size_; }         ///< bytes of the file and of its buffers
  JsonView root() const { return {path_, root_}; }
  /// The JSON object of an array's name and an index: object("nodes", view) is nodes[view].
  JsonView object(const char* array, const JsonView& index) const;

  struct Accessor {
    std::size_t count = 0, components = 0;
    bool normalized = false;
    int component_type = 0;
  };
  /// Throws InputError where the elements do not lie within the buffer; without a bufferView (all zero) the count is
  /// believed up to size().
  Accessor accessor(const JsonView& index) const;
  /// count x components numbers, integers normalized where the accessor says so, sparse values in their places.
  std::vector<double> numbers(const JsonView& index, std::size_t components) const;

 private:
  struct Elements {
    const std::byte* begin = nullptr;  ///< null: all zero
    std::size_t stride = 0;
  };
  std::string_view json_of_glb();
  std::vector<std::byte> load_buffer(const JsonView& buffer, bool first);
  std::span<const std::byte> view_bytes(const JsonView& view) const;
  Elements elements(const JsonView& where, const char* view, std::size_t count, std::size_t element) const;
  void replace_sparse(const JsonView& sparse, const Accessor& accessor, std::vector<double>& numbers) const;

  std::string path_;
  std::vector<std::byte> bytes_;
  bool glb_ = false, self_contained_ = true;
  std::span<const std::byte> binary_;  ///< the BIN chunk
  JsonNode root_;
  std::vector<std::vector<std::byte>> buffers_;
  std::size_t total_size_ = 0;
};

}  // namespace sinew::io
