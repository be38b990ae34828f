#include "engine/io/gltf.h"

#include <algorithm>

#include "engine/io/byte_source.h"
#include "engine/io/gltf_mesh.h"

namespace sinew::io {

namespace {

Shape shape_of(const std::shared_ptr<const GltfMesh>& mesh, std::size_t frame) {
  Shape shape = mesh->shape(frame);
  auto content = std::make_shared<GltfContent>();
  content->mesh = mesh;
  content->frame = frame;
  shape.content = std::move(content);
  return shape;
}

}  // namespace

Shape read_gltf(const std::string& path, std::vector<std::byte> bytes, const ReadOptions&) {
  const auto mesh = std::make_shared<const GltfMesh>(std::make_unique<GltfDocument>(path, std::move(bytes)));
  Shape shape = shape_of(mesh, 0);
  if (mesh->frames().size() > 1)
    shape.notes.push_back("Only the first of " + std::to_string(mesh->frames().size()) + " frames is read.");
  return shape;
}

Sequence open_gltf(std::shared_ptr<const ByteSource> bytes, const ReadOptions&) {
  const auto mesh = std::make_shared<const GltfMesh>(
      std::make_unique<GltfDocument>(bytes->path(), bytes->read(0, static_cast<std::size_t>(bytes->size()))));
  Sequence sequence;
  sequence.frames = mesh->frames();
  sequence.rate = mesh->rate();
  sequence.load = [mesh](int frame) {
    const auto at = std::lower_bound(mesh->frames().begin(), mesh->frames().end(), frame);
    CHECK(at != mesh->frames().end() && *at == frame, frame);
    auto shape = std::make_shared<Shape>(shape_of(mesh, static_cast<std::size_t>(at - mesh->frames().begin())));
    set_origin(*shape);
    return shape;
  };
  return sequence;
}

std::vector<std::shared_ptr<const Shape>> read_gltf_targets(const std::string& path) {
  const GltfMesh mesh(std::make_unique<GltfDocument>(path, load_bytes(path)));
  std::vector<std::shared_ptr<const Shape>> out;
  for (std::size_t k = 0; k < mesh.targets(); ++k) {
    auto shape = std::make_shared<Shape>(mesh.target(k));
    set_origin(*shape);
    out.push_back(std::move(shape));
  }
  return out;
}

}  // namespace sinew::io
