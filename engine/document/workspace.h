#pragma once
/// Workspace: what is derived from a Project and its input, kept from one update to the next and thrown away at any
/// moment: a deformer per layer, its weights and its pose.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "engine/document/project.h"
#include "engine/document/selection.h"
#include "engine/geometry/deformer.h"

namespace sinew::document {

/// A layer that is on, after an update.
struct LayerResult {
  std::size_t layer = 0;                       ///< its index in Project::layers
  std::shared_ptr<const SkinWeights> weights;  ///< of all points of the input
  std::shared_ptr<const Pose> pose;
  std::shared_ptr<const Deformer::Structure> structure;  ///< of the layer's deformer, at rest, to draw
  SolveReport report;
  Constraints constraints;   ///< that the pose was solved for
  bool solved = false;       ///< false: an earlier pose is carried along, because a layer below is being dragged
  double build_seconds = 0;  ///< making the deformer: its structure and the weights of the points
};

struct UpdateOptions {
  SolveOptions solve;  ///< on_iteration is set by update()
  /// Called while a deformer is made ("building") and after each iteration ("solving", with 0), fraction 0..1;
  /// false stops. May be empty.
  std::function<bool(const char* what, std::size_t layer, double fraction)> progress;
  /// Called after each iteration with all layers so far; false stops. May be empty.
  std::function<bool(const std::vector<LayerResult>&)> on_iteration;
};

struct UpdateResult {
  std::vector<LayerResult> layers;
  bool stopped = false;  ///< a callback said so; `layers` may then lack some
};

class Workspace {
 public:
  /// `methods` must outlive the workspace.
  Workspace(std::shared_ptr<const Shape> input, std::span<const Method> methods);

  const std::shared_ptr<const Shape>& input() const { return input_; }

  /// Brings everything up to date with `layers` (Project::layers). What did not change is not done again: a deformer is
  /// remade when its method, its settings or the output of the layers below changed, a pose is solved again (from where
  /// it is) when constraints or the wanted quality changed. With Quality::Interactive a layer above one that moved is
  /// not remade: its last pose is carried along. Throws InputError.
  UpdateResult update(std::span<const Layer> layers, const UpdateOptions& options);

  /// Deformer of a layer of the last update; null where there is none.
  const Deformer* deformer(std::size_t layer) const;
  /// The rest shape of a layer: the output of the layers below.
  std::shared_ptr<const Shape> rest(std::size_t layer) const;

 private:
  struct Kept {
    Layer layer;  ///< as it was last solved
    std::shared_ptr<const Shape> rest;
    std::shared_ptr<Deformer> deformer;
    std::shared_ptr<const Shape> output;  ///< rest, bent by `result`; null until a layer above asks
    LayerResult result;
    bool settled = false;  ///< the last solve was not stopped
    SolveOptions::Quality quality = SolveOptions::Quality::Interactive;
  };

  std::shared_ptr<const Shape> output(Kept* kept) const;
  bool make(Kept& kept, const Layer& layer, std::size_t index, const UpdateOptions& options);
  bool solve(Kept& kept, const Layer& layer, const UpdateOptions& options, std::vector<LayerResult>& done);

  std::shared_ptr<const Shape> input_;
  std::span<const Method> methods_;
  Selector selector_;
  std::vector<Kept> kept_;
};

}  // namespace sinew::document
