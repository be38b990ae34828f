#pragma once
/// A shape bent by the layers of a project, once and to convergence: what the command line, export and tests use.

#include <functional>
#include <memory>
#include <span>

#include "engine/document/project.h"
#include "engine/document/report.h"
#include "engine/document/workspace.h"

namespace sinew::document {

struct Evaluation {
  std::shared_ptr<const Shape> shape;  ///< bent, with the input's attributes, faces and content
  std::vector<LayerResult> layers;
  std::vector<std::vector<Deformer::Table>> bindings;  ///< of each of `layers`, for a pose file
  std::vector<std::vector<double>> map_energies;       ///< of each of `layers` (Deformer::map_energy)
  std::vector<LayerReport> reports;                    ///< of each of `layers`
};

struct EvaluateOptions {
  std::function<bool(const char* what, std::size_t layer, double fraction)> progress;  ///< see UpdateOptions
  bool measure = false;  ///< fill in all of `reports`: work that the result alone does not need
};

/// Selections are made on `input`; motions act on what a layer starts from, the output of the layers below.
/// Throws InputError, or io::Cancelled where `progress` returned false.
Evaluation evaluate(const std::shared_ptr<const Shape>& input, std::span<const Layer> layers,
                    std::span<const Method> methods, const EvaluateOptions& options = {});

/// The same at one frame of a sequence, with a workspace that may have evaluated others: neither the result nor its
/// bits depend on which. Velocities become those of the bent points: the rates of the maps come from the poses at the
/// frames beside this one.
Evaluation evaluate(Workspace& workspace, std::span<const Layer> layers, int frame,
                    const EvaluateOptions& options = {});

}  // namespace sinew::document
