#pragma once
/// The example poses of a layer, read and checked against its rest shape.

#include <functional>
#include <vector>

#include "engine/document/project.h"
#include "engine/io/poses.h"

namespace sinew::document {

/// A pose and which of Layer::examples it comes from.
struct Example : io::NamedPose {
  std::size_t entry = 0;
};

/// Poses of all paths of Layer::examples, in their order. Throws InputError: a file that can't be read, one that does
/// not correspond to `rest` (path, first differing face, both counts), fewer poses than Layer::example_weights.
/// `progress` as of Method::make; where it says false, the list ends early.
std::vector<Example> examples_of(const Layer& layer, const Shape& rest, const std::function<bool(double)>& progress);

/// The shape that the examples are poses of, where that is another (Layer::examples_of). Throws InputError as above.
std::shared_ptr<const Shape> examples_of_another(const Layer& layer, const Shape& rest);

}  // namespace sinew::document
