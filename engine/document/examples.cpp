#include "engine/document/examples.h"

#include "engine/document/settings.h"
#include "engine/geometry/error.h"
#include "engine/geometry/topology.h"

namespace sinew::document {

namespace {

void require_correspondence(const std::string& path, const Shape& rest, const Shape& pose) {
  if (const std::string difference = difference_of_faces(rest, pose); !difference.empty())
    throw InputError(path + ": " + difference + ": an example has the points and faces of the shape it is for");
}

}  // namespace

std::vector<Example> examples_of(const Layer& layer, const Shape& rest, const std::function<bool(double)>& progress) {
  std::vector<Example> out;
  for (std::size_t entry = 0; entry < layer.examples.size(); ++entry) {
    if (progress && !progress(0)) return out;
    for (io::NamedPose& pose : io::read_poses(layer.examples[entry])) {
      require_correspondence(pose.path, rest, *pose.shape);
      out.push_back({std::move(pose), entry});
    }
  }
  if (layer.example_weights.size() > out.size())
    throw place_error(layer.place, "layer",
                      "at most " + std::to_string(out.size()) + " \"example_weights\", one an example",
                      std::to_string(layer.example_weights.size()));
  return out;
}

std::shared_ptr<const Shape> examples_of_another(const Layer& layer, const Shape& rest) {
  std::shared_ptr<const Shape> out = io::read(layer.examples_of);
  require_correspondence(layer.examples_of, rest, *out);
  return out;
}

}  // namespace sinew::document
