#pragma once
/// Batch editing of what moves: the Horse and Fluid rows of Table 1 of Sumner, Schmid and Pauly 2007.

#include <memory>
#include <string>
#include <vector>

#include "engine/document/project.h"

namespace sinew::benchmarks {

/// A sample in memory with its edit, every frame of it: "walk" with 303 nodes, "jet" as it is.
struct MovingCase {
  std::shared_ptr<const Sequence> input;
  std::vector<document::Layer> layers;
};
MovingCase moving_case(const std::string& name);

/// What a frame costs once all keys are solved, seconds each: the median over all frames.
struct FrameSeconds {
  double solve = 0;  ///< all iterations to the minimum
  double skin = 0;   ///< all points once; of a stream with binding them
  double whole = 0;  ///< evaluate(): the frame from the loaded shape to the bent one, on one core
  double points = 0, nodes = 0, iterations = 0;
};
FrameSeconds time_frames(const MovingCase& c);

}  // namespace sinew::benchmarks
