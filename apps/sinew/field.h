#pragma once
/// Field: a number of each point, and the colours that show it.

#include <optional>
#include <string>

#include "engine/document/evaluate.h"
#include "engine/document/field.h"
#include "engine/gpu/colormap.h"

namespace sinew::app {

/// What --color, --colormap and --range ask for.
struct FieldOptions {
  std::string name;  ///< of an attribute or of document::field_names but the influence; empty: none
  gpu::Colormap map = gpu::Colormap::Viridis;
  std::optional<document::ValueRange> range;  ///< nothing: the usual one
};

struct Field {
  document::Field field;
  document::ValueRange range;  ///< that the ends of the colours stand for
  gpu::Colormap map = gpu::Colormap::Viridis;
  double most = 0;  ///< the finite value that is farthest from 0
};

/// An attribute of `shape` is preferred. `evaluation` may be null. Throws UsageError where there is no such thing.
Field field_of(const FieldOptions& options, const Shape& rest, const Shape& shape,
               const document::Evaluation* evaluation);

/// Grey for what is not finite.
gpu::PointColor color_of(const Field& field, double value);

}  // namespace sinew::app
